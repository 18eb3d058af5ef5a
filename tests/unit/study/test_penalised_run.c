// SPDX-License-Identifier: GPL-3.0-or-later
// Penalty, augmented Lagrangian and Udwadia-Kalaba against figures of an independent program and
// against exact statements.

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "study/cost/convergence.h"
#include "support/lagrangian_turns.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NV = 3 }; // of the reference four-bar

// largest |phi_i| at a sample
static double largest_row(const hn_model *m, const hn_sample *s) {
    hn_eval *e = NULL;
    double q[NV];
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_PHI, m->arena, &e), HN_OK);
    hn_system_from_user(m->sys, s->q, q);
    hn_eval_run(e, s->t, q, NULL);
    const double largest = hn_norm_max(m->info.nc, hn_eval_get(e, HN_TERM_PHI));
    hn_eval_free(e);
    return largest;
}

static void a_penalty_leaves_a_gap_and_an_error_that_fall_like_its_inverse(void **state) {
    (void)state;
    // at t = 1, omega = 10
    static const double a[3] = {1e3, 1e5, 1e7}, known_gap[3] = {2.9e-5, 2.9e-7, 2.9e-9},
                        known_error[3] = {1.0e-4, 1.0e-6, 1.0e-8};
    double gap[3], error[3];
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (int i = 0; i < 3; i++) {
        char method[96];
        (void)snprintf(method, sizeof method, "penalty:a=%g@rk4:h=5e-4", a[i]);
        hn_run *run = hn_motion_start(&m, method);
        const hn_sample s = hn_motion_at(run, 1);
        gap[i] = largest_row(&m, &s);
        error[i] = fabs(s.q[hn_model_user(&m, "th1")] - 2.72677524435375);
        assert_rel(gap[i], known_gap[i], 0.03);
        assert_rel(error[i], known_error[i], 0.15); // at 1e7 rounding takes the second digit
        hn_run_free(run);
    }
    assert_near(hn_fit_order(3, a, gap), -1, 0.01);
    assert_near(hn_fit_order(3, a, error), -1, 0.02);
    hn_model_close(&m);
}

static void halving_the_step_does_not_help_a_penalty(void **state) {
    (void)state;
    hn_model m;
    double error[2];
    hn_model_open_closed(&m, "fb0", NULL);
    for (int i = 0; i < 2; i++) {
        hn_run *run =
            hn_motion_start(&m, i ? "penalty:a=1e5@rk4:h=5e-4" : "penalty:a=1e5@rk4:h=1e-3");
        const hn_sample s = hn_motion_at(run, 1);
        error[i] = fabs(s.q[hn_model_user(&m, "th1")] - 2.72677524435375);
        hn_run_free(run);
    }
    assert_rel(error[1], error[0], 1e-3);
    hn_model_close(&m);
}

static void
a_penalty_is_not_stiff_in_time_however_strong_and_stops_at_the_limit_of_omega(void **state) {
    (void)state;
    // omega h = 2.5 and 2.9 about the limit 2.785 of rk4, at weights eight powers of ten apart
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (int i = 0; i < 2; i++) {
        char method[96];
        (void)snprintf(method, sizeof method, "penalty:a=%s,omega=2500@rk4:h=1e-3",
                       i ? "1e10" : "1e2");
        assert_true(hn_motion_summary(&m, method, 0.5).worst_gap < 1e-4);
        (void)snprintf(method, sizeof method, "penalty:a=%s,omega=2900@rk4:h=1e-3",
                       i ? "1e10" : "1e2");
        hn_run *run = hn_motion_start(&m, method);
        (void)hn_run_advance(run, 0.5);
        assert_true(hn_run_get_summary(run).worst_gap > 1e-2 ||
                    hn_run_get_summary(run).state == HN_RUN_FAILED);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// ---- the turns of the augmented Lagrangian ----

static void
each_turn_of_the_augmented_lagrangian_shrinks_the_error_by_the_known_factor(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    double s[2];
    hn_turns_eigenvalues(&m, s);
    assert_near(1 / (1 + 10 * s[0]), 0.0838, 5e-5);
    assert_near(1 / (1 + 1e3 * s[0]), 9.1e-4, 1e-5);
    // the other eigenvalue's part is gone after a few turns
    for (int k = 6; k <= 9; k++) {
        const double factor = hn_turns_error(&m, 10, k + 1) / hn_turns_error(&m, 10, k);
        assert_rel(factor, 1 / (1 + 10 * s[0]), 5e-3);
    }
    assert_rel(hn_turns_error(&m, 1e3, 3) / hn_turns_error(&m, 1e3, 2), 1 / (1 + 1e3 * s[0]), 0.05);
    // the weight of the card: at rounding after its three turns; stronger ones lose no digits
    assert_true(hn_turns_error(&m, 0, 3) < 1e-12);
    assert_true(hn_turns_error(&m, 1e8, 3) < 1e-12);
    hn_model_close(&m);
}

static void the_limit_of_the_turns_is_baumgarte(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_run *a = hn_motion_start(&m, "augmented-lagrangian:omega=10,iterations=5@rk4:h=1e-2");
    hn_run *b = hn_motion_start(&m, "baumgarte:alpha=10,beta=10@rk4:h=1e-2");
    double q[NV];
    memcpy(q, hn_motion_at(a, 2).q, sizeof q);
    assert_all_near(q, hn_motion_at(b, 2).q, NV, 1e-9);
    hn_run_free(a);
    hn_run_free(b);
    hn_model_close(&m);
}

// ---- redundant rows, massless links ----

static void repeated_rows_change_nothing_for_those_that_promise_it(void **state) {
    (void)state;
    static const char *const methods[] = {"udwadia-kalaba@rk4:h=1e-2",
                                          "augmented-lagrangian@rk4:h=1e-2"};
    hn_model once, twice;
    hn_model_open_closed(&once, "fb0", NULL);
    hn_model_open_closed(&twice, "fb0-redundant", NULL);
    assert_true(twice.info.nc > once.info.nc);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        hn_run *a = hn_motion_start(&once, methods[i]), *b = hn_motion_start(&twice, methods[i]);
        const double th = hn_motion_at(a, 1).q[hn_model_user(&once, "th1")];
        assert_near(hn_motion_at(b, 1).q[hn_model_user(&twice, "th1")], th, 1e-9);
        hn_run_free(a);
        hn_run_free(b);
    }
    hn_model_close(&once);
    hn_model_close(&twice);
}

static void udwadia_kalaba_is_index_one_by_another_formula(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_run *a = hn_motion_start(&m, "udwadia-kalaba@rk4:h=1e-2");
    hn_run *b = hn_motion_start(&m, "index1@rk4:h=1e-2");
    const double gap = hn_motion_at(a, 2).gap;
    assert_rel(gap, hn_motion_at(b, 2).gap, 1e-6); // the same drift
    hn_run_free(a);
    hn_run_free(b);
    hn_model_close(&m);
}

static void a_massless_rocker_is_moved_as_the_saddle_system_says(void **state) {
    (void)state;
    static const char *const methods[] = {"udwadia-kalaba@rk4:h=1e-3",
                                          "augmented-lagrangian@rk4:h=1e-3"};
    hn_model m;
    hn_model_open_closed(&m, "fb0-massless-rocker", NULL);
    assert_int_equal(m.status, HN_OK);
    hn_run *reference = hn_motion_start(&m, "baumgarte:alpha=10,beta=10@rk4:h=1e-3");
    double q[NV];
    memcpy(q, hn_motion_at(reference, 1).q, sizeof q);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        hn_run *run = hn_motion_start(&m, methods[i]);
        assert_all_near(hn_motion_at(run, 1).q, q, NV, 1e-7);
        assert_int_equal(hn_run_get_summary(run).cost.fallbacks > 0, i == 0); // the second formula
        hn_run_free(run);
    }
    hn_run_free(reference);
    hn_model_close(&m);
}

// a parallelogram lying flat: one of its two rows depends on the other there
static const char flat_start[] =
    "{\"holonom\": 1, \"name\": \"flat\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"th1\", \"rate\": \"w1\", \"unit\": \"rad\"}, "
    "{\"name\": \"th2\", \"rate\": \"w2\", \"unit\": \"rad\"}, "
    "{\"name\": \"th3\", \"rate\": \"w3\", \"unit\": \"rad\"}],"
    "\"kinetic\": \"(1/3 + 2)*w1^2/2 + 8/3*w2^2/2 + w3^2/6 + 2*cos(th1 - th2)*w1*w2\","
    "\"potential\": \"9.81*(2.5*sin(th1) + 2*sin(th2) + sin(th3)/2)\","
    "\"constraints\": [{\"name\": \"x\", \"formula\": \"cos(th1) + 2*cos(th2) - cos(th3) - 2\"},"
    "{\"name\": \"y\", \"formula\": \"sin(th1) + 2*sin(th2) - sin(th3)\"}]},"
    "\"start\": {\"positions\": {\"th1\": 0, \"th2\": 0, \"th3\": 0},"
    "\"rates\": {\"th1\": 2, \"th2\": 0, \"th3\": 2}}}";

static void udwadia_kalaba_starts_where_the_loop_has_lost_rank(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, flat_start, NULL);
    assert_int_equal(m.status, HN_OK);
    hn_run *run = hn_motion_start(&m, "udwadia-kalaba@rk4:h=1e-3");
    const hn_sample s = hn_motion_at(run, 0.2);
    assert_true(fabs(s.energy_change) < 1e-8 && s.gap < 1e-8);
    assert_near(s.q[0], s.q[2], 1e-8); // on the parallel branch, which its speeds had chosen
    assert_true(s.q[0] > 0.1);
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_penalty_leaves_a_gap_and_an_error_that_fall_like_its_inverse),
        cmocka_unit_test(halving_the_step_does_not_help_a_penalty),
        cmocka_unit_test(
            a_penalty_is_not_stiff_in_time_however_strong_and_stops_at_the_limit_of_omega),
        cmocka_unit_test(
            each_turn_of_the_augmented_lagrangian_shrinks_the_error_by_the_known_factor),
        cmocka_unit_test(the_limit_of_the_turns_is_baumgarte),
        cmocka_unit_test(repeated_rows_change_nothing_for_those_that_promise_it),
        cmocka_unit_test(udwadia_kalaba_is_index_one_by_another_formula),
        cmocka_unit_test(udwadia_kalaba_starts_where_the_loop_has_lost_rank),
        cmocka_unit_test(a_massless_rocker_is_moved_as_the_saddle_system_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
