// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_EXPLICIT_RK_H
#define HN_INTEGRATORS_EXPLICIT_RK_H
// One engine for every explicit Runge-Kutta tableau. The functions below fit the slots of
// hn_stepper; a stepper's file adds its tableau and its card.
//
// A rejected step is taken again from the same (t, y): the first stage is kept. After an accepted
// step the last stage of a FSAL method becomes the first of the next one, unless the state was
// changed in between. Dense output: Hairer, Norsett & Wanner 1993, section II.6 (order 4 for
// dopri5, 7 for dop853).

#include "base/arena.h"
#include "base/status.h"
#include "formulations/ground/formulation.h"
#include "integrators/explicit/tableau.h"

/// Memory for steps of n = n_pos + n_vel entries; NULL when the arena has run out.
void *hn_explicit_rk_create(const hn_tableau *tableau, int n, hn_arena *arena);
hn_status hn_explicit_rk_step(void *self, const hn_ode *ode, double t, double h, const double *y,
                              double *y_new, double *err);
hn_status hn_explicit_rk_finish(void *self, const hn_ode *ode); ///< tableau with extra stages only
/// Settings of the fixed-step ones: h, sum.
void hn_explicit_rk_configure(void *self, const double *options);
void hn_explicit_rk_accepted(void *self, int changed);
void hn_explicit_rk_dense(void *self, double theta, double *y); ///< tableau with d only

double hn_explicit_rk_stiffness(const void *self); ///< tableau with a stiff_stage only

#endif
