// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/motion.h"

#include "dynamics/compile/coordinates.h"

#include "linalg/dense.h"

#include <math.h>

/// The motion between two states.
typedef struct movement {
    double most;  ///< its largest component
    double rest;  ///< the largest that the velocities do not explain
    double along; ///< scalar product of the velocities: negative where they turn round
} movement;

static movement find_movement(const hn_watch *w, const hn_state_at *from, const hn_state_at *to) {
    const hn_stepping *s = w->run;
    const int n = s->info.nv;
    const bool plain = s->info.nq == n; // no quaternions
    const double half = 0.5 * (to->t - from->t), *start = from->q, *end = to->q;
    movement m = {0};
    if (!plain) {
        hn_system_difference(s->sys, from->q, to->q, w->scratch);
    }
    for (int i = 0; i < n; i++) {
        const double u = from->v[i], v = to->v[i];
        const double step = plain ? end[i] - start[i] : w->scratch[i];
        const double way = fabs(step), other = fabs(step - half * (v + u));
        m.most = way > m.most ? way : m.most;
        m.rest = other > m.rest ? other : m.rest;
        m.along += v * u;
    }
    return m;
}

double hn_motion_unexplained_between(const hn_watch *w, const hn_state_at *from,
                                     const hn_state_at *to, double least) {
    const movement m = find_movement(w, from, to);
    const double most = m.most > least ? m.most : least;
    return most > 0 ? m.rest / most : 0;
}

bool hn_motion_is_steady(const hn_watch *w, double share) {
    const movement m = find_movement(w, &w->run->before, &w->run->now);
    return m.along >= 0 && m.rest <= share * m.most;
}

/// Steps of a pilot run: in one of the run, in half a turn of the fastest coordinate, in all.
enum { PILOT_FINER = 8, PILOT_HALF_TURN = 48, PILOT_MOST = 400 };
/// Share of the length: where the loops are open by more a pilot run would follow links that drift
/// apart.
static const double CLOSED = 1e-6;
/// Share of the way between two states: a pilot run that ends this near to the second arrives
/// there.
static const double ARRIVES = 0.25;

const hn_pilot *hn_motion_pilot(hn_watch *w, const hn_state_at *from, double t, double *lowest) {
    hn_pilot *pilot = hn_singularity_pilot(w->singular.monitor);
    const double span = t - from->t;
    const double pace =
        fmin(w->run->h / PILOT_FINER, hn_pilot_half_turn(pilot, from->v) / PILOT_HALF_TURN);
    const int steps = (int)fmin(PILOT_MOST, ceil(span / pace));
    *lowest = HUGE_VAL;
    hn_pilot_start(pilot, from->t, from->q, from->v);
    for (int k = 0; k < steps; k++) {
        if (hn_pilot_step(pilot, span / steps) != HN_OK) {
            return NULL;
        }
        const double sigma =
            hn_singularity_probe(w->singular.monitor, hn_pilot_time(pilot), hn_pilot_q(pilot));
        *lowest = fmin(*lowest, sigma);
    }
    return pilot;
}

bool hn_motion_is_followed(hn_watch *w, const hn_state_at *from, const hn_state_at *to) {
    const hn_stepping *s = w->run;
    double way = 0, rest = 0, lowest = 0;
    const bool closed = w->measure.gap < CLOSED * w->length;
    const hn_pilot *pilot = closed ? hn_motion_pilot(w, from, to->t, &lowest) : NULL;
    if (!pilot) {
        return false;
    }
    hn_system_difference(s->sys, from->q, to->q, w->scratch);
    for (int i = 0; i < s->info.nv; i++) {
        way = fmax(way, fabs(w->scratch[i]));
    }
    hn_system_difference(s->sys, hn_pilot_q(pilot), to->q, w->scratch);
    for (int i = 0; i < s->info.nv; i++) {
        rest = fmax(rest, fabs(w->scratch[i]));
    }
    return rest < ARRIVES * way;
}

double hn_motion_unexplained(const hn_watch *w, double least) {
    return hn_motion_unexplained_between(w, &w->run->before, &w->run->now, least);
}

double hn_motion_way(const hn_watch *w, const double *from, double *step) {
    const hn_stepping *s = w->run;
    double most = 0;
    hn_system_difference(s->sys, from, s->now.q, step);
    for (int i = 0; i < s->info.nc; i++) {
        const double unit = hn_system_row_is_length(s->sys, i) ? w->length : 1;
        const double way = hn_closure_rows_largest(&w->rows, i, step) / unit;
        most = way > most ? way : most;
    }
    return most;
}

// If all links of a loop lie on one line a whole row vanishes: the pivots of K, each measured
// against its own row, do not see that.
double hn_motion_shortest_row(const hn_watch *w, const hn_closure_rows *rows) {
    double least = 1;
    for (int i = 0; i < w->run->info.nc; i++) {
        const double size = hn_closure_rows_length(rows, i);
        const double largest = fmax(w->row_size[i], size);
        least = fmin(least, largest > 0 ? size / largest : 1);
    }
    return least;
}

int hn_motion_dof(const hn_watch *w) {
    return w->run->info.nv - w->start_rank;
}
