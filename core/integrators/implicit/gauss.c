// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_steppers.h"

#include <math.h>

// Hairer & Wanner 1996, VII.4: on index 2, s Gauss stages have order s + 1 in the state and s - 1
// in the multipliers where s is odd, s and s - 2 where it is even, because J v is asked for at the
// stages and only extrapolated, with |R(infinity)| = 1, to the end.
#define NOT_INDEX_2                                                                          \
    "no stage of Gauss stands at the end of a step: on index 2 two stages have order 2 and " \
    "multipliers that do not converge, three 4 and 2; midpoint asks for the loop at the end"

static hn_collocation nodes_of_gauss2(void) {
    hn_collocation col;
    const double c[] = {0.5 - sqrt(3) / 6, 0.5 + sqrt(3) / 6};
    hn_collocation_init(&col, 2, 4, c);
    return col;
}

static void *create_gauss2(int n_pos, int n_vel, hn_arena *arena) {
    const hn_collocation col = nodes_of_gauss2();
    return hn_implicit_ode_create(&col, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_gauss2 = {
    .name = "gauss2",
    .title = "Gauss, 2 stages",
    .about =
        "Order 4, symmetric. In long runs the energy does not drift if the formulation preserves "
        "this (reduced, partitioning). Stiff motions are not damped. Not for index2: no stage is "
        "at the end of the step, so the order falls to 2 and the multipliers do not converge.",
    .source = "Hairer, Lubich & Wanner 2006, II.1; Hairer & Wanner 1996, VII.4",
    .unserved = NOT_INDEX_2,
    .order = 4,
    .stages = 2,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .create = create_gauss2,
    HN_IMPLICIT_ODE_SLOTS,
    .dense_order = 2,
};

static hn_collocation nodes_of_gauss3(void) {
    hn_collocation col;
    const double c[] = {0.5 - sqrt(15) / 10, 0.5, 0.5 + sqrt(15) / 10};
    hn_collocation_init(&col, 3, 6, c);
    return col;
}

static void *create_gauss3(int n_pos, int n_vel, hn_arena *arena) {
    const hn_collocation col = nodes_of_gauss3();
    return hn_implicit_ode_create(&col, n_pos + n_vel, arena);
}

const hn_stepper hn_stepper_gauss3 = {
    .name = "gauss3",
    .title = "Gauss, 3 stages",
    .about =
        "Order 6, symmetric. In long runs the energy does not drift if the formulation preserves "
        "this (reduced, partitioning). Stiff motions are not damped. Not for index2: no stage is "
        "at the end of the step, so the order falls to 4, and that of the multipliers to 2.",
    .source = "Hairer, Lubich & Wanner 2006, II.1; Hairer & Wanner 1996, VII.4",
    .unserved = NOT_INDEX_2,
    .order = 6,
    .stages = 3,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .create = create_gauss3,
    HN_IMPLICIT_ODE_SLOTS,
    .dense_order = 3,
};
