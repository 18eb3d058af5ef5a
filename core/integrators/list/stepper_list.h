// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_STEPPER_LIST_H
#define HN_INTEGRATORS_STEPPER_LIST_H
// The list of all integrators. A new integrator is one file in its room and one line here.

#include "integrators/step/stepper.h"

/// In the order of `list methods`, the page and the API.
#define HN_STEPPER_LIST(X) \
    X(euler)               \
    X(symplectic_euler)    \
    X(verlet)              \
    X(heun)                \
    X(rk4)                 \
    X(dopri5)              \
    X(dop853)              \
    X(hem3)                \
    X(hem4)                \
    X(hem4_adaptive)       \
    X(half_explicit_rk4)   \
    X(rattle)              \
    X(genalpha)            \
    X(hht)                 \
    X(trapezoidal)         \
    X(ida)                 \
    X(gsl_rk8pd)           \
    X(gsl_msadams)         \
    X(gsl_msbdf)           \
    X(gsl_bsimp)           \
    X(implicit_euler)      \
    X(midpoint)            \
    X(gauss2)              \
    X(gauss3)              \
    X(radau3)              \
    X(radau5)

#define HN_STEPPER_DECLARE(name) extern const hn_stepper hn_stepper_##name;
HN_STEPPER_LIST(HN_STEPPER_DECLARE)
#undef HN_STEPPER_DECLARE

/// The table of integrators: its length, and row i of it.
int hn_stepper_count(void);
const hn_stepper *hn_stepper_at(int i);
/// The integrator of this name ("rk4"); NULL when unknown.
const hn_stepper *hn_stepper_find(const char *name);

#endif
