// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/work.h"

#include "dynamics/compile/coordinates.h"

#include <math.h>
#include <string.h>

enum { POINTS = 4, MOST_DATA = 3 * HN_WORK_NODES };
// A polynomial through nodes at very uneven distances amplifies the error of the nearer ones.
#define MOST_UNEVEN 5.0

/// Gauss-Legendre nodes and weights on [0, 1]: exact for polynomials of degree 7.
static const double gauss_at[POINTS] = {0.069431844202973714, 0.33000947820757187,
                                        0.66999052179242813, 0.93056815579702629};
static const double gauss_weight[POINTS] = {0.17392742256872693, 0.32607257743127307,
                                            0.32607257743127307, 0.17392742256872693};

// ---- nodes ----

/// q'' of a state from its accelerations: for plain coordinates a itself, for quaternions
/// (G v)' = G(q) a + G(q') v.
static void find_second_rates(hn_work_record *w, hn_work_node *node, const double *v) {
    const hn_system *sys = w->run->sys;
    const int nq = w->run->info.nq, nv = w->run->info.nv;
    hn_system_kinematics(sys, node->q, w->a, node->rate2);
    if (nq == nv) {
        return;
    }
    hn_system_kinematics(sys, node->rate, v, w->q);
    for (int i = 0; i < nv; i++) {
        const int at = hn_system_position_of(sys, i);
        if (at >= 0) {
            w->q[at] = 0; // the rate of a plain coordinate is no function of it
        }
    }
    for (int i = 0; i < nq; i++) {
        node->rate2[i] += w->q[i];
    }
}

static void set_node(hn_work_record *w, hn_work_node *node, const hn_state_at *at, double t_load) {
    const hn_stepping *s = w->run;
    node->t = at->t;
    memcpy(node->q, at->q, (size_t)s->info.nq * sizeof *node->q);
    hn_system_kinematics(s->sys, at->q, at->v, node->rate);
    node->has_rate2 =
        hn_accel_eval(s->accel, t_load, at->q, at->v, 0, 0, w->a, w->lambda, NULL) == HN_OK;
    if (node->has_rate2) {
        find_second_rates(w, node, at->v);
    }
}

// ---- the polynomial through them ----

/// Newton's form through the nodes of one interval.
typedef struct polynomial {
    int n;               ///< data per coordinate
    double origin, unit; ///< time is (t - origin) / unit
    double z[MOST_DATA];
    const hn_work_node *of[MOST_DATA];
    int order[MOST_DATA]; ///< which data of its node: 0 q, 1 q', 2 q''
} polynomial;

static void add_node(polynomial *p, const hn_work_node *node) {
    for (int k = 0; k < (node->has_rate2 ? 3 : 2); k++) {
        p->z[p->n] = (node->t - p->origin) / p->unit;
        p->of[p->n] = node;
        p->order[p->n++] = k;
    }
}

/// The k-th derivative at a node in units of the polynomial, over k!.
static double datum(const polynomial *p, const hn_work_node *node, int k, int i) {
    return k == 0   ? node->q[i]
           : k == 1 ? node->rate[i] * p->unit
                    : node->rate2[i] * p->unit * p->unit / 2;
}

/// Value and rate of coordinate i at the time z of the polynomial, by divided differences.
static void evaluate(const polynomial *p, int i, double z, double *q, double *rate) {
    double d[MOST_DATA] = {0};
    for (int k = 0; k < p->n; k++) {
        d[k] = datum(p, p->of[k], 0, i);
    }
    for (int k = 1; k < p->n; k++) {
        for (int j = p->n - 1; j >= k; j--) {
            const bool same = p->of[j] == p->of[j - k];
            d[j] = same ? datum(p, p->of[j], k, i) : (d[j] - d[j - 1]) / (p->z[j] - p->z[j - k]);
        }
    }
    *q = d[p->n - 1];
    *rate = 0;
    for (int k = p->n - 2; k >= 0; k--) {
        *rate = *rate * (z - p->z[k]) + *q;
        *q = *q * (z - p->z[k]) + d[k];
    }
    *rate /= p->unit;
}

/// v from q' = G v. The columns of G are orthogonal.
static void find_velocities(hn_work_record *w, const double *rate, double *v) {
    const hn_system *sys = w->run->sys;
    const int nq = w->run->info.nq, nv = w->run->info.nv;
    if (nq == nv) {
        memcpy(v, rate, (size_t)nv * sizeof *v);
        return;
    }
    memset(w->column, 0, (size_t)nv * sizeof *w->column);
    for (int i = 0; i < nv; i++) {
        double along = 0, square = 0;
        w->column[i] = 1;
        hn_system_kinematics(sys, w->q, w->column, w->column_rate);
        for (int k = 0; k < nq; k++) {
            along += w->column_rate[k] * rate[k];
            square += w->column_rate[k] * w->column_rate[k];
        }
        v[i] = along / square;
        w->column[i] = 0;
    }
}

// ---- quadrature ----

/// The power at a time inside the interval [W]; NaN where the multipliers are not known.
static double power_at(hn_work_record *w, const polynomial *p, double t) {
    const hn_stepping *s = w->run;
    for (int i = 0; i < s->info.nq; i++) {
        evaluate(p, i, (t - p->origin) / p->unit, &w->q[i], &w->slope[i]);
    }
    hn_system_normalise(s->sys, w->q);
    find_velocities(w, w->slope, w->v);
    if (hn_power_needs_lambda(w->power) &&
        hn_accel_eval(s->accel, t, w->q, w->v, 0, 0, w->a, w->lambda, NULL) != HN_OK) {
        return nan("");
    }
    return hn_power_run(w->power, t, w->q, w->v, w->lambda);
}

static double integrate(hn_work_record *w, const polynomial *p, double from, double to) {
    double sum = 0;
    for (int k = 0; k < POINTS; k++) {
        sum += gauss_weight[k] * power_at(w, p, from + gauss_at[k] * (to - from));
    }
    return sum * (to - from);
}

/// The work between two nodes, in pieces from corner to corner; `older` may be NULL.
static double work_between(hn_work_record *w, const hn_work_node *older, const hn_work_node *from,
                           const hn_work_node *to) {
    polynomial p = {.origin = from->t, .unit = to->t - from->t};
    if (!(p.unit > 0)) {
        return 0;
    }
    add_node(&p, from);
    add_node(&p, to);
    const double before = older ? from->t - older->t : 0;
    if (before * MOST_UNEVEN > p.unit && before < MOST_UNEVEN * p.unit) {
        add_node(&p, older);
    }

    double work = 0, t = from->t;
    double corner = hn_system_next_corner(w->run->sys, t);
    while (corner < to->t) {
        work += integrate(w, &p, t, corner);
        t = corner;
        corner = hn_system_next_corner(w->run->sys, t);
    }
    return work + integrate(w, &p, t, to->t);
}

// ---- along a run ----

void hn_work_start(hn_work_record *w) {
    w->done = w->until = 0;
    w->n = 0;
    w->at_corner = false;
    if (w->on) {
        set_node(w, &w->node[w->n++], &w->run->now, w->run->now.t);
    }
}

/// Makes room for the next node: the oldest is dropped.
static hn_work_node *next_node(hn_work_record *w) {
    if (w->n < HN_WORK_NODES) {
        return &w->node[w->n++];
    }
    const hn_work_node spare = w->node[0];
    w->node[0] = w->node[1];
    w->node[1] = w->node[2];
    w->node[2] = spare;
    return &w->node[2];
}

/// Begins anew at a corner: the motion before it says nothing about the motion after it.
static void begin_after_corner(hn_work_record *w) {
    w->at_corner = false;
    w->n = 0;
    set_node(w, &w->node[w->n++], &w->run->before, w->run->before.t);
}

void hn_work_step(hn_work_record *w) {
    const hn_stepping *s = w->run;
    if (!w->on) {
        return;
    }
    if (w->at_corner) {
        begin_after_corner(w);
    }

    // a step that ends at a corner ends just before it
    const double last = w->node[w->n - 1].t;
    w->at_corner = hn_system_next_corner(s->sys, last) <= s->now.t;
    const double t = w->at_corner ? last + hn_stepping_short_of(last, s->now.t) : s->now.t;
    hn_work_node *now = next_node(w);
    set_node(w, now, &s->now, t);
    w->until = w->done;
    w->done += work_between(w, w->n > 2 ? &w->node[0] : NULL, &w->node[w->n - 2], now);
}

double hn_work_at(hn_work_record *w, const hn_state_at *at) {
    const hn_work_node *now = w->n > 0 ? &w->node[w->n - 1] : NULL;
    if (!w->on || at->t == now->t) {
        return w->done;
    }
    set_node(w, &w->sample, at, at->t);

    // ahead of the last step: past a corner its accelerations are other ones
    if (at->t > now->t) {
        hn_work_node from = *now;
        from.has_rate2 = now->has_rate2 && !w->at_corner;
        const hn_work_node *older = w->n > 1 && !w->at_corner ? now - 1 : NULL;
        return w->done + work_between(w, older, &from, &w->sample);
    }
    return w->n > 1 ? w->until + work_between(w, w->n > 2 ? now - 2 : NULL, now - 1, &w->sample)
                    : w->done;
}

// ---- life ----

static void create_node(hn_work_node *node, hn_arena *arena, size_t nq) {
    node->q = hn_arena_doubles(arena, nq);
    node->rate = hn_arena_doubles(arena, nq);
    node->rate2 = hn_arena_doubles(arena, nq);
}

hn_status hn_work_create(const hn_stepping *run, bool on, hn_work_record *w) {
    hn_arena *arena = run->arena;
    const size_t nq = (size_t)run->info.nq, nv = (size_t)run->info.nv, nc = (size_t)run->info.nc;
    *w = (hn_work_record){.run = run, .on = on};
    if (!on) {
        return HN_OK;
    }

    for (int i = 0; i < HN_WORK_NODES; i++) {
        create_node(&w->node[i], arena, nq);
    }
    create_node(&w->sample, arena, nq);
    double **const positions[] = {&w->q, &w->slope, &w->column_rate};
    double **const velocities[] = {&w->v, &w->a, &w->column};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) {
        *positions[i] = hn_arena_doubles(arena, nq);
        *velocities[i] = hn_arena_doubles(arena, nv);
    }
    w->lambda = hn_arena_doubles(arena, nc);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : hn_power_create(run->sys, arena, &w->power);
}

void hn_work_free(hn_work_record *w) {
    hn_power_free(w->power);
}
