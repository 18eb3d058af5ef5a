// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/alloc.h"
#include "support/near.h"
#include "support/odes.h"
#include "support/test_arena.h"

#include <math.h>
#include <string.h>

#define ORDER_TOL 0.2

// the others choose their steps themselves, or take the differential-algebraic system
static int is_stepped_by_the_caller(const hn_stepper *s) {
    return s->create && s->step;
}

static double kepler_error(const hn_stepper *stepper, double e, double T, int n) {
    const hn_ode ode = hn_test_kepler_ode();
    double y[4], exact[4], worst = 0;
    hn_test_kepler_exact(e, 0, y);
    hn_test_kepler_exact(e, T, exact);
    assert_int_equal(hn_test_integrate(stepper, &ode, T, n, y, hn_test_arena), HN_OK);
    for (int i = 0; i < 4; i++) {
        worst = fmax(worst, fabs(y[i] - exact[i]));
    }
    return worst;
}

static void observed_order_on_an_orbit_is_the_stated_one(void **state) {
    (void)state;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_stepped_by_the_caller(s)) {
            continue; // the others have tests of their own
        }
        double h[4], err[4];
        const int implicit = !isfinite(s->real_limit);
        const int base = s->order == 1   ? 4000
                         : s->order == 2 ? 400
                         : s->order < 5  ? 100
                         : s->order < 8  ? (implicit ? 20 : 100)
                                         : 6;
        for (int i = 0; i < 4; i++) {
            const int n = base << i;
            h[i] = 1.0 / n;
            // order 8 reaches rounding before it settles on anything but a circle
            err[i] = kepler_error(s, s->order < 8 ? 0.3 : 0, 4.0, n);
        }
        assert_near(hn_test_slope(4, h, err), s->order, ORDER_TOL);
    }
}

static void observed_order_on_an_oscillation_is_the_stated_one(void **state) {
    (void)state;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_stepped_by_the_caller(s)) {
            continue; // the others have tests of their own
        }
        double h[4], err[4];
        const int base = s->order == 1 ? 400 : s->order < 8 ? 20 : 2;
        for (int i = 0; i < 4; i++) {
            hn_test_oscillator o = {0, 1.7, 0};
            const hn_ode ode = hn_test_oscillator_ode(&o);
            double y[2] = {1, 0.5};
            const int n = base << i;
            const double T = 2.3, w = 1.7;
            h[i] = T / n;
            assert_int_equal(hn_test_integrate(s, &ode, T, n, y, hn_test_arena), HN_OK);
            const double x = cos(w * T) + 0.5 / w * sin(w * T);
            const double v = -w * sin(w * T) + 0.5 * cos(w * T);
            err[i] = hypot(y[0] - x, y[1] - v);
        }
        assert_near(hn_test_slope(4, h, err), s->order, ORDER_TOL);
    }
}

// error of the interpolant in the middle of one step from an exact start
static double dense_error(const hn_stepper *s, double h) {
    const hn_ode ode = hn_test_kepler_ode();
    double y[4], next[4], err[4], inner[4], exact[4], worst = 0;
    void *self = s->create(2, 2, hn_test_arena);
    assert_non_null(self);
    hn_test_kepler_exact(0.3, 0.5, y);
    assert_int_equal(s->step(self, &ode, 0.5, h, y, next, err), HN_OK);
    if (s->finish) {
        assert_int_equal(s->finish(self, &ode), HN_OK);
    }
    s->on_accepted(self, 0);
    for (int i = 0; i <= 10; i++) {
        const double theta = i / 10.0;
        s->dense(self, theta, inner);
        hn_test_kepler_exact(0.3, 0.5 + theta * h, exact);
        for (int j = 0; j < 4; j++) {
            worst = fmax(worst, fabs(inner[j] - exact[j]));
        }
    }
    s->dense(self, 0, inner);
    assert_all_near(inner, y, 4, 0);
    s->dense(self, 1, inner);
    assert_all_near(inner, next, 4, 1e-15);
    return worst;
}

static void dense_output_has_the_stated_order_and_meets_both_ends(void **state) {
    (void)state;
    int found = 0;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_stepped_by_the_caller(s)) {
            continue; // the others have tests of their own
        }
        double h[4], err[4];
        if (!s->dense) {
            continue;
        }
        found++;
        for (int i = 0; i < 4; i++) {
            h[i] = (s->dense_order < 7 ? 0.2 : 0.5) / (1 << i);
            err[i] = dense_error(s, h[i]);
        }
        // a local error: one power of h above the order
        assert_near(hn_test_slope(4, h, err), s->dense_order + 1, 0.3);
    }
    assert_true(found > 0);
}

static double error_estimate_order(const hn_stepper *s, double largest) {
    const hn_ode ode = hn_test_kepler_ode();
    double h[4], size[4];
    for (int i = 0; i < 4; i++) {
        double y[4], next[4], err[4];
        void *self = s->create(2, 2, hn_test_arena);
        hn_test_kepler_exact(0.3, 0.5, y);
        h[i] = largest / (1 << i);
        assert_int_equal(s->step(self, &ode, 0, h[i], y, next, err), HN_OK);
        size[i] = fabs(err[0]) + fabs(err[1]) + fabs(err[2]) + fabs(err[3]);
    }
    return hn_test_slope(4, h, size);
}

static void error_estimate_falls_like_the_order_of_the_method(void **state) {
    (void)state;
    // the control takes that power for granted
    assert_near(error_estimate_order(hn_stepper_find("dopri5"), 0.1), 5, ORDER_TOL);
    assert_near(error_estimate_order(hn_stepper_find("dop853"), 0.4), 8, 2 * ORDER_TOL);
}

static void dense_stages_of_dop853_are_paid_once_and_serve_the_next_step(void **state) {
    (void)state;
    const hn_stepper *s = hn_stepper_find("dop853");
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    double y[2] = {1, 0}, next[2], err[2];
    void *self = s->create(1, 1, hn_test_arena);
    assert_int_equal(s->step(self, &ode, 0, 0.1, y, next, err), HN_OK);
    assert_int_equal(o.evals, 12);
    // a rejected trial costs its stages only
    assert_int_equal(s->step(self, &ode, 0, 0.05, y, next, err), HN_OK);
    assert_int_equal(o.evals, 23);
    assert_int_equal(s->finish(self, &ode), HN_OK);
    assert_int_equal(o.evals, 27);
    s->on_accepted(self, 0);
    assert_int_equal(s->step(self, &ode, 0.05, 0.1, next, y, err), HN_OK);
    assert_int_equal(o.evals, 38);
    assert_int_equal(s->finish(self, &ode), HN_OK);
    s->on_accepted(self, 1); // moved: the slope at the new point is stale
    assert_int_equal(s->step(self, &ode, 0.15, 0.1, y, next, err), HN_OK);
    assert_int_equal(o.evals, 54);
}

static void fsal_saves_a_stage_unless_the_state_was_changed(void **state) {
    (void)state;
    const hn_stepper *s = hn_stepper_find("dopri5");
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    double y[2] = {1, 0}, next[2], err[2];
    void *self = s->create(1, 1, hn_test_arena);
    assert_int_equal(s->step(self, &ode, 0, 0.1, y, next, err), HN_OK);
    assert_int_equal(o.evals, 7);
    // rejected: the same point again needs no new first slope
    assert_int_equal(s->step(self, &ode, 0, 0.05, y, next, err), HN_OK);
    assert_int_equal(o.evals, 13);
    s->on_accepted(self, 0);
    memcpy(y, next, sizeof y);
    assert_int_equal(s->step(self, &ode, 0.05, 0.1, y, next, err), HN_OK);
    assert_int_equal(o.evals, 19);
    s->on_accepted(self, 1);
    assert_int_equal(s->step(self, &ode, 0.15, 0.1, next, y, err), HN_OK);
    assert_int_equal(o.evals, 26);
}

static void a_kept_slope_gives_the_same_bits_as_a_fresh_one(void **state) {
    (void)state;
    const hn_stepper *s = hn_stepper_find("dopri5");
    const hn_ode ode = hn_test_kepler_ode();
    double a[2][4];
    for (int changed = 0; changed <= 1; changed++) {
        double y[4], next[4], err[4];
        void *self = s->create(2, 2, hn_test_arena);
        hn_test_kepler_exact(0.3, 0, y);
        for (int i = 0; i < 20; i++) {
            assert_int_equal(s->step(self, &ode, i * 0.05, 0.05, y, next, err), HN_OK);
            s->on_accepted(self, changed);
            memcpy(y, next, sizeof y);
        }
        memcpy(a[changed], y, sizeof y);
    }
    assert_memory_equal(a[0], a[1], sizeof a[0]);
}

static void a_step_does_not_allocate(void **state) {
    (void)state;
    const hn_ode ode = hn_test_kepler_ode();
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_stepped_by_the_caller(s)) {
            continue; // the others have tests of their own
        }
        double y[4], next[4], err[4];
        void *self = s->create(2, 2, hn_test_arena);
        hn_test_kepler_exact(0.3, 0, y);
        const long before = hn_alloc_count();
        for (int i = 0; i < 10; i++) {
            assert_int_equal(s->step(self, &ode, 0, 0.01, y, next, err), HN_OK);
            if (s->finish) {
                assert_int_equal(s->finish(self, &ode), HN_OK);
            }
            s->on_accepted(self, i % 2);
            if (s->dense) {
                s->dense(self, 0.5, next);
            }
        }
        assert_int_equal(hn_alloc_count(), before);
    }
}

static hn_status refuse(void *self, double t, const double *y, double *ydot) {
    (void)self;
    (void)y;
    ydot[0] = ydot[1] = 0;
    return t > 0.04 ? HN_ERR_CHART : HN_OK;
}

static void failure_of_the_right_hand_side_is_handed_on(void **state) {
    (void)state;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_stepped_by_the_caller(s)) {
            continue; // the others have tests of their own
        }
        const hn_ode ode = {.n_pos = 1, .n_vel = 1, .rhs = refuse, .kinematics = refuse};
        double y[2] = {0, 0}, next[2], err[2];
        void *self = s->create(1, 1, hn_test_arena);
        assert_int_equal(s->step(self, &ode, 0.05, 0.1, y, next, err), HN_ERR_CHART);
    }
}

static void symplectic_euler_keeps_the_energy_of_an_oscillation_bounded(void **state) {
    (void)state;
    const hn_stepper *s = hn_stepper_find("symplectic-euler");
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const double h = 0.1;
    double y[2] = {1, 0};
    void *self = s->create(1, 1, hn_test_arena);
    // x^2 + v^2 - h x v is exactly conserved by the map (1) of symplectic_euler.c
    for (int i = 0; i < 100000; i++) {
        double next[2];
        assert_int_equal(s->step(self, &ode, 0, h, y, next, NULL), HN_OK);
        memcpy(y, next, sizeof y);
        assert_near(y[0] * y[0] + y[1] * y[1] - h * y[0] * y[1], 1, 1e-10);
    }
}

static void verlet_keeps_its_own_energy_of_an_oscillation_exactly(void **state) {
    (void)state;
    const hn_stepper *s = hn_stepper_find("verlet");
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const double h = 0.5;
    double y[2] = {1, 0};
    void *self = s->create(1, 1, hn_test_arena);
    // v^2 + (1 - h^2/4) x^2 is exactly conserved by the map (1) of verlet.c
    for (int i = 0; i < 100000; i++) {
        double next[2];
        assert_int_equal(s->step(self, &ode, 0, h, y, next, NULL), HN_OK);
        memcpy(y, next, sizeof y);
        assert_near(y[1] * y[1] + (1 - h * h / 4) * y[0] * y[0], 1 - h * h / 4, 1e-10);
    }
}

static void verlet_has_order_two_where_the_force_depends_on_speed(void **state) {
    (void)state;
    double h[4], err[4];
    for (int i = 0; i < 4; i++) {
        hn_test_oscillator o = {0.6, 1.7, 0};
        const hn_ode ode = hn_test_oscillator_ode(&o);
        double y[2] = {1, 0.5};
        const double T = 2.3, w = sqrt(1.7 * 1.7 - 0.36), c = (0.5 + 0.6) / w;
        h[i] = T / (50 << i);
        assert_int_equal(
            hn_test_integrate(hn_stepper_find("verlet"), &ode, T, 50 << i, y, hn_test_arena),
            HN_OK);
        const double x = exp(-0.6 * T) * (cos(w * T) + c * sin(w * T));
        const double v = -0.6 * x + exp(-0.6 * T) * w * (-sin(w * T) + c * cos(w * T));
        err[i] = hypot(y[0] - x, y[1] - v);
    }
    assert_near(hn_test_slope(4, h, err), 2, ORDER_TOL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(observed_order_on_an_orbit_is_the_stated_one,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(observed_order_on_an_oscillation_is_the_stated_one,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(dense_output_has_the_stated_order_and_meets_both_ends,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(error_estimate_falls_like_the_order_of_the_method,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(
            dense_stages_of_dop853_are_paid_once_and_serve_the_next_step, hn_test_arena_open,
            hn_test_arena_close),
        cmocka_unit_test_setup_teardown(fsal_saves_a_stage_unless_the_state_was_changed,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_kept_slope_gives_the_same_bits_as_a_fresh_one,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_step_does_not_allocate, hn_test_arena_open,
                                        hn_test_arena_close),
        cmocka_unit_test_setup_teardown(failure_of_the_right_hand_side_is_handed_on,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(verlet_keeps_its_own_energy_of_an_oscillation_exactly,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(verlet_has_order_two_where_the_force_depends_on_speed,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(symplectic_euler_keeps_the_energy_of_an_oscillation_bounded,
                                        hn_test_arena_open, hn_test_arena_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
