// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_solve.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_model.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "linalg/kkt.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// twice the digits of double, or the widest type of the machine
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 wide;
#else
typedef long double wide;
#endif

enum { MOST_UNKNOWNS = 60 };
#define LOST_PIVOT \
    1e-12 // of the first one, rows and columns equilibrated: that row follows from others

static const char *const WAYS[HN_KKT_WAYS] = {"dense", "range-space", "null-space", "proximal",
                                              "least-norm"};

bool hn_extreme_is_solver(const char *name) {
    for (int i = 0; i < HN_KKT_WAYS; i++) {
        if (strcmp(WAYS[i], name) == 0) {
            return true;
        }
    }
    return false;
}

static hn_kkt_way way_of(const char *name) {
    int way = 0;
    while (way < HN_KKT_WAYS - 1 && strcmp(WAYS[way], name) != 0) {
        way++;
    }
    return (hn_kkt_way)way;
}

/// K x = b with its scaling, n unknowns, the right-hand side in column n.
typedef struct table {
    int n;
    wide a[MOST_UNKNOWNS][MOST_UNKNOWNS + 1];
    int column[MOST_UNKNOWNS]; ///< unknown that stands in a column
} table;

static double size_of(wide x) {
    return fabs((double)x);
}

static void swap_rows(table *k, int a, int b) {
    for (int j = 0; j <= k->n; j++) {
        const wide keep = k->a[a][j];
        k->a[a][j] = k->a[b][j];
        k->a[b][j] = keep;
    }
}

static void swap_columns(table *k, int a, int b) {
    for (int i = 0; i < k->n; i++) {
        const wide keep = k->a[i][a];
        k->a[i][a] = k->a[i][b];
        k->a[i][b] = keep;
    }
    const int keep = k->column[a];
    k->column[a] = k->column[b];
    k->column[b] = keep;
}

/// Moves the largest entry of the remaining block to (at, at). Returns its size.
static double pivot(table *k, int at) {
    int row = at, column = at;
    for (int i = at; i < k->n; i++) {
        for (int j = at; j < k->n; j++) {
            if (size_of(k->a[i][j]) > size_of(k->a[row][column])) {
                row = i;
                column = j;
            }
        }
    }
    swap_rows(k, at, row);
    swap_columns(k, at, column);
    return size_of(k->a[at][at]);
}

/// Solves by Gauss-Jordan elimination with complete pivoting; unknowns without a pivot are 0.
static void eliminate(table *k, wide x[MOST_UNKNOWNS]) {
    double first = 0;

    // start from zero and the given order of unknowns
    for (int i = 0; i < k->n; i++) {
        k->column[i] = i;
        x[i] = 0;
    }

    // clear each pivot's column in all other rows, until the pivots vanish
    int rank = 0;
    for (; rank < k->n; rank++) {
        const double size = pivot(k, rank);
        first = rank == 0 ? size : first;
        if (!(size > LOST_PIVOT * first)) {
            break;
        }
        for (int i = 0; i < k->n; i++) {
            const wide factor = i == rank ? 0 : k->a[i][rank] / k->a[rank][rank];
            for (int j = rank; j <= k->n && factor != 0; j++) {
                k->a[i][j] -= factor * k->a[rank][j];
            }
        }
    }

    // read off the unknowns that have a pivot
    for (int i = 0; i < rank; i++) {
        x[k->column[i]] = k->a[i][k->n] / k->a[i][i];
    }
}

/// Finds powers of two that scale each row and column of the symmetric K to about 1.
static void find_scales(const table *k, double *scale) {
    for (int i = 0; i < k->n; i++) {
        scale[i] = 1;
    }
    for (int round = 0; round < 10; round++) {
        for (int i = 0; i < k->n; i++) {
            double most = 0;
            for (int j = 0; j < k->n; j++) {
                most = fmax(most, size_of(k->a[i][j]) * scale[i] * scale[j]);
            }
            scale[i] *= most > 0 ? exp2(-floor(log2(most) / 2)) : 1;
        }
    }
}

typedef struct saddle {
    int nv, nc;
    const double *M, *J, *f, *gamma;
} saddle;

/// Solves for a (nv) and lambda (nc), exact to the digits of double.
static void solve_exactly(const saddle *s, double *a, double *lambda) {
    table k = {.n = s->nv + s->nc};
    double scale[MOST_UNKNOWNS];
    wide x[MOST_UNKNOWNS];

    // fill the saddle matrix and its right-hand side
    memset(k.a, 0, sizeof k.a);
    for (int i = 0; i < s->nv; i++) {
        for (int j = 0; j < s->nv; j++) {
            k.a[i][j] = (wide)s->M[i >= j ? i * s->nv + j : j * s->nv + i];
        }
        for (int j = 0; j < s->nc; j++) {
            k.a[i][s->nv + j] = k.a[s->nv + j][i] = (wide)s->J[j * s->nv + i];
        }
        k.a[i][k.n] = (wide)s->f[i];
    }
    for (int j = 0; j < s->nc; j++) {
        k.a[s->nv + j][k.n] = -(wide)s->gamma[j];
    }

    // equilibrate symmetrically
    find_scales(&k, scale);
    for (int i = 0; i < k.n; i++) {
        for (int j = 0; j < k.n; j++) {
            k.a[i][j] *= (wide)scale[i] * (wide)scale[j];
        }
        k.a[i][k.n] *= (wide)scale[i];
    }

    // eliminate, then undo the scaling; lambda has the opposite sign here
    eliminate(&k, x);
    for (int i = 0; i < k.n; i++) {
        const double value = (double)(x[i] * (wide)scale[i]);
        if (i < s->nv) {
            a[i] = value;
        } else {
            lambda[i - s->nv] = -value;
        }
    }
}

static double relative(const double *x, const double *exact, int n) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        worst = fmax(worst, fabs(x[i] - exact[i]));
    }
    return worst / hn_norm_max(n, exact);
}

static void tell_refusal(const hn_model *model, const hn_kkt_info *info, hn_extreme_answer *out) {
    const hn_scene *scene = hn_model_scene(model);
    const hn_system *sys = hn_model_system(model);
    const int has_names = info->massless >= 0 && hn_system_get_info(sys).n_user > info->massless;
    if (has_names) {
        const int c = hn_system_user_coordinate(sys, info->massless);
        snprintf(out->reason, sizeof out->reason, "%.60s has no mass of its own",
                 scene->coordinates[c].name);
    } else {
        snprintf(out->reason, sizeof out->reason, "%s", hn_status_text(out->status));
    }
}

static void solve_by_way(hn_arena *arena, const hn_model *model, const saddle *s, hn_kkt_way way,
                         int refine, hn_extreme_answer *out) {
    const size_t nv = (size_t)s->nv, nc = (size_t)s->nc;
    double *a = hn_arena_doubles(arena, nv), *exact = hn_arena_doubles(arena, nv),
           *lambda = hn_arena_doubles(arena, nc), *exact_lambda = hn_arena_doubles(arena, nc),
           *force = hn_arena_doubles(arena, nv), *exact_force = hn_arena_doubles(arena, nv);
    hn_kkt *kkt = hn_kkt_create(arena, s->nv, s->nc);
    hn_kkt_info info = {.massless = -1};
    hn_kkt_opts opts = hn_kkt_opts_default();

    // report missing memory before any solve
    if (hn_arena_failed(arena) || !kkt) {
        out->status = HN_ERR_MEMORY;
        return;
    }

    // the answer of the solver under test
    opts.max_refine = refine;
    out->status =
        hn_kkt_solve(kkt, way, s->nv, s->nc, s->M, s->J, s->f, s->gamma, a, lambda, &info, &opts);
    if (out->status != HN_OK) {
        tell_refusal(model, &info, out);
        return;
    }

    // the exact answer
    solve_exactly(s, exact, exact_lambda);

    // errors of accelerations and constraint forces, and both norms of lambda
    hn_mat_t_vec(s->nc, s->nv, s->J, lambda, force);
    hn_mat_t_vec(s->nc, s->nv, s->J, exact_lambda, exact_force);
    out->error = relative(a, exact, s->nv);
    out->force_error = relative(force, exact_force, s->nv);
    out->lambda_norm = hn_norm2(s->nc, lambda);
    out->exact_lambda_norm = hn_norm2(s->nc, exact_lambda);
}

void hn_extreme_solve(hn_extreme_bench *bench, const hn_extreme_point *point,
                      hn_extreme_answer *out) {
    const unsigned terms = HN_TERM_M | HN_TERM_J | HN_TERM_F | HN_TERM_GAMMA;
    const hn_model *model = hn_extreme_model(bench, point);
    hn_eval *e = NULL;
    double *q = NULL, *v = NULL;

    // load the model and its start
    memset(out, 0, sizeof *out);
    hn_arena *arena = hn_arena_create(1 << 14);
    out->status = !model ? bench->load_status : !arena ? HN_ERR_MEMORY : HN_OK;
    if (out->status == HN_OK) {
        const hn_system_info info = hn_system_get_info(hn_model_system(model));
        out->status = info.nv + info.nc > MOST_UNKNOWNS
                          ? HN_ERR_LIMIT
                          : hn_extreme_start(bench, model, point->trial, arena, &q, &v);
    }

    // evaluate the saddle system there
    if (out->status == HN_OK) {
        out->status = hn_eval_create(hn_model_system(model), terms, arena, &e);
    }

    // solve it, or say why there is nothing to solve
    if (out->status == HN_OK) {
        const hn_system_info info = hn_system_get_info(hn_model_system(model));
        hn_eval_run(e, 0, q, v);
        const saddle s = {info.nv,
                          info.nc,
                          hn_eval_get(e, HN_TERM_M),
                          hn_eval_get(e, HN_TERM_J),
                          hn_eval_get(e, HN_TERM_F),
                          hn_eval_get(e, HN_TERM_GAMMA)};
        solve_by_way(arena, model, &s, way_of(point->method), point->trial->refine, out);
    } else {
        snprintf(out->reason, sizeof out->reason, "%.199s",
                 bench->diags.n ? bench->diags.item[0].message : hn_status_text(out->status));
    }

    hn_eval_free(e);
    hn_arena_free(arena);
}
