// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "linalg/kkt.h"
#include "linalg/qr.h"
#include "linalg/square.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// The ways to solve the saddle-point system: extreme masses, rows written twice, a massless link.

__extension__ typedef __float128 quad;

enum { MAX_NV = 24, MAX_NC = 24, MAX_N = MAX_NV + MAX_NC };

typedef struct saddle {
    int nv, nc;
    double M[MAX_NV * MAX_NV], J[MAX_NC * MAX_NV], f[MAX_NV], gamma[MAX_NC];
} saddle;

static void fill(const hn_model *m, saddle *s) {
    hn_eval *e = NULL;
    s->nv = m->info.nv;
    s->nc = m->info.nc;
    assert_true(s->nv <= MAX_NV && s->nc <= MAX_NC);
    assert_int_equal(
        hn_eval_create(m->sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA, m->arena, &e),
        HN_OK);
    hn_eval_run(e, 0, m->q, m->v);
    memcpy(s->M, hn_eval_get(e, HN_TERM_M), (size_t)(s->nv * s->nv) * sizeof(double));
    memcpy(s->J, hn_eval_get(e, HN_TERM_J), (size_t)(s->nc * s->nv) * sizeof(double));
    memcpy(s->f, hn_eval_get(e, HN_TERM_F), (size_t)s->nv * sizeof(double));
    memcpy(s->gamma, hn_eval_get(e, HN_TERM_GAMMA), (size_t)s->nc * sizeof(double));
    hn_eval_free(e);
}

static void quad_rows(const saddle *s, quad K[MAX_N][MAX_N + 1]) {
    const int n = s->nv + s->nc;
    memset(K, 0, sizeof(quad[MAX_N][MAX_N + 1]));
    for (int i = 0; i < s->nv; i++) {
        for (int j = 0; j < s->nv; j++) {
            K[i][j] = (quad)s->M[i * s->nv + j];
        }
        for (int j = 0; j < s->nc; j++) {
            K[i][s->nv + j] = K[s->nv + j][i] = (quad)s->J[j * s->nv + i];
        }
        K[i][n] = (quad)s->f[i];
    }
    for (int j = 0; j < s->nc; j++) {
        K[s->nv + j][n] = -(quad)s->gamma[j];
    }
}

/// a in quadruple precision, by Gauss and Jordan with pivots.
static void solve_exactly(const saddle *s, double *a) {
    static quad K[MAX_N][MAX_N + 1];
    const int n = s->nv + s->nc;
    quad_rows(s, K);
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k; i < n; i++) {
            p = K[i][k] * K[i][k] > K[p][k] * K[p][k] ? i : p;
        }
        for (int j = 0; j <= n; j++) {
            const quad keep = K[k][j];
            K[k][j] = K[p][j];
            K[p][j] = keep;
        }
        for (int i = 0; i < n; i++) {
            const quad l = i == k ? 0 : K[i][k] / K[k][k];
            for (int j = k; j <= n; j++) {
                K[i][j] -= l * K[k][j];
            }
        }
    }
    for (int i = 0; i < s->nv; i++) {
        a[i] = (double)(K[i][n] / K[i][i]);
    }
}

/// Largest difference, relative to the largest entry of `exact`.
static double difference(int n, const double *a, const double *exact) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        worst = fmax(worst, fabs(a[i] - exact[i]));
    }
    return worst / hn_norm_max(n, exact);
}

static void pack(const saddle *s, double *K) {
    const int nv = s->nv, n = nv + s->nc;
    memset(K, 0, (size_t)(n * n) * sizeof *K);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            K[i * n + j] = s->M[i * nv + j];
        }
        for (int j = 0; j < s->nc; j++) {
            K[i * n + nv + j] = K[(nv + j) * n + i] = s->J[j * nv + i];
        }
    }
}

static double relative_error(const saddle *s, hn_kkt_way way, int refinements) {
    hn_arena *arena = hn_arena_create(0);
    hn_kkt *kkt = hn_kkt_create(arena, s->nv, s->nc);
    hn_kkt_opts opts = hn_kkt_opts_default();
    double a[MAX_NV], lambda[MAX_NC], exact[MAX_NV];
    opts.max_refine = refinements;
    const hn_status status =
        hn_kkt_solve(kkt, way, s->nv, s->nc, s->M, s->J, s->f, s->gamma, a, lambda, NULL, &opts);
    solve_exactly(s, exact);
    hn_arena_free(arena);
    return status == HN_OK ? difference(s->nv, a, exact) : nan("");
}

// ---- plainly, as in the books ----

/// LU of K with partial pivoting.
static void by_elimination(const saddle *s, double *a) {
    hn_arena *arena = hn_arena_create(0);
    const int n = s->nv + s->nc;
    double x[MAX_N], lu[MAX_N * MAX_N];
    hn_square k;
    pack(s, lu);
    assert_true(hn_square_init(&k, arena, n));
    memcpy(k.lu, lu, (size_t)(n * n) * sizeof(double));
    assert_int_equal(hn_square_factor(&k, n), HN_OK);
    memcpy(x, s->f, (size_t)s->nv * sizeof(double));
    for (int i = 0; i < s->nc; i++) {
        x[s->nv + i] = -s->gamma[i];
    }
    hn_square_solve(&k, x);
    memcpy(a, x, (size_t)s->nv * sizeof(double));
    hn_arena_free(arena);
}

/// M = L L', X = L^-1 J', S = X' X.
static void by_range_space(const saddle *s, double *a) {
    const int nv = s->nv, nc = s->nc;
    double L[MAX_NV * MAX_NV], X[MAX_NC][MAX_NV], S[MAX_NC * MAX_NC], lambda[MAX_NC];
    memcpy(L, s->M, (size_t)(nv * nv) * sizeof(double));
    assert_int_equal(hn_cholesky(nv, L, nv, 0), HN_OK);
    memcpy(a, s->f, (size_t)nv * sizeof(double));
    hn_lower_solve(nv, L, nv, a);
    for (int i = 0; i < nc; i++) {
        memcpy(X[i], s->J + (size_t)i * nv, (size_t)nv * sizeof(double));
        hn_lower_solve(nv, L, nv, X[i]);
        lambda[i] = -s->gamma[i] - hn_dot(nv, X[i], a);
        for (int j = 0; j <= i; j++) {
            S[i * nc + j] = S[j * nc + i] = hn_dot(nv, X[i], X[j]);
        }
    }
    assert_int_equal(hn_cholesky(nc, S, nc, 0), HN_OK);
    hn_cholesky_solve(nc, S, nc, lambda);
    memcpy(a, s->f, (size_t)nv * sizeof(double));
    for (int i = 0; i < nc; i++) {
        hn_axpy(nv, lambda[i], s->J + (size_t)i * nv, a);
    }
    hn_cholesky_solve(nv, L, nv, a);
}

/// J' = Q R; a = N z - J^+ gamma with the last columns of Q for N.
static void by_null_space(const saddle *s, double *a) {
    hn_arena *arena = hn_arena_create(0);
    const int nv = s->nv, nc = s->nc, r = nv - nc;
    double N[MAX_NV][MAX_NV], A[MAX_NV * MAX_NV], z[MAX_NV], g[MAX_NC], rest[MAX_NV];
    hn_qr qr;
    assert_true(hn_qr_init(&qr, arena, nv, nc));
    memcpy(qr.a, s->J, (size_t)(nc * nv) * sizeof(double));
    hn_qr_factor(&qr, nv, nc, 0);
    assert_int_equal(qr.rank, nc);
    for (int i = 0; i < nc; i++) {
        g[i] = -s->gamma[i];
    }
    hn_qr_least_norm(&qr, g, a);
    hn_mat_vec(nv, nv, s->M, a, rest);
    for (int i = 0; i < nv; i++) {
        rest[i] = s->f[i] - rest[i];
    }
    for (int k = 0; k < r; k++) {
        memset(N[k], 0, sizeof N[k]);
        N[k][nc + k] = 1;
        hn_qr_apply_q(&qr, N[k]);
        z[k] = hn_dot(nv, N[k], rest);
    }
    for (int k = 0; k < r; k++) {
        double Mn[MAX_NV];
        hn_mat_vec(nv, nv, s->M, N[k], Mn);
        for (int j = 0; j < r; j++) {
            A[j * r + k] = hn_dot(nv, N[j], Mn);
        }
    }
    assert_int_equal(hn_cholesky(r, A, r, 0), HN_OK);
    hn_cholesky_solve(r, A, r, z);
    for (int k = 0; k < r; k++) {
        hn_axpy(nv, z[k], N[k], a);
    }
    hn_arena_free(arena);
}

static double plain_error(const saddle *s, void (*way)(const saddle *, double *)) {
    double a[MAX_NV], exact[MAX_NV];
    solve_exactly(s, exact);
    way(s, a);
    return difference(s->nv, a, exact);
}

static double condition(const saddle *s) {
    hn_arena *arena = hn_arena_create(0);
    const int n = s->nv + s->nc;
    double K[MAX_N * MAX_N], sigma[MAX_N];
    pack(s, K);
    assert_int_equal(hn_singular_values(n, n, K, sigma, arena), HN_OK);
    hn_arena_free(arena);
    return hn_condition_of(n, sigma);
}

// ---- extreme masses ----

typedef struct mass_row {
    const char *scene;
    const char *condition, *elimination, *range, *null; ///< printed
    double factor; ///< errors of rounding: within it either way
} mass_row;

static const char lucky[] = "rounding of one pose; below 1e-15 luck decides";

static void put_error(hn_figures *f, const char *scene, const char *way, const char *printed,
                      double found, double factor) {
    char how[120];
    (void)snprintf(how, sizeof how, "%s, %s as in the books", scene, way);
    const hn_figure row = {.what = "relative error of the accelerations",
                           .how = how,
                           .printed = printed,
                           .factor = factor,
                           .note = lucky};
    hn_figure_add(f, &row, found);
}

static void put_ways(hn_figures *f, const saddle *s, const mass_row *r) {
    static const struct {
        hn_kkt_way way;
        const char *name;
    } ways[] = {{HN_KKT_DENSE, "elimination"},
                {HN_KKT_RANGE_SPACE, "range space"},
                {HN_KKT_NULL_SPACE, "null space"}};
    const hn_figure cond = {.what = "condition of K",
                            .how = r->scene,
                            .printed = r->condition,
                            .factor = r->factor,
                            .note = "of one pose"};
    hn_figure_add(f, &cond, condition(s));
    put_error(f, r->scene, "elimination", r->elimination, plain_error(s, by_elimination),
              r->factor);
    put_error(f, r->scene, "range space", r->range, plain_error(s, by_range_space), r->factor);
    put_error(f, r->scene, "null space", r->null, plain_error(s, by_null_space), r->factor);
    for (int k = 0; k < 3; k++) {
        char how[120];
        (void)snprintf(how, sizeof how, "%s, %s as built in: refined", r->scene, ways[k].name);
        hn_figure_put(f, "relative error of the accelerations", how, "<1e-14",
                      relative_error(s, ways[k].way, 4));
    }
}

static void mass_ratios(hn_figures *f) {
    static const mass_row rows[] = {
        {"fb0, coupler of 1e-8 kg", "8", "3e-17", "3e-10", "2e-16", 10},
        {"fb0, coupler of 1e8 kg", "7e15", "7e-11", "4e-10", "6e-17", 10},
        {"chain of ten rods, tip of 1e-8 kg", "3e8", "2e-15", "2e-15", "1e-9", 1000},
        {"chain of ten rods, tip of 1e8 kg", "1e10", "9e-15", "6e-15", "2e-9", 1000},
    };
    static saddle s;
    hn_model m;
    hn_figure_links links = hn_figure_fb0();
    links.m2 = 1e-8;
    hn_figure_open_links(&m, &links);
    fill(&m, &s);
    put_ways(f, &s, &rows[0]);
    hn_model_close(&m);
    links.m2 = 1e8;
    hn_figure_open_links(&m, &links);
    fill(&m, &s);
    put_ways(f, &s, &rows[1]);
    hn_model_close(&m);
    hn_figure_open_chain(&m, 1e-8);
    fill(&m, &s);
    put_ways(f, &s, &rows[2]);
    hn_model_close(&m);
    hn_figure_open_chain(&m, 1e8);
    fill(&m, &s);
    put_ways(f, &s, &rows[3]);
    hn_model_close(&m);
}

void hn_figures_solvers(hn_figures *f) {
    mass_ratios(f);
}
