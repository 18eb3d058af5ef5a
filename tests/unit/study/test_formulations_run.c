// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/list/formulation_list.h"
#include "support/near.h"
#include "support/trial.h"

#include "dynamics/evaluate/eval.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FB0 HN_TRIAL_LESSON "fb0.json"

static void an_open_gap_decays_under_baumgarte_as_the_closed_formula_says(void **state) {
    (void)state;
    // phi'' at an open state is -2 alpha phi' - alpha^2 phi; along the run phi(t) = (p + (p' +
    // alpha p) t) exp(-alpha t)
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    const double alpha = 10, T = 1;
    hn_arena *arena = hn_arena_create(0);
    hn_eval *loop = NULL;
    assert_int_equal(hn_eval_create(trial.sys, HN_TERM_PHI | HN_TERM_J, arena, &loop), HN_OK);
    trial.q[1] += 1e-4;
    trial.v[2] += 1e-3;
    hn_eval_run(loop, 0, trial.q, trial.v);
    double p[2], rate[2] = {0, 0};
    memcpy(p, hn_eval_get(loop, HN_TERM_PHI), sizeof p);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++) {
            rate[i] += hn_eval_get(loop, HN_TERM_J)[i * 3 + j] * trial.v[j];
        }
    }
    hn_run *run = hn_trial_run(&trial, "baumgarte:alpha=10,beta=10@dopri5:rtol=1e-12");
    assert_int_equal(hn_run_advance(run, T), HN_OK);
    hn_sample sample;
    assert_int_equal(hn_run_sample(run, T, &sample), HN_OK);
    const double x = (p[0] + (rate[0] + alpha * p[0]) * T) * exp(-alpha * T);
    const double y = (p[1] + (rate[1] + alpha * p[1]) * T) * exp(-alpha * T);
    assert_rel(sample.gap, hypot(x, y), 1e-2);
    hn_run_free(run);
    hn_eval_free(loop);
    hn_arena_free(arena);
    hn_trial_close(&trial);
}

// a cart moved by hand, x = 0.3 sin(2 t), with a pendulum of mass 1 and length 1 below it
static const char driven_cart[] =
    "{\"holonom\": 1, \"name\": \"driven-cart\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"th\", \"rate\": \"w\", "
    "\"unit\": \"rad\"}],"
    "\"kinetic\": \"2*vx^2/2 + (vx^2 + w^2 + 2*vx*w*cos(th))/2\", \"potential\": \"-9.81*cos(th)\","
    "\"constraints\": [{\"name\": \"hand\", \"formula\": \"x - 0.3*sin(2*t)\"}]},"
    "\"start\": {\"positions\": {\"x\": {\"guess\": 0}, \"th\": 0.5}, \"rates\": {\"th\": 0.2}}}";

// th'' = -9.81 sin th - x'' cos th with x'' = -1.2 sin(2 t), by small steps of the midpoint rule
static double pendulum_on_a_cart(double T) {
    const int n = 200000;
    const double h = T / n;
    double th = 0.5, w = 0.2;
    for (int i = 0; i < n; i++) {
        const double t = i * h, push = 1.2 * sin(2 * t), half_push = 1.2 * sin(2 * t + h);
        const double th_mid = th + h / 2 * w;
        const double w_mid = w + h / 2 * (-9.81 * sin(th) + push * cos(th));
        th += h * w_mid;
        w += h * (-9.81 * sin(th_mid) + half_push * cos(th_mid));
    }
    return th;
}

static void a_constraint_that_moves_in_time_drives_every_formulation_alike(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open_text(&trial, driven_cart);
    const double exact = pendulum_on_a_cart(2);
    for (int i = 0; i < hn_formulation_count(); i++) {
        char text[HN_SPEC_MAX];
        hn_sample s;
        if (hn_formulation_at(i)->model_error || hn_formulation_at(i)->form != HN_FORM_ODE) {
            continue;
        }
        snprintf(text, sizeof text, "%s@rk4:h=2e-3", hn_formulation_at(i)->name);
        hn_run *run = hn_trial_run(&trial, text);
        assert_int_equal(hn_run_advance(run, 2), HN_OK);
        assert_int_equal(hn_run_sample(run, 2, &s), HN_OK);
        assert_near(s.q[0], 0.3 * sin(4), 1e-9);
        assert_near(s.v[0], 0.6 * cos(4), 1e-9);
        assert_near(s.q[1], exact, 1e-7);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

static void projection_takes_kinetic_energy_and_counts_it(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=0.02");
    assert_int_equal(hn_run_advance(run, 2), HN_OK);
    const hn_run_summary s = hn_run_get_summary(run);
    assert_int_equal(s.cost.projections, s.steps);
    assert_true(s.cost.energy_removed > 0);
    assert_true(s.worst_gap < 1e-13);
    assert_true(s.worst_velocity_gap < 1e-12);
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void weight_and_part_of_a_projection_can_be_chosen(void **state) {
    (void)state;
    static const struct {
        const char *spelling;
        int closes_position, closes_speed;
    } rows[] = {
        {"projection:weight=euclidean@rk4:h=0.01", 1, 1},
        {"projection:what=position@rk4:h=0.01", 1, 0},
        {"projection:what=velocity@rk4:h=0.01", 0, 1},
        {"projection:what=velocity,weight=euclidean@rk4:h=0.01", 0, 1},
    };
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hn_run *run = hn_trial_run(&trial, rows[i].spelling);
        assert_int_equal(hn_run_advance(run, 2), HN_OK);
        const hn_run_summary s = hn_run_get_summary(run);
        assert_int_equal(s.worst_gap < 1e-13, rows[i].closes_position);
        assert_int_equal(s.worst_velocity_gap < 1e-12, rows[i].closes_speed);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

/// What each formulation states about the gap is what it does: closed to rounding, or open by what
/// RK4 leaves (about 1e-6 m at this step).
static void traits_say_what_stays_closed(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        char text[HN_SPEC_MAX];
        if (f->form != HN_FORM_ODE || (f->traits & HN_TRAIT_COUNTER_EXAMPLE)) {
            continue;
        }
        snprintf(text, sizeof text, "%s@rk4:h=0.01", f->name);
        hn_run *run = hn_trial_run(&trial, text);
        assert_int_equal(hn_run_advance(run, 1), HN_OK);
        const hn_run_summary s = hn_run_get_summary(run);
        assert_int_equal(s.worst_gap < 1e-12, (f->traits & HN_TRAIT_CLOSES_POSITION) != 0);
        assert_int_equal(s.worst_velocity_gap < 1e-11, (f->traits & HN_TRAIT_CLOSES_VELOCITY) != 0);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

static void a_formulation_is_found_by_its_traits(void **state) {
    (void)state;
    const hn_formulation *closing =
        hn_formulation_with(HN_TRAIT_CLOSES_POSITION, HN_TRAIT_HAS_CHART);
    assert_string_equal(closing->name, "projection");
    assert_null(hn_formulation_with(HN_TRAIT_PULLS_GAP | HN_TRAIT_CLOSES_POSITION, 0));
}

static void reduced_coordinates_stop_at_the_dead_point_at_every_step_size(void **state) {
    (void)state;
    // the coupler of FB0 turns round at t = 0.746 s, where crank and rocker are parallel
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    static const char *const spellings[] = {
        "reduced:coordinate=2@rk4:h=0.02",       "reduced:coordinate=2@rk4:h=0.01",
        "reduced:coordinate=2@rk4:h=0.005",      "reduced:coordinate=2@rk4:h=0.002",
        "reduced:coordinate=2@rk4:h=0.001",      "reduced:coordinate=2@rk4:h=0.0005",
        "reduced:coordinate=2@dopri5:rtol=1e-6", "reduced:coordinate=2@dopri5:rtol=1e-10",
    };
    for (size_t i = 0; i < sizeof spellings / sizeof spellings[0]; i++) {
        hn_run *run = hn_trial_run(&trial, spellings[i]);
        const hn_incident *incidents = NULL;
        assert_int_equal(hn_run_advance(run, 3), HN_ERR_CHART);
        const hn_run_summary s = hn_run_get_summary(run);
        assert_near(s.t, 0.746, 0.021);
        assert_non_null(strstr(s.reason, "th2 = 0.37"));
        const int n = hn_run_incidents(run, &incidents);
        assert_int_equal(incidents[n - 1].code, HN_INCIDENT_CHART_LOST);
        // the remedy that is offered first goes on
        hn_run *cured = hn_trial_run(&trial, incidents[n - 1].remedy[0]);
        assert_int_equal(hn_run_advance(cured, 3), HN_OK);
        hn_run_free(cured);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

static void partitioning_goes_through_the_dead_point_where_a_fixed_crank_stops(void **state) {
    (void)state;
    // l = 1, 2, 1 and d = 2.5: the crank cannot turn round, its range ends where coupler and rocker
    // are in line, |A - O3| = 3, at cos th1 = (1 + 6.25 - 9) / 5
    static const hn_setting lengths[] = {{"l1", 1}, {"l2", 2}, {"l3", 1}, {"d", 2.5}};
    const double fold = acos(-0.35);
    hn_trial trial;
    hn_trial_open_with(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json", lengths, 4);
    hn_run *fixed = hn_trial_run(&trial, "reduced:coordinate=1@rk4:h=1e-3");
    hn_run *moving = hn_trial_run(&trial, "partitioning@rk4:h=5e-4");
    hn_run *projected = hn_trial_run(&trial, "projection@rk4:h=5e-4");
    hn_sample a, b;
    assert_int_equal(hn_run_advance(fixed, 5), HN_ERR_CHART);
    assert_int_equal(hn_run_sample(fixed, hn_run_time(fixed), &a), HN_OK);
    assert_near(fabs(a.q[0]), fold, 0.02);
    assert_int_equal(hn_run_advance(moving, 2), HN_OK);
    const hn_run_summary s = hn_run_get_summary(moving);
    assert_true(s.cost.chart_changes >= 2);
    assert_true(s.worst_gap < 1e-14);
    assert_int_equal(hn_run_advance(projected, 2), HN_OK);
    assert_int_equal(hn_run_sample(projected, 2, &a), HN_OK);
    assert_int_equal(hn_run_sample(moving, 2, &b), HN_OK);
    assert_all_near(b.q, a.q, (size_t)trial.info.n_user, 2e-5);
    hn_run_free(fixed);
    hn_run_free(moving);
    hn_run_free(projected);
    hn_trial_close(&trial);
}

static void a_coordinate_that_does_not_exist_is_refused(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    const hn_method_spec spec = hn_trial_spec("reduced:coordinate=4@rk4");
    hn_run *run = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_run_create(trial.sys, &spec, trial.q, trial.v, NULL, &run, &diag),
                     HN_ERR_UNSUPPORTED);
    assert_non_null(strstr(diag.message, "1 to 3"));
    assert_null(run);
    hn_trial_close(&trial);
}

static void operations_are_counted_and_follow_the_evaluations(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FB0);
    for (int i = 0; i < hn_formulation_count(); i++) {
        char text[HN_SPEC_MAX];
        if (hn_formulation_at(i)->form != HN_FORM_ODE) {
            continue;
        }
        snprintf(text, sizeof text, "%s@rk4:h=0.01", hn_formulation_at(i)->name);
        hn_run *run = hn_trial_run(&trial, text);
        assert_int_equal(hn_run_advance(run, 1), HN_OK);
        const hn_run_summary s = hn_run_get_summary(run);
        assert_int_equal(s.steps, 100);
        if (hn_formulation_at(i)->around_step) { // several of the integrator's steps in each
            assert_true(s.cost.evals > 400 && s.cost.evals % 4 == 0);
        } else {
            assert_int_equal(s.cost.evals, 400);
        }
        assert_true(s.cost.ops / (double)s.cost.evals > 80);
        // tangent-space coordinates close the loops at each evaluation: two turns, each with its
        // own factors
        assert_true(s.cost.ops / (double)s.cost.evals < 800);
        assert_true(s.cost.factorisations >= 400);
        assert_int_equal(s.cost.fallbacks, 0);
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_open_gap_decays_under_baumgarte_as_the_closed_formula_says),
        cmocka_unit_test(a_constraint_that_moves_in_time_drives_every_formulation_alike),
        cmocka_unit_test(projection_takes_kinetic_energy_and_counts_it),
        cmocka_unit_test(traits_say_what_stays_closed),
        cmocka_unit_test(a_formulation_is_found_by_its_traits),
        cmocka_unit_test(weight_and_part_of_a_projection_can_be_chosen),
        cmocka_unit_test(reduced_coordinates_stop_at_the_dead_point_at_every_step_size),
        cmocka_unit_test(partitioning_goes_through_the_dead_point_where_a_fixed_crank_stops),
        cmocka_unit_test(a_coordinate_that_does_not_exist_is_refused),
        cmocka_unit_test(operations_are_counted_and_follow_the_evaluations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
