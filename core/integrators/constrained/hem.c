// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/constrained/half_explicit.h"
#include "integrators/step/dae_base.h"
#include "integrators/step/options.h"

#define HALF_EXPLICIT(name, scheme, doubled)                                                      \
    static hn_status create_##name(const hn_system *sys, hn_dae_form form, const double *options, \
                                   const double *form_options, hn_arena *arena, void **self,      \
                                   hn_diag *diag) {                                               \
        (void)options;                                                                            \
        const int close = hn_dae_close_option(form, form_options);                                \
        return hn_half_explicit_create(&(scheme), doubled, close, sys, arena, self, diag);        \
    }                                                                                             \
    static const hn_dae_stepper dae_##name = {                                                    \
        .create = create_##name,                                                                  \
        .destroy = hn_half_explicit_destroy,                                                      \
        .start = hn_half_explicit_start,                                                          \
        .step = hn_half_explicit_step,                                                            \
        .on_accepted = hn_half_explicit_accepted,                                                 \
        .raw_lambda = hn_half_explicit_raw_lambda,                                                \
        .add_cost = hn_half_explicit_add_cost,                                                    \
        .why = hn_half_explicit_why,                                                              \
    }

HALF_EXPLICIT(hem3, hn_half_explicit_hem3, 0);
HALF_EXPLICIT(hem4, hn_half_explicit_hem4, 0);
HALF_EXPLICIT(hem4a, hn_half_explicit_hem4, 1);
HALF_EXPLICIT(hrk4, hn_half_explicit_rk4, 0);

const hn_stepper hn_stepper_hem3 = {
    .name = "hem3",
    .title = "half-explicit Runge-Kutta 3",
    .about = "Three explicit stages. The multipliers of each stage make the velocities of the next "
             "stage satisfy J v = 0 to rounding; no Newton iteration and no rate of J is needed. "
             "The gap drifts with the error of the method.",
    .source = "Brasey & Hairer 1993",
    .order = 3,
    .stages = 3,
    .real_limit = 2.513,
    .imag_limit = 1.732,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = 1u << HN_FORM_INDEX2,
    .dae = &dae_hem3,
};

const hn_stepper hn_stepper_hem4 = {
    .name = "hem4",
    .title = "half-explicit Runge-Kutta 4",
    .about = "Five explicit stages of order 4 for the index-2 system. The velocities satisfy J v = "
             "0 at every stage; the gap drifts with the error of the method.",
    .source = "Brasey & Hairer 1993",
    .order = 4,
    .stages = 5,
    .real_limit = 5.364,
    .imag_limit = 3.275,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = 1u << HN_FORM_INDEX2,
    .dae = &dae_hem4,
};

const hn_stepper hn_stepper_hem4_adaptive = {
    .name = "hem4-adaptive",
    .title = "half-explicit Runge-Kutta 4, adaptive",
    .about = "hem4 with an error estimate by step doubling: each step is made once whole and once "
             "as two half steps, and the half steps are kept. A partitioned pair of order 5(4), "
             "PHEM56 (Murua 1997), would need fewer evaluations; it is not included, because no "
             "source was found with which its coefficients could be checked. rtol limits the error "
             "of one step, not that of the motion: over the shipped scenes at rtol=1e-6 the median "
             "error is 320 times rtol, and one scene in ten has more than 9000 times rtol.",
    .source = "Brasey & Hairer 1993; Hairer, Norsett & Wanner 1993, section II.4",
    .order = 4,
    .control_order = 5,
    .stages = 15,
    .adaptive = true,
    .real_limit = 10.729,
    .imag_limit = 6.551,
    .n_options = HN_ADAPTIVE_OPTIONS,
    .options = {HN_OPTIONS_ADAPTIVE},
    .forms = 1u << HN_FORM_INDEX2,
    .dae = &dae_hem4a,
};

const hn_stepper hn_stepper_half_explicit_rk4 = {
    .name = "half-explicit-rk4",
    .title = "Runge-Kutta 4, used half-explicitly",
    .about = "A counter-example: the classical tableau meets the conditions of order 4 for "
             "ordinary differential equations, but not those for index 2, where its order is 3.",
    .source = "Brasey & Hairer 1993; Hairer, Lubich & Roche 1989",
    .order = 3,
    .stages = 4,
    .real_limit = 2.785,
    .imag_limit = 2.828,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = 1u << HN_FORM_INDEX2,
    .dae = &dae_hrk4,
};
