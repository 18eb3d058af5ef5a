// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/tangent_state.h"

#include "dynamics/compile/coordinates.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

hn_status hn_tangent_init(hn_tangent_state *s, const hn_system *sys, bool with_rate,
                          int orthonormal, hn_arena *arena, hn_diag *diag) {
    s->orthonormal = orthonormal;
    s->with_rate = with_rate;
    s->arena = arena;
    s->v = hn_arena_doubles(arena, (size_t)hn_system_get_info(sys).nv);
    if (!s->v) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return hn_chart_init(&s->chart, sys, with_rate, arena, diag);
}

void hn_tangent_destroy(void *self) {
    hn_tangent_state *s = self;
    hn_chart_destroy(&s->chart);
    hn_chart_jacobian_free(&s->slopes);
}

static double column_dot(const double *N, int nv, int r, int i, int j) {
    double sum = 0;
    for (int k = 0; k < nv; k++) {
        sum += N[k * r + i] * N[k * r + j];
    }
    return sum;
}

// Gram-Schmidt on the columns of N, smooth in q because the order is fixed
static void orthonormalise(hn_tangent_state *s, double *N) {
    const int nv = s->chart.nv, r = s->chart.r;
    for (int j = 0; j < r; j++) {
        for (int i = 0; i < j; i++) {
            const double along = column_dot(N, nv, r, i, j);
            for (int k = 0; k < nv; k++) {
                N[k * r + j] -= along * N[k * r + i];
            }
        }
        const double scale = 1 / sqrt(column_dot(N, nv, r, j, j));
        for (int k = 0; k < nv; k++) {
            N[k * r + j] *= scale;
        }
    }
    s->chart.cost.ops += 2.0 * nv * r * (r + 1);
}

static hn_status locate(hn_tangent_state *s, hn_chart_point *p, double t, const double *q) {
    if (hn_chart_is_at(&s->chart, p, t, q)) {
        return HN_OK;
    }
    HN_TRY(hn_chart_locate(&s->chart, p, t, q));
    if (s->orthonormal) {
        orthonormalise(s, p->N);
    }
    return HN_OK;
}

static hn_status close_here(hn_tangent_state *s, double t, double *q) {
    hn_chart_point *p = &s->chart.here;
    HN_TRY(hn_chart_close(&s->chart, p, t, q, HN_CHART_TOL_FINE));
    if (s->orthonormal) {
        orthonormalise(s, p->N);
    }
    return HN_OK;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    hn_tangent_state *s = self;
    const int nq = s->chart.nq;
    s->chart.cost.evals++;
    HN_TRY(locate(s, &s->chart.here, t, y));
    hn_chart_speeds(&s->chart, &s->chart.here, y + nq, s->v);
    hn_system_kinematics(s->chart.sys, y, s->v, ydot);
    return hn_chart_accel(&s->chart, s->v, ydot + nq);
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    hn_tangent_state *s = self;
    HN_TRY(locate(s, &s->chart.here, t, y));
    hn_chart_speeds(&s->chart, &s->chart.here, y + s->chart.nq, s->v);
    hn_system_kinematics(s->chart.sys, y, s->v, pos_dot);
    return HN_OK;
}

static hn_status prepare(void *self) {
    hn_tangent_state *s = self;
    return hn_chart_jacobian_prepare(&s->slopes, &s->chart, s->arena);
}

static hn_status jacobian(void *self, double t, const double *y, double *jac) {
    hn_tangent_state *s = self;
    HN_TRY(locate(s, &s->chart.here, t, y));
    hn_chart_speeds(&s->chart, &s->chart.here, y + s->chart.nq, s->v);
    HN_TRY(hn_chart_jacobian_at(&s->slopes, &s->chart, s->arena, s->v));
    hn_chart_jacobian_speeds(&s->slopes, &s->chart, jac);
    return HN_OK;
}

// The form that leaves out the rate of the basis has accelerations of its own, an orthonormal basis
// turns by a rule of its own, and the positions of balls are not moved one speed at a time: these
// are left to differences.
static bool has_derivatives(const hn_tangent_state *s) {
    return s->with_rate && !s->orthonormal && s->chart.nq == s->chart.nv;
}

void hn_tangent_ode(void *self, hn_ode *out) {
    const hn_tangent_state *s = self;
    *out = (hn_ode){.n_pos = s->chart.nq,
                    .n_vel = s->chart.r,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics,
                    .jacobian = has_derivatives(s) ? jacobian : NULL,
                    .prepare = has_derivatives(s) ? prepare : NULL,
                    .is_angle = hn_system_angles(s->chart.sys)};
}

// u such that N u + s = v for a v that J allows, else the nearest in the sense of the basis
static void speeds_to_basis(const hn_tangent_state *s, const double *v, double *u) {
    const hn_chart *chart = &s->chart;
    const int nv = chart->nv, r = chart->r;
    for (int j = 0; j < r; j++) {
        u[j] = v[chart->ind[j]];
        if (s->orthonormal) {
            u[j] = 0;
            for (int k = 0; k < nv; k++) {
                u[j] += chart->here.N[k * r + j] * (v[k] - chart->here.s[k]);
            }
        }
    }
}

// the rest of a start or a change of chart, once the columns are chosen; s->v holds the velocities
static hn_status settle_in(hn_tangent_state *s, double t, double *y) {
    HN_TRY(close_here(s, t, y));
    speeds_to_basis(s, s->v, y + s->chart.nq);
    return hn_chart_settle(&s->chart);
}

static hn_status start(hn_tangent_state *s, int choice, double t, const double *q, const double *v,
                       double *y) {
    memmove(s->v, v, (size_t)s->chart.nv * sizeof *v);
    memmove(y, q, (size_t)s->chart.nq * sizeof *q);
    (void)hn_system_normalise(s->chart.sys, y);
    HN_TRY(hn_chart_choose(&s->chart, t, y, choice));
    return settle_in(s, t, y);
}

hn_status hn_tangent_change_chart(void *self, double t, double *y) {
    hn_tangent_state *s = self;
    hn_chart *chart = &s->chart;
    hn_chart_speeds(chart, &chart->base, y + chart->nq, s->v);
    HN_TRY(hn_chart_choose_other(chart));
    chart->cost.chart_changes++;
    return settle_in(s, t, y);
}

hn_status hn_tangent_set_state(void *self, double t, const double *q, const double *v, double *y) {
    return start(self, HN_CHART_PREFERRED, t, q, v, y);
}

hn_status hn_tangent_get_state(void *self, double t, const double *y, double *q, double *v) {
    hn_tangent_state *s = self;
    const int nq = s->chart.nq;
    const hn_chart_point *p = &s->chart.base;
    if (!hn_chart_is_at(&s->chart, p, t, y)) {
        const hn_status status = locate(s, &s->chart.probe, t, y);
        if (status != HN_OK) {
            return status;
        }
        p = &s->chart.probe;
    }
    memcpy(q, y, (size_t)nq * sizeof *q);
    hn_chart_speeds(&s->chart, p, y + nq, v);
    return HN_OK;
}

hn_status hn_tangent_after_step(void *self, double t, double *y, int *changed) {
    hn_tangent_state *s = self;
    hn_chart *chart = &s->chart;
    const double h = t - chart->base.t;
    *changed = hn_system_normalise(chart->sys, y) || chart->nc > 0;
    hn_status status = close_here(s, t, y);
    HN_THEN(status, hn_chart_settle(chart));
    if (status != HN_OK || !hn_chart_is_poor(chart, h, HN_CHART_TAU)) {
        return status;
    }
    chart->cost.chart_changes++;
    hn_chart_speeds(chart, &chart->here, y + chart->nq, s->v);
    return start(s, HN_CHART_BEST, t, y, s->v, y);
}

void hn_tangent_add_cost(const void *self, hn_cost *cost) {
    const hn_tangent_state *s = self;
    hn_chart_add_cost(&s->chart, cost);
    hn_chart_jacobian_add_cost(&s->slopes, cost);
}

const char *hn_tangent_why(const void *self) {
    const hn_tangent_state *s = self;
    return s->chart.why[0] ? s->chart.why : NULL;
}
