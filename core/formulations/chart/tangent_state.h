// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_TANGENT_STATE_H
#define HN_FORMULATIONS_TANGENT_STATE_H
// Common part of both null-space formulations: the state y = (q, u) with v = N(q) u + s, so that J
// v + phi_t = 0 holds exactly at any q. Positions drift inside a step only: at its end the
// dependent coordinates are closed by Newton.

#include "formulations/chart/chart.h"
#include "formulations/chart/chart_jacobian.h"

#include <stdbool.h>

typedef struct hn_tangent_state {
    hn_chart chart;
    hn_chart_jacobian slopes;
    hn_arena *arena;
    bool with_rate; ///< see hn_tangent_init
    /// 1: the columns of N have length 1 and are orthogonal, 0: N = [I; -J_d^-1 J_i]
    int orthonormal;
    double *v; ///< nv, scratch
} hn_tangent_state;

/// `with_rate` 0 leaves out the basis-rate term (a model error, see nullspace_as_printed.c).
HN_MUST_CHECK hn_status hn_tangent_init(hn_tangent_state *s, const hn_system *sys, bool with_rate,
                                        int orthonormal, hn_arena *arena, hn_diag *diag);
void hn_tangent_destroy(void *self);
void hn_tangent_ode(void *self, hn_ode *out);
hn_status hn_tangent_set_state(void *self, double t, const double *q, const double *v, double *y);
hn_status hn_tangent_get_state(void *self, double t, const double *y, double *q, double *v);
/// Goes on in another chart, as hn_minimal_change_chart().
hn_status hn_tangent_change_chart(void *self, double t, double *y);
hn_status hn_tangent_after_step(void *self, double t, double *y, int *changed);
void hn_tangent_add_cost(const void *self, hn_cost *cost);
const char *hn_tangent_why(const void *self);

#endif
