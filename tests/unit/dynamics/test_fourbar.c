// SPDX-License-Identifier: GPL-3.0-or-later
// The reference four-bar FB0 (uniform rods 1, 2, 1.8 m of 1, 2, 1.8 kg, ground 2.2 m): both kinds
// of scenes, other planes and doubled closures against its formulas written out, and its
// accelerations and multipliers against known numbers.
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "support/alloc.h"
#include "support/mechanism.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const char BODIES[] = "lessons/01-closed-loops/scenes/fb0.json";
static const char FORMULAS[] = "lessons/01-closed-loops/scenes/fb0-lagrangian.json";
static const char TILTED[] = "tests/scenes/fb0-tilted.json";
static const char REDUNDANT[] = "tests/scenes/fb0-redundant.json";

typedef struct fourbar {
    hn_scene *scene;
    hn_system *sys;
    hn_arena *arena;
} fourbar;

static fourbar open_fourbar(const char *path) {
    fourbar s = {.arena = hn_arena_create(0)};
    hn_diags diags = {0};
    assert_int_equal(hn_scene_load_file(path, NULL, 0, &s.scene, &diags), HN_OK);
    assert_int_equal(hn_system_compile(s.scene, NULL, &s.sys, &diags), HN_OK);
    assert_int_equal(hn_system_get_info(s.sys).nv, 3);
    return s;
}

static void close_fourbar(fourbar *s) {
    hn_system_free(s->sys);
    hn_arena_free(s->arena);
    hn_scene_free(s->scene);
}

/// The formulas of FB0 in absolute angles.
typedef struct by_hand {
    double M[9], f[3], phi[2], J[6], gamma[2];
} by_hand;

static by_hand formulas(const double *q, const double *w) {
    const double l[3] = {1, 2, 1.8}, m[3] = {1, 2, 1.8}, d = 2.2, g = 9.81,
                 k = m[1] * l[0] * l[1] / 2;
    double s12 = sin(q[0] - q[1]), c12 = cos(q[0] - q[1]);
    by_hand h = {.phi = {-d, 0}};
    h.M[0] = m[0] * l[0] * l[0] / 3 + m[1] * l[0] * l[0];
    h.M[1] = h.M[3] = k * c12;
    h.M[4] = m[1] * l[1] * l[1] / 3;
    h.M[8] = m[2] * l[2] * l[2] / 3;
    h.f[0] = -k * s12 * w[1] * w[1] - g * (m[0] / 2 + m[1]) * l[0] * cos(q[0]);
    h.f[1] = k * s12 * w[0] * w[0] - g * m[1] / 2 * l[1] * cos(q[1]);
    h.f[2] = -g * m[2] / 2 * l[2] * cos(q[2]);
    for (int i = 0; i < 3; i++) {
        double sign = i == 2 ? -1 : 1, c = sign * l[i] * cos(q[i]), s = sign * l[i] * sin(q[i]);
        h.phi[0] += c;
        h.phi[1] += s;
        h.J[i] = -s;
        h.J[3 + i] = c;
        h.gamma[0] -= c * w[i] * w[i];
        h.gamma[1] -= s * w[i] * w[i];
    }
    return h;
}

static void check_formulas(const char *path) {
    fourbar s = open_fourbar(path);
    hn_eval *e;
    unsigned seed = 7;
    assert_int_equal(hn_system_get_info(s.sys).nc, 2);
    assert_int_equal(hn_eval_create(s.sys,
                                    HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_J | HN_TERM_GAMMA,
                                    s.arena, &e),
                     HN_OK);
    for (int k = 0; k < 20; k++) {
        double q[3], v[3];
        for (int i = 0; i < 3; i++) {
            q[i] = 3 * random_signed(&seed);
            v[i] = 5 * random_signed(&seed);
        }
        hn_eval_run(e, 0, q, v);
        by_hand h = formulas(q, v);
        assert_all_near(hn_eval_get(e, HN_TERM_M), h.M, 9, 1e-13);
        assert_all_near(hn_eval_get(e, HN_TERM_F), h.f, 3,
                        1e-12); // terms up to 100: a dozen roundings
        assert_all_near(hn_eval_get(e, HN_TERM_PHI), h.phi, 2, 1e-13);
        assert_all_near(hn_eval_get(e, HN_TERM_J), h.J, 6, 1e-13);
        assert_all_near(hn_eval_get(e, HN_TERM_GAMMA), h.gamma, 2, 1e-13 * 50);
    }
    hn_eval_free(e);
    close_fourbar(&s);
}

static void terms_are_the_formulas_whatever_the_kind_of_scene_and_the_plane(void **state) {
    (void)state;
    check_formulas(BODIES);
    check_formulas(FORMULAS);
    check_formulas(TILTED);
}

// ---- accelerations and multipliers ----

/// The closed pose at t = 0, with consistent rates.
static void start_state(double *q, double *v) {
    const double angles[3] = {1, 0.498324904142577, 1.516841745037813};
    memcpy(q, angles, sizeof angles);
    by_hand h = formulas(q, (double[3]){0, 0, 0});
    double det = h.J[1] * h.J[5] - h.J[2] * h.J[4];
    v[0] = 2;
    v[1] = (-h.J[0] * 2 * h.J[5] + h.J[2] * h.J[3] * 2) / det;
    v[2] = (-h.J[1] * h.J[3] * 2 + h.J[4] * h.J[0] * 2) / det;
}

static hn_accel *open_accel(fourbar *s, bool baumgarte) {
    const hn_accel_opts opts = {.baumgarte = baumgarte, .want_lambda = 1};
    hn_accel *accel;
    assert_int_equal(hn_accel_create(s->sys, &opts, s->arena, &accel), HN_OK);
    return accel;
}

static void multipliers_at_the_start_are_the_known_ones(void **state) {
    (void)state;
    const char *const paths[3] = {BODIES, FORMULAS, TILTED};
    for (int k = 0; k < 3; k++) {
        fourbar s = open_fourbar(paths[k]);
        hn_accel *accel = open_accel(&s, 0);
        hn_accel_info info;
        double q[3], v[3], a[3], lambda[2];
        start_state(q, v);
        assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
        assert_int_equal(info.fallback, 0);
        assert_int_equal(info.rank, 2);
        assert_near(lambda[0], 0.921838074449043, 2e-14);
        assert_near(lambda[1], 6.630912100630129, 2e-14);
        by_hand h = formulas(q, v);
        for (int i = 0; i < 3; i++) { // M a = f + J' lambda
            double r = -h.f[i] - h.J[i] * lambda[0] - h.J[3 + i] * lambda[1];
            for (int j = 0; j < 3; j++) {
                r += h.M[3 * i + j] * a[j];
            }
            assert_near(r, 0, 1e-13);
        }
        hn_accel_free(accel);
        close_fourbar(&s);
    }
}

static void baumgarte_feeds_the_gap_back_with_its_gains(void **state) {
    (void)state;
    fourbar s = open_fourbar(BODIES);
    hn_accel *accel = open_accel(&s, 1);
    const double q[3] = {1, 0.5, 1.5}, v[3] = {2, -1, 0.3}, alpha = 3, beta = 7; // open on purpose
    double a[3], lambda[2];
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(accel, 0, q, v, alpha, beta, a, lambda, &info), HN_OK);
    assert_int_equal(info.fallback, 0);
    by_hand h = formulas(q, v);
    for (int k = 0; k < 2; k++) {
        double row = h.gamma[k] + beta * beta * h.phi[k];
        for (int j = 0; j < 3; j++) {
            row += h.J[3 * k + j] * (a[j] + 2 * alpha * v[j]);
        }
        assert_near(row, 0, 1e-13);
    }
    hn_accel_free(accel);
    close_fourbar(&s);
}

static void a_loop_closed_twice_moves_as_if_closed_once(void **state) {
    (void)state;
    fourbar once = open_fourbar(BODIES), twice = open_fourbar(REDUNDANT);
    for (int baumgarte = 0; baumgarte < 2; baumgarte++) {
        hn_accel *one = open_accel(&once, baumgarte), *two = open_accel(&twice, baumgarte);
        double q[3], v[3], a1[3], a2[3], l1[2], l2[4];
        hn_accel_info info;
        start_state(q, v);
        q[1] += 1e-6; // a small gap, so that the gains have something to do
        assert_int_equal(hn_accel_eval(one, 0, q, v, 2, 2, a1, l1, &info), HN_OK);
        assert_int_equal(info.fallback, 0);
        assert_int_equal(hn_accel_eval(two, 0, q, v, 2, 2, a2, l2, &info), HN_OK);
        assert_int_equal(info.fallback, 1);
        assert_int_equal(info.rank, 2);
        assert_int_equal(hn_accel_fallbacks(two), 1);
        assert_all_near(a2, a1, 3, 1e-12);
        for (int k = 0; k < 2; k++) { // least norm: shared equally
            assert_near(l2[k], l1[k] / 2, 1e-12);
            assert_near(l2[2 + k], l1[k] / 2, 1e-12);
        }
        hn_accel_free(one);
        hn_accel_free(two);
    }
    close_fourbar(&once);
    close_fourbar(&twice);
}

static void a_pose_where_the_rank_drops_goes_to_the_dense_solve(void **state) {
    (void)state;
    fourbar s = open_fourbar(BODIES);
    hn_accel *accel = open_accel(&s, 0);
    const double q[3] = {0, 0, 0},
                 v[3] = {0, 0, 0}; // all bars on one line: the x row has no coefficient
    double a[3], lambda[2];
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
    assert_int_equal(info.fallback, 1);
    assert_int_equal(info.rank, 1);
    assert_true(info.pivot_ratio < HN_PIVOT_GUARD);
    assert_near(a[0] + 2 * a[1] - 1.8 * a[2], 0, 1e-13); // the row that is left
    hn_accel_free(accel);
    close_fourbar(&s);
}

static void a_state_that_is_not_finite_is_refused_and_leaves_the_outputs(void **state) {
    (void)state;
    fourbar s = open_fourbar(BODIES);
    hn_accel *accel = open_accel(&s, 0);
    double q[3] = {1, (double)NAN, 1}, v[3] = {0, 0, 0}, a[3], lambda[2];
    hn_poison_fill(a, 3);
    hn_poison_fill(lambda, 2);
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_ERR_DIVERGED);
    assert_true(hn_poison_intact(a, 3) && hn_poison_intact(lambda, 2));
    hn_accel_free(accel);
    close_fourbar(&s);
}

static void the_whole_evaluation_stays_within_140_operations(void **state) {
    (void)state;
    fourbar bodies = open_fourbar(BODIES), formula = open_fourbar(FORMULAS),
            tilted = open_fourbar(TILTED);
    hn_accel *b = open_accel(&bodies, 0), *l = open_accel(&formula, 0), *t = open_accel(&tilted, 0);
    int ops = hn_accel_tape_info(b).ops;
    assert_true(ops <= 140);
    assert_true(ops <= 1.3 * hn_accel_tape_info(l).ops);
    assert_int_equal(hn_accel_tape_info(t).ops, ops); // the plane costs nothing
    hn_accel_free(b);
    hn_accel_free(l);
    hn_accel_free(t);
    close_fourbar(&bodies);
    close_fourbar(&formula);
    close_fourbar(&tilted);
}

// ---- the factor ----

static void the_factor_solves_as_the_tape_does(void **state) {
    (void)state;
    fourbar s = open_fourbar(BODIES);
    hn_accel *accel = open_accel(&s, 0);
    hn_factor *factor;
    double q[3], v[3], a[3], lambda[2], x[3], y[2], ratio;
    hn_accel_info info;
    start_state(q, v);
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
    assert_int_equal(hn_factor_create(s.sys, HN_FACTOR_MASS, s.arena, &factor), HN_OK);
    assert_int_equal(hn_factor_get_info(factor).available, 1);
    assert_int_equal(hn_factor_update(factor, 0, q, &ratio), HN_OK);
    by_hand h = formulas(q, v);
    double r2[2] = {-h.gamma[0], -h.gamma[1]};
    hn_factor_solve(factor, h.f, r2, x, y);
    assert_all_near(x, a, 3, 1e-13);
    assert_all_near(y, lambda, 2, 1e-13);
    hn_factor_free(factor);

    // least change in the plain norm: x = J' (J J')^-1 r2
    assert_int_equal(hn_factor_create(s.sys, HN_FACTOR_IDENTITY, s.arena, &factor), HN_OK);
    assert_int_equal(hn_factor_update(factor, 0, q, NULL), HN_OK);
    hn_factor_solve(factor, NULL, r2, x, y);
    for (int k = 0; k < 2; k++) {
        double row = 0;
        for (int j = 0; j < 3; j++) {
            row += h.J[3 * k + j] * x[j];
        }
        assert_near(row, r2[k], 1e-13);
    }
    for (int j = 0; j < 3; j++) {
        assert_near(x[j], h.J[j] * y[0] + h.J[3 + j] * y[1], 1e-13);
    }
    const double flat[3] = {0, 0, 0};
    assert_int_equal(hn_factor_update(factor, 0, flat, &ratio), HN_ERR_SINGULAR);
    hn_factor_free(factor);
    hn_accel_free(accel);
    close_fourbar(&s);
}

// ---- memory ----

static void an_evaluation_allocates_nothing_even_when_the_dense_solve_answers(void **state) {
    (void)state;
    fourbar s = open_fourbar(REDUNDANT), one = open_fourbar(BODIES);
    hn_accel *dense = open_accel(&s, 1), *tape = open_accel(&one, 1);
    hn_eval *e;
    hn_factor *factor;
    assert_int_equal(hn_eval_create(s.sys, (1u << HN_TERM_COUNT) - 1, s.arena, &e), HN_OK);
    assert_int_equal(hn_factor_create(one.sys, HN_FACTOR_MASS, one.arena, &factor), HN_OK);
    double q[3], v[3], a[3], lambda[4];
    start_state(q, v);
    long before = hn_alloc_count();
    for (int k = 0; k < 10; k++) {
        assert_int_equal(hn_accel_eval(dense, 0, q, v, 1, 1, a, lambda, NULL), HN_OK);
        assert_int_equal(hn_accel_eval(tape, 0, q, v, 1, 1, a, lambda, NULL), HN_OK);
        hn_eval_run(e, 0, q, v);
        assert_int_equal(hn_factor_update(factor, 0, q, NULL), HN_OK);
        hn_factor_solve(factor, NULL, lambda, a, lambda);
    }
    assert_int_equal(hn_alloc_count(), before);
    hn_eval_free(e);
    hn_factor_free(factor);
    hn_accel_free(dense);
    hn_accel_free(tape);
    close_fourbar(&s);
    close_fourbar(&one);
}

/// Compiles and makes evaluators; the status of the first that fails.
static hn_status make_all(const hn_scene *scene) {
    hn_system *sys = NULL;
    hn_eval *e = NULL;
    hn_accel *accel = NULL;
    hn_factor *factor = NULL;
    const hn_accel_opts opts = {.baumgarte = 1, .want_lambda = 1};
    hn_arena *arena = hn_arena_create(0);
    hn_status status = arena ? hn_system_compile(scene, NULL, &sys, NULL) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = hn_eval_create(sys, (1u << HN_TERM_COUNT) - 1, arena, &e);
    }
    if (status == HN_OK) {
        status = hn_accel_create(sys, &opts, arena, &accel);
    }
    if (status == HN_OK) {
        status = hn_factor_create(sys, HN_FACTOR_IDENTITY, arena, &factor);
    }
    hn_factor_free(factor);
    hn_accel_free(accel);
    hn_eval_free(e);
    hn_system_free(sys);
    hn_arena_free(arena);
    return status;
}

static void memory_that_runs_out_anywhere_is_told_and_leaves_nothing_behind(void **state) {
    (void)state;
    const char *const paths[2] = {BODIES, FORMULAS};
    for (int k = 0; k < 2; k++) {
        fourbar s = open_fourbar(paths[k]);
        long live = hn_alloc_live();
        int failures = 0;
        for (long n = 1;; n++) {
            hn_alloc_fail_at(n);
            hn_status status = make_all(s.scene);
            int failed = hn_alloc_has_failed();
            hn_alloc_fail_at(0);
            assert_int_equal(hn_alloc_live(), live);
            if (!failed) {
                assert_int_equal(status, HN_OK);
                break;
            }
            assert_int_equal(status, HN_ERR_MEMORY);
            failures++;
        }
        assert_true(failures > 20);
        close_fourbar(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(terms_are_the_formulas_whatever_the_kind_of_scene_and_the_plane),
        cmocka_unit_test(multipliers_at_the_start_are_the_known_ones),
        cmocka_unit_test(baumgarte_feeds_the_gap_back_with_its_gains),
        cmocka_unit_test(a_loop_closed_twice_moves_as_if_closed_once),
        cmocka_unit_test(a_pose_where_the_rank_drops_goes_to_the_dense_solve),
        cmocka_unit_test(a_state_that_is_not_finite_is_refused_and_leaves_the_outputs),
        cmocka_unit_test(the_whole_evaluation_stays_within_140_operations),
        cmocka_unit_test(the_factor_solves_as_the_tape_does),
        cmocka_unit_test(an_evaluation_allocates_nothing_even_when_the_dense_solve_answers),
        cmocka_unit_test(memory_that_runs_out_anywhere_is_told_and_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
