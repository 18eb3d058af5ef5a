// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "formulations/chart/tangent_space.h"
#include "formulations/ground/formulation.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// Inside one step, from q_n with the bases N_n of the free speeds and Y_n across them
// (tangent_space.h):
//
//     q = q_n moved by  N_n xi + Y_n eta(xi),   eta by Newton on phi(q) = 0                   (1)
//     xi' = N_n' W^-1 (rate of the move),       u = N_n' W^-1 v                               (2)
//
// with state (xi, u); xi' = u where q is a plain vector. Every right-hand side is closed, and xi is
// taken from 0 again at each step, so that no chart of the whole motion is needed. Source: Potra &
// Rheinboldt 1991.

typedef struct nullspace_tangent {
    hn_tspace space;
    double *q, *v, *delta; ///< nq, nv, nv; delta is the move of (1) at the place last closed
    int *ball;             ///< first speeds of the balls
    int n_balls;
} nullspace_tangent;

static bool init(nullspace_tangent *s, const hn_system *sys, hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t nv = (size_t)info.nv;
    s->q = hn_arena_doubles(arena, (size_t)info.nq);
    s->v = hn_arena_doubles(arena, nv);
    s->delta = hn_arena_doubles(arena, nv);
    s->ball = hn_arena_ints(arena, nv);
    if (!s->q || !s->v || !s->delta || !s->ball) {
        return false;
    }
    s->n_balls = 0;
    for (int i = 0; i < info.nv; i++) {
        if (hn_system_position_of(sys, i) < 0) {
            s->ball[s->n_balls++] = i;
            i += 2;
        }
    }
    return true;
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)options;
    nullspace_tangent *s = hn_arena_get(arena, sizeof *s);
    if (!s || !init(s, sys, arena)) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    return hn_tspace_init(&s->space, sys, arena, diag);
}

static void destroy(void *self) {
    nullspace_tangent *s = self;
    hn_tspace_destroy(&s->space);
}

// The pose of (1), Newton beginning at eta = 0.
static hn_status place(nullspace_tangent *s, double t, const double *y, double tol) {
    hn_tspace *ts = &s->space;
    for (int i = 0; i < ts->nv; i++) {
        double move = 0;
        for (int j = 0; j < ts->r; j++) {
            move += ts->N0[i * ts->r + j] * y[j];
        }
        s->delta[i] = move;
    }
    return hn_tspace_close(ts, t, ts->q0, s->delta, s->q, tol);
}

// The rate of a rotation vector d whose turn has the angular velocity w (in the turned axes):
//     d' = w + 1/2 d x w + k d x (d x w),   k = (1 - (a/2) cot(a/2)) / a^2,   a = |d|         (3)
// Hairer, Lubich & Wanner 2006, III.4 (the inverse of dexp).
static void turn_rate(const double d[3], double w[3]) {
    const double a = hypot(hypot(d[0], d[1]), d[2]);
    const double k = a > 1e-2 ? (1 - 0.5 * a / tan(0.5 * a)) / (a * a) : 1.0 / 12 + a * a / 720;
    const double x[3] = {d[1] * w[2] - d[2] * w[1], d[2] * w[0] - d[0] * w[2],
                         d[0] * w[1] - d[1] * w[0]};
    const double xx[3] = {d[1] * x[2] - d[2] * x[1], d[2] * x[0] - d[0] * x[2],
                          d[0] * x[1] - d[1] * x[0]};
    for (int i = 0; i < 3; i++) {
        w[i] += 0.5 * x[i] + k * xx[i];
    }
}

static void rates(nullspace_tangent *s, const double *y, double *xi_dot) {
    hn_tspace *ts = &s->space;
    hn_tspace_speeds(ts, y + ts->r, s->v);
    for (int k = 0; k < s->n_balls; k++) {
        turn_rate(s->delta + s->ball[k], s->v + s->ball[k]);
    }
    hn_tspace_coordinates(ts, s->v, xi_dot);
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    nullspace_tangent *s = self;
    HN_TRY(place(s, t, y, HN_TSPACE_TOL));
    rates(s, y, pos_dot);
    return HN_OK;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    nullspace_tangent *s = self;
    s->space.cost.evals++;
    HN_TRY(kinematics(self, t, y, ydot));
    hn_tspace_speeds(&s->space, y + s->space.r, s->v);
    return hn_tspace_accel(&s->space, s->v, ydot + s->space.r);
}

static void ode(void *self, hn_ode *out) {
    const nullspace_tangent *s = self;
    *out = (hn_ode){.n_pos = s->space.r,
                    .n_vel = s->space.r,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics};
}

// y = (0, u) at the base
static void centre(nullspace_tangent *s, const double *v, double *y) {
    memset(y, 0, (size_t)s->space.r * sizeof *y);
    hn_tspace_coordinates(&s->space, v, y + s->space.r);
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    nullspace_tangent *s = self;
    hn_tspace *ts = &s->space;
    memmove(s->q, q, (size_t)ts->nq * sizeof *q);
    memmove(s->v, v, (size_t)ts->nv * sizeof *v);
    (void)hn_system_normalise(ts->sys, s->q);
    memset(s->delta, 0, (size_t)ts->nv * sizeof *s->delta);
    ts->has_base = ts->valid = 0;
    HN_TRY(hn_tspace_set_base(ts, t, s->q, HN_TSPACE_FRESH));
    HN_TRY(hn_tspace_close(ts, t, ts->q0, s->delta, s->q, HN_TSPACE_TOL_FINE));
    if (!hn_tspace_base_is_at(ts, t, s->q)) {
        HN_TRY(hn_tspace_set_base(ts, t, s->q, HN_TSPACE_FRESH));
    }
    centre(s, s->v, y);
    return HN_OK;
}

static int is_centred(const hn_tspace *ts, double t, const double *y) {
    int zero = ts->has_base && ts->t0 == t;
    for (int j = 0; j < ts->r && zero; j++) {
        zero = y[j] == 0;
    }
    return zero;
}

static hn_status get_state(void *self, double t, const double *y, double *q, double *v) {
    nullspace_tangent *s = self;
    hn_tspace *ts = &s->space;
    const int centred = is_centred(ts, t, y);
    HN_TRY(centred ? hn_tspace_locate(ts, t, ts->q0) : place(s, t, y, HN_TSPACE_TOL_FINE));
    memcpy(q, centred ? ts->q0 : s->q, (size_t)ts->nq * sizeof *q);
    hn_tspace_speeds(ts, y + ts->r, v);
    return HN_OK;
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    nullspace_tangent *s = self;
    hn_tspace *ts = &s->space;
    *changed = 1;
    HN_TRY(place(s, t, y, HN_TSPACE_TOL_FINE));
    (void)hn_system_normalise(ts->sys, s->q);
    hn_tspace_speeds(ts, y + ts->r, s->v);
    HN_TRY(hn_tspace_set_base(ts, t, s->q, HN_TSPACE_CARRIED));
    centre(s, s->v, y);
    return HN_OK;
}

static int state_is_local(const void *self) {
    (void)self;
    return 1;
}

static void add_cost(const void *self, hn_cost *cost) {
    const nullspace_tangent *s = self;
    hn_tspace_add_cost(&s->space, cost);
}

static const char *why(const void *self) {
    const nullspace_tangent *s = self;
    return s->space.why[0] ? s->space.why : NULL;
}

const hn_formulation hn_formulation_nullspace_tangent = {
    .name = "nullspace-tangent",
    .title = "tangent-space coordinates",
    .short_name = "tangent space",
    .rule = "Within one step, describe the motion by its projection onto the tangent space "
            "at the start of the step, with closed loops at every evaluation; the next "
            "step uses a new tangent space.",
    .drift = "none: every evaluation closes the loops",
    .when = "any number of degrees of freedom, no drift, no coordinate that serves for the "
            "whole motion",
    .when_not = "singular configurations; many loops (dense algebra); multistep integrators: "
                "their history ends with every step",
    .source = "Potra & Rheinboldt 1991",
    .needs = "M f phi J gamma",
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_CHART |
              HN_TRAIT_HAS_BASIS,
    .create = create,
    .destroy = destroy,
    .ode = ode,
    .set_state = set_state,
    .get_state = get_state,
    .after_step = after_step,
    .state_is_local = state_is_local,
    .add_cost = add_cost,
    .why = why,
};
