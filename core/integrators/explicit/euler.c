// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"
#include "integrators/step/compensated.h"
#include "integrators/step/options.h"

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    return hn_explicit_rk_create(&hn_tableau_euler, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_euler = {
    .name = "euler",
    .title = "explicit Euler",
    .about = "One evaluation per step, order 1. An undamped oscillation always grows: for "
             "teaching, not for use.",
    .source = "Euler 1768",
    .order = 1,
    .stages = 1,
    .real_limit = 2,
    .imag_limit = 0,
    .tableau = &hn_tableau_euler,
    .n_options = HN_FIXED_STEP_OPTIONS,
    .options = {HN_OPTIONS_FIXED_STEP},
    .create = create,
    .configure = hn_explicit_rk_configure,
    .step = hn_explicit_rk_step,
    .on_accepted = hn_explicit_rk_accepted,
};
