// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_ORTHONORMAL_STATE_H
#define HN_FORMULATIONS_ORTHONORMAL_STATE_H
// The state y = (q, u) with v = N u + s and an orthonormal basis N (tangent_space.h). Tracked, the
// basis of a step is the last one carried along, and the equation knows its rate. Untracked, it is
// found anew at every right-hand side, as a factorisation gives it, and its rate is taken as if it
// had been carried: true until a column changes its sign.

#include "formulations/chart/tangent_space.h"

typedef struct hn_orthonormal_state {
    hn_tspace space;
    int tracked;
    double *q, *v, *delta; ///< nq, nv, nv; scratch
} hn_orthonormal_state;

/// Prepares the state. tracked 1: the basis is carried along. Fails: HN_ERR_MEMORY, reported in
/// diag.
HN_MUST_CHECK hn_status hn_orthonormal_init(hn_orthonormal_state *s, const hn_system *sys,
                                            int tracked, hn_arena *arena, hn_diag *diag);
/// The slots of hn_formulation for formulations that have this state; `self` begins with it.
void hn_orthonormal_destroy(void *self);
void hn_orthonormal_ode(void *self, hn_ode *out);
hn_status hn_orthonormal_set_state(void *self, double t, const double *q, const double *v,
                                   double *y);
hn_status hn_orthonormal_get_state(void *self, double t, const double *y, double *q, double *v);
hn_status hn_orthonormal_after_step(void *self, double t, double *y, int *changed);
void hn_orthonormal_add_cost(const void *self, hn_cost *cost);
const char *hn_orthonormal_why(const void *self);

#endif
