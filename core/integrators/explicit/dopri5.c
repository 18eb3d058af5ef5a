// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"
#include "integrators/step/options.h"

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    return hn_explicit_rk_create(&hn_tableau_dopri5, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_dopri5 = {
    .name = "dopri5",
    .title = "Dormand-Prince 5(4)",
    .about = "Chooses its own step from rtol and atol; order 5, dense output of order 4. On stiff "
             "undamped springs it takes smaller steps than rk4. After 5 s the motion of a pole on "
             "a cart is off by about 5 times rtol; over the shipped scenes at rtol=1e-6 the median "
             "error "
             "is 32 times rtol, and one scene in ten has more than 2600 times rtol.",
    .source = "Dormand & Prince 1980; Hairer, Norsett & Wanner 1993, II.4-II.6",
    .order = 5,
    .stages = 6,
    .adaptive = true,
    .real_limit = 3.306567892634947,
    .imag_limit = 0.9971890086325299,
    .n_options = HN_ADAPTIVE_OPTIONS_OR_FIXED,
    .options = {HN_OPTIONS_ADAPTIVE_OR_FIXED},
    .create = create,
    .step = hn_explicit_rk_step,
    .on_accepted = hn_explicit_rk_accepted,
    .dense = hn_explicit_rk_dense,
    .stiffness = hn_explicit_rk_stiffness,
    .dense_order = 4,
};
