// SPDX-License-Identifier: GPL-3.0-or-later
// The dense saddle-point solve: redundancy, mass ratios, massless coordinates, contradictions,
// against quadruple precision.

#include "linalg/dense.h"
#include "linalg/saddle.h"
#include "support/alloc.h"
#include "support/near.h"

#include <float.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

enum { MAX_NV = 24, MAX_NC = 20, MAX_N = MAX_NV + MAX_NC };
static const double G = 9.81;

__extension__ typedef __float128 quad;

typedef struct problem {
    int nv, nc;
    double M[MAX_NV * MAX_NV], J[MAX_NC * MAX_NV], f[MAX_NV], gamma[MAX_NC];
} problem;

typedef struct fixture {
    hn_arena *arena;
    hn_saddle_ws *ws;
    gsl_rng *rng;
    problem p;
    double a[MAX_NV], lambda[MAX_NC];
    hn_saddle_info info;
} fixture;

static int setup(void **state) {
    static fixture f;
    memset(&f, 0, sizeof f);
    f.arena = hn_arena_create(0);
    f.ws = hn_saddle_ws_create(f.arena, MAX_NV, MAX_NC);
    f.rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(f.rng, 11);
    hn_poison_fill(f.a, MAX_NV);
    hn_poison_fill(f.lambda, MAX_NC);
    *state = &f;
    return f.ws ? 0 : -1;
}

static int teardown(void **state) {
    fixture *f = *state;
    gsl_rng_free(f->rng);
    hn_arena_free(f->arena);
    return 0;
}

static hn_status solve(fixture *f, const hn_saddle_opts *opts) {
    const problem *p = &f->p;
    return hn_saddle_solve(p->nv, p->nc, p->M, p->J, p->f, p->gamma, f->a, f->lambda, &f->info,
                           opts, f->ws);
}

static double random_unit(fixture *f) {
    return 2 * gsl_rng_uniform(f->rng) - 1;
}

/// Gauss elimination with row pivoting in quadruple precision on the full symmetric system.
static void solve_quad(const problem *p, double *a, double *lambda) {
    static quad K[MAX_N][MAX_N + 1];
    int nv = p->nv, n = p->nv + p->nc;
    memset(K, 0, sizeof K);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            K[i][j] = (quad)(i >= j ? p->M[i * nv + j] : p->M[j * nv + i]);
        }
        K[i][n] = (quad)p->f[i];
    }
    for (int i = 0; i < p->nc; i++) {
        for (int j = 0; j < nv; j++) {
            K[nv + i][j] = K[j][nv + i] = (quad)p->J[i * nv + j];
        }
        K[nv + i][n] = -(quad)p->gamma[i];
    }
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            quad x = K[i][k] < 0 ? -K[i][k] : K[i][k],
                 y = K[best][k] < 0 ? -K[best][k] : K[best][k];
            best = x > y ? i : best;
        }
        for (int j = 0; j <= n; j++) {
            quad keep = K[k][j];
            K[k][j] = K[best][j];
            K[best][j] = keep;
        }
        for (int i = 0; i < n; i++) {
            quad factor = i == k ? 0 : K[i][k] / K[k][k];
            for (int j = k; j <= n; j++) {
                K[i][j] -= factor * K[k][j];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        double x = (double)(K[i][n] / K[i][i]);
        *(i < nv ? a + i : lambda + (i - nv)) = i < nv ? x : -x;
    }
}

/// The four-bar with links 1, 2, 1.8 on a 2.2 m ground at th1 = 1, w1 = 2, with a coupler of mass
/// m2.
static void make_four_bar(problem *p, double m2) {
    const double l1 = 1, l2 = 2, l3 = 1.8, m1 = 1, m3 = 1.8;
    const double th1 = 1, th2 = 0.498324904142577, th3 = 1.516841745037813, w1 = 2;
    double k = m2 * l1 * l2 / 2, c12 = cos(th1 - th2), s12 = sin(th1 - th2);
    // rates from the closure: w2, w3 by Cramer's rule
    double det = l2 * l3 * sin(th2 - th3);
    double w2 = -l1 * l3 * sin(th1 - th3) * w1 / det, w3 = -l1 * l2 * sin(th1 - th2) * w1 / det;
    *p = (problem){.nv = 3,
                   .nc = 2,
                   .M = {m1 * l1 * l1 / 3 + m2 * l1 * l1, k * c12, 0, k * c12, m2 * l2 * l2 / 3, 0,
                         0, 0, m3 * l3 * l3 / 3},
                   .J = {-l1 * sin(th1), -l2 * sin(th2), l3 * sin(th3), l1 * cos(th1),
                         l2 * cos(th2), -l3 * cos(th3)},
                   .f = {-k * s12 * w2 * w2 - G * (m1 / 2 + m2) * l1 * cos(th1),
                         k * s12 * w1 * w1 - G * m2 / 2 * l2 * cos(th2),
                         -G * m3 / 2 * l3 * cos(th3)}};
    const double th[3] = {th1, th2, th3}, l[3] = {l1, l2, -l3}, w[3] = {w1, w2, w3};
    for (int i = 0; i < 3; i++) {
        p->gamma[0] -= l[i] * cos(th[i]) * w[i] * w[i];
        p->gamma[1] -= l[i] * sin(th[i]) * w[i] * w[i];
    }
}

/// Bars of length 1 hanging as a zigzag of point masses in x, y; the tip weighs `tip`.
static void make_chain(problem *p, int links, double tip) {
    *p = (problem){.nv = 2 * links, .nc = links};
    for (int i = 0; i < links; i++) {
        double angle = 0.3 + 0.7 * i, ex = cos(angle), ey = sin(angle),
               mass = i == links - 1 ? tip : 1;
        p->M[(2 * i) * p->nv + 2 * i] = p->M[(2 * i + 1) * p->nv + 2 * i + 1] = mass;
        p->f[2 * i + 1] = -G * mass;
        double *row = p->J + i * p->nv;
        row[2 * i] = ex;
        row[2 * i + 1] = ey;
        if (i > 0) {
            row[2 * i - 2] = -ex;
            row[2 * i - 1] = -ey;
        }
        p->gamma[i] = 0.5 + 0.1 * i;
    }
}

static void hanging_bob_with_duplicated_rod_row_has_rank_one(void **state) {
    fixture *f = *state;
    // a 2 kg bob hangs at rest, its rod row written twice: the weight is carried, half by each row
    f->p = (problem){.nv = 2, .nc = 2, .M = {2, 0, 0, 2}, .J = {0, -1, 0, -1}, .f = {0, -2 * G}};
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_int_equal(f->info.rank, 1);
    assert_near(-(f->lambda[0] + f->lambda[1]), 2 * G, 1e-13);
    assert_near(f->lambda[0], f->lambda[1], 1e-13);
    assert_near(hn_norm_max(2, f->a), 0, 1e-14);
}

static void least_norm_holds_in_the_given_row_units(void **state) {
    fixture *f = *state;
    // the same row in metres and in centimetres: lambda must be parallel to (1, 100)
    f->p = (problem){.nv = 2, .nc = 2, .M = {2, 0, 0, 2}, .J = {0, -1, 0, -100}, .f = {0, -2 * G}};
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_near(f->lambda[0] + 100 * f->lambda[1], -2 * G, 1e-13);
    assert_near(f->lambda[1], 100 * f->lambda[0], 1e-13);
}

static void four_bar_multipliers_are_the_published_ones(void **state) {
    fixture *f = *state;
    make_four_bar(&f->p, 2);
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_near(f->lambda[0], 0.921838074449043, 2e-14);
    assert_near(f->lambda[1], 6.630912100630129, 2e-14);
    assert_int_equal(f->info.rank, 2);
    assert_true(f->info.pivot_ratio > 0.1 && f->info.pivot_ratio <= 1);
}

static void duplicated_and_summed_rows_leave_accelerations_and_forces_alone(void **state) {
    fixture *f = *state;
    make_four_bar(&f->p, 2);
    double a[3], lambda[2], force[3], redundant_force[3];
    solve_quad(&f->p, a, lambda);
    hn_mat_t_vec(2, 3, f->p.J, lambda, force);

    problem *p = &f->p;
    p->nc = 4;
    for (int j = 0; j < 3; j++) {
        p->J[6 + j] = p->J[j];
        p->J[9 + j] = p->J[j] + p->J[3 + j];
    }
    p->gamma[2] = p->gamma[0];
    p->gamma[3] = p->gamma[0] + p->gamma[1];
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_int_equal(f->info.rank, 2);
    assert_all_near(f->a, a, 3, 1e-13);
    hn_mat_t_vec(4, 3, p->J, f->lambda, redundant_force);
    assert_all_near(redundant_force, force, 3, 1e-13);

    // least norm: orthogonal to the two combinations of rows that make no force
    assert_near(f->lambda[0] - f->lambda[2], 0, 1e-13);
    assert_near(f->lambda[0] + f->lambda[1] - f->lambda[3], 0, 1e-13);
}

static void every_mass_ratio_is_solved_to_thirteen_digits(void **state) {
    fixture *f = *state;
    for (int power = -8; power <= 8; power += 2) {
        for (int which = 0; which < 2; which++) {
            double a[MAX_NV], lambda[MAX_NC];
            if (which == 0) {
                make_four_bar(&f->p, pow(10, power));
            } else {
                make_chain(&f->p, 10, pow(10, power));
            }
            solve_quad(&f->p, a, lambda);
            assert_int_equal(solve(f, NULL), HN_OK);
            assert_int_equal(f->info.rank, f->p.nc);
            assert_all_near(f->a, a, f->p.nv, 1e-13 * hn_norm_max(f->p.nv, a));
            assert_all_near(f->lambda, lambda, f->p.nc, 1e-13 * hn_norm_max(f->p.nc, lambda));
        }
    }
}

/// An open chain of rods in absolute angles, its tip held in x, with a heavy point mass at the tip:
/// M is nearly of rank two.
static void make_heavy_tip(problem *p, int links, double tip) {
    *p = (problem){.nv = links, .nc = 1, .gamma = {0.7}};
    for (int i = 0; i < links; i++) {
        for (int j = 0; j <= i; j++) {
            double beyond = links - i - 1 + (i == j ? 1 / 3.0 : 0.5);
            p->M[i * links + j] = (beyond + tip) * cos(0.4 * (i - j));
        }
        p->J[i] = -sin(0.4 * i + 0.2);
        p->f[i] = -G * (links - i - 0.5 + tip) * cos(0.4 * i + 0.2);
    }
}

static void refinement_repairs_what_one_solve_loses(void **state) {
    fixture *f = *state;
    double a[MAX_NV], lambda[MAX_NC], worst[2] = {0, 0};
    make_heavy_tip(&f->p, 6, 1e8);
    solve_quad(&f->p, a, lambda);
    for (int refined = 0; refined < 2; refined++) {
        hn_saddle_opts opts = hn_saddle_opts_default();
        opts.max_refine = refined ? opts.max_refine : 0;
        assert_int_equal(solve(f, &opts), HN_OK);
        for (int i = 0; i < f->p.nv; i++) {
            worst[refined] = fmax(worst[refined], fabs(f->a[i] - a[i]) / hn_norm_max(f->p.nv, a));
        }
    }
    assert_true(worst[0] > 1e-11); // light directions drown in heavy ones
    assert_true(worst[1] < 1e-14);
}

static void massless_rocker_is_solved_as_if_its_mass_went_to_zero(void **state) {
    fixture *f = *state;
    make_four_bar(&f->p, 2);
    f->p.M[8] = 0;
    f->p.f[2] = 0;
    double a[3], lambda[2];
    solve_quad(&f->p, a, lambda);
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_all_near(f->a, a, 3, 1e-13);
    assert_all_near(f->lambda, lambda, 2, 1e-13);
}

static void mass_that_vanishes_on_a_free_direction_is_singular(void **state) {
    fixture *f = *state;
    // the constraint holds x, nothing holds the massless y
    f->p = (problem){.nv = 2, .nc = 1, .M = {1, 0, 0, 0}, .J = {1, 0}, .f = {1, 1}};
    assert_int_equal(solve(f, NULL), HN_ERR_SINGULAR);
    assert_true(hn_poison_intact(f->a, 2) && hn_poison_intact(f->lambda, 1));
}

static void negative_mass_is_told(void **state) {
    fixture *f = *state;
    f->p = (problem){.nv = 2, .nc = 1, .M = {1, 0, 0, -1}, .J = {1, 0}, .f = {1, 1}};
    assert_int_equal(solve(f, NULL), HN_ERR_NOT_SPD);
    f->p = (problem){.nv = 2, .nc = 0, .M = {1, 0, 2, 1}, .f = {1, 1}};
    assert_int_equal(solve(f, NULL), HN_ERR_NOT_SPD);
    assert_true(hn_poison_intact(f->a, 2) && hn_poison_intact(f->lambda, 1));
}

static void rows_that_contradict_each_other_are_refused_or_met_by_least_squares(void **state) {
    fixture *f = *state;
    f->p = (problem){
        .nv = 2, .nc = 2, .M = {2, 0, 0, 2}, .J = {0, 1, 0, 1}, .f = {0, 0}, .gamma = {-1, -2}};
    assert_int_equal(solve(f, NULL), HN_ERR_INCONSISTENT);
    assert_true(hn_poison_intact(f->a, 2) && hn_poison_intact(f->lambda, 2));

    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.residual_tol = HUGE_VAL;
    assert_int_equal(solve(f, &opts), HN_OK);
    assert_near(f->a[1], 1.5, 1e-14);
    assert_near(f->info.residual, 0.5, 1e-14);
}

static void rounding_in_a_redundant_row_is_no_contradiction(void **state) {
    fixture *f = *state;
    make_four_bar(&f->p, 2);
    f->p.nc = 3;
    for (int j = 0; j < 3; j++) {
        f->p.J[6 + j] = f->p.J[j] * (1 + 4e-13);
    }
    f->p.gamma[2] = f->p.gamma[0] * (1 - 4e-13);
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_int_equal(f->info.rank, 2);
    assert_true(f->info.dropped < 1e-11);
}

static void a_short_row_of_noise_is_kept_short_by_a_floor(void **state) {
    fixture *f = *state;
    // the second row should be 0 = 0; noise of 1e-7 makes it a row of its own once it is stretched
    f->p = (problem){.nv = 2,
                     .nc = 2,
                     .M = {1, 0, 0, 1},
                     .J = {1, 0, 0, 1e-7},
                     .f = {0, 5},
                     .gamma = {-2, 1e-7}};
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_int_equal(f->info.rank, 2);
    assert_near(f->a[1], -1, 1e-13);
    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.row_floor = 0.05;
    opts.rank_tol = opts.residual_tol = 1e-5;
    assert_int_equal(solve(f, &opts), HN_OK);
    assert_int_equal(f->info.rank, 1);
    assert_near(f->a[0], 2, 1e-13);
    assert_near(f->a[1], 5, 1e-6);
}

static void a_disagreement_that_the_error_of_the_state_explains_is_no_contradiction(void **state) {
    fixture *f = *state;
    hn_saddle_opts opts = hn_saddle_opts_default();
    // the second row is the first, 20 times shorter, and asks for 1 + 2e-5 in place of 1
    f->p = (problem){.nv = 2,
                     .nc = 2,
                     .M = {1, 0, 0, 1},
                     .J = {1, 0, 0.05, 0},
                     .f = {0, 5},
                     .gamma = {-1, -0.05 * (1 + 2e-5)}};
    assert_int_equal(solve(f, &opts), HN_ERR_INCONSISTENT);
    opts.noise = 2e-6; // stretched 20 times
    assert_int_equal(solve(f, &opts), HN_OK);
    assert_int_equal(f->info.rank, 1);
    assert_near(f->a[0], 1, 2e-5);
    f->p.gamma[1] = -0.05 * (1 + 2e-3);
    assert_int_equal(solve(f, &opts), HN_ERR_INCONSISTENT);

    // where all accelerations vanish, those that the velocities could make are the measure
    opts.noise = 2e-6;
    f->p.f[1] = 0;
    f->p.gamma[0] = 0;
    f->p.gamma[1] = -0.05 * 2e-5;
    assert_int_equal(solve(f, &opts), HN_ERR_INCONSISTENT);
    opts.motion = 1;
    assert_int_equal(solve(f, &opts), HN_OK);
}

static void a_row_of_zeros_needs_a_gamma_of_zero(void **state) {
    fixture *f = *state;
    f->p = (problem){.nv = 1, .nc = 2, .M = {1}, .J = {0, 1}, .f = {3}, .gamma = {0, -4}};
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_near(f->a[0], 4, 1e-14);
    assert_near(f->lambda[0], 0, 0);
    assert_near(f->lambda[1], 1, 1e-14);
    f->p.gamma[0] = 1;
    assert_int_equal(solve(f, NULL), HN_ERR_INCONSISTENT);
}

static void without_constraints_it_is_newtons_law(void **state) {
    fixture *f = *state;
    f->p = (problem){.nv = 2, .nc = 0, .M = {2, 0, 1, 3}, .f = {4, 7}};
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_all_near(f->a, ((double[]){1, 2}), 2, 1e-14);
    assert_int_equal(f->info.rank, 0);
}

static void inputs_that_are_not_finite_leave_the_outputs_alone(void **state) {
    fixture *f = *state;
    make_four_bar(&f->p, 2);
    double *spots[] = {&f->p.M[3], &f->p.J[4], &f->p.f[1], &f->p.gamma[0]};
    const double values[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            double keep = *spots[i];
            *spots[i] = values[k];
            assert_int_equal(solve(f, NULL), HN_ERR_DIVERGED);
            *spots[i] = keep;
        }
    }
    assert_true(hn_poison_intact(f->a, MAX_NV) && hn_poison_intact(f->lambda, MAX_NC));
    f->p.M[1] = (double)NAN; // above the diagonal: not read
    assert_int_equal(solve(f, NULL), HN_OK);
}

static void make_random(fixture *f, int nv, int nc) {
    problem *p = &f->p;
    *p = (problem){.nv = nv, .nc = nc};
    double L[MAX_NV * MAX_NV] = {0};
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < i; j++) {
            L[i * nv + j] = random_unit(f);
        }
        L[i * nv + i] = 1 + gsl_rng_uniform(f->rng);
        p->f[i] = random_unit(f);
    }
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            p->M[i * nv + j] = hn_dot(nv, L + i * nv, L + j * nv);
        }
    }
    for (int i = 0; i < nc; i++) {
        p->gamma[i] = random_unit(f);
        for (int j = 0; j < nv; j++) {
            p->J[i * nv + j] = random_unit(f);
        }
    }
}

static void random_systems_agree_with_lu(void **state) {
    fixture *f = *state;
    for (int trial = 0; trial < 200; trial++) {
        int nv = 1 + (int)gsl_rng_uniform_int(f->rng, MAX_NV),
            nc = (int)gsl_rng_uniform_int(f->rng, nv + 1);
        nc = nc > MAX_NC ? MAX_NC : nc;
        make_random(f, nv, nc);
        size_t n = (size_t)(nv + nc);
        gsl_matrix *K = gsl_matrix_calloc(n, n);
        gsl_vector *b = gsl_vector_alloc(n), *x = gsl_vector_alloc(n);
        for (int i = 0; i < nv; i++) {
            for (int j = 0; j < nv; j++) {
                gsl_matrix_set(K, i, j, f->p.M[i * nv + j]);
            }
            for (int k = 0; k < nc; k++) {
                gsl_matrix_set(K, i, nv + k, f->p.J[k * nv + i]);
                gsl_matrix_set(K, nv + k, i, f->p.J[k * nv + i]);
            }
            gsl_vector_set(b, i, f->p.f[i]);
        }
        for (int k = 0; k < nc; k++) {
            gsl_vector_set(b, nv + k, -f->p.gamma[k]);
        }
        int sign;
        gsl_permutation *perm = gsl_permutation_alloc(n);
        gsl_linalg_LU_decomp(K, perm, &sign);
        gsl_linalg_LU_solve(K, perm, b, x);

        assert_int_equal(solve(f, NULL), HN_OK);
        double size = 0;
        for (size_t i = 0; i < n; i++) {
            size = fmax(size, fabs(gsl_vector_get(x, i)));
        }
        for (int i = 0; i < nv; i++) {
            assert_near(f->a[i], gsl_vector_get(x, i), 1e-9 * size);
        }
        for (int k = 0; k < nc; k++) {
            assert_near(f->lambda[k], -gsl_vector_get(x, nv + k), 1e-9 * size);
        }
        gsl_permutation_free(perm);
        gsl_matrix_free(K);
        gsl_vector_free(b);
        gsl_vector_free(x);
    }
}

enum { CHAIN_NV = 121, CHAIN_NC = 80 };

// Masses coupled to their neighbours, rows over three coordinates each: most of the reflectors have
// few entries. What comes out meets both equations.
static void a_long_chain_meets_its_equations(void **state) {
    fixture *f = *state;
    static double M[CHAIN_NV * CHAIN_NV], J[CHAIN_NC * CHAIN_NV];
    double force[CHAIN_NV], gamma[CHAIN_NC], a[CHAIN_NV], lambda[CHAIN_NC];
    for (int i = 0; i < CHAIN_NV; i++) {
        M[i * CHAIN_NV + i] = 3 + random_unit(f);
        force[i] = random_unit(f);
        if (i > 0) {
            M[i * CHAIN_NV + i - 1] = M[(i - 1) * CHAIN_NV + i] = 0.5 * random_unit(f);
        }
    }
    for (int k = 0; k < CHAIN_NC; k++) {
        gamma[k] = random_unit(f);
        for (int j = k; j < k + 3; j++) {
            J[k * CHAIN_NV + j] = random_unit(f);
        }
    }

    hn_saddle_ws *ws = hn_saddle_ws_create(f->arena, CHAIN_NV, CHAIN_NC);
    hn_saddle_info info;
    assert_int_equal(
        hn_saddle_solve(CHAIN_NV, CHAIN_NC, M, J, force, gamma, a, lambda, &info, NULL, ws), HN_OK);
    assert_int_equal(info.rank, CHAIN_NC);
    const double size = fmax(hn_norm_max(CHAIN_NV, a), hn_norm_max(CHAIN_NC, lambda));
    for (int i = 0; i < CHAIN_NV; i++) {
        double rest = hn_dot(CHAIN_NV, M + i * CHAIN_NV, a) - force[i];
        for (int k = 0; k < CHAIN_NC; k++) {
            rest -= J[k * CHAIN_NV + i] * lambda[k];
        }
        assert_near(rest, 0, 1e-13 * size); // a few entries of size 3 a row
    }
    for (int k = 0; k < CHAIN_NC; k++) {
        assert_near(hn_dot(CHAIN_NV, J + k * CHAIN_NV, a), -gamma[k], 1e-13 * size);
    }
}

static void condition_estimate_follows_a_known_condition_number(void **state) {
    fixture *f = *state;
    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.want_cond = 1;
    // unit masses and two rows at a small angle e: the smallest singular value of the equilibrated
    // J is e / sqrt 2
    for (int power = 1; power <= 4; power++) {
        double e = pow(10, -power);
        f->p = (problem){
            .nv = 3, .nc = 2, .M = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .J = {1, 0, 0, cos(e), sin(e), 0}};
        assert_int_equal(solve(f, &opts), HN_OK);
        // |K^-1| holds 1 / sigma and (J M^-1 J')^-1 ~ 1 / sigma^2 = 2 / e^2
        assert_true(f->info.cond > 1 / (e * e) && f->info.cond < 20 / (e * e));
    }
}

static void nothing_is_allocated_and_the_bits_repeat(void **state) {
    fixture *f = *state;
    make_chain(&f->p, 10, 1e8);
    long before = hn_alloc_count();
    assert_int_equal(solve(f, NULL), HN_OK);
    double a[MAX_NV], lambda[MAX_NC];
    memcpy(a, f->a, sizeof a);
    memcpy(lambda, f->lambda, sizeof lambda);
    assert_int_equal(solve(f, NULL), HN_OK);
    assert_int_equal(hn_alloc_count(), before);
    assert_memory_equal(a, f->a, sizeof a);
    assert_memory_equal(lambda, f->lambda, sizeof lambda);
}

static void one_factor_serves_many_right_hand_sides(void **state) {
    fixture *f = *state;
    make_random(f, 9, 5);
    assert_int_equal(hn_saddle_factor(9, 5, f->p.M, f->p.J, &f->info, NULL, f->ws), HN_OK);
    for (int k = 0; k < 3; k++) {
        double a[9], lambda[5];
        f->p.f[k] += 1;
        f->p.gamma[k] -= 2;
        solve_quad(&f->p, a, lambda);
        assert_int_equal(hn_saddle_apply(f->p.f, f->p.gamma, f->a, f->lambda, &f->info, f->ws),
                         HN_OK);
        assert_all_near(f->a, a, 9, 1e-12);
        assert_all_near(f->lambda, lambda, 5, 1e-12);
    }
}

#define with_fixture(test) cmocka_unit_test_setup_teardown(test, setup, teardown)

int main(void) {
    const struct CMUnitTest tests[] = {
        with_fixture(hanging_bob_with_duplicated_rod_row_has_rank_one),
        with_fixture(least_norm_holds_in_the_given_row_units),
        with_fixture(four_bar_multipliers_are_the_published_ones),
        with_fixture(duplicated_and_summed_rows_leave_accelerations_and_forces_alone),
        with_fixture(every_mass_ratio_is_solved_to_thirteen_digits),
        with_fixture(refinement_repairs_what_one_solve_loses),
        with_fixture(massless_rocker_is_solved_as_if_its_mass_went_to_zero),
        with_fixture(mass_that_vanishes_on_a_free_direction_is_singular),
        with_fixture(negative_mass_is_told),
        with_fixture(rows_that_contradict_each_other_are_refused_or_met_by_least_squares),
        with_fixture(rounding_in_a_redundant_row_is_no_contradiction),
        with_fixture(a_short_row_of_noise_is_kept_short_by_a_floor),
        with_fixture(a_disagreement_that_the_error_of_the_state_explains_is_no_contradiction),
        with_fixture(a_row_of_zeros_needs_a_gamma_of_zero),
        with_fixture(without_constraints_it_is_newtons_law),
        with_fixture(inputs_that_are_not_finite_leave_the_outputs_alone),
        with_fixture(random_systems_agree_with_lu),
        with_fixture(a_long_chain_meets_its_equations),
        with_fixture(condition_estimate_follows_a_known_condition_number),
        with_fixture(nothing_is_allocated_and_the_bits_repeat),
        with_fixture(one_factor_serves_many_right_hand_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
