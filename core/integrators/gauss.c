#include "integrators/implicit_steppers.h"

#include <math.h>

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
    .about = "Order 4, symmetric; long runs without drift of the energy where the formulation "
             "keeps its structure (reduced, partitioning). Stiff motions are not damped.",
    .source = "Hairer, Lubich & Wanner 2006, II.1",
    .order = 4,
    .stages = 2,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_settings = 1,
    .settings = {HN_SETTING_STEP},
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
    .about = "Order 6, symmetric; long runs without drift of the energy where the formulation "
             "keeps its structure (reduced, partitioning). Stiff motions are not damped.",
    .source = "Hairer, Lubich & Wanner 2006, II.1",
    .order = 6,
    .stages = 3,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_settings = 1,
    .settings = {HN_SETTING_STEP},
    .create = create_gauss3,
    HN_IMPLICIT_ODE_SLOTS,
    .dense_order = 3,
};
