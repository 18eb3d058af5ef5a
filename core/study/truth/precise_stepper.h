// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PRECISE_STEPPER_H
#define HN_STUDY_PRECISE_STEPPER_H
// y' = f(t, y) in extended precision, in two ways that share nothing: a table each. Both choose
// their steps.

#include "study/truth/precise_model.h"

typedef struct hn_precise_ode {
    int n;
    HN_MUST_CHECK hn_status (*rate)(void *user, hn_real t, const hn_real *y, hn_real *dy);
    void *user;
    /// n: what an error of 1 in each entry is worth; may change between steps
    const hn_real *scale;
    hn_real tol; ///< of a step, times the scale
} hn_precise_ode;

typedef struct hn_precise_stepper {
    const char *name; ///< second half of a computation's name
    HN_MUST_CHECK hn_status (*create)(const hn_precise_ode *ode, hn_arena *arena, void **ws);
    /// One step from (t, y) of at most *h: y in place, the step taken in *taken, the next to try in
    /// *h. Fails: HN_ERR_STEP_UNDERFLOW below `least`; as rate() does when even that step cannot be
    /// taken.
    HN_MUST_CHECK hn_status (*step)(void *ws, hn_real t, hn_real *y, hn_real least, hn_real *h,
                                    hn_real *taken);
    /// The motion has a corner here: nothing of the step before says anything about the next.
    void (*forget)(void *ws);
} hn_precise_stepper;

/// Extrapolated midpoint steps (Gragg, Bulirsch and Stoer): order and step chosen.
extern const hn_precise_stepper hn_precise_extrapolation;
/// Gauss collocation with ten stages, order 20, its equations iterated to rounding.
extern const hn_precise_stepper hn_precise_gauss;
#endif
