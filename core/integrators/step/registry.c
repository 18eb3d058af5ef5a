#include "integrators/step/registry.h"

#include <string.h>

static const hn_stepper *const steppers[] = {
    &hn_stepper_euler,
    &hn_stepper_symplectic_euler,
    &hn_stepper_verlet,
    &hn_stepper_heun,
    &hn_stepper_rk4,
    &hn_stepper_dopri5,
    &hn_stepper_dop853,
    &hn_stepper_hem3,
    &hn_stepper_hem4,
    &hn_stepper_hem4_adaptive,
    &hn_stepper_half_explicit_rk4,
    &hn_stepper_rattle,
    &hn_stepper_genalpha,
    &hn_stepper_hht,
    &hn_stepper_trapezoidal,
    &hn_stepper_ida,
    &hn_stepper_gsl_rk8pd,
    &hn_stepper_gsl_msadams,
    &hn_stepper_gsl_msbdf,
    &hn_stepper_gsl_bsimp,
    &hn_stepper_implicit_euler,
    &hn_stepper_midpoint,
    &hn_stepper_gauss2,
    &hn_stepper_gauss3,
    &hn_stepper_radau3,
    &hn_stepper_radau5,
};
enum { N_STEPPERS = sizeof steppers / sizeof steppers[0] };

int hn_stepper_serves(const hn_stepper *stepper, hn_dae_form form) {
    return stepper->forms ? (stepper->forms >> form & 1u) != 0 : form == HN_FORM_ODE;
}

int hn_stepper_count(void) {
    return N_STEPPERS;
}

const hn_stepper *hn_stepper_at(int i) {
    HN_ASSERT(i >= 0 && i < N_STEPPERS);
    return steppers[i];
}

const hn_stepper *hn_stepper_find(const char *name) {
    for (int i = 0; i < N_STEPPERS; i++) {
        if (strcmp(steppers[i]->name, name) == 0) {
            return steppers[i];
        }
    }
    return NULL;
}
