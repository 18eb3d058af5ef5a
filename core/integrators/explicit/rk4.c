// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"
#include "integrators/step/compensated.h"
#include "integrators/step/options.h"

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    return hn_explicit_rk_create(&hn_tableau_rk4, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_rk4 = {
    .name = "rk4",
    .title = "Runge-Kutta 4",
    .about = "Four evaluations per step, order 4: the classical choice for smooth motion at a "
             "fixed step.",
    .source = "Kutta 1901",
    .order = 4,
    .stages = 4,
    .real_limit = 2.785293563405282,
    .imag_limit = 2.8284271247461903,
    .tableau = &hn_tableau_rk4,
    .n_options = HN_FIXED_STEP_OPTIONS,
    .options = {HN_OPTIONS_FIXED_STEP},
    .create = create,
    .configure = hn_explicit_rk_configure,
    .step = hn_explicit_rk_step,
    .on_accepted = hn_explicit_rk_accepted,
};
