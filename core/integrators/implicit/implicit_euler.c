// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_steppers.h"
#include "integrators/step/dae_base.h"

#include <math.h>

static hn_collocation nodes_of_implicit_euler(void) {
    hn_collocation col;
    const double c[] = {1};
    hn_collocation_init(&col, 1, 1, c);
    return col;
}

static void *create_implicit_euler(int n_pos, int n_vel, hn_arena *arena) {
    const hn_collocation col = nodes_of_implicit_euler();
    return hn_implicit_ode_create(&col, n_pos + n_vel, arena);
}

static hn_status create_implicit_euler_dae(const hn_system *sys, hn_dae_form form,
                                           const double *options, const double *form_options,
                                           hn_arena *arena, void **self, hn_diag *diag) {
    const hn_collocation col = nodes_of_implicit_euler();
    const hn_implicit_dae_opts opts = {.close = hn_dae_close_option(form, form_options),
                                       .projects = hn_dae_projects_speeds(form, form_options)};
    (void)options;
    return hn_implicit_dae_create(sys, form, &col, &opts, arena, self, diag);
}

static const hn_dae_stepper implicit_euler_dae = {.create = create_implicit_euler_dae,
                                                  HN_IMPLICIT_DAE_SLOTS};

const hn_stepper hn_stepper_implicit_euler = {
    .name = "implicit-euler",
    .title = "implicit Euler",
    .about =
        "Takes the slope at the end of the step: order 1. It damps every stiff motion, and slow "
        "motions too. It also solves the differential-algebraic forms (ggl, index2, index3).",
    .source = "Hairer & Wanner 1996, IV.3",
    .order = 1,
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = HN_FORMS_STIFFLY_ACCURATE,
    .dae = &implicit_euler_dae,
    .create = create_implicit_euler,
    HN_IMPLICIT_ODE_SLOTS,
    .dense_order = 1,
};
