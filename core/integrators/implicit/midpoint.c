// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_steppers.h"
#include "integrators/step/dae_base.h"

#include <math.h>

static hn_collocation nodes_of_midpoint(void) {
    hn_collocation col;
    const double c[] = {0.5};
    hn_collocation_init(&col, 1, 2, c);
    return col;
}

static void *create_midpoint(int n_pos, int n_vel, hn_arena *arena) {
    const hn_collocation col = nodes_of_midpoint();
    return hn_implicit_ode_create(&col, n_pos + n_vel, arena);
}

static hn_status create_midpoint_dae(const hn_system *sys, hn_dae_form form, const double *options,
                                     const double *form_options, hn_arena *arena, void **self,
                                     hn_diag *diag) {
    const hn_collocation col = nodes_of_midpoint();
    const hn_implicit_dae_opts opts = {.at_end = 1,
                                       .close = hn_dae_close_option(form, form_options)};
    (void)options;
    return hn_implicit_dae_create(sys, form, &col, &opts, arena, self, diag);
}

static const hn_dae_stepper midpoint_dae = {.create = create_midpoint_dae, HN_IMPLICIT_DAE_SLOTS};

const hn_stepper hn_stepper_midpoint = {
    .name = "midpoint",
    .title = "implicit midpoint",
    .about = "Order 2, symmetric; the energy error stays bounded in long runs. Stiff motions are "
             "not damped: they change their sign at each step. With index2 the constraints hold at "
             "the end of the step, and the multipliers belong to its middle.",
    .source = "Hairer, Lubich & Wanner 2006, II.1; Hairer & Wanner 1996, IV.3",
    .order = 2,
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = HN_FORM_BIT(HN_FORM_ODE) | HN_FORM_BIT(HN_FORM_INDEX2),
    .dae = &midpoint_dae,
    .create = create_midpoint,
    HN_IMPLICIT_ODE_SLOTS,
    .dense_order = 1,
};
