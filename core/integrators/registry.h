#ifndef HN_INTEGRATORS_REGISTRY_H
#define HN_INTEGRATORS_REGISTRY_H
// The steppers that exist; each is defined in its own file.
#include "integrators/stepper.h"

extern const hn_stepper hn_stepper_euler, hn_stepper_symplectic_euler, hn_stepper_heun,
    hn_stepper_rk4, hn_stepper_dopri5;

/// The one setting of every fixed-step integrator.
#define HN_SETTING_STEP \
    { "h", 1e-3, 1e-12, 100, "s", "step size", NULL, 0, 0 }

#endif
