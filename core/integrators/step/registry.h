#ifndef HN_INTEGRATORS_REGISTRY_H
#define HN_INTEGRATORS_REGISTRY_H
// The steppers that exist; each is defined in its own file.
#include "integrators/step/stepper.h"

extern const hn_stepper hn_stepper_euler, hn_stepper_symplectic_euler, hn_stepper_verlet,
    hn_stepper_heun, hn_stepper_rk4, hn_stepper_dopri5, hn_stepper_dop853, hn_stepper_gsl_rk8pd,
    hn_stepper_gsl_msadams, hn_stepper_gsl_msbdf, hn_stepper_gsl_bsimp, hn_stepper_ida;

extern const hn_stepper hn_stepper_hem3, hn_stepper_hem4, hn_stepper_hem4_adaptive,
    hn_stepper_half_explicit_rk4, hn_stepper_rattle, hn_stepper_genalpha, hn_stepper_trapezoidal,
    hn_stepper_hht;

extern const hn_stepper hn_stepper_implicit_euler, hn_stepper_midpoint, hn_stepper_gauss2,
    hn_stepper_gauss3, hn_stepper_radau3, hn_stepper_radau5;

/// The one setting of every fixed-step integrator.
#define HN_SETTING_STEP \
    { "h", 1e-3, 1e-12, 100, "s", "step size", NULL, 0, 0 }

/// The settings of adaptive ones; HN_SETTINGS_ADAPTIVE is what they share.
#define HN_SETTING_TOLERANCES                                                                      \
    {"rtol", 1e-6, 1e-14, 0.1, "", "relative error allowed in a step", NULL, 0, 0}, {              \
        "atol", 0, 0, 1, "", "absolute error allowed in a step; 0: the same number as rtol", NULL, \
            0, 0                                                                                   \
    }
#define HN_SETTING_FIRST_STEP \
    { "h0", 0, 0, 100, "s", "first step; 0: chosen from the slope", NULL, 0, 0 }
#define HN_SETTING_LARGEST_STEP \
    { "hmax", 0, 0, 100, "s", "largest step; 0: no limit", NULL, 0, 0 }
/// Of adaptive ones that can be held to a step.
#define HN_SETTING_FIXED_STEP \
    { "h", 0, 0, 100, "s", "fixed step; 0: chosen from rtol and atol", NULL, 0, 0 }
#define HN_SETTINGS_ADAPTIVE HN_SETTING_TOLERANCES, HN_SETTING_FIRST_STEP, HN_SETTING_LARGEST_STEP

#endif
