// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/lookout.h"

#include "dynamics/compile/coordinates.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double AT_END = 0.999; // of a step
// steps of a pilot run in half a turn: 7 degrees each, where RK4 keeps six digits
enum { PILOT_STEPS = 24, NARROWINGS = 24 };
enum { CONFIRMING = 8 };             // times as many steps in the run that confirms a prediction
static const double CONFIRMED = 0.1; // of the time to go: two pilot runs agree
// marks on the way of a pilot run: in one horizon, and kept
enum { MARKS_AHEAD = 8, MARKS = 16 };
// of a radian, or of the characteristic length: a motion this near to the pilot run follows it.
// sigma_min differs there by a few thousandths of its largest, less than what counts as singular
static const double FOLLOWED = 1e-3;

/// A state that a pilot run went through.
typedef struct mark {
    double t, *q, *v;
} mark;

struct hn_lookout {
    const hn_system *sys;
    int nq, nv;
    hn_pilot *pilot;
    double *inside; ///< nq: a configuration inside a step
    double *unit;   ///< nv: the characteristic length for lengths, else 1
    // the last pilot run that found nothing
    bool is_clear;          ///< there is one
    mark end, marks[MARKS]; ///< where it stopped; states on its way, from the oldest, `n` of them
    int n;
    double before, slope; ///< sigma_min at its end, and its change over the last step
    double *way, *moved;  ///< nv: between two marks; from the first of them to a state
};

// ---- life ----

static void create_mark(hn_lookout *l, mark *m, hn_arena *arena) {
    m->q = hn_arena_doubles(arena, (size_t)l->nq);
    m->v = hn_arena_doubles(arena, (size_t)l->nv);
}

hn_status hn_lookout_create(const hn_system *sys, hn_arena *arena, hn_lookout **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_lookout *l = hn_arena_get(arena, sizeof *l);
    *out = NULL;
    if (!l) {
        return HN_ERR_MEMORY;
    }
    *l = (hn_lookout){.sys = sys, .nq = info.nq, .nv = info.nv};

    // room for states
    create_mark(l, &l->end, arena);
    for (int i = 0; i < MARKS; i++) {
        create_mark(l, &l->marks[i], arena);
    }
    l->inside = hn_arena_doubles(arena, (size_t)l->nq);
    double **const of_nv[] = {&l->unit, &l->way, &l->moved};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, (size_t)l->nv);
    }
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    for (int i = 0; i < l->nv; i++) {
        const int user = hn_system_user_coordinate(sys, i);
        const bool is_length = hn_system_scene(sys)->coordinates[user].kind == HN_LENGTH;
        l->unit[i] = is_length ? hn_system_length(sys) : 1;
    }
    HN_TRY(hn_pilot_create(sys, arena, &l->pilot));
    *out = l;
    return HN_OK;
}

void hn_lookout_free(hn_lookout *l) {
    if (l) {
        hn_pilot_free(l->pilot);
        l->pilot = NULL;
    }
}

void hn_lookout_reset(hn_lookout *l) {
    l->is_clear = false;
    l->n = 0;
}

hn_pilot *hn_lookout_pilot(hn_lookout *l) {
    return l->pilot;
}

// ---- one pilot run ----

/// The smallest sigma_min inside the pilot's last step, by golden section; *share: where.
static double smallest_inside(hn_lookout *l, const hn_lookout_aim *aim, double *share) {
    const double golden = 0.6180339887498949, t = hn_pilot_time(l->pilot);
    double low = 0, high = 1, x[2] = {1 - golden, golden}, sigma[2];
    for (int i = 0; i < 2; i++) {
        hn_pilot_inside(l->pilot, x[i], l->inside);
        sigma[i] = aim->probe(aim->user, t, l->inside);
    }
    for (int k = 0; k < NARROWINGS; k++) {
        const int left = sigma[0] < sigma[1], fresh = left ? 0 : 1;
        *(left ? &high : &low) = x[left ? 1 : 0];
        x[!fresh] = x[fresh];
        sigma[!fresh] = sigma[fresh];
        x[fresh] = left ? high - golden * (high - low) : low + golden * (high - low);
        hn_pilot_inside(l->pilot, x[fresh], l->inside);
        sigma[fresh] = aim->probe(aim->user, t, l->inside);
    }
    *share = 0.5 * (low + high);
    return fmin(sigma[0], sigma[1]);
}

/// Returns whether the pilot's last step, at whose end sigma_min is `sigma`, meets what is looked
/// for; *share: where in it.
static bool is_met(hn_lookout *l, const hn_lookout_aim *aim, double sigma, double *share,
                   double *lowest) {
    const double steepest = fmax(l->slope, fabs(sigma - l->before));
    if (!(sigma + l->before < 2 * steepest || sigma < aim->reached)) {
        return false;
    }
    const double smallest = smallest_inside(l, aim, share);
    if (!(smallest < aim->reached &&
          *share < AT_END)) { // lowest at its end: it is in the next step
        return false;
    }
    *lowest = smallest;
    return true;
}

static void take_mark(const hn_lookout *l, mark *m) {
    m->t = hn_pilot_time(l->pilot);
    memcpy(m->q, hn_pilot_q(l->pilot), (size_t)l->nq * sizeof *m->q);
    memcpy(m->v, hn_pilot_v(l->pilot), (size_t)l->nv * sizeof *m->v);
}

/// Marks the pilot's state if the last mark lies `apart` or more behind; the oldest makes room.
static void mark_way(hn_lookout *l, double apart) {
    if (l->n > 0 && hn_pilot_time(l->pilot) < l->marks[l->n - 1].t + apart) {
        return;
    }
    if (l->n == MARKS) {
        const mark oldest = l->marks[0];
        memmove(l->marks, l->marks + 1, (MARKS - 1) * sizeof *l->marks);
        l->marks[--l->n] = oldest;
    }
    take_mark(l, &l->marks[l->n++]);
}

/// The time at which the pilot meets what is looked for before `until`, else HUGE_VAL. It makes
/// `steps` steps for half a turn or `horizon`, and as many more where the motion becomes faster on
/// the way. A run that finds nothing is kept where its steps are the usual ones.
static double walk(hn_lookout *l, double until, double horizon, int steps,
                   const hn_lookout_aim *aim, double *lowest) {
    l->is_clear = false;
    for (int k = 0; k < 2 * steps && hn_pilot_time(l->pilot) < until; k++) {
        // a step of the pilot, short enough for its own rhythm
        const double half_turn = hn_pilot_half_turn(l->pilot, hn_pilot_v(l->pilot));
        const double h = fmin(horizon, half_turn) / steps;
        mark_way(l, horizon / MARKS_AHEAD);
        if (hn_pilot_step(l->pilot, h) != HN_OK) {
            return HUGE_VAL;
        }

        // a fall to zero inside the step, where the ends do not rule it out
        const double t = hn_pilot_time(l->pilot);
        const double sigma = aim->probe(aim->user, t, hn_pilot_q(l->pilot));
        double share = 1;
        if (is_met(l, aim, sigma, &share, lowest)) {
            return t - (1 - share) * h;
        }
        l->slope = fabs(sigma - l->before);
        l->before = sigma;
    }
    take_mark(l, &l->end);
    l->is_clear = steps == PILOT_STEPS;
    return HUGE_VAL;
}

static double walk_from(hn_lookout *l, double t, const double *q, const double *v, double horizon,
                        double sigma_now, int steps, const hn_lookout_aim *aim, double *lowest) {
    l->before = sigma_now;
    l->slope = 0;
    l->n = 0;
    hn_pilot_start(l->pilot, t, q, v);
    return walk(l, t + horizon, horizon, steps, aim, lowest) - t;
}

// ---- going on from the last one ----

/// Returns whether the motion has come where the last pilot run said that it would be, between two
/// of its marks.
static bool is_followed(hn_lookout *l, double t, const double *q) {
    int k = 0;
    while (k + 1 < l->n && l->marks[k + 1].t < t) {
        k++;
    }
    const mark *from = &l->marks[k], *to = k + 1 < l->n ? from + 1 : &l->end;
    if (!l->is_clear || l->n == 0 || !(from->t <= t && t <= to->t && from->t < to->t)) {
        return false;
    }

    // cubic Hermite interpolation between the marks
    const double h = to->t - from->t, s = (t - from->t) / h;
    const double whole = s * s * (3 - 2 * s), first = s * (1 - s) * (1 - s) * h,
                 last = -s * s * (1 - s) * h;
    hn_system_difference(l->sys, from->q, to->q, l->way);
    hn_system_difference(l->sys, from->q, q, l->moved);
    for (int i = 0; i < l->nv; i++) {
        const double there = whole * l->way[i] + first * from->v[i] + last * to->v[i];
        if (!(fabs(l->moved[i] - there) <= FOLLOWED * l->unit[i])) {
            return false;
        }
    }
    return true;
}

/// Takes the last pilot run on to `until`; true where nothing is met on the way.
static bool stays_clear(hn_lookout *l, double until, double horizon, const hn_lookout_aim *aim) {
    double lowest = 0;
    hn_pilot_start(l->pilot, l->end.t, l->end.q, l->end.v);
    (void)walk(l, until, horizon, PILOT_STEPS, aim, &lowest);
    return l->is_clear;
}

double hn_lookout_search(hn_lookout *l, double t, const double *q, const double *v, double horizon,
                         double sigma_now, const hn_lookout_aim *aim, double *lowest) {
    if (is_followed(l, t, q) && stays_clear(l, t + horizon, horizon, aim)) {
        return HUGE_VAL;
    }
    const double coarse = walk_from(l, t, q, v, horizon, sigma_now, PILOT_STEPS, aim, lowest);
    if (!isfinite(coarse)) {
        return HUGE_VAL;
    }
    const double fine =
        walk_from(l, t, q, v, horizon, sigma_now, CONFIRMING * PILOT_STEPS, aim, lowest);
    return fabs(fine - coarse) < CONFIRMED * coarse ? fine : HUGE_VAL;
}
