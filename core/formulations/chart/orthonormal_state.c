// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/orthonormal_state.h"

#include "dynamics/compile/coordinates.h"

#include <string.h>

hn_status hn_orthonormal_init(hn_orthonormal_state *s, const hn_system *sys, int tracked,
                              hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    s->tracked = tracked;
    s->q = hn_arena_doubles(arena, (size_t)info.nq);
    s->v = hn_arena_doubles(arena, (size_t)info.nv);
    s->delta = hn_arena_doubles(arena, (size_t)info.nv);
    if (!s->q || !s->v || !s->delta) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return hn_tspace_init(&s->space, sys, arena, diag);
}

void hn_orthonormal_destroy(void *self) {
    hn_orthonormal_state *s = self;
    hn_tspace_destroy(&s->space);
}

// N and s at (t, q)
static hn_status locate(hn_orthonormal_state *s, double t, const double *q) {
    hn_tspace *ts = &s->space;
    if (!s->tracked && !hn_tspace_base_is_at(ts, t, q)) {
        return hn_tspace_set_base(ts, t, q, HN_TSPACE_FRESH);
    }
    return hn_tspace_locate(ts, t, q);
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    hn_orthonormal_state *s = self;
    HN_TRY(locate(s, t, y));
    hn_tspace_speeds(&s->space, y + s->space.nq, s->v);
    hn_system_kinematics(s->space.sys, y, s->v, pos_dot);
    return HN_OK;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    hn_orthonormal_state *s = self;
    s->space.cost.evals++;
    HN_TRY(kinematics(self, t, y, ydot));
    return hn_tspace_accel(&s->space, s->v, ydot + s->space.nq);
}

void hn_orthonormal_ode(void *self, hn_ode *out) {
    const hn_orthonormal_state *s = self;
    *out = (hn_ode){.n_pos = s->space.nq,
                    .n_vel = s->space.r,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics,
                    .is_angle = hn_system_angles(s->space.sys)};
}

// the loops closed along Y0 from q as it is
static hn_status close_here(hn_orthonormal_state *s, double t, double *q) {
    memcpy(s->q, q, (size_t)s->space.nq * sizeof *q);
    memset(s->delta, 0, (size_t)s->space.nv * sizeof(double));
    return hn_tspace_close(&s->space, t, s->q, s->delta, q, HN_TSPACE_TOL_FINE);
}

hn_status hn_orthonormal_set_state(void *self, double t, const double *q, const double *v,
                                   double *y) {
    hn_orthonormal_state *s = self;
    hn_tspace *ts = &s->space;
    memmove(s->v, v, (size_t)ts->nv * sizeof *v);
    memmove(y, q, (size_t)ts->nq * sizeof *q);
    (void)hn_system_normalise(ts->sys, y);
    ts->has_base = ts->valid = 0;
    HN_TRY(hn_tspace_set_base(ts, t, y, HN_TSPACE_FRESH));
    HN_TRY(close_here(s, t, y));
    if (!hn_tspace_base_is_at(ts, t, y)) {
        HN_TRY(hn_tspace_set_base(ts, t, y, HN_TSPACE_FRESH));
    }
    hn_tspace_coordinates(ts, s->v, y + ts->nq);
    return HN_OK;
}

hn_status hn_orthonormal_get_state(void *self, double t, const double *y, double *q, double *v) {
    hn_orthonormal_state *s = self;
    const int nq = s->space.nq;
    HN_TRY(locate(s, t, y));
    memcpy(q, y, (size_t)nq * sizeof *q);
    hn_tspace_speeds(&s->space, y + nq, v);
    return HN_OK;
}

hn_status hn_orthonormal_after_step(void *self, double t, double *y, int *changed) {
    hn_orthonormal_state *s = self;
    hn_tspace *ts = &s->space;
    *changed = 1;
    (void)hn_system_normalise(ts->sys, y);
    hn_status status = s->tracked ? HN_OK : locate(s, t, y);
    HN_THEN(status, close_here(s, t, y));
    if (status != HN_OK || !s->tracked) {
        return status;
    }
    hn_tspace_speeds(ts, y + ts->nq, s->v);
    HN_TRY(hn_tspace_set_base(ts, t, y, HN_TSPACE_CARRIED));
    hn_tspace_coordinates(ts, s->v, y + ts->nq);
    return HN_OK;
}

void hn_orthonormal_add_cost(const void *self, hn_cost *cost) {
    const hn_orthonormal_state *s = self;
    hn_tspace_add_cost(&s->space, cost);
}

const char *hn_orthonormal_why(const void *self) {
    const hn_orthonormal_state *s = self;
    return s->space.why[0] ? s->space.why : NULL;
}
