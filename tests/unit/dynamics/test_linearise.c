// SPDX-License-Identifier: GPL-3.0-or-later
// Exact derivatives of the equations of motion against differences along the motions of the
// coordinates.
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/linearise.h"

#include "linalg/dense.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX = 40, ALL = (1 << HN_LINEAR_COUNT) - 1 };

static const char *const scenes[] = {
    "fb0",     "fb0-lagrangian",       "fb0-redundant", "fb0-tilted",    "andrews",
    "caraxis", "spatial-slider-crank", "heavy-top",     "spinning-block"};
enum { N_SCENES = sizeof scenes / sizeof scenes[0] };

typedef struct bench {
    hn_model model;
    hn_eval *eval;
    hn_linear *linear;
    int nv, nc;
    double t, q[MAX], v[MAX], a[MAX], lambda[MAX];
} bench;

static double next_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1 << 23) - 1;
}

// any state will do: derivatives hold off the constraints too
static void open_bench(bench *b, const char *scene) {
    unsigned seed = 7;
    hn_model_begin(&b->model, scene, NULL);
    b->nv = b->model.info.nv;
    b->nc = b->model.info.nc;
    assert_in_range(b->nv, 1, MAX);
    assert_in_range(b->nc, 0, MAX);
    assert_in_range(b->model.info.nq, 1, MAX);
    assert_int_equal(hn_eval_create(b->model.sys,
                                    HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_PHI_T |
                                        HN_TERM_J | HN_TERM_GAMMA,
                                    b->model.arena, &b->eval),
                     HN_OK);
    assert_int_equal(hn_linear_create(b->model.sys, ALL, b->model.arena, &b->linear), HN_OK);
    b->t = 0.3;
    memcpy(b->q, b->model.q, (size_t)b->model.info.nq * sizeof *b->q);
    double move[MAX];
    for (int i = 0; i < b->nv; i++) {
        move[i] = 0.2 * next_random(&seed);
        b->v[i] = 2 * next_random(&seed);
        b->a[i] = 3 * next_random(&seed);
    }
    for (int i = 0; i < b->nc; i++) {
        b->lambda[i] = 5 * next_random(&seed);
    }
    hn_system_move(b->model.sys, b->q, move);
}

static void close_bench(bench *b) {
    hn_eval_free(b->eval);
    hn_linear_free(b->linear);
    hn_model_close(&b->model);
}

typedef struct terms {
    double residual[MAX], f[MAX], phi[MAX], speed_gap[MAX], gamma[MAX];
} terms;

static void calc_terms(bench *b, const double *q, const double *v, terms *out) {
    double forces[MAX];
    hn_eval_run(b->eval, b->t, q, v);
    hn_mat_vec(b->nv, b->nv, hn_eval_get(b->eval, HN_TERM_M), b->a, out->residual);
    hn_mat_t_vec(b->nc, b->nv, hn_eval_get(b->eval, HN_TERM_J), b->lambda, forces);
    memcpy(out->f, hn_eval_get(b->eval, HN_TERM_F), (size_t)b->nv * sizeof(double));
    for (int i = 0; i < b->nv; i++) {
        out->residual[i] -= out->f[i] + forces[i];
    }
    memcpy(out->phi, hn_eval_get(b->eval, HN_TERM_PHI), (size_t)b->nc * sizeof(double));
    memcpy(out->gamma, hn_eval_get(b->eval, HN_TERM_GAMMA), (size_t)b->nc * sizeof(double));
    hn_mat_vec(b->nc, b->nv, hn_eval_get(b->eval, HN_TERM_J), v, out->speed_gap);
    hn_axpy(b->nc, 1, hn_eval_get(b->eval, HN_TERM_PHI_T), out->speed_gap);
}

static void run_linear(bench *b) {
    hn_linear_run(b->linear, b->t, b->q, b->v, b->a, b->lambda);
}

// column j of `term` against (plus - minus) / 2 e; rounding of a difference is eps / e of the
// largest value
static void check_column(bench *b, hn_linear_term term, int j, int rows, const double *plus,
                         const double *minus, double e, const char *scene) {
    const double *matrix = hn_linear_get(b->linear, term);
    double size = 1;
    for (int i = 0; i < rows; i++) {
        size = fmax(size, fmax(fabs(plus[i]), fabs(matrix[i * b->nv + j])));
    }
    for (int i = 0; i < rows; i++) {
        const double difference = (plus[i] - minus[i]) / (2 * e);
        if (!(fabs(difference - matrix[i * b->nv + j]) <= 3e-8 * size)) {
            fail_msg("%s: term %d entry %d, %d is %.12g, by differences %.12g", scene, (int)term, i,
                     j, matrix[i * b->nv + j], difference);
        }
    }
}

static void derivatives_by_position_are_those_of_motions_along_the_speeds(void **state) {
    (void)state;
    const double e = 1e-6;
    for (int s = 0; s < N_SCENES; s++) {
        bench b;
        open_bench(&b, scenes[s]);
        run_linear(&b);
        for (int j = 0; j < b.nv; j++) {
            terms at[2];
            for (int side = 0; side < 2; side++) {
                double q[MAX], delta[MAX] = {0};
                memcpy(q, b.q, sizeof q);
                delta[j] = side ? e : -e;
                hn_system_move(b.model.sys, q, delta);
                calc_terms(&b, q, b.v, &at[side]);
            }
            check_column(&b, HN_LINEAR_K, j, b.nv, at[1].residual, at[0].residual, e, scenes[s]);
            check_column(&b, HN_LINEAR_V, j, b.nc, at[1].speed_gap, at[0].speed_gap, e, scenes[s]);
            check_column(&b, HN_LINEAR_GAMMA_Q, j, b.nc, at[1].gamma, at[0].gamma, e, scenes[s]);
            check_column(&b, HN_LINEAR_J, j, b.nc, at[1].phi, at[0].phi, e, scenes[s]);
        }
        close_bench(&b);
    }
}

static void derivatives_by_speed_are_those_of_changed_speeds(void **state) {
    (void)state;
    const double e = 1e-5;
    for (int s = 0; s < N_SCENES; s++) {
        bench b;
        open_bench(&b, scenes[s]);
        run_linear(&b);
        for (int j = 0; j < b.nv; j++) {
            terms at[2];
            for (int side = 0; side < 2; side++) {
                double v[MAX];
                memcpy(v, b.v, sizeof v);
                v[j] += side ? e : -e;
                calc_terms(&b, b.q, v, &at[side]);
            }
            check_column(&b, HN_LINEAR_C, j, b.nv, at[1].residual, at[0].residual, e, scenes[s]);
            check_column(&b, HN_LINEAR_GAMMA_V, j, b.nc, at[1].gamma, at[0].gamma, e, scenes[s]);
            check_column(&b, HN_LINEAR_J, j, b.nc, at[1].speed_gap, at[0].speed_gap, e, scenes[s]);
        }
        close_bench(&b);
    }
}

static void values_are_those_of_the_evaluator(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        bench b;
        terms at;
        open_bench(&b, scenes[s]);
        run_linear(&b);
        calc_terms(&b, b.q, b.v, &at);
        const double tol = 1e-13 * fmax(1, hn_norm_max(b.nv, at.f));
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_RESIDUAL), at.residual, (size_t)b.nv,
                        100 * tol);
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_F), at.f, (size_t)b.nv, tol);
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_PHI), at.phi, (size_t)b.nc, 1e-13);
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_SPEED_GAP), at.speed_gap, (size_t)b.nc,
                        1e-12);
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_GAMMA), at.gamma, (size_t)b.nc, 1e-11);
        assert_all_near(hn_linear_get(b.linear, HN_LINEAR_M), hn_eval_get(b.eval, HN_TERM_M),
                        (size_t)(b.nv * b.nv), 1e-13);
        close_bench(&b);
    }
}

// loops that do not move in time: gamma = (J v)_q v, of second degree in v
static void gamma_of_a_fixed_loop_is_its_speed_derivative_along_the_motion(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        bench b;
        double product[MAX];
        open_bench(&b, scenes[s]);
        run_linear(&b);
        if (!b.model.info.has_time) {
            const double *gamma = hn_linear_get(b.linear, HN_LINEAR_GAMMA);
            const double tol = 1e-12 * fmax(1, hn_norm_max(b.nc, gamma));
            hn_mat_vec(b.nc, b.nv, hn_linear_get(b.linear, HN_LINEAR_V), b.v, product);
            assert_all_near(product, gamma, (size_t)b.nc, tol);
            hn_mat_vec(b.nc, b.nv, hn_linear_get(b.linear, HN_LINEAR_GAMMA_V), b.v, product);
            for (int i = 0; i < b.nc; i++) {
                product[i] /= 2;
            }
            assert_all_near(product, gamma, (size_t)b.nc, tol);
        }
        close_bench(&b);
    }
}

// at rest and without acceleration K is the second derivative of the potential minus lambda' phi
static void stiffness_at_rest_of_a_conservative_scene_is_symmetric(void **state) {
    (void)state;
    static const char *const conservative[] = {"fb0", "fb0-lagrangian", "fb0-tilted"};
    for (int s = 0; s < 3; s++) {
        bench b;
        open_bench(&b, conservative[s]);
        hn_linear_run(b.linear, b.t, b.q, NULL, NULL, b.lambda);
        const double *K = hn_linear_get(b.linear, HN_LINEAR_K);
        assert_true(hn_norm_max(b.nv * b.nv, K) > 1);
        for (int i = 0; i < b.nv; i++) {
            for (int j = 0; j < i; j++) {
                assert_near(K[i * b.nv + j], K[j * b.nv + i], 1e-12);
            }
        }
        assert_near(hn_norm_max(b.nv * b.nv, hn_linear_get(b.linear, HN_LINEAR_C)), 0, 1e-14);
        close_bench(&b);
    }
}

static void a_pattern_covers_every_entry_that_is_not_zero(void **state) {
    (void)state;
    bench b;
    open_bench(&b, "andrews");
    run_linear(&b);
    const int *rows, *cols;
    double rest[MAX * MAX];
    const int n = hn_linear_pattern(b.linear, HN_LINEAR_K, &rows, &cols);
    memcpy(rest, hn_linear_get(b.linear, HN_LINEAR_K), (size_t)(b.nv * b.nv) * sizeof *rest);
    assert_true(n < b.nv * b.nv);
    for (int k = 0; k < n; k++) {
        rest[rows[k] * b.nv + cols[k]] = 0;
    }
    assert_near(hn_norm_max(b.nv * b.nv, rest), 0, 0);
    close_bench(&b);
}

static void a_run_allocates_nothing_and_is_counted(void **state) {
    (void)state;
    bench b;
    open_bench(&b, "fb0");
    const long before = hn_alloc_count();
    run_linear(&b);
    run_linear(&b);
    assert_int_equal(hn_alloc_count(), before);
    assert_int_equal(hn_linear_count(b.linear), 2);
    assert_true(hn_linear_ops(b.linear) > 0);
    close_bench(&b);
}

// what an entry is does not depend on whether its matrix is a list
static void lists_hold_the_entries_of_whole_matrices(void **state) {
    (void)state;
    static const hn_linear_term matrices[] = {HN_LINEAR_M, HN_LINEAR_K, HN_LINEAR_C, HN_LINEAR_J,
                                              HN_LINEAR_V};
    for (int s = 0; s < N_SCENES; s++) {
        bench b;
        hn_linear *listed = NULL;
        open_bench(&b, scenes[s]);
        assert_int_equal(hn_linear_create_listed(b.model.sys, ALL, b.model.arena, &listed), HN_OK);
        hn_linear_run(b.linear, b.t, b.q, b.v, b.a, b.lambda);
        hn_linear_run(listed, b.t, b.q, b.v, b.a, b.lambda);
        for (size_t m = 0; m < sizeof matrices / sizeof matrices[0]; m++) {
            const int *rows, *cols, n = hn_linear_pattern(listed, matrices[m], &rows, &cols);
            const double *whole = hn_linear_get(b.linear, matrices[m]),
                         *list = hn_linear_list(listed, matrices[m]);
            double copied[MAX * MAX] = {0};
            hn_linear_copy_whole(listed, matrices[m], copied);
            for (int k = 0; k < n; k++) {
                const double here[] = {list[k], hn_linear_entry(listed, matrices[m], k),
                                       hn_linear_entry(b.linear, matrices[m], k),
                                       copied[rows[k] * b.nv + cols[k]]};
                for (size_t i = 0; i < sizeof here / sizeof *here; i++) {
                    assert_memory_equal(&here[i], &whole[rows[k] * b.nv + cols[k]], sizeof *here);
                }
            }
        }
        hn_linear_free(listed);
        close_bench(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_by_position_are_those_of_motions_along_the_speeds),
        cmocka_unit_test(derivatives_by_speed_are_those_of_changed_speeds),
        cmocka_unit_test(values_are_those_of_the_evaluator),
        cmocka_unit_test(gamma_of_a_fixed_loop_is_its_speed_derivative_along_the_motion),
        cmocka_unit_test(stiffness_at_rest_of_a_conservative_scene_is_symmetric),
        cmocka_unit_test(a_pattern_covers_every_entry_that_is_not_zero),
        cmocka_unit_test(lists_hold_the_entries_of_whole_matrices),
        cmocka_unit_test(a_run_allocates_nothing_and_is_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
