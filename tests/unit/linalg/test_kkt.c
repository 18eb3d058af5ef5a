// SPDX-License-Identifier: GPL-3.0-or-later
// The dense ways to solve the saddle-point system, one beside the other: extreme masses, a massless
// link, rows that repeat and rows that contradict each other. The reference is an elimination in
// quadruple precision.

#include "linalg/bunch_kaufman.h"
#include "linalg/dense.h"
#include "linalg/kkt.h"
#include "support/alloc.h"
#include "support/near.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

__extension__ typedef __float128 quad;

enum { NV = 3, MAX_NC = 4, MAX_N = NV + MAX_NC };

/// The four-bar of links 1, 2, 1.8 on a ground of 2.2 m at crank angle 1 rad and 2 rad/s, absolute
/// angles, uniform bars.
typedef struct four_bar {
    int nc;
    double M[NV * NV], J[MAX_NC * NV], f[NV], gamma[MAX_NC];
} four_bar;

static four_bar make_four_bar(double coupler_mass, double rocker_mass) {
    const double l[] = {1, 2, 1.8}, th[] = {1, 0.498324904142577, 1.516841745037813}, g = 9.81;
    const double m1 = 1, m2 = coupler_mass, m3 = rocker_mass, w1 = 2, sign[] = {1, 1, -1};
    four_bar b = {.nc = 2};
    double c[NV], s[NV], w[NV] = {w1, 0, 0};
    for (int i = 0; i < NV; i++) {
        c[i] = cos(th[i]);
        s[i] = sin(th[i]);
        b.J[i] = -sign[i] * l[i] * s[i];
        b.J[NV + i] = sign[i] * l[i] * c[i];
    }
    const double det = b.J[1] * b.J[5] - b.J[2] * b.J[4];
    w[1] = -w1 * (b.J[0] * b.J[5] - b.J[2] * b.J[3]) / det;
    w[2] = -w1 * (b.J[1] * b.J[3] - b.J[0] * b.J[4]) / det;
    for (int i = 0; i < NV; i++) {
        b.gamma[0] -= sign[i] * l[i] * c[i] * w[i] * w[i];
        b.gamma[1] -= sign[i] * l[i] * s[i] * w[i] * w[i];
    }
    const double k = m2 * l[0] * l[1] / 2;
    b.M[0] = (m1 / 3 + m2) * l[0] * l[0];
    b.M[1] = b.M[3] = k * cos(th[0] - th[1]);
    b.M[4] = m2 * l[1] * l[1] / 3;
    b.M[8] = m3 * l[2] * l[2] / 3;
    b.f[0] = -k * sin(th[0] - th[1]) * w[1] * w[1] - g * (m1 / 2 + m2) * l[0] * c[0];
    b.f[1] = k * sin(th[0] - th[1]) * w[0] * w[0] - g * m2 / 2 * l[1] * c[1];
    b.f[2] = -g * m3 / 2 * l[2] * c[2];
    return b;
}

/// The same with row 1 written again and the sum of both rows.
static four_bar repeat_rows(four_bar b) {
    for (int j = 0; j < NV; j++) {
        b.J[2 * NV + j] = b.J[j];
        b.J[3 * NV + j] = b.J[j] + b.J[NV + j];
    }
    b.gamma[2] = b.gamma[0];
    b.gamma[3] = b.gamma[0] + b.gamma[1];
    b.nc = 4;
    return b;
}

static void swap_rows(quad K[][MAX_N + 1], int a, int b) {
    for (int j = 0; j <= MAX_N; j++) {
        const quad keep = K[a][j];
        K[a][j] = K[b][j];
        K[b][j] = keep;
    }
}

/// a of the four-bar by elimination in quadruple precision.
static void solve_reference(const four_bar *b, double a[NV]) {
    quad K[MAX_N][MAX_N + 1] = {{0}};
    const int n = NV + b->nc;
    for (int i = 0; i < NV; i++) {
        for (int j = 0; j < NV; j++) {
            K[i][j] = (quad)b->M[i * NV + j];
        }
        for (int j = 0; j < b->nc; j++) {
            K[i][NV + j] = K[NV + j][i] = (quad)b->J[j * NV + i];
        }
        K[i][MAX_N] = (quad)b->f[i];
    }
    for (int j = 0; j < b->nc; j++) {
        K[NV + j][MAX_N] = -(quad)b->gamma[j];
    }
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k; i < n; i++) {
            p = K[i][k] * K[i][k] > K[p][k] * K[p][k] ? i : p;
        }
        swap_rows(K, k, p);
        for (int i = 0; i < n; i++) {
            const quad l = i == k ? 0 : K[i][k] / K[k][k];
            for (int j = 0; j <= MAX_N; j++) {
                K[i][j] -= l * K[k][j];
            }
        }
    }
    for (int i = 0; i < NV; i++) {
        a[i] = (double)(K[i][MAX_N] / K[i][i]);
    }
}

typedef struct answer {
    hn_status status;
    double a[NV], lambda[MAX_NC], force[NV]; ///< force: J' lambda
    hn_kkt_info info;
} answer;

static answer solve(hn_kkt *kkt, hn_kkt_way way, const four_bar *b, int max_refine) {
    answer x;
    hn_kkt_opts opts = hn_kkt_opts_default();
    opts.max_refine = max_refine;
    opts.want_cond = 1;
    hn_poison_fill(x.a, NV);
    hn_poison_fill(x.lambda, MAX_NC);
    x.status = hn_kkt_solve(kkt, way, NV, b->nc, b->M, b->J, b->f, b->gamma, x.a, x.lambda, &x.info,
                            &opts);
    if (x.status == HN_OK) {
        hn_mat_t_vec(b->nc, NV, b->J, x.lambda, x.force);
    }
    return x;
}

static double difference(const double *x, const double *y) {
    double worst = 0;
    for (int i = 0; i < NV; i++) {
        worst = fmax(worst, fabs(x[i] - y[i]));
    }
    return worst / hn_norm_max(NV, y);
}

static int setup(void **state) {
    hn_arena *arena = hn_arena_create(0);
    static hn_kkt *kkt;
    kkt = hn_kkt_create(arena, NV, MAX_NC);
    static void *both[2];
    both[0] = arena;
    both[1] = kkt;
    *state = both;
    return kkt ? 0 : -1;
}

static int teardown(void **state) {
    hn_arena_free(((void **)*state)[0]);
    return 0;
}

static hn_kkt *kkt_of(void **state) {
    return ((void **)*state)[1];
}

static void every_way_is_exact_at_every_mass_ratio_once_refined(void **state) {
    static const double ratio[] = {1e-8, 1e-4, 1, 1e4, 1e8};
    for (int k = 0; k < 5; k++) {
        const four_bar b = make_four_bar(2 * ratio[k], 1.8);
        double exact[NV];
        solve_reference(&b, exact);
        for (int way = 0; way < HN_KKT_WAYS; way++) {
            const answer x = solve(kkt_of(state), (hn_kkt_way)way, &b, 4);
            assert_int_equal(x.status, HN_OK);
            // a rounding of each entry of a, and of the data of the reference
            assert_true(difference(x.a, exact) < 1e-14);
        }
    }
}

static void without_refinement_elimination_loses_digits_at_the_extremes(void **state) {
    double exact[NV];
    const four_bar heavy = make_four_bar(2e8, 1.8), light = make_four_bar(2e-8, 1.8);
    solve_reference(&heavy, exact);
    const double range = difference(solve(kkt_of(state), HN_KKT_RANGE_SPACE, &heavy, 0).a, exact);
    // J M^-1 J' squares what the masses spread: some 1e8 roundings
    assert_true(range > 1e-13 && range < 1e-6);
    solve_reference(&light, exact);
    const double other = difference(solve(kkt_of(state), HN_KKT_RANGE_SPACE, &light, 0).a, exact);
    assert_true(other > 1e-13 && other < 1e-6);
    // orthogonal columns do not mix in a system this small
    assert_true(difference(solve(kkt_of(state), HN_KKT_NULL_SPACE, &light, 0).a, exact) < 1e-12);
}

static void a_massless_rocker_is_served_by_all_but_the_range_space(void **state) {
    const four_bar b = make_four_bar(2, 0);
    double exact[NV];
    solve_reference(&b, exact);
    for (int way = 0; way < HN_KKT_WAYS; way++) {
        const answer x = solve(kkt_of(state), (hn_kkt_way)way, &b, 4);
        if (way == HN_KKT_RANGE_SPACE) {
            assert_int_equal(x.status, HN_ERR_SINGULAR);
            assert_int_equal(x.info.massless, 2);
            assert_true(hn_poison_intact(x.a, NV));
        } else {
            assert_int_equal(x.status, HN_OK);
            assert_true(difference(x.a, exact) < 1e-14);
        }
    }
}

static void repeated_rows_change_nothing_where_they_are_served(void **state) {
    const four_bar once = make_four_bar(2, 1.8), often = repeat_rows(once);
    const answer plain = solve(kkt_of(state), HN_KKT_LEAST_NORM, &once, 4);
    double least_norm = 0;
    for (int way = 0; way < HN_KKT_WAYS; way++) {
        const answer x = solve(kkt_of(state), (hn_kkt_way)way, &often, 4);
        if (way != HN_KKT_PROXIMAL && way != HN_KKT_LEAST_NORM) {
            assert_int_equal(x.status, HN_ERR_SINGULAR);
            assert_true(hn_poison_intact(x.a, NV));
            continue;
        }
        assert_int_equal(x.status, HN_OK);
        assert_true(difference(x.a, plain.a) < 1e-12);
        assert_true(difference(x.force, plain.force) < 1e-12);
        // two or three turns of the proximal iteration leave nothing of its shift
        assert_true(difference(x.a, plain.a) < 1e-14);
        if (way == HN_KKT_LEAST_NORM) {
            assert_int_equal(x.info.rank, 2);
            least_norm = hn_norm2(4, x.lambda);
        }
    }
    // any lambda with the same J' lambda is at least as long: here the one that uses the first two
    // rows alone
    assert_true(least_norm < hn_norm2(2, plain.lambda));
}

static void forces_that_the_rows_take_whole_leave_no_acceleration(void **state) {
    // two coordinates held, the third without force
    const four_bar b = {.nc = 3,
                        .M = {2, 0, 0, 0, 3, 0, 0, 0, 1},
                        .J = {1, 0, 0, 0, 1, 0, 1, 1, 0},
                        .f = {3, -4, 0}};
    const answer x = solve(kkt_of(state), HN_KKT_PROXIMAL, &b, 4);
    assert_int_equal(x.status, HN_OK);
    assert_true(hn_norm_max(NV, x.a) < 1e-14);
    assert_near(x.force[0], -3, 1e-12);
    assert_near(x.force[1], 4, 1e-12);
}

static void rows_that_contradict_each_other_are_met_as_well_as_can_be_or_refused(void **state) {
    four_bar b = repeat_rows(make_four_bar(2, 1.8));
    b.nc = 3;
    b.gamma[2] += 1e-3; // row 1 says gamma, its copy says gamma + 1e-3
    const answer x = solve(kkt_of(state), HN_KKT_PROXIMAL, &b, 4);
    assert_int_equal(x.status, HN_OK);
    // half the difference is left in each copy: 1e-3 / sqrt 2 = 7.07e-4 together
    double left[2];
    for (int i = 0; i < 2; i++) {
        left[i] = hn_dot(NV, b.J + (i ? 2 : 0) * NV, x.a) + b.gamma[i ? 2 : 0];
    }
    assert_near(hypot(left[0], left[1]), 7.0710678e-4, 1e-9);
    assert_near(left[0], -left[1], 1e-9);
    // its multipliers grow by the contradiction over the shift each turn: why it is not the
    // automatic choice
    const four_bar plain = make_four_bar(2, 1.8);
    const answer usual = solve(kkt_of(state), HN_KKT_PROXIMAL, &plain, 4);
    assert_true(hn_norm2(3, x.lambda) > 100 * hn_norm2(2, usual.lambda));
    assert_int_equal(solve(kkt_of(state), HN_KKT_LEAST_NORM, &b, 4).status, HN_ERR_INCONSISTENT);
}

static void the_condition_is_that_of_the_equilibrated_matrix(void **state) {
    // units of all kinds, but after scaling K is [1 . . 1; . 1 . .; . . 1 .; 1 . . .]: |K|_1 = 2,
    // |K^-1|_1 = 2
    const four_bar good = {
        .nc = 1, .M = {4, 0, 0, 0, 9, 0, 0, 0, 1e-6}, .J = {1e3, 0, 0}, .f = {1, 0, 0}};
    // two rows at an angle of e to each other: J M^-1 J' has the eigenvalues 2 and e^2 / 2
    const double e = 1e-4;
    const four_bar bad = {
        .nc = 2, .M = {4, 0, 0, 0, 9, 0, 0, 0, 1e-6}, .J = {2, 0, 0, 2, 3 * e, 0}, .f = {1, 0, 0}};
    for (int way = 0; way < HN_KKT_WAYS; way++) {
        if (way == HN_KKT_PROXIMAL) {
            continue; // its matrix is another one, and better conditioned
        }
        // a lower bound, within a factor of three (Higham 2002, section 15.3); scales are rounded
        // to powers of two
        const double of_good = solve(kkt_of(state), (hn_kkt_way)way, &good, 4).info.cond;
        assert_true(of_good < 4.0001 * 4 && of_good > 4.0 / 3);

        const double of_bad = solve(kkt_of(state), (hn_kkt_way)way, &bad, 4).info.cond;
        assert_true(of_bad < 80 / (e * e) && of_bad > 1 / (e * e));
    }
}

static void an_indefinite_matrix_is_factored_and_its_inertia_is_told(void **state) {
    (void)state;
    enum { N = 12 };
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < 50; trial++) {
        // A = Q D Q' by reflections of a diagonal with a known number of negative entries
        double A[N * N] = {0}, F[N * N], x[N], b[N], u[N];
        int pivot[N], negative = -1;
        const int below = trial % (N + 1);
        for (int i = 0; i < N; i++) {
            A[i * N + i] = (i < below ? -1 : 1) * (1 + i);
            x[i] = 2 * gsl_rng_uniform(rng) - 1;
        }
        for (int k = 0; k < 3; k++) {
            double square = 0;
            for (int i = 0; i < N; i++) {
                u[i] = 2 * gsl_rng_uniform(rng) - 1;
                square += u[i] * u[i];
            }
            for (int side = 0; side < 2; side++) {
                for (int i = 0; i < N; i++) {
                    double dot = 0;
                    for (int j = 0; j < N; j++) {
                        dot += A[side ? j * N + i : i * N + j] * u[j];
                    }
                    for (int j = 0; j < N; j++) {
                        A[side ? j * N + i : i * N + j] -= 2 * dot * u[j] / square;
                    }
                }
            }
        }
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < i; j++) {
                A[i * N + j] = A[j * N + i];
            }
        }
        hn_mat_vec(N, N, A, x, b);
        memcpy(F, A, sizeof F);
        assert_int_equal(hn_bunch_kaufman(N, F, pivot, 1e-12, &negative), HN_OK);
        assert_int_equal(negative, below);
        hn_bunch_kaufman_solve(N, F, pivot, b);
        assert_all_near(b, x, N, 1e-13);
    }
    gsl_rng_free(rng);
}

static void a_matrix_that_needs_two_by_two_pivots_is_no_obstacle(void **state) {
    (void)state;
    double A[] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 2, 0, 0, 2, 0}, b[] = {5, 6, 7, 8};
    const double x[] = {6, 5, 4, 3.5};
    int pivot[4], negative = 0;
    assert_int_equal(hn_bunch_kaufman(4, A, pivot, 1e-14, &negative), HN_OK);
    assert_int_equal(negative, 2);
    hn_bunch_kaufman_solve(4, A, pivot, b);
    assert_all_near(b, x, 4, 1e-15);
}

static void solving_does_not_allocate(void **state) {
    const four_bar b = make_four_bar(2, 1.8);
    const long before = hn_alloc_count();
    for (int way = 0; way < HN_KKT_WAYS; way++) {
        (void)solve(kkt_of(state), (hn_kkt_way)way, &b, 4);
    }
    assert_int_equal(hn_alloc_count(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_way_is_exact_at_every_mass_ratio_once_refined),
        cmocka_unit_test(without_refinement_elimination_loses_digits_at_the_extremes),
        cmocka_unit_test(a_massless_rocker_is_served_by_all_but_the_range_space),
        cmocka_unit_test(repeated_rows_change_nothing_where_they_are_served),
        cmocka_unit_test(forces_that_the_rows_take_whole_leave_no_acceleration),
        cmocka_unit_test(rows_that_contradict_each_other_are_met_as_well_as_can_be_or_refused),
        cmocka_unit_test(the_condition_is_that_of_the_equilibrated_matrix),
        cmocka_unit_test(an_indefinite_matrix_is_factored_and_its_inertia_is_told),
        cmocka_unit_test(a_matrix_that_needs_two_by_two_pivots_is_no_obstacle),
        cmocka_unit_test(solving_does_not_allocate),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
