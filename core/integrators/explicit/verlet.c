// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/compensated.h"
#include "integrators/step/options.h"

#include <string.h>

// v' = v + h/2 a(t, q, v) q1 = q + h qdot(q + h/2 qdot(q, v), v')
// (1) v1 = v' + h/2 a(t + h, q1, v' + h/2 a(t, q, v))
//
// With qdot = v and accelerations that do not depend on speed this is velocity Verlet: the midpoint
// in the middle line is v' itself, and the predicted speed in the last line is not looked at. If
// positions turn with their rates (tangent coordinates) or forces depend on speed (every mechanism
// in angles), the two keep the order at 2, but the map is then not symplectic. The acceleration is
// taken anew at the start of each step, at the state that was kept. Source: Swope et al. 1982;
// Hairer, Lubich & Wanner 2003, Geometric numerical integration illustrated by Stormer-Verlet.

typedef struct verlet {
    int n_pos, n_vel;
    double *slope; // n_pos + n_vel
    double *mixed; // n_pos + n_vel: a state to evaluate at
    double *half;  // n_vel: v' - v = h/2 a
    hn_compensated sum;
} verlet;

static void *create(int n_pos, int n_vel, hn_arena *arena) {
    verlet *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return NULL;
    }
    s->n_pos = n_pos;
    s->n_vel = n_vel;
    s->slope = hn_arena_doubles(arena, (size_t)(n_pos + n_vel));
    s->mixed = hn_arena_doubles(arena, (size_t)(n_pos + n_vel));
    s->half = hn_arena_doubles(arena, (size_t)n_vel);
    return hn_compensated_init(&s->sum, n_pos + n_vel, arena) && !hn_arena_failed(arena) ? s : NULL;
}

static void configure(void *self, const double *options) {
    verlet *s = self;
    hn_compensated_switch(&s->sum, options[HN_FIXED_STEP_SUM] != 0);
}

// the middle line of (1): new positions from s->slope = y' at y and the kicked speeds in s->half
static hn_status drift(verlet *s, const hn_ode *ode, double t, double h, const double *y,
                       double *y_new) {
    for (int i = 0; i < s->n_pos; i++) {
        s->mixed[i] = y[i] + h / 2 * s->slope[i];
    }
    for (int i = 0; i < s->n_vel; i++) {
        s->mixed[s->n_pos + i] = y[s->n_pos + i] + s->half[i];
    }
    HN_TRY(ode->kinematics(ode->self, t + h / 2, s->mixed, s->slope));
    for (int i = 0; i < s->n_pos; i++) {
        s->slope[i] *= h;
    }
    hn_compensated_add(&s->sum, 0, s->n_pos, y, s->slope, y_new);
    return HN_OK;
}

static hn_status step(void *self, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err) {
    (void)err;
    verlet *s = self;
    const int n_pos = s->n_pos, n_vel = s->n_vel;
    HN_TRY(ode->rhs(ode->self, t, y, s->slope));
    for (int i = 0; i < n_vel; i++) {
        s->half[i] = h / 2 * s->slope[n_pos + i];
    }
    HN_TRY(drift(s, ode, t, h, y, y_new));
    memcpy(s->mixed, y_new, (size_t)n_pos * sizeof *y);
    for (int i = 0; i < n_vel; i++) {
        s->mixed[n_pos + i] = y[n_pos + i] + 2 * s->half[i];
    }
    HN_TRY(ode->rhs(ode->self, t + h, s->mixed, s->slope));
    for (int i = 0; i < n_vel; i++) {
        s->half[i] += h / 2 * s->slope[n_pos + i];
    }
    hn_compensated_add(&s->sum, n_pos, n_vel, y, s->half, y_new);
    return HN_OK;
}

static void accepted(void *self, int changed) {
    verlet *s = self;
    hn_compensated_accepted(&s->sum, changed);
}

const hn_stepper hn_stepper_verlet = {
    .name = "verlet",
    .title = "velocity Verlet",
    .about = "Half a step of the velocities, a step of the positions, half a step of the "
             "velocities: order 2. Where forces depend on positions alone, the energy error stays "
             "bounded. Where they depend on velocities, as in every mechanism described by angles, "
             "the energy is only as accurate as the order.",
    .source = "Swope, Andersen, Berens & Wilson 1982; Hairer, Lubich & Wanner 2003",
    .order = 2,
    .stages = 2,
    .partitioned = true,
    .real_limit = 1.0, // of x'' + 2 a x' + a^2 x = 0: a h < 1
    .imag_limit = 2,
    .n_options = HN_FIXED_STEP_OPTIONS,
    .options = {HN_OPTIONS_FIXED_STEP},
    .create = create,
    .configure = configure,
    .step = step,
    .on_accepted = accepted,
};
