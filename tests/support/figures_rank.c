// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/ldl.h"
#include "expr/tape.h"
#include "linalg/dense.h"
#include "linalg/kkt.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Rows that depend on each other, links without mass, sparse elimination along a chain, singular
// poses.

// ---- repeated rows ----

enum { NV = 3, MAX_NC = 4 };

typedef struct rows {
    double M[NV * NV], J[MAX_NC * NV], f[NV], gamma[MAX_NC], a[NV];
} rows;

/// FB0 at its start; row 2 repeats row 0 (off by `offset` in gamma), row 3 is the sum of both.
static void repeat(rows *r, double offset) {
    hn_model m;
    hn_eval *e = NULL;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    assert_int_equal(
        hn_eval_create(m.sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA, m.arena, &e),
        HN_OK);
    hn_eval_run(e, 0, m.q, m.v);
    memcpy(r->M, hn_eval_get(e, HN_TERM_M), sizeof r->M);
    memcpy(r->J, hn_eval_get(e, HN_TERM_J), 2 * NV * sizeof(double));
    memcpy(r->f, hn_eval_get(e, HN_TERM_F), sizeof r->f);
    memcpy(r->gamma, hn_eval_get(e, HN_TERM_GAMMA), 2 * sizeof(double));
    memcpy(r->a, m.a, sizeof r->a);
    for (int j = 0; j < NV; j++) {
        r->J[2 * NV + j] = r->J[j];
        r->J[3 * NV + j] = r->J[j] + r->J[NV + j];
    }
    r->gamma[2] = r->gamma[0] + offset;
    r->gamma[3] = r->gamma[0] + r->gamma[1];
    hn_eval_free(e);
    hn_model_close(&m);
}

static double error_of(const rows *r, const double *a) {
    double worst = 0;
    for (int i = 0; i < NV; i++) {
        worst = fmax(worst, fabs(a[i] - r->a[i]));
    }
    return worst / hn_norm_max(NV, r->a);
}

/// [M J'; J -mu I] with mu = 1e-6 trace(S) / m, as in the books, so many turns.
static double proximal_error(const rows *r, int nc, int turns) {
    double L[NV * NV], X[MAX_NC][NV], S[MAX_NC * MAX_NC], lambda[MAX_NC] = {0}, a[NV], b[MAX_NC];
    double trace = 0;
    memcpy(L, r->M, sizeof L);
    assert_int_equal(hn_cholesky(NV, L, NV, 0), HN_OK);
    for (int i = 0; i < nc; i++) {
        memcpy(X[i], r->J + (size_t)i * NV, sizeof X[i]);
        hn_lower_solve(NV, L, NV, X[i]);
        trace += hn_dot(NV, X[i], X[i]);
    }
    const double mu = 1e-6 * trace / nc;
    for (int k = 0; k < turns; k++) {
        memcpy(a, r->f, sizeof a);
        hn_cholesky_solve(NV, L, NV, a);
        for (int i = 0; i < nc; i++) {
            // (S + mu) lambda' = -gamma - J M^-1 f + mu lambda
            b[i] = -r->gamma[i] - hn_dot(NV, r->J + (size_t)i * NV, a) + mu * lambda[i];
            for (int j = 0; j < nc; j++) {
                S[i * nc + j] = hn_dot(NV, X[i], X[j]) + (i == j ? mu : 0);
            }
        }
        assert_int_equal(hn_cholesky(nc, S, nc, 0), HN_OK);
        hn_cholesky_solve(nc, S, nc, b);
        memcpy(lambda, b, sizeof lambda);
    }
    memcpy(a, r->f, sizeof a);
    for (int i = 0; i < nc; i++) {
        hn_axpy(NV, lambda[i], r->J + (size_t)i * NV, a);
    }
    hn_cholesky_solve(NV, L, NV, a);
    return error_of(r, a);
}

/// The way built in; NaN when it refuses.
static double built_in_error(const rows *r, hn_kkt_way way, int nc, double *a) {
    hn_arena *arena = hn_arena_create(0);
    hn_kkt *kkt = hn_kkt_create(arena, NV, MAX_NC);
    double lambda[MAX_NC];
    hn_kkt_opts opts = hn_kkt_opts_default();
    const hn_status status =
        hn_kkt_solve(kkt, way, NV, nc, r->M, r->J, r->f, r->gamma, a, lambda, NULL, &opts);
    hn_arena_free(arena);
    return status == HN_OK ? error_of(r, a) : nan("");
}

static void repeated_rows(hn_figures *f) {
    rows r;
    double a[NV];
    repeat(&r, 0);
    const char *how = "fb0, a row repeated and a sum, proximal as in the books";
    const hn_figure turn[3] = {{.what = "relative error of a after one turn",
                                .how = how,
                                .printed = "2.6e-6",
                                .factor = 3,
                                .note = "which rows were repeated is not told"},
                               {.what = "after two turns",
                                .how = how,
                                .printed = "1.1e-12",
                                .factor = 10,
                                .note = "the square of the first"},
                               {.what = "after three turns",
                                .how = how,
                                .printed = "1e-16",
                                .factor = 1e3,
                                .note = "rounding"}};
    for (int k = 0; k < 3; k++) {
        hn_figure_add(f, &turn[k], proximal_error(&r, 3, k + 1));
    }
    hn_figure_put(f, "relative error of a", "fb0, a row repeated and a sum, proximal as built in",
                  "<1e-14", built_in_error(&r, HN_KKT_PROXIMAL, 4, a));
    hn_figure_put(f, "relative error of a", "fb0, a row repeated and a sum, least norm", "<1e-14",
                  built_in_error(&r, HN_KKT_LEAST_NORM, 4, a));
    hn_figure_put_words(f, "elimination of K", "fb0, a row repeated", "singular",
                        isnan(built_in_error(&r, HN_KKT_DENSE, 3, a)) ? "singular" : "an answer");
    repeat(&r, 1e-3);
    (void)built_in_error(&r, HN_KKT_PROXIMAL, 3, a);
    hn_figure_put(f, "what contradicting rows leave [m/s^2]",
                  "fb0, a row repeated with 1e-3 more, proximal", "7.07e-4",
                  hypot(hn_dot(NV, r.J, a) + r.gamma[0], hn_dot(NV, r.J + 2 * NV, a) + r.gamma[2]));
}

// ---- Udwadia and Kalaba ----

/// Largest difference of the accelerations by the method's right-hand side from those of the saddle
/// system.
static double by_udwadia_kalaba(const hn_model *m, const double *a) {
    const double settings[HN_MAX_OPTIONS] = {0};
    return hn_motion_acceleration_error(m, "udwadia-kalaba", settings, a);
}

static void udwadia_kalaba(hn_figures *f) {
    hn_model once, often;
    hn_figure_links links = hn_figure_fb0();
    static const hn_figure same = {.what = "difference of an acceleration [rad/s^2]",
                                   .how = "fb0, rows written twice, udwadia-kalaba",
                                   .printed = "7e-15",
                                   .factor = 10,
                                   .note = "rounding"},
                           massless = {.what = "difference of an acceleration [rad/s^2]",
                                       .how = "fb0, rocker without mass, udwadia-kalaba",
                                       .printed = "4e-15",
                                       .factor = 10,
                                       .note = "rounding"};
    hn_model_open_closed(&once, "fb0", NULL);
    hn_model_open_closed(&often, "fb0-redundant", NULL);
    hn_figure_add(f, &same, by_udwadia_kalaba(&often, once.a));
    hn_model_close(&once);
    hn_model_close(&often);
    links.m3 = 0;
    hn_figure_open_links(&once, &links);
    hn_figure_add(f, &massless, by_udwadia_kalaba(&once, once.a));
    hn_model_close(&once);
}

// ---- a chain of point masses on rods ----

enum { MAX_RODS = 30, MAX_SYMBOLS = 20 * MAX_RODS };

static hn_ex symbol(hn_graph *g, char letter, int k, int *numbers, int *n) {
    char name[16];
    (void)snprintf(name, sizeof name, "%c%d", letter, k);
    const hn_ex e = hn_symbol(g, name, NULL);
    assert_true(*n < MAX_SYMBOLS);
    numbers[*n] = (*n);
    ++*n;
    return e;
}

static void chain_costs(int rods, double *fill, double *operations) {
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    hn_entries W = {0}, J = {0};
    hn_ex x[3 * MAX_RODS];
    int numbers[MAX_SYMBOLS], n = 0;
    for (int i = 0; i < 2 * rods; i++) {
        hn_entries_add(&W, i, i, symbol(g, 'm', i, numbers, &n));
    }
    for (int k = 0; k < rods; k++) {
        for (int j = k > 0 ? 2 * k - 2 : 0; j < 2 * k + 2; j++) {
            hn_entries_add(&J, k, j, symbol(g, 'j', 4 * k + j, numbers, &n));
        }
    }
    for (int i = 0; i < 3 * rods; i++) {
        x[i] = symbol(g, 'r', i, numbers, &n);
    }
    hn_ldl ldl;
    hn_tape *tape = NULL;
    const hn_ldl_input in = {2 * rods, rods, &W, &J, 0};
    assert_int_equal(hn_ldl_build(g, &in, arena, &ldl), HN_OK);
    assert_true(ldl.available);
    *fill = ldl.nnz;
    assert_int_equal(hn_ldl_solve(g, &ldl, x, x), HN_OK);
    assert_int_equal(hn_tape_compile(g, x, 3 * rods, numbers, n, &tape), HN_OK);
    *operations = hn_tape_get_info(tape).ops;
    hn_tape_free(tape);
    hn_entries_reset(&W);
    hn_entries_reset(&J);
    hn_arena_free(arena);
    hn_graph_free(g);
}

static void chains(hn_figures *f) {
    static const struct {
        int rods;
        const char *how, *fill, *operations, *instead;
    } table[] = {{2, "chain of 2 rods", "7", "65", "62"},
                 {5, "chain of 5 rods", "22", "200", "193"},
                 {10, "chain of 10 rods", "47", "425", "410"},
                 {30, "chain of 30 rods", "147", "1325", "1280"}};
    for (int i = 0; i < 4; i++) {
        double fill, operations;
        chain_costs(table[i].rods, &fill, &operations);
        hn_figure_put(f, "entries of L", table[i].how, table[i].fill, fill);
        const hn_figure row = {.what = "operations, factor and solve",
                               .how = table[i].how,
                               .printed = table[i].operations,
                               .instead = table[i].instead,
                               .units = 0.5,
                               .note =
                                   "changes of sign are folded into what follows: 3 for two rods"};
        hn_figure_add(f, &row, operations);
    }
}

void hn_figures_rank(hn_figures *f) {
    repeated_rows(f);
    udwadia_kalaba(f);
    chains(f);
}

// ---- singular poses ----

static int singular_values_of(const hn_model *m, const double *q, double *sigma) {
    hn_eval *e = NULL;
    const int nc = m->info.nc, nv = m->info.nv;
    double JT[64 * 64];
    assert_true(nc <= nv && nc * nv <= 64 * 64);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_J, m->arena, &e), HN_OK);
    hn_eval_run(e, 0, q, NULL);
    const double *J = hn_eval_get(e, HN_TERM_J);
    for (int i = 0; i < nc; i++) {
        for (int j = 0; j < nv; j++) {
            JT[j * nc + i] = J[i * nv + j];
        }
    }
    assert_int_equal(hn_singular_values(nv, nc, JT, sigma, m->arena), HN_OK);
    hn_eval_free(e);
    int rank = 0;
    for (int i = 0; i < nc; i++) {
        rank += sigma[i] > 1e-10 * sigma[0];
    }
    return rank;
}

/// The ladder in Cartesian coordinates of its tips: N + 1 points, 2 N + 1 bars of length 1, all at
/// `angle` from level.
static void open_points(hn_model *m, int n, double angle) {
    char text[8000], *p = text;
    const char *const end = text + sizeof text;
#define PUT(...) p += snprintf(p, p < end ? (size_t)(end - p) : 0, __VA_ARGS__)
    PUT("{\"holonom\": 1, \"name\": \"points\", \"lagrangian\": {\"coordinates\": [");
    for (int i = 0; i <= n; i++) {
        PUT("%s{\"name\": \"x%d\", \"rate\": \"u%d\", \"unit\": \"m\"}, ", i ? ", " : "", i, i);
        PUT("{\"name\": \"y%d\", \"rate\": \"v%d\", \"unit\": \"m\"}", i, i);
    }
    PUT("], \"kinetic\": \"(0");
    for (int i = 0; i <= n; i++) {
        PUT(" + u%d^2 + v%d^2", i, i);
    }
    PUT(")/2\", \"potential\": \"0*x0\", \"constraints\": [");
    for (int i = 0; i <= n; i++) {
        PUT("%s{\"name\": \"vertical %d\", \"formula\": ", i ? ", " : "", i);
        PUT("\"((x%d - %d)^2 + y%d^2 - 1)/2\"}", i, i, i);
    }
    for (int i = 1; i <= n; i++) {
        PUT(", {\"name\": \"coupler %d\", \"formula\": ", i);
        PUT("\"((x%d - x%d)^2 + (y%d - y%d)^2 - 1)/2\"}", i, i - 1, i, i - 1);
    }
    PUT("]}, \"start\": {\"positions\": {");
    for (int i = 0; i <= n; i++) {
        PUT("%s\"x%d\": %.17g, \"y%d\": %.17g", i ? ", " : "", i, i + cos(angle), i, sin(angle));
    }
    PUT("}, \"rates\": {}}}");
#undef PUT
    assert_true(p < end);
    hn_model_open_text(m, text, NULL);
}

void hn_figures_singular(hn_figures *f) {
    static const struct {
        int n;
        const char *how, *full, *flat, *freedoms;
    } ladders[] = {{1, "ladder of 1 four-bar, tips as points", "3", "2", "2"},
                   {2, "ladder of 2 four-bars, tips as points", "5", "3", "3"},
                   {10, "ladder of 10 four-bars, tips as points", "21", "11", "11"}};
    double sigma[64], q[64];
    for (int i = 0; i < 3; i++) {
        const int n = ladders[i].n;
        hn_model m;
        open_points(&m, n, 1);
        for (int k = 0; k <= n; k++) {
            q[2 * k] = k + cos(1.0);
            q[2 * k + 1] = sin(1.0);
        }
        hn_figure_put(f, "rank of J", ladders[i].how, ladders[i].full,
                      singular_values_of(&m, q, sigma));
        for (int k = 0; k <= n; k++) {
            q[2 * k] = k + 1;
            q[2 * k + 1] = 0;
        }
        const int flat = singular_values_of(&m, q, sigma);
        hn_figure_put(f, "rank of J, flat", ladders[i].how, ladders[i].flat, flat);
        hn_figure_put(f, "freedoms, flat", ladders[i].how, ladders[i].freedoms, 2 * n + 2 - flat);
        for (int k = 0; k <= n; k++) {
            q[2 * k] = k + cos(1e-3);
            q[2 * k + 1] = sin(1e-3);
        }
        (void)singular_values_of(&m, q, sigma);
        if (n == 2) {
            hn_figure_put(f, "smallest singular value over the angle", ladders[i].how, "0.7",
                          sigma[2 * n] / 1e-3);
        }
        hn_model_close(&m);
    }
}
