// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/compensated.h"
#include "integrators/step/options.h"

#include <string.h>

// v1 = v0 + h a(t, q0, v0),   q1 = q0 + h qdot(q0, v1)
// (1)
//
// Speeds first, positions with the new speeds. On a separable conservative system the map is
// symplectic, so energy oscillates instead of drifting. Source: Hairer, Lubich & Wanner 2006,
// section I.1.2.

typedef struct symplectic_euler {
    int n_pos, n_vel;
    double *slope; // n_pos + n_vel
    double *mixed; // old positions, new speeds
    hn_compensated sum;
} symplectic_euler;

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    symplectic_euler *se = hn_arena_get(arena, sizeof *se);
    if (!se) {
        return NULL;
    }
    se->n_pos = n_pos;
    se->n_vel = n_vel;
    se->slope = hn_arena_doubles(arena, (size_t)(n_pos + n_vel));
    se->mixed = hn_arena_doubles(arena, (size_t)(n_pos + n_vel));
    return hn_compensated_init(&se->sum, n_pos + n_vel, arena) && !hn_arena_failed(arena) ? se
                                                                                          : NULL;
}

static void configure(void *self, const double *options) {
    symplectic_euler *se = self;
    hn_compensated_switch(&se->sum, options[HN_FIXED_STEP_SUM] != 0);
}

static hn_status step(void *self, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err) {
    (void)err;
    symplectic_euler *se = self;
    HN_TRY(ode->rhs(ode->self, t, y, se->slope));
    const int n_pos = se->n_pos, n_vel = se->n_vel;
    for (int i = 0; i < n_vel; i++) {
        se->slope[n_pos + i] *= h;
    }
    hn_compensated_add(&se->sum, n_pos, n_vel, y, se->slope + n_pos, y_new);
    memcpy(se->mixed, y, (size_t)n_pos * sizeof *y);
    memcpy(se->mixed + n_pos, y_new + n_pos, (size_t)n_vel * sizeof *y);
    HN_TRY(ode->kinematics(ode->self, t, se->mixed, se->slope));
    for (int i = 0; i < n_pos; i++) {
        se->slope[i] *= h;
    }
    hn_compensated_add(&se->sum, 0, n_pos, y, se->slope, y_new);
    return HN_OK;
}

static void accepted(void *self, int changed) {
    symplectic_euler *se = self;
    hn_compensated_accepted(&se->sum, changed);
}

const hn_stepper hn_stepper_symplectic_euler = {
    .name = "symplectic-euler",
    .title = "symplectic Euler",
    .about = "Computes new velocities first, then positions from them. Order 1, but the energy "
             "error of a conservative motion stays bounded.",
    .source = "Hairer, Lubich & Wanner 2006, I.1.2",
    .order = 1,
    .stages = 1,
    .partitioned = true,
    .real_limit = 0.8284271247461903, // of x'' + 2 a x' + a^2 x = 0: a h < 2 (sqrt 2 - 1)
    .imag_limit = 2,
    .n_options = HN_FIXED_STEP_OPTIONS,
    .options = {HN_OPTIONS_FIXED_STEP},
    .create = create,
    .configure = configure,
    .step = step,
    .on_accepted = accepted,
};
