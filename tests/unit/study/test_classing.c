// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/trial.h"

#include "base/strbuf.h"
#include "study/cost/pareto.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- ladders written down by hand ----

typedef struct written {
    hn_wp wp;
    hn_ref ref;
    hn_wp_method methods[3];
    hn_class classes[3];
} written;

static void write_down(written *w, int n_methods, int n_levels, double reference_error) {
    memset(w, 0, sizeof *w);
    w->ref.T = 1;
    w->ref.error[HN_ERROR_Q] = reference_error;
    w->wp = (hn_wp){
        .ref = &w->ref, .n_methods = n_methods, .n_levels = n_levels, .methods = w->methods};
    static const char *const spellings[3] = {"index1@rk4", "projection@rk4", "nullspace@rk4"};
    for (int m = 0; m < n_methods; m++) {
        w->methods[m].spec = hn_trial_spec(spellings[m]);
        snprintf(w->methods[m].spelling, HN_SPEC_MAX, "%s", spellings[m]);
    }
}

/// Errors e at steps 10, 20, 40, ...; `limit` is where the method converges to, away from the
/// reference.
static void set_ladder(written *w, int m, const double *e, double limit) {
    for (int k = 0; k < w->wp.n_levels; k++) {
        hn_wp_point *p = &w->methods[m].point[k];
        p->state = HN_WP_DONE;
        p->steps = 10 << k;
        p->size = 1.0 / (double)p->steps;
        p->worst[HN_ERROR_Q] = p->end[HN_ERROR_Q] = limit + e[k];
        p->own = k ? fabs(e[k] - e[k - 1]) : (double)NAN;
        p->cost.ops = 1000.0 * (1 << k);
    }
}

/// A single method: n errors, the limit of set_ladder(), the error of the reference itself.
static void write_one(written *w, const double *e, int n, double limit, double reference_error) {
    write_down(w, 1, n, reference_error);
    set_ladder(w, 0, e, limit);
}

static hn_class class_of(const written *w, int m) {
    hn_class c;
    hn_wp_classify(&w->wp, m, &c);
    return c;
}

static void a_fourth_order_ladder_converges_with_order_four(void **state) {
    (void)state;
    written w;
    const double e[6] = {1e-2, 1e-2 / 16, 1e-2 / 256, 1e-2 / 4096, 1e-2 / 65536, 1e-2 / 1048576};
    write_one(&w, e, 6, 0, 1e-13);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_near(c.order, 4, 1e-12);
    assert_true(c.as_theory && isnan(c.floor));
}

static void an_order_that_is_not_the_integrators_is_told_as_such(void **state) {
    (void)state;
    written w;
    const double e[5] = {1e-2, 1e-2 / 8, 1e-2 / 64, 1e-2 / 512, 1e-2 / 4096};
    write_one(&w, e, 5, 0, 1e-13);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_near(c.order, 3, 1e-12);
    assert_false(c.as_theory);
    assert_non_null(strstr(c.text, "where its integrator has 4"));
}

// as of a program that makes its own steps
static void where_theory_is_not_known_none_is_claimed(void **state) {
    (void)state;
    written w;
    const double e[5] = {1e-2, 1e-2 / 32, 1e-2 / 1024, 1e-2 / 32768, 1e-2 / 1048576};
    const double bent[4] = {1e-2, 1e-2 / 2, 1e-2 / 40, 1e-2 / 90};
    hn_stepper unknown = {.name = "own", .order = 0};
    write_one(&w, e, 5, 0, 1e-13);
    for (int k = 0; k < 5; k++) {
        w.methods[0].point[k].worst[HN_ERROR_ENERGY] = e[k] / 75;
    }
    w.methods[0].spec.stepper = &unknown;
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_string_equal(c.text, "converges with order 5.00");
    assert_true(isnan(c.theory));
    assert_false(c.as_theory);

    write_one(&w, bent, 4, 0, 1e-13);
    w.methods[0].spec.stepper = &unknown;
    assert_null(strstr(class_of(&w, 0).text, "theory"));
    assert_null(strstr(class_of(&w, 0).text, "nan"));
}

// a Runge-Kutta method of order 4 loses energy with order 5: where that carries the phase, the
// coordinates converge with order 5 too
static void
an_order_above_the_integrators_is_put_down_to_the_energy_where_it_follows_it(void **state) {
    (void)state;
    written w;
    const double e[5] = {1e-2, 1e-2 / 32, 1e-2 / 1024, 1e-2 / 32768, 1e-2 / 1048576};
    write_one(&w, e, 5, 0, 1e-13);
    assert_null(strstr(class_of(&w, 0).text, "energy")); // its error is not known

    for (int k = 0; k < 5; k++) {
        w.methods[0].point[k].worst[HN_ERROR_ENERGY] = e[k] / 75;
    }
    const hn_class c = class_of(&w, 0);
    assert_near(c.energy_order, 5, 1e-12);
    assert_non_null(strstr(c.text, "order 5.00, where its integrator has 4: the coordinates follow "
                                   "the error of the energy, which falls with order 5.00"));

    for (int k = 0; k < 5; k++) {
        w.methods[0].point[k].worst[HN_ERROR_ENERGY] = 1e-3 / (1 << k);
    }
    assert_null(strstr(class_of(&w, 0).text, "energy"));
}

static void a_slope_that_rises_towards_theory_is_told(void **state) {
    (void)state;
    written w;
    const double e[5] = {1e-2, 1e-2 / 11, 1e-2 / 11 / 12, 1e-2 / 11 / 12 / 13,
                         1e-2 / 11 / 12 / 13 / 14};
    write_one(&w, e, 5, 0, 1e-13);
    // log2(14) = 3.81
    assert_non_null(strstr(class_of(&w, 0).text, "the slope rises, to 3.81 at the finest"));
}

static void rounding_at_the_fine_end_is_a_floor_and_leaves_the_order_alone(void **state) {
    (void)state;
    written w;
    const double e[7] = {1e-4, 6.25e-6, 3.9e-7, 2.44e-8, 3e-10, 5e-10, 2e-10};
    write_one(&w, e, 7, 0, 1e-14);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_near(c.floor, 5e-10, 1e-14);
    // the fit may use the first point of the floor's size or not, but nothing that wanders
    assert_near(c.order, 4, 0.2);
}

static void rounding_that_bends_the_fine_end_leaves_the_order_above_it(void **state) {
    (void)state;
    written w;
    // measured: a four-bar ladder by RK4 over 10 s, whose last two halvings meet rounding
    const double e[7] = {2.1e-5, 1.31e-6, 8.2e-8, 5.1e-9, 3.2e-10, 3.7e-11, 9.7e-12};
    write_one(&w, e, 7, 0, 1e-14);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_near(c.order, 4, 0.05);
    assert_int_equal(c.rounding, 5);
    assert_non_null(strstr(c.text, "rounding"));
}

static void slopes_that_wander_far_above_rounding_are_told_with_the_reason(void **state) {
    (void)state;
    written w;
    // measured: the leading terms of the error cancel at one size
    const double e[5] = {1.6e-1, 4.4e-3, 1.04e-4, 8.3e-7, 1.2e-7};
    write_one(&w, e, 5, 0, 1e-14);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_UNSETTLED);
    assert_non_null(strstr(c.text, "cancel"));
    assert_non_null(strstr(c.text, "; try a shorter time, "));
}

static void errors_below_the_references_own_are_a_floor(void **state) {
    (void)state;
    written w;
    const double e[5] = {3e-12, 2e-12, 4e-12, 1e-12, 2e-12};
    write_one(&w, e, 5, 0, 1e-12);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_FLOOR);
    assert_near(c.floor, 1e-11, 1e-15);
}

static void a_limit_that_is_not_the_motion_is_something_else(void **state) {
    (void)state;
    written w;
    const double e[5] = {1e-2, 1e-2 / 16, 1e-2 / 256, 1e-2 / 4096, 1e-2 / 65536};
    write_one(&w, e, 5, 0.3, 1e-13);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_ELSEWHERE);
    assert_near(c.offset, 0.3, 1e-6);
    // the same distance from a reference that knows no better accuses nobody
    w.ref.error[HN_ERROR_Q] = 0.1;
    assert_int_not_equal(class_of(&w, 0).kind, HN_CLASS_ELSEWHERE);
}

static void a_slow_method_that_still_converges_is_not_something_else(void **state) {
    (void)state;
    written w;
    const double e[5] = {0.4, 0.2, 0.1, 0.05, 0.025}; // order 1, far from the end
    write_one(&w, e, 5, 0, 1e-13);
    const hn_class c = class_of(&w, 0);
    assert_int_equal(c.kind, HN_CLASS_CONVERGES);
    assert_near(c.order, 1, 1e-12);
}

static void slopes_that_wander_are_not_in_the_asymptotic_range(void **state) {
    (void)state;
    written w;
    const double e[5] = {0.3, 0.25, 2e-2, 1e-2, 1e-4};
    write_one(&w, e, 5, 0, 1e-13);
    assert_int_equal(class_of(&w, 0).kind, HN_CLASS_UNSETTLED);
    assert_non_null(strstr(class_of(&w, 0).text, "asymptotic"));

    // the run to try is a tenth of this one, of 25 s
    w.ref.T = 25;
    assert_non_null(strstr(class_of(&w, 0).text, "; try a shorter time, 2.5 s"));
}

static void a_method_that_hardly_ever_finishes_is_failed_with_its_reason(void **state) {
    (void)state;
    written w;
    const double e[4] = {1, 1, 1, 1e-3};
    write_one(&w, e, 4, 0, 1e-13);
    for (int k = 0; k < 3; k++) {
        w.methods[0].point[k].state = HN_WP_FAILED;
        snprintf(w.methods[0].point[k].reason, HN_DIAG_MESSAGE, "the loop flew apart");
    }
    assert_int_equal(class_of(&w, 0).kind, HN_CLASS_FAILED);
    assert_non_null(strstr(class_of(&w, 0).text, "1 of 4 sizes reached the end: the loop flew"));
}

static void sizes_that_are_still_to_be_run_have_not_failed(void **state) {
    (void)state;
    written w;
    const double e[4] = {1, 1, 1, 1e-3};
    write_one(&w, e, 4, 0, 1e-13);
    for (int k = 0; k < 3; k++) {
        w.methods[0].point[k].state = HN_WP_PENDING;
    }
    assert_int_equal(class_of(&w, 0).kind, HN_CLASS_UNSETTLED);
    assert_string_equal(class_of(&w, 0).text, "not known yet: 3 of 4 sizes are still to be run");
}

// ---- times ----

static void set_time(hn_wp_point *p, const double *samples, int n) {
    memcpy(p->sample, samples, (size_t)n * sizeof *samples);
    p->n_samples = n;
    hn_wp_point_statistics(p);
}

static void medians_and_quartiles_are_those_of_the_samples(void **state) {
    (void)state;
    hn_wp_point p = {0};
    const double samples[5] = {5, 1, 4, 2, 3};
    set_time(&p, samples, 5);
    assert_near(p.median, 3, 0);
    assert_near(p.low, 2, 0);
    assert_near(p.high, 4, 0);
    assert_near(p.spread, 2.0 / 3, 1e-15);
}

/// Two methods with the same errors, the second with times `factor` as long.
static hn_pareto front_of(written *w, double factor) {
    const double e[3] = {1e-2, 1e-4, 1e-6};
    hn_pareto p;
    write_down(w, 3, 3, 1e-13);
    for (int m = 0; m < 3; m++) {
        set_ladder(w, m, e, m == 2 ? 0.5 : 0);
        w->classes[m].kind = m == 2 ? HN_CLASS_ELSEWHERE : HN_CLASS_CONVERGES;
        for (int k = 0; k < 3; k++) {
            const double t = (1 << k) * (m == 1 ? factor : m == 2 ? 0.01 : 1);
            const double samples[4] = {0.99 * t, t, 1.01 * t, t};
            set_time(&w->methods[m].point[k], samples, 4);
        }
    }
    hn_wp_pareto(&w->wp, w->classes, HN_ERROR_Q, HN_COST_TIME, &p);
    return p;
}

static void assert_sentences(const written *w, const hn_pareto *p, const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_pareto_sentences(&b, &w->wp, p);
    assert_string_equal(hn_strbuf_text(&b), expected);
    hn_strbuf_reset(&b);
}

static void the_cheapest_method_of_each_accuracy_is_named(void **state) {
    (void)state;
    written w;
    const hn_pareto p = front_of(&w, 2);
    assert_int_equal(p.n_bands, 6); // 1e-1 .. 1e-6
    for (int i = 0; i < p.n_bands; i++) {
        assert_int_equal(p.band[i].best.method, 0);
        assert_int_equal(p.band[i].next.method, 1);
        assert_int_equal(p.band[i].n_close, 0);
        assert_near(p.band[i].ratio, 2, 1e-12);
    }
    // accuracies between the points are read off: 1e-3 lies halfway from 1 s to 2 s in the
    // logarithms
    assert_near(p.band[2].best.cost, sqrt(2), 1e-12);
    assert_near(p.band[0].best.cost, 1, 0); // nothing cheaper was measured
    assert_int_equal(p.band[0].best.level, 0);
    assert_int_equal(p.band[5].best.level, 2);
    assert_sentences(&w, &p,
                     "Errors of 1e-01 to 1e-06: index1@rk4, 1.0 s to 4.0 s; next, for 1e-06, "
                     "projection@rk4 at 2 times that.\n");
}

static void times_that_cannot_be_told_apart_are_not_ranked(void **state) {
    (void)state;
    written w;
    const hn_pareto p = front_of(&w, 1.05);
    assert_int_equal(p.band[0].n_close, 1);
    assert_int_equal(p.band[0].close[0].method, 1);
    assert_int_equal(p.band[0].ranking, HN_RANKING_CLOSE);
    assert_sentences(&w, &p,
                     "Errors of 1e-01 to 1e-06: not ranked by time: index1@rk4 4.0 s and "
                     "projection@rk4 4.2 s are too close to rank; by operations: index1@rk4 and "
                     "projection@rk4 alike, 1.0 thousand operations to 4.0 thousand operations.\n");
}

/// Ten samples of a clock that was disturbed: the first half of one value, the second of another.
static void disturb(hn_wp_point *p, double first, double second) {
    double samples[HN_WP_SAMPLES];
    for (int i = 0; i < HN_WP_SAMPLES; i++) {
        samples[i] = i < HN_WP_SAMPLES / 2 ? first : second;
    }
    set_time(p, samples, HN_WP_SAMPLES);
}

static void halves_are_the_earlier_samples_and_the_later_ones(void **state) {
    (void)state;
    hn_wp_point p = {0};
    const double samples[7] = {1, 3, 2, 2, 8, 9, 7}; // four, then three
    set_time(&p, samples, 7);
    assert_near(p.half[0], 2, 0);
    assert_near(p.half[1], 8, 0);
    assert_near(hn_wp_point_halves_apart(&p), 4, 0);
    set_time(&p, samples, HN_WP_ENOUGH - 1);
    assert_true(isnan(hn_wp_point_halves_apart(&p)));
}

static void a_clock_that_changed_its_pace_ranks_nothing_and_counts_do(void **state) {
    (void)state;
    written w;
    hn_pareto p = front_of(&w, 3);
    assert_int_equal(p.band[5].ranking, HN_RANKING_CLEAR);
    // the second method costs a little more operations, and the clock ran 20 % slower in its second
    // half
    for (int k = 0; k < 3; k++) {
        w.methods[1].point[k].cost.ops *= 1.5;
        disturb(&w.methods[1].point[k], 3.0 * (1 << k), 3.6 * (1 << k));
    }
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    for (int i = 0; i < p.n_bands; i++) {
        assert_int_equal(p.band[i].ranking, HN_RANKING_UNSTEADY);
        assert_int_equal(p.band[i].unsteady.method, 1);
        assert_int_equal(p.band[i].n_close,
                         0); // it is far from the best, but by how much is not known
    }
    assert_sentences(
        &w, &p,
        "Errors of 1e-01 to 1e-06: not ranked by time: the two halves of the timing of "
        "projection@rk4 differ by 20 %, 12 s and 14 s; by operations: index1@rk4, "
        "1.0 thousand operations to 4.0 thousand operations; next, for 1e-06, projection@rk4 at "
        "1.5 times that.\n");
    // within 10 % a second measurement says the same
    for (int k = 0; k < 3; k++) {
        disturb(&w.methods[1].point[k], 3.0 * (1 << k), 3.27 * (1 << k));
    }
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_int_equal(p.band[5].ranking, HN_RANKING_CLEAR);
}

static void the_winner_too_must_be_as_fast_the_second_time(void **state) {
    (void)state;
    written w;
    hn_pareto p;
    front_of(&w, 3);
    disturb(&w.methods[0].point[1], 2.0, 1.7);
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    // errors of 1e-3 and 1e-5 are read off between that point and a neighbour; 1e-1 and 1e-6 need
    // it not
    const hn_ranking expected[6] = {HN_RANKING_CLEAR,    HN_RANKING_CLEAR,    HN_RANKING_UNSTEADY,
                                    HN_RANKING_UNSTEADY, HN_RANKING_UNSTEADY, HN_RANKING_CLEAR};
    for (int i = 0; i < 6; i++) {
        assert_int_equal(p.band[i].ranking, expected[i]);
    }
}

static void what_was_met_in_either_half_widens_what_cannot_be_told_apart(void **state) {
    (void)state;
    written w;
    hn_pareto p = front_of(&w, 1.15);
    assert_int_equal(p.band[5].ranking, HN_RANKING_CLEAR);
    // the first half of the other overlaps the best one's time
    for (int k = 0; k < 3; k++) {
        disturb(&w.methods[1].point[k], 1.0 * (1 << k), 1.3 * (1 << k));
    }
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_int_equal(p.band[5].ranking, HN_RANKING_CLOSE);
}

static void parts_whose_yardsticks_differ_are_not_ranked_by_time(void **state) {
    (void)state;
    written w;
    hn_pareto p;
    front_of(&w, 2);
    w.wp.clocks_apart = 1.4;
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_true(p.clocks_differ);
    assert_sentences(&w, &p,
                     "Not ranked by time: the same run took 40 % longer in one part than in "
                     "another.\n");
    w.wp.clocks_apart = (double)NAN;
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_true(p.clocks_differ);
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_OPS, &p);
    assert_false(p.clocks_differ);
    w.wp.clocks_apart = 1.04;
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_false(p.clocks_differ);
}

static void times_taken_too_seldom_are_not_ranked(void **state) {
    (void)state;
    written w;
    hn_pareto p = front_of(&w, 2);
    assert_false(p.few);
    w.methods[1].point[2].n_samples = HN_WP_ENOUGH - 1;
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, &p);
    assert_true(p.few);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_pareto_sentences(&b, &w.wp, &p);
    assert_null(strstr(hn_strbuf_text(&b), "index1@rk4"));
    hn_strbuf_reset(&b);
    // counts are exact, however often a clock was read
    hn_wp_pareto(&w.wp, w.classes, HN_ERROR_Q, HN_COST_OPS, &p);
    assert_false(p.few);
}

static void what_converges_to_something_else_takes_no_part(void **state) {
    (void)state;
    written w;
    front_of(&w, 2); // the third is a hundred times cheaper
    const double least = hn_wp_claimed(&w.wp, &w.wp.methods[0].point[2], HN_ERROR_Q);
    hn_band band;
    hn_wp_band(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, least, &band);
    assert_int_equal(band.best.method, 0);
    assert_true(hn_wp_reach(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, 0, least).level >= 0);
    assert_int_equal(hn_wp_reach(&w.wp, w.classes, HN_ERROR_Q, HN_COST_TIME, 2, least).level, -1);
}

static void equal_cost_is_read_off_between_the_points(void **state) {
    (void)state;
    written w;
    hn_race race;
    front_of(&w, 2);
    hn_wp_race(&w.wp, w.classes, HN_ERROR_Q, &race);
    assert_int_equal(race.n, HN_RACE_COSTS);
    for (int i = 0; i < race.n; i++) {
        // e = 1e-2 at 1000, 1e-4 at 2000, 1e-6 at 4000 operations: a straight line in the
        // logarithms
        const double expected = 1e-2 * pow(1e-2, log2(race.cost[i] / 1000));
        assert_true(race.cost[i] > 1000 && race.cost[i] < 4000);
        assert_near(race.error[i][0] / expected, 1, 1e-9);
        assert_true(isnan(race.error[i][2]) && !race.is_bound[i][0]);
    }
    // a method that stops getting dearer before: what it had reached is a bound
    for (int k = 0; k < 3; k++) {
        w.methods[1].point[k].cost.ops /= 100;
    }
    hn_wp_race(&w.wp, w.classes, HN_ERROR_Q, &race);
    assert_true(race.cost[0] > 40 && race.is_bound[0][1]);
    assert_near(race.error[0][1], 1e-6, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fourth_order_ladder_converges_with_order_four),
        cmocka_unit_test(an_order_that_is_not_the_integrators_is_told_as_such),
        cmocka_unit_test(where_theory_is_not_known_none_is_claimed),
        cmocka_unit_test(
            an_order_above_the_integrators_is_put_down_to_the_energy_where_it_follows_it),
        cmocka_unit_test(a_slope_that_rises_towards_theory_is_told),
        cmocka_unit_test(rounding_at_the_fine_end_is_a_floor_and_leaves_the_order_alone),
        cmocka_unit_test(rounding_that_bends_the_fine_end_leaves_the_order_above_it),
        cmocka_unit_test(slopes_that_wander_far_above_rounding_are_told_with_the_reason),
        cmocka_unit_test(errors_below_the_references_own_are_a_floor),
        cmocka_unit_test(a_limit_that_is_not_the_motion_is_something_else),
        cmocka_unit_test(a_slow_method_that_still_converges_is_not_something_else),
        cmocka_unit_test(slopes_that_wander_are_not_in_the_asymptotic_range),
        cmocka_unit_test(a_method_that_hardly_ever_finishes_is_failed_with_its_reason),
        cmocka_unit_test(sizes_that_are_still_to_be_run_have_not_failed),
        cmocka_unit_test(medians_and_quartiles_are_those_of_the_samples),
        cmocka_unit_test(the_cheapest_method_of_each_accuracy_is_named),
        cmocka_unit_test(times_that_cannot_be_told_apart_are_not_ranked),
        cmocka_unit_test(times_taken_too_seldom_are_not_ranked),
        cmocka_unit_test(halves_are_the_earlier_samples_and_the_later_ones),
        cmocka_unit_test(a_clock_that_changed_its_pace_ranks_nothing_and_counts_do),
        cmocka_unit_test(the_winner_too_must_be_as_fast_the_second_time),
        cmocka_unit_test(what_was_met_in_either_half_widens_what_cannot_be_told_apart),
        cmocka_unit_test(parts_whose_yardsticks_differ_are_not_ranked_by_time),
        cmocka_unit_test(what_converges_to_something_else_takes_no_part),
        cmocka_unit_test(equal_cost_is_read_off_between_the_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
