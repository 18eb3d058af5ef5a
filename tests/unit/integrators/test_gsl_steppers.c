// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/alloc.h"
#include "support/near.h"
#include "support/odes.h"
#include "support/test_arena.h"

#include <math.h>
#include <string.h>

// The library's integrators through our table: that they are the ones named, keep the tolerance
// asked for, land where they are stopped, and hand on what the right-hand side says.

static const char *const names[] = {"gsl-rk8pd", "gsl-msadams", "gsl-msbdf", "gsl-bsimp"};
enum { N_NAMES = sizeof names / sizeof *names };

static void *create(const hn_stepper *s, int n_pos, int n_vel, double rtol, double hmax) {
    const double options[4] = {rtol, 0, 0, hmax};
    void *self = s->create(n_pos, n_vel, hn_test_arena);
    assert_non_null(self);
    s->configure(self, options);
    return self;
}

// steps from t to T, the last one cut to end there; returns their number
static int integrate(const hn_stepper *s, void *self, const hn_ode *ode, double t, double T,
                     double *y) {
    double next[4];
    int n = 0;
    while (t < T) {
        double t_new = nan("");
        assert_int_equal(s->advance(self, ode, t, T, y, &t_new, next), HN_OK);
        assert_true(t_new > t);
        s->on_accepted(self, 0);
        memcpy(y, next, (size_t)(ode->n_pos + ode->n_vel) * sizeof *y);
        t = t_new;
        n++;
    }
    assert_near(t, T, 0); // the very number
    return n;
}

static double orbit_error(const hn_stepper *s, double rtol) {
    const hn_ode ode = hn_test_kepler_ode();
    double y[4], exact[4], worst = 0;
    void *self = create(s, 2, 2, rtol, 0);
    hn_test_kepler_exact(0.3, 0, y);
    hn_test_kepler_exact(0.3, 4, exact);
    integrate(s, self, &ode, 0, 4, y);
    s->destroy(self);
    for (int i = 0; i < 4; i++) {
        worst = fmax(worst, fabs(y[i] - exact[i]));
    }
    return worst;
}

static void an_orbit_is_followed_to_the_tolerance(void **state) {
    (void)state;
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        assert_non_null(s);
        // errors of steps add up along the orbit: a factor of 1000 leaves room for that, and for
        // 2700 steps of msbdf
        assert_true(orbit_error(s, 1e-5) < 1e-2);
        assert_true(orbit_error(s, 1e-9) < 1e-6);
    }
}

static void the_largest_step_is_kept(void **state) {
    (void)state;
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        hn_test_oscillator o = {0, 1, 0};
        const hn_ode ode = hn_test_oscillator_ode(&o);
        double y[2] = {1, 0};
        void *self = create(s, 1, 1, 1e-3, 0.01);
        assert_true(integrate(s, self, &ode, 0, 1, y) >= 100);
        s->destroy(self);
    }
}

// x' = -rate (x - cos t): a fast decay onto a slow motion
static hn_status stiff(void *self, double t, const double *y, double *ydot) {
    int *evals = self;
    (*evals)++;
    ydot[0] = -1e5 * (y[0] - cos(t));
    return HN_OK;
}

static int jacobians;

static hn_status stiff_jacobian(void *self, double t, const double *y, double *jac) {
    (void)self;
    (void)t;
    (void)y;
    jacobians++;
    jac[0] = -1e5;
    return HN_OK;
}

static void the_two_for_stiff_motion_need_no_small_steps(void **state) {
    (void)state;
    for (int i = 2; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        int evals = 0;
        const hn_ode ode = {.n_pos = 1, .self = &evals, .rhs = stiff};
        double y[1] = {0};
        void *self = create(s, 1, 0, 1e-6, 0);
        const int n = integrate(s, self, &ode, 0, 2, y);
        s->destroy(self);
        // an explicit method is held to h < 3e-5 or so, 70000 steps
        assert_true(n < 1000);
        assert_near(y[0], cos(2) + 1e-5 * sin(2), 1e-5); // to first order in 1 / rate
    }
}

static void a_jacobian_that_is_there_is_used_in_place_of_differences(void **state) {
    (void)state;
    for (int i = 2; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        int evals = 0;
        const hn_ode ode = {.n_pos = 1, .self = &evals, .rhs = stiff, .jacobian = stiff_jacobian};
        double y[1] = {0};
        void *self = create(s, 1, 0, 1e-6, 0);
        jacobians = 0;
        integrate(s, self, &ode, 0, 2, y);
        s->destroy(self);
        assert_true(jacobians > 0);
        assert_near(y[0], cos(2) + 1e-5 * sin(2), 1e-5);
    }
}

static hn_status refuse_late(void *self, double t, const double *y, double *ydot) {
    (void)self;
    (void)y;
    ydot[0] = ydot[1] = 1;
    return t > 0.5 ? HN_ERR_CHART : HN_OK;
}

static void a_refusal_of_the_right_hand_side_is_reached_and_handed_on(void **state) {
    (void)state;
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        const hn_ode ode = {.n_pos = 1, .n_vel = 1, .rhs = refuse_late};
        double y[2] = {0, 0}, next[2], t = 0, t_new = 0;
        void *self = create(s, 1, 1, 1e-6, 0.1);
        hn_status status = HN_OK;
        int n = 0;
        while (status == HN_OK && n < 10000) {
            status = s->advance(self, &ode, t, HUGE_VAL, y, &t_new, next);
            if (status == HN_OK) {
                s->on_accepted(self, 0);
                memcpy(y, next, sizeof y);
                t = t_new;
            }
            n++;
        }
        assert_int_equal(status, HN_ERR_CHART);
        assert_near(t, 0.5, 0.05);
        hn_cost cost = {0};
        s->add_cost(self, &cost);
        assert_true(cost.rejected > 0);
        s->destroy(self);
    }
}

static void a_changed_state_is_gone_on_from(void **state) {
    (void)state;
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        hn_test_oscillator o = {0, 1, 0};
        const hn_ode ode = hn_test_oscillator_ode(&o);
        double y[2] = {1, 0};
        void *self = create(s, 1, 1, 1e-8, 0);
        integrate(s, self, &ode, 0, 1, y);
        // another motion from here: twice as large
        y[0] *= 2;
        y[1] *= 2;
        s->on_accepted(self, 1);
        integrate(s, self, &ode, 1, 2, y);
        s->destroy(self);
        assert_near(y[0], 2 * cos(2), 1e-5);
        assert_near(y[1], -2 * sin(2), 1e-5);
    }
}

static void our_own_code_allocates_nothing_in_a_step(void **state) {
    (void)state;
    const hn_ode ode = hn_test_kepler_ode();
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        double y[4];
        void *self = create(s, 2, 2, 1e-6, 0);
        hn_test_kepler_exact(0.3, 0, y);
        const long before = hn_alloc_count();
        integrate(s, self, &ode, 0, 1, y);
        assert_int_equal(hn_alloc_count(), before);
        s->destroy(self);
    }
}

static void a_state_without_entries_is_passed_through(void **state) {
    (void)state;
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        const hn_ode ode = {.rhs = stiff};
        double y[1] = {0};
        void *self = create(s, 0, 0, 1e-6, 0.5);
        assert_int_equal(integrate(s, self, &ode, 0, 2, y), 4);
        s->destroy(self);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_orbit_is_followed_to_the_tolerance, hn_test_arena_open,
                                        hn_test_arena_close),
        cmocka_unit_test_setup_teardown(the_largest_step_is_kept, hn_test_arena_open,
                                        hn_test_arena_close),
        cmocka_unit_test_setup_teardown(the_two_for_stiff_motion_need_no_small_steps,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_jacobian_that_is_there_is_used_in_place_of_differences,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_refusal_of_the_right_hand_side_is_reached_and_handed_on,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_changed_state_is_gone_on_from, hn_test_arena_open,
                                        hn_test_arena_close),
        cmocka_unit_test_setup_teardown(our_own_code_allocates_nothing_in_a_step,
                                        hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(a_state_without_entries_is_passed_through,
                                        hn_test_arena_open, hn_test_arena_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
