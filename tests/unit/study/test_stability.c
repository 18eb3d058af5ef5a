// SPDX-License-Identifier: GPL-3.0-or-later
// Stiff mechanisms at steps below and beyond the predicted limit, and what trials are classed as.
#include "study/stability/stability.h"

#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const hn_walk_limits LIMITS = {60, NULL, NULL};

static hn_stability_path *open_path(hn_model *m, const char *scene, const char *settings,
                                    double T) {
    hn_stability_path *path = NULL;
    hn_diag diag = {0};
    hn_model_open_closed(m, scene, settings);
    if (hn_stability_path_create(m->sys, m->q, m->v, T, &LIMITS, &path, &diag) != HN_OK) {
        fail_msg("%s: %s", scene, diag.message);
    }
    return path;
}

static hn_method_spec spec_of(const char *method, double h) {
    char text[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    snprintf(text, sizeof text, "%s:h=%.17g", method, h);
    if (hn_method_parse(text, &spec, &diag) != HN_OK) {
        fail_msg("%s: %s", text, diag.message);
    }
    return spec;
}

static hn_stability_trial try(const hn_stability_path *path, const char *method, double h) {
    const hn_method_spec spec = spec_of(method, h);
    hn_stability_trial t;
    assert_int_equal(hn_stability_try(path, &spec, &LIMITS, &t), 1);
    return t;
}

static const char *const EXPLICIT[] = {"projection@rk4", "projection@dop853",
                                       "projection@symplectic-euler", "projection@verlet"};
enum { N_EXPLICIT = sizeof EXPLICIT / sizeof *EXPLICIT };

static const struct {
    const char *scene, *settings;
    double T;
} STIFF[] = {
    {"stiff-four-bar", "k=1e6", 5},
    {"stiff-four-bar", "k=1e6 m2=1e-4", 2},
    {"stiff-slider-crank", "k=1e9", 0.05},
    {"stiff-slider-crank", "k=0 c=1e6", 0.01},
    {"car-axis", NULL, 3},
};
enum { N_STIFF = sizeof STIFF / sizeof *STIFF };

static void a_step_is_stable_at_95_percent_of_the_predicted_limit_and_not_at_105(void **state) {
    (void)state;
    for (int i = 0; i < N_STIFF; i++) {
        hn_model m;
        hn_stability_path *path = open_path(&m, STIFF[i].scene, STIFF[i].settings, STIFF[i].T);
        for (int k = 0; k < N_EXPLICIT; k++) {
            const hn_method_spec spec = spec_of(EXPLICIT[k], 1e-3);
            const hn_stability_forecast f = hn_stability_predict(path, &spec, 1000);
            assert_null(f.why);
            const hn_stability_trial below = try(path, EXPLICIT[k], 0.95 * f.limit),
                                     beyond = try(path, EXPLICIT[k], 1.05 * f.limit);
            if (!hn_stability_is_stable(below.kind) ||
                (beyond.kind != HN_STABILITY_GREW && beyond.kind != HN_STABILITY_STOPPED)) {
                fail_msg("%s %s, limit %.4g s: %s at 0.95 (%s), %s at 1.05", STIFF[i].scene,
                         EXPLICIT[k], f.limit, hn_stability_class_name(below.kind), below.reason,
                         hn_stability_class_name(beyond.kind));
            }
            assert_true(strlen(beyond.reason) > 10);
        }
        hn_stability_path_free(path);
        hn_model_close(&m);
    }
}

static void implicit_steps_stay_stable_far_beyond_where_explicit_ones_end(void **state) {
    (void)state;
    hn_model m;
    hn_stability_path *path = open_path(&m, "stiff-slider-crank", "k=1e9", 0.05);
    const hn_method_spec rk4 = spec_of("projection@rk4", 1e-3);
    const double limit = hn_stability_predict(path, &rk4, 1000).limit;
    static const char *const methods[] = {"projection@implicit-euler", "projection@radau5"};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        const hn_method_spec spec = spec_of(methods[k], 1e-3);
        assert_true(isinf(hn_stability_predict(path, &spec, 1000).limit));
        const hn_stability_trial t = try(path, methods[k], 10 * limit);
        if (!hn_stability_is_stable(t.kind)) {
            fail_msg("%s: %s", methods[k], t.reason);
        }
    }
    hn_stability_path_free(path);
    hn_model_close(&m);
}

static void an_integrator_without_a_region_gets_no_prediction_but_a_reason(void **state) {
    (void)state;
    static const char *const methods[] = {"index3@genalpha", "index2@hem4", "penalty@rk4",
                                          "baumgarte:rule=auto@rk4"};
    hn_model m;
    hn_stability_path *path = open_path(&m, "fb0", NULL, 1);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        const hn_method_spec spec = spec_of(methods[k], 1e-3);
        const hn_stability_forecast f = hn_stability_predict(path, &spec, 1000);
        assert_true(isnan(f.limit));
        assert_non_null(f.why);
    }
    hn_stability_path_free(path);
    hn_model_close(&m);
}

// fb0 has no stiffness: alpha h alone decides, and 2.785 is the limit of Runge-Kutta 4
static void baumgartes_roots_limit_the_step_where_the_mechanism_does_not(void **state) {
    (void)state;
    hn_model m;
    hn_stability_path *path = open_path(&m, "fb0", NULL, 1);
    const char *const method = "baumgarte:alpha=1600,beta=1600@rk4";
    const hn_method_spec spec = spec_of(method, 1e-3);
    const double limit = hn_stability_predict(path, &spec, 1000).limit;
    assert_rel(limit, 2.785293563405282 / 1600, 1e-9);
    assert_true(hn_stability_is_stable(try(path, method, 0.95 * limit).kind));
    const hn_stability_trial beyond = try(path, method, 1.05 * limit);
    assert_true(beyond.kind == HN_STABILITY_GREW || beyond.kind == HN_STABILITY_STOPPED);
    hn_stability_path_free(path);
    hn_model_close(&m);
}

static void classes_tell_accurate_inaccurate_and_refused_apart(void **state) {
    (void)state;
    hn_model m;
    hn_stability_path *path = open_path(&m, "fb0", NULL, 2);
    const hn_stability_trial fine = try(path, "projection@rk4", 1e-3),
                             coarse = try(path, "projection@implicit-euler", 0.02),
                             grown = try(path, "projection@euler", 0.05);
    assert_int_equal(fine.kind, HN_STABILITY_FINE);
    assert_true(fine.error < 1e-6);
    assert_int_equal(coarse.kind, HN_STABILITY_INACCURATE);
    assert_true(coarse.error > HN_STABILITY_ACCURATE);
    assert_false(grown.kind == HN_STABILITY_FINE);
    hn_stability_path_free(path);
    hn_model_close(&m);

    path = open_path(&m, "fb0-redundant", NULL, 0.5);
    const hn_stability_trial refused = try(path, "index1:solver=ldl@rk4", 1e-3);
    assert_true(refused.kind == HN_STABILITY_REFUSED || refused.kind == HN_STABILITY_STOPPED);
    assert_true(strlen(refused.reason) > 10);
    hn_stability_path_free(path);
    hn_model_close(&m);
}

static int always(void *user) {
    (void)user;
    return 1;
}

static void a_trial_that_is_stopped_is_pending_and_one_out_of_time_says_so(void **state) {
    (void)state;
    hn_model m;
    hn_stability_path *path = open_path(&m, "fb0", NULL, 1);
    const hn_method_spec spec = spec_of("projection@rk4", 1e-5);
    const hn_walk_limits stop = {0, always, NULL}, brief = {1e-4, NULL, NULL};
    hn_stability_trial t;
    assert_int_equal(hn_stability_try(path, &spec, &stop, &t), 0);
    assert_int_equal(t.kind, HN_STABILITY_PENDING);
    assert_int_equal(hn_stability_try(path, &spec, &brief, &t), 1);
    assert_int_equal(t.kind, HN_STABILITY_SKIPPED);
    assert_non_null(strstr(t.reason, "computing time"));
    hn_stability_path_free(path);

    hn_diag diag = {0};
    assert_int_equal(hn_stability_path_create(m.sys, m.q, m.v, 1e3, &brief, &path, &diag),
                     HN_ERR_STOPPED);
    assert_null(path);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_is_stable_at_95_percent_of_the_predicted_limit_and_not_at_105),
        cmocka_unit_test(implicit_steps_stay_stable_far_beyond_where_explicit_ones_end),
        cmocka_unit_test(an_integrator_without_a_region_gets_no_prediction_but_a_reason),
        cmocka_unit_test(baumgartes_roots_limit_the_step_where_the_mechanism_does_not),
        cmocka_unit_test(classes_tell_accurate_inaccurate_and_refused_apart),
        cmocka_unit_test(a_trial_that_is_stopped_is_pending_and_one_out_of_time_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
