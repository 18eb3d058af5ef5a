// SPDX-License-Identifier: GPL-3.0-or-later
// Flows against motions in closed form, and derivatives that are carried back along them.

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "study/budget/flow.h"
#include "support/model.h"
#include "support/near.h"
#include "support/odes.h"

#include "dynamics/evaluate/eval.h"
#include "formulations/ground/accel_jacobian.h"

#include <math.h>
#include <string.h>

enum { MOST = 64 };

// ---- in closed form ----

static hn_status oscillator_back(void *self, double t, const double *y, const double *w,
                                 double *out) {
    const hn_test_oscillator *o = self;
    (void)t;
    (void)y;
    out[0] = -o->b * o->b * w[1];
    out[1] = w[0] - 2 * o->a * w[1];
    return HN_OK;
}

static void a_linear_equation_carries_weights_back_by_its_own_exponential(void **state) {
    (void)state;
    hn_test_oscillator o = {.a = 0, .b = 3};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const hn_flow_slopes slopes = {2, &o, oscillator_back};
    hn_arena *arena = hn_arena_create(0);
    hn_flow_carrier *carrier;
    assert_int_equal(hn_flow_carrier_create(1, 1, 2, arena, &carrier), HN_OK);
    // from one step to many: the list of them has to grow
    for (double h = 0.01; h < 100; h *= 4) {
        const double y[2] = {1, -0.5}, c = cos(3 * h), s = sin(3 * h);
        double w[2] = {0.7, 0.2};
        assert_int_equal(hn_flow_carry_back(carrier, &ode, &slopes, 1e-12, 0, h, y, w), HN_OK);
        // x = c x0 + s v0 / 3, v = -3 s x0 + c v0, and this transposed; errors of the steps add up
        assert_near(w[0], 0.7 * c - 3 * 0.2 * s, 1e-11 * (1 + h));
        assert_near(w[1], 0.7 * s / 3 + 0.2 * c, 1e-11 * (1 + h));
    }
    hn_arena_free(arena);
}

static void a_flow_does_not_depend_on_the_ones_before_it_but_in_the_last_digits(void **state) {
    (void)state;
    const hn_ode ode = hn_test_kepler_ode();
    hn_arena *arena = hn_arena_create(0);
    hn_flow *flow;
    assert_int_equal(hn_flow_create(2, 2, arena, &flow), HN_OK);
    double start[4], y[4], exact[4];
    hn_test_kepler_exact(0.6, 0, start);
    // steps that the flow before has found, too long by far or too short for the next
    static const double times[] = {1e-4, 3, 1e-3, 0.5, 6, 1e-6, 2};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        assert_int_equal(hn_flow_run(flow, &ode, 1e-14, 0, times[i], start, y), HN_OK);
        hn_test_kepler_exact(0.6, times[i], exact);
        for (int k = 0; k < 4; k++) {
            // some 100 steps of 1e-14 at most, each stretched no more than tenfold by the end
            assert_near(y[k], exact[k], 1e-11);
        }
    }
    hn_arena_free(arena);
}

static hn_status sick(void *self, double t, const double *y, const double *w, double *out) {
    (void)self;
    (void)t;
    (void)y;
    (void)w;
    (void)out;
    return HN_ERR_SINGULAR;
}

static void slopes_that_fail_are_told(void **state) {
    (void)state;
    hn_test_oscillator o = {.b = 1};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const hn_flow_slopes slopes = {2, &o, sick};
    const double y[2] = {1, 0};
    double w[2] = {1, 0};
    hn_arena *arena = hn_arena_create(0);
    hn_flow_carrier *carrier;
    assert_int_equal(hn_flow_carrier_create(1, 1, 2, arena, &carrier), HN_OK);
    assert_int_equal(hn_flow_carry_back(carrier, &ode, &slopes, 1e-12, 0, 1, y, w),
                     HN_ERR_SINGULAR);
    hn_arena_free(arena);
}

// ---- mechanisms: against differences of flows ----

typedef struct motion {
    const hn_model *m;
    hn_accel *accel;
    hn_accel_jacobian *slopes;
} motion;

static hn_status motion_rhs(void *self, double t, const double *y, double *ydot) {
    const motion *o = self;
    const int nq = o->m->info.nq;
    hn_system_kinematics(o->m->sys, y, y + nq, ydot);
    return hn_accel_eval(o->accel, t, y, y + nq, 0, 0, ydot + nq, NULL, NULL);
}

static hn_status motion_back(void *self, double t, const double *y, const double *w, double *out) {
    const motion *o = self;
    const hn_accel_law law = {0};
    hn_status status = hn_accel_jacobian_at(o->slopes, t, y, y + o->m->info.nq, &law);
    status = status == HN_OK ? hn_accel_jacobian_prepare(o->slopes) : status;
    if (status == HN_OK) {
        hn_accel_jacobian_back(o->slopes, w, out);
    }
    return status;
}

// w' times the difference of two flows that start a nudge of entry i apart, over the nudge
static double by_difference(const motion *o, hn_flow *flow, const hn_ode *ode, const double *start,
                            double h, int i, const double *w) {
    const int nq = o->m->info.nq, nv = o->m->info.nv;
    const double nudge = 1e-5;
    double end[2][2 * MOST], delta[2 * MOST] = {0};
    for (int k = 0; k < 2; k++) {
        double move[MOST] = {0};
        memcpy(end[k], start, (size_t)(nq + nv) * sizeof *start);
        if (i < nv) {
            move[i] = k ? nudge : -nudge;
            hn_system_move(o->m->sys, end[k], move);
        } else {
            end[k][nq + i - nv] += k ? nudge : -nudge;
        }
        assert_int_equal(hn_flow_run(flow, ode, 1e-13, 0, h, end[k], end[k]), HN_OK);
    }
    hn_system_difference(o->m->sys, end[0], end[1], delta);
    double sum = 0;
    for (int k = 0; k < nv; k++) {
        sum += w[k] * delta[k] + w[nv + k] * (end[1][nq + k] - end[0][nq + k]);
    }
    return sum / (2 * nudge);
}

static void weights_carried_back_are_differences_of_flows_of(const char *name, double h) {
    hn_model m;
    hn_model_open_closed(&m, name, NULL);
    const int nq = m.info.nq, nv = m.info.nv;
    assert_true(nq + nv <= 2 * MOST && nv <= MOST);
    const hn_accel_opts opts = {0};
    motion o = {.m = &m};
    hn_flow *flow;
    hn_flow_carrier *carrier;
    assert_int_equal(hn_accel_create(m.sys, &opts, m.arena, &o.accel), HN_OK);
    assert_int_equal(hn_accel_jacobian_create(m.sys, &(hn_accel_law){0}, m.arena, &o.slopes),
                     HN_OK);
    assert_int_equal(hn_flow_create(nq, nv, m.arena, &flow), HN_OK);
    assert_int_equal(hn_flow_carrier_create(nq, nv, 2 * nv, m.arena, &carrier), HN_OK);
    const hn_ode ode = {.n_pos = nq, .n_vel = nv, .self = &o, .rhs = motion_rhs};
    const hn_flow_slopes slopes = {2 * nv, &o, motion_back};
    double y[2 * MOST], w[2 * MOST], carried[2 * MOST], largest = 0;
    memcpy(y, m.q, (size_t)nq * sizeof *y);
    memcpy(y + nq, m.v, (size_t)nv * sizeof *y);
    for (int i = 0; i < 2 * nv; i++) {
        w[i] = carried[i] = cos(3.0 * i);
    }
    assert_int_equal(hn_flow_carry_back(carrier, &ode, &slopes, 1e-12, 0, h, y, carried), HN_OK);
    for (int i = 0; i < 2 * nv; i++) {
        largest = fmax(largest, fabs(carried[i]));
    }
    for (int i = 0; i < 2 * nv; i++) {
        // a nudge of 1e-5: its square, and rounding of 1e-13 over it
        assert_near(carried[i], by_difference(&o, flow, &ode, y, h, i, w), 1e-7 * largest);
    }
    hn_accel_free(o.accel);
    hn_accel_jacobian_free(o.slopes);
    hn_model_close(&m);
}

static void weights_carried_back_are_differences_of_flows(void **state) {
    (void)state;
    // one loop; balls that turn; several loops in space; rows that depend on others, in the plane
    // and in space
    weights_carried_back_are_differences_of_flows_of("fb0", 0.1);
    weights_carried_back_are_differences_of_flows_of("heavy-top", 0.05);
    weights_carried_back_are_differences_of_flows_of("spinning-block", 0.1);
    weights_carried_back_are_differences_of_flows_of("rssr", 0.05);
    weights_carried_back_are_differences_of_flows_of("stewart-6-6", 0.01);
    weights_carried_back_are_differences_of_flows_of("fb0-redundant", 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_equation_carries_weights_back_by_its_own_exponential),
        cmocka_unit_test(a_flow_does_not_depend_on_the_ones_before_it_but_in_the_last_digits),
        cmocka_unit_test(slopes_that_fail_are_told),
        cmocka_unit_test(weights_carried_back_are_differences_of_flows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
