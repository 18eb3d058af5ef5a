// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"
#include "integrators/step/compensated.h"
#include "integrators/step/options.h"

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    return hn_explicit_rk_create(&hn_tableau_heun, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_heun = {
    .name = "heun",
    .title = "Heun",
    .about = "Two evaluations per step, order 2. An undamped oscillation still grows, but slowly.",
    .source = "Heun 1900",
    .order = 2,
    .stages = 2,
    .real_limit = 2,
    .imag_limit = 0,
    .tableau = &hn_tableau_heun,
    .n_options = HN_FIXED_STEP_OPTIONS,
    .options = {HN_OPTIONS_FIXED_STEP},
    .create = create,
    .configure = hn_explicit_rk_configure,
    .step = hn_explicit_rk_step,
    .on_accepted = hn_explicit_rk_accepted,
};
