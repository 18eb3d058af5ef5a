// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit methods in runs: orders of q, v and multipliers on every form they serve, what stays
// closed, redundant rows, stiffness.
#include "study/cost/convergence.h"

#include "support/alloc.h"
#include "support/near.h"
#include "support/trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FB0 HN_TRIAL_LESSON "fb0-lagrangian.json"

enum { MOST_STEPS = 6, MAX = 32 };

typedef struct errors {
    double q, v, raw, lambda, gap, speed_gap;
} errors;

typedef struct state {
    double q[MAX], v[MAX], lambda[MAX];
} state;

static double largest(int n, const double *x, const double *y) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        worst = fmax(worst, fabs(x[i] - y[i]));
    }
    return worst;
}

static void reference_state(const hn_trial *trial, double T, state *out) {
    hn_sample s;
    hn_run *run = hn_trial_run(trial, "projection@dop853:rtol=1e-13");
    assert_int_equal(hn_run_advance(run, T), HN_OK);
    assert_int_equal(hn_run_sample(run, T, &s), HN_OK);
    memcpy(out->q, s.q, (size_t)trial->info.n_user * sizeof(double));
    memcpy(out->v, s.v, (size_t)trial->info.n_user * sizeof(double));
    memcpy(out->lambda, s.lambda, (size_t)trial->info.nc * sizeof(double));
    hn_run_free(run);
}

static hn_run *raw_run(const hn_trial *trial, const char *spelling) {
    const hn_method_spec spec = hn_trial_spec(spelling);
    hn_run_opts opts = hn_run_opts_default();
    hn_run *run = NULL;
    hn_diag diag = {0};
    opts.raw_lambda = 1;
    if (hn_run_create(trial->sys, &spec, trial->q, trial->v, &opts, &run, &diag) != HN_OK) {
        fail_msg("%s: %s", spelling, diag.message);
    }
    return run;
}

static errors errors_of(const hn_trial *trial, const char *spelling, double T, const state *at) {
    hn_sample s;
    hn_run *run = raw_run(trial, spelling);
    if (hn_run_advance(run, T) != HN_OK) {
        fail_msg("%s: %s", spelling, hn_run_get_summary(run).reason);
    }
    assert_int_equal(hn_run_sample(run, T, &s), HN_OK);
    const hn_run_summary summary = hn_run_get_summary(run);
    const int n = trial->info.n_user, nc = trial->info.nc;
    const errors e = {.q = largest(n, s.q, at->q),
                      .v = largest(n, s.v, at->v),
                      .raw = s.raw_lambda ? largest(nc, s.raw_lambda, at->lambda) : 0,
                      .lambda = largest(nc, s.lambda, at->lambda),
                      .gap = summary.worst_gap,
                      .speed_gap = summary.worst_velocity_gap};
    hn_run_free(run);
    return e;
}

// Hairer, Lubich & Roche 1989, table 2.3: orders of q, v and the scheme's own multipliers;
// multipliers from the saddle system follow the state
typedef struct order_row {
    const char *method;
    double h;
    int n;
    double q, v, raw, lambda; ///< 0: not looked at
} order_row;

static void check_order(const char *what, const order_row *row, const double *h, const double *err,
                        double wanted) {
    const double order = hn_fit_order(row->n, h, err);
    // observed orders wander by what the next term of the expansion still is
    if (!(fabs(order - wanted) <= 0.3)) {
        fail_msg("%s: %s converges with order %.2f, expected %.0f (errors %.2g to %.2g)",
                 row->method, what, order, wanted, err[0], err[row->n - 1]);
    }
}

static void check_orders(const hn_trial *trial, const order_row *rows, int n_rows, double T) {
    state at;
    reference_state(trial, T, &at);
    for (int k = 0; k < n_rows; k++) {
        const order_row *row = &rows[k];
        double h[MOST_STEPS], q[MOST_STEPS], v[MOST_STEPS], raw[MOST_STEPS], lambda[MOST_STEPS];
        for (int i = 0; i < row->n; i++) {
            char spelling[HN_SPEC_MAX];
            h[i] = row->h / (1 << i);
            snprintf(spelling, sizeof spelling, "%s:h=%.17g", row->method, h[i]);
            const errors e = errors_of(trial, spelling, T, &at);
            q[i] = e.q;
            v[i] = e.v;
            raw[i] = e.raw;
            lambda[i] = e.lambda;
        }
        check_order("q", row, h, q, row->q);
        check_order("v", row, h, v, row->v);
        if (row->lambda > 0) {
            check_order("lambda from the state", row, h, lambda, row->lambda);
        }
        if (row->raw > 0) {
            check_order("raw lambda", row, h, raw, row->raw);
        }
    }
}

static const order_row orders[] = {
    {"index3@implicit-euler", 1.0 / 800, 4, 1, 1, 1, 1},
    {"index2@implicit-euler", 1.0 / 800, 4, 1, 1, 1, 1},
    {"ggl@implicit-euler", 1.0 / 800, 4, 1, 1, 1, 1},
    {"index2@midpoint", 1.0 / 50, 4, 2, 2, 1, 2},
    {"index2@radau3", 1.0 / 40, 4, 3, 3, 2, 3},
    {"ggl@radau3", 1.0 / 40, 4, 3, 3, 2, 3},
    {"index3@radau5", 1.0 / 20, 4, 5, 3, 2, 3},
    {"index2@radau5", 1.0 / 20, 4, 5, 5, 3, 5},
    {"ggl@radau5", 1.0 / 20, 4, 5, 5, 3, 5},
    {"index1@radau5", 1.0 / 20, 4, 5, 5, 0, 5},
    {"reduced@gauss2", 1.0 / 20, 4, 4, 4, 0, 4},
    {"reduced@gauss3", 1.0 / 20, 3, 6, 6, 0, 6},
};

static void orders_on_the_four_bar_are_those_of_the_theory(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    check_orders(&trial, orders, sizeof orders / sizeof orders[0], 1);
    hn_trial_close(&trial);
}

static const order_row orders_elsewhere[] = {
    {"index3@implicit-euler", 1.0 / 800, 3, 1, 1, 1, 1},
    {"index2@midpoint", 1.0 / 50, 3, 2, 2, 1, 2},
    {"index3@radau5", 1.0 / 20, 3, 5, 3, 2, 0},
    {"index2@radau5", 1.0 / 20, 3, 5, 5, 3, 5},
    {"ggl@radau5", 1.0 / 20, 3, 5, 5, 3, 5},
};

static void orders_on_a_pendulum_in_cartesian_coordinates_are_the_same(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_trial_open(&trial, "tests/reference/a01-simple-pendulum.json");
    check_orders(&trial, orders_elsewhere, sizeof orders_elsewhere / sizeof orders_elsewhere[0], 1);
    hn_trial_close(&trial);
}

static const order_row orders_of_turns[] = {
    {"index1@radau5", 1.0 / 100, 3, 5, 5, 0, 0},
    {"ggl@radau5", 1.0 / 100, 3, 5, 5, 0, 0},
    {"index2@midpoint", 1.0 / 400, 3, 2, 2, 0, 0},
};

// orientations are carried by rotation vectors from the start of each step, so turns cost no order
static void orders_on_a_spinning_block_are_those_of_the_method(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_trial_open(&trial, "lessons/09-space-and-drives/scenes/heavy-top.json");
    check_orders(&trial, orders_of_turns, sizeof orders_of_turns / sizeof orders_of_turns[0], 0.1);
    hn_trial_close(&trial);
}

static void ggl_keeps_loop_and_speed_closed_to_rounding(void **unused) {
    (void)unused;
    hn_trial trial;
    state at;
    hn_trial_open(&trial, FB0);
    reference_state(&trial, 2, &at);
    errors e = errors_of(&trial, "ggl@radau5:h=0.01", 2, &at);
    assert_near(e.gap, 0, 4e-15);       // links of length 2
    assert_near(e.speed_gap, 0, 1e-13); // rates of 10 rad/s
    e = errors_of(&trial, "ggl@radau5:rtol=1e-6", 2, &at);
    assert_near(e.gap, 0, 4e-15);
    assert_near(e.speed_gap, 0, 1e-13);
    e = errors_of(&trial, "index2@radau5:h=0.01", 2, &at);
    assert_near(e.speed_gap, 0, 1e-13);
    assert_true(e.gap > 1e-12); // nothing closes it
    e = errors_of(&trial, "index3@radau5:h=0.01", 2, &at);
    assert_near(e.gap, 0, 4e-15);
    assert_true(e.speed_gap > 1e-6);
    hn_trial_close(&trial);
}

static void an_adaptive_run_follows_its_tolerance_with_every_form(void **unused) {
    (void)unused;
    static const char *const forms[] = {"ggl", "index2", "index1", "projection", "reduced"};
    hn_trial trial;
    state at;
    hn_trial_open(&trial, FB0);
    reference_state(&trial, 2, &at);
    for (int k = 0; k < 5; k++) {
        double last = HUGE_VAL;
        for (int digits = 4; digits <= 10; digits += 2) {
            char spelling[HN_SPEC_MAX];
            snprintf(spelling, sizeof spelling, "%s@radau5:rtol=1e-%d", forms[k], digits);
            const errors e = errors_of(&trial, spelling, 2, &at);
            // local errors add up over two seconds
            assert_true(e.q < 100 * pow(10, -digits));
            assert_true(e.q < last);
            last = e.q;
        }
    }
    hn_trial_close(&trial);
}

static void a_step_that_is_given_is_kept_and_spelled(void **unused) {
    (void)unused;
    char text[HN_SPEC_MAX];
    hn_trial trial;
    hn_method_spec spec = hn_trial_spec("ggl@radau5:h=0.01");
    assert_int_equal(hn_method_is_adaptive(&spec), 0);
    hn_method_format(&spec, text);
    assert_string_equal(text, "ggl@radau5:h=0.01");
    hn_trial_open(&trial, FB0);
    hn_run *run = hn_trial_run(&trial, text);
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_int_equal(hn_run_get_summary(run).steps, 100);
    hn_run_free(run);
    hn_trial_close(&trial);
    spec = hn_trial_spec("ggl@radau5");
    assert_int_equal(hn_method_is_adaptive(&spec), 1);
    hn_method_format(&spec, text);
    assert_string_equal(text, "ggl@radau5:rtol=1e-06");
}

static void redundant_rows_change_nothing_but_single_multipliers(void **unused) {
    (void)unused;
    static const char *const methods[] = {"ggl@radau5:h=0.01", "index2:close=-1@radau5:h=0.01",
                                          "index3@radau5:h=0.01",
                                          "index2:close=-1@midpoint:h=0.01"};
    static const char *const scenes[] = {"tests/scenes/fb0-redundant.json",
                                         "tests/scenes/fb0-tilted.json"};
    hn_trial plain;
    hn_trial_open(&plain, HN_TRIAL_LESSON "fb0.json");
    for (int m = 0; m < 4; m++) {
        hn_sample s;
        state at;
        hn_run *run = hn_trial_run(&plain, methods[m]);
        assert_int_equal(hn_run_advance(run, 1), HN_OK);
        assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
        memcpy(at.q, s.q, sizeof(double) * 3);
        hn_run_free(run);
        for (int k = 0; k < 2; k++) {
            hn_trial trial;
            hn_trial_open(&trial, scenes[k]);
            run = hn_trial_run(&trial, methods[m]);
            assert_int_equal(hn_run_advance(run, 1), HN_OK);
            assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
            // the closing at each end with all rows moves what index 2 has let open
            assert_all_near(s.q, at.q, 3, 1e-6);
            hn_run_free(run);
            hn_trial_close(&trial);
        }
    }
    hn_trial_close(&plain);
}

static void a_step_does_not_allocate_whatever_the_form(void **unused) {
    (void)unused;
    static const char *const methods[] = {"ggl@radau5:rtol=1e-6", "index2@midpoint:h=0.01",
                                          "index3@implicit-euler:h=0.01", "index1@gauss3:h=0.01",
                                          "ggl@radau3:h=0.01"};
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    for (int k = 0; k < 5; k++) {
        hn_sample s;
        hn_run *run = raw_run(&trial, methods[k]);
        const long before = hn_alloc_count();
        assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run) - 0.003, &s), HN_OK);
        assert_int_equal(hn_run_reset(run), HN_OK);
        assert_int_equal(hn_run_advance(run, 0.1), HN_OK);
        assert_int_equal(hn_alloc_count(), before);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

static void a_reset_run_gives_the_same_bits_again(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_sample s;
    double q[2][MAX];
    hn_trial_open(&trial, FB0);
    hn_run *run = hn_trial_run(&trial, "ggl@radau5:rtol=1e-7");
    for (int k = 0; k < 2; k++) {
        assert_int_equal(hn_run_advance(run, 1), HN_OK);
        assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
        memcpy(q[k], s.q, (size_t)trial.info.n_user * sizeof(double));
        assert_int_equal(hn_run_reset(run), HN_OK);
    }
    assert_memory_equal(q[0], q[1], (size_t)trial.info.n_user * sizeof(double));
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void raw_multipliers_come_only_when_asked_for_and_also_between_steps(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_sample s;
    state at;
    hn_trial_open(&trial, FB0);
    hn_run *run = hn_trial_run(&trial, "ggl@radau5:rtol=1e-8");
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
    assert_null(s.raw_lambda);
    hn_run_free(run);
    run = raw_run(&trial, "ggl@radau5:rtol=1e-8");
    reference_state(&trial, 1, &at);
    assert_int_equal(hn_run_has_raw_lambda(run), 1);
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_true(hn_run_time(run) > 1);
    assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
    assert_non_null(s.raw_lambda);
    assert_all_near(s.raw_lambda, at.lambda, (size_t)trial.info.nc, 1e-2); // order 3 of 5
    assert_all_near(s.q, at.q, 3, 1e-6);
    hn_run_free(run);
    run = raw_run(&trial, "index1@rk4:h=0.01");
    assert_int_equal(hn_run_has_raw_lambda(run), 0);
    hn_run_free(run);
    hn_trial_close(&trial);
}

// A slider-crank whose slider drags a second mass on a spring of 1e9 N/m, stretched by 1 um at the
// start: more than 31,600 rad/s against motions of a second.
static const char stiff[] =
    "{\"holonom\": 1, \"name\": \"stiff\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"th\", \"rate\": \"w\", \"unit\": \"rad\"}, {\"name\": \"x\", \"rate\": \"vx\", "
    "\"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", \"unit\": \"m\"}],"
    "\"kinetic\": \"(w^2 + vx^2 + vy^2)/2\", \"potential\": \"9.81*sin(th) + 1e9*(y - x - 1)^2/2\","
    "\"constraints\": [{\"name\": \"rod\", \"formula\": \"(x - cos(th))^2 + sin(th)^2 - 4\"}]},"
    "\"start\": {\"positions\": {\"th\": 1, \"x\": {\"guess\": 2.3}, "
    "\"y\": \"cos(1) + sqrt(4 - sin(1)^2) + 1.000001\"}, \"rates\": {\"w\": 0, \"vy\": 0}}}";

// largest stretch of the spring over the last steps of a second [m]
static double ringing(const hn_trial *trial, const char *method, double h) {
    char spelling[HN_SPEC_MAX];
    double worst = 0;
    hn_sample s;
    snprintf(spelling, sizeof spelling, "%s:h=%g", method, h);
    hn_run *run = hn_trial_run(trial, spelling);
    if (hn_run_advance(run, 1) != HN_OK) {
        fail_msg("%s: %s", spelling, hn_run_get_summary(run).reason);
    }
    for (int i = 0; i < 5; i++) {
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
        worst = fmax(worst, fabs(s.q[2] - s.q[1] - 1));
    }
    hn_run_free(run);
    return worst;
}

static void a_stiff_spring_is_damped_by_radau_and_rings_under_midpoint(void **unused) {
    (void)unused;
    static const char *const damping[] = {"ggl@radau5",         "index2@radau5", "index3@radau5",
                                          "ggl@implicit-euler", "index1@radau5", "ggl@radau3"};
    hn_trial trial;
    hn_trial_open_text(&trial, stiff);
    for (int k = 0; k < 6; k++) {
        for (double h = 0.02; h > 1e-3; h /= 4) {
            // what is left is the pull of the motion itself: some 10 N
            assert_true(ringing(&trial, damping[k], h) < 5e-8);
        }
    }
    assert_true(ringing(&trial, "index2@midpoint", 0.01) > 2e-7);
    hn_trial_close(&trial);
}

static void a_step_too_large_for_newton_is_told_in_words(void **unused) {
    (void)unused;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    hn_run *run = hn_trial_run(&trial, "ggl@radau5:h=3");
    assert_int_equal(hn_run_advance(run, 30), HN_ERR_NO_CONVERGENCE);
    const hn_run_summary s = hn_run_get_summary(run);
    assert_non_null(strstr(s.reason, "Newton's method at t = 0 s"));
    assert_non_null(strstr(s.reason, "the step of 3 s is too long for it"));
    hn_run_free(run);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders_on_the_four_bar_are_those_of_the_theory),
        cmocka_unit_test(orders_on_a_pendulum_in_cartesian_coordinates_are_the_same),
        cmocka_unit_test(orders_on_a_spinning_block_are_those_of_the_method),
        cmocka_unit_test(ggl_keeps_loop_and_speed_closed_to_rounding),
        cmocka_unit_test(an_adaptive_run_follows_its_tolerance_with_every_form),
        cmocka_unit_test(a_step_that_is_given_is_kept_and_spelled),
        cmocka_unit_test(redundant_rows_change_nothing_but_single_multipliers),
        cmocka_unit_test(a_step_does_not_allocate_whatever_the_form),
        cmocka_unit_test(a_reset_run_gives_the_same_bits_again),
        cmocka_unit_test(raw_multipliers_come_only_when_asked_for_and_also_between_steps),
        cmocka_unit_test(a_stiff_spring_is_damped_by_radau_and_rings_under_midpoint),
        cmocka_unit_test(a_step_too_large_for_newton_is_told_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
