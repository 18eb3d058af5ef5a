// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/kkt.h"

#include "linalg/bunch_kaufman.h"
#include "linalg/dense.h"
#include "linalg/equilibrate.h"
#include "linalg/saddle.h"

#include <float.h>
#include <math.h>
#include <string.h>

// of the equilibrated matrix, whose entries are about 1 (within a factor of four)
static const double PIVOT_TOL = 1e-13;
// The shift of the proximal matrix against J M^-1 J', which is about 1 after scaling: a turn gains
// shift / eigenvalue. The first
// serves in two or three turns; where light and heavy bodies meet, eigenvalues are small too and a
// smaller one is taken, at the price of rounding / shift in multipliers that make no force.
static const double PROXIMAL_SHIFTS[] = {1e-6, 1e-9, 1e-12};
static const double PROXIMAL_TOL = 1e-14; // of the accelerations: what the last turn may still move
enum { MAX_TURNS = 12, N_SHIFTS = 3 };

struct hn_kkt {
    int nv_max, nc_max, nv, nc, n;
    hn_saddle_ws *saddle;
    hn_kkt_way way;
    hn_kkt_opts opts;
    double *K; // n x n, equilibrated, both triangles
    double *F; // n x n: factor of the dense and proximal ways; the range space keeps L and X in it
    double *S; // nc x nc: range space
    double *scale;            // n: D, then R
    int *pivot;               // n
    double shift;             // proximal
    double moved;             // the last correction against the solution
    double *b, *x, *r, *step; // n
};

hn_kkt_opts hn_kkt_opts_default(void) {
    const hn_saddle_opts saddle = hn_saddle_opts_default();
    return (hn_kkt_opts){
        .max_refine = 4, .rank_tol = saddle.rank_tol, .residual_tol = saddle.residual_tol};
}

hn_kkt *hn_kkt_create(hn_arena *arena, int nv, int nc) {
    hn_kkt *k = hn_arena_get(arena, sizeof *k);
    if (!k) {
        return NULL;
    }
    const size_t n = (size_t)nv + (size_t)nc;
    *k = (hn_kkt){.nv_max = nv, .nc_max = nc};
    k->saddle = hn_saddle_ws_create(arena, nv, nc);
    k->K = hn_arena_doubles(arena, n * n);
    k->F = hn_arena_doubles(arena, n * n);
    k->S = hn_arena_doubles(arena, (size_t)nc * (size_t)nc);
    k->pivot = hn_arena_ints(arena, n);
    double **of_n[] = {&k->scale, &k->b, &k->x, &k->r, &k->step};
    for (size_t i = 0; i < sizeof of_n / sizeof *of_n; i++) {
        *of_n[i] = hn_arena_doubles(arena, n);
    }
    return k->saddle && !hn_arena_failed(arena) ? k : NULL;
}

// ---- equilibration ----

/// The power of two next below 1 / size: scaling with it rounds nothing, so that refinement meets
/// the very system it was given.
static double reciprocal(double size) {
    return ldexp(1, -ilogb(size));
}

/// D = diag(M)^-1/2; a massless coordinate is scaled by what the rows see of it. *massless: the
/// last such coordinate, -1 where there is none. Fails: HN_ERR_NOT_SPD.
static hn_status scale_coordinates(hn_kkt *k, const double *M, const double *J, int *massless) {
    double heaviest;
    HN_TRY(hn_heaviest_mass(k->nv, M, &heaviest));
    *massless = -1;
    for (int j = 0; j < k->nv; j++) {
        const double m = M[(size_t)j * (size_t)k->nv + (size_t)j];
        if (!hn_is_massless(m, heaviest)) {
            k->scale[j] = reciprocal(sqrt(m));
            continue;
        }
        const double seen = hn_column_size(k->nv, k->nc, J, j);
        k->scale[j] = seen > 0 ? reciprocal(seen) : 1;
        *massless = j;
    }
    return HN_OK;
}

static void scale_rows(hn_kkt *k, const double *J) {
    for (int i = 0; i < k->nc; i++) {
        double sum = 0;
        for (int j = 0; j < k->nv; j++) {
            const double e = J[(size_t)i * (size_t)k->nv + (size_t)j] * k->scale[j];
            sum += e * e;
        }
        k->scale[k->nv + i] = sum > 0 ? reciprocal(sqrt(sum)) : 1;
    }
}

static void fill(hn_kkt *k, const double *M, const double *J) {
    const size_t n = (size_t)k->n, nv = (size_t)k->nv;
    memset(k->K, 0, n * n * sizeof *k->K);
    for (size_t i = 0; i < nv; i++) {
        for (size_t j = 0; j <= i; j++) {
            k->K[i * n + j] = k->K[j * n + i] = M[i * nv + j] * k->scale[i] * k->scale[j];
        }
    }
    for (size_t i = 0; i < (size_t)k->nc; i++) {
        for (size_t j = 0; j < nv; j++) {
            k->K[(nv + i) * n + j] = k->K[j * n + nv + i] =
                J[i * nv + j] * k->scale[nv + i] * k->scale[j];
        }
    }
}

// ---- factors ----

static hn_status factor_symmetric(hn_kkt *k, double shift) {
    const size_t n = (size_t)k->n;
    int negative = 0;
    memcpy(k->F, k->K, n * n * sizeof *k->F);
    for (size_t i = (size_t)k->nv; i < n; i++) {
        k->F[i * n + i] -= shift;
    }
    HN_TRY(hn_bunch_kaufman(k->n, k->F, k->pivot, PIVOT_TOL, &negative));
    return negative == k->nc ? HN_OK
                             : HN_ERR_NOT_SPD; // one for each row, or M is not definite on ker J
}

/// L in the first nv rows and columns of F, X = L^-1 J' transposed in the rows below, S = X' X =
/// its Cholesky factor.
static hn_status factor_range(hn_kkt *k) {
    const size_t n = (size_t)k->n, nv = (size_t)k->nv, nc = (size_t)k->nc;
    memcpy(k->F, k->K, n * n * sizeof *k->F);
    hn_status status = hn_cholesky(k->nv, k->F, k->n, PIVOT_TOL);
    for (size_t i = 0; i < nc && status == HN_OK; i++) {
        double *row = k->F + (nv + i) * n;
        hn_lower_solve(k->nv, k->F, k->n, row);
        for (size_t j = 0; j <= i; j++) {
            k->S[i * nc + j] = hn_dot(k->nv, row, k->F + (nv + j) * n);
        }
    }
    return status == HN_OK ? hn_cholesky(k->nc, k->S, k->nc, PIVOT_TOL) : status;
}

static hn_status factor(hn_kkt *k) {
    switch (k->way) {
    case HN_KKT_DENSE:
        return factor_symmetric(k, 0);
    case HN_KKT_PROXIMAL:
        return factor_symmetric(k, k->shift);
    default:
        return factor_range(k);
    }
}

/// x (n) <- F^-1 x for the scaled unknowns [a; -lambda].
static void solve(hn_kkt *k, double *x) {
    const size_t n = (size_t)k->n, nv = (size_t)k->nv;
    if (k->way != HN_KKT_RANGE_SPACE) {
        hn_bunch_kaufman_solve(k->n, k->F, k->pivot, x);
        return;
    }
    // y = L^-1 f;  S (-lambda) = X' y - g;  a = L^-T (y - X (-lambda))
    double *y = x, *g = x + nv;
    hn_lower_solve(k->nv, k->F, k->n, y);
    for (int i = 0; i < k->nc; i++) {
        g[i] = hn_dot(k->nv, k->F + (nv + (size_t)i) * n, y) - g[i];
    }
    hn_cholesky_solve(k->nc, k->S, k->nc, g);
    for (int i = 0; i < k->nc; i++) {
        hn_axpy(k->nv, -g[i], k->F + (nv + (size_t)i) * n, y);
    }
    hn_lower_t_solve(k->nv, k->F, k->n, y);
}

// ---- refinement and condition ----

/// r = b - K x in twice the precision.
static void find_residual(hn_kkt *k) {
    const size_t n = (size_t)k->n;
    for (size_t i = 0; i < n; i++) {
        hn_sum2 sum = {k->b[i], 0};
        for (size_t j = 0; j < n; j++) {
            hn_sum2_add_product(&sum, -k->K[i * n + j], k->x[j]);
        }
        k->r[i] = hn_sum2_value(&sum);
    }
}

/// Corrections x += F^-1 (b - K x) while they halve. With the proximal F this is the proximal
/// iteration itself.
static int refine(hn_kkt *k, int max) {
    double last = HUGE_VAL;
    int kept = 0;
    while (kept < max) {
        find_residual(k);
        memcpy(k->step, k->r, (size_t)k->n * sizeof *k->step);
        solve(k, k->step);

        // contradictory rows make multipliers grow for ever; the accelerations settle. If forces
        // cancel in them they are known to the rounding of these
        const int proximal = k->way == HN_KKT_PROXIMAL, judged = proximal ? k->nv : k->n;
        const double cancelled = proximal ? hn_norm_max(k->n, k->b) : 0,
                     size = fmax(cancelled, hn_norm_max(judged, k->x)),
                     moved = hn_norm_max(judged, k->step);
        k->moved = size > 0 ? moved / size : 0;

        if (!(moved > 2 * DBL_EPSILON * size) || !(moved < 0.5 * last)) {
            break;
        }
        hn_axpy(k->n, 1, k->step, k->x);
        last = moved;
        kept++;
    }
    return kept;
}

static double norm_of_columns(const hn_kkt *k) {
    const size_t n = (size_t)k->n;
    double worst = 0;
    for (size_t j = 0; j < n; j++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) {
            sum += fabs(k->K[i * n + j]);
        }
        worst = fmax(worst, sum);
    }
    return worst;
}

/// |K|_1 times Hager's lower bound of |K^-1|_1; K is symmetric. Uses step as scratch.
static double estimate_condition(hn_kkt *k) {
    double *x = k->step, bound = 0;
    int last = -1;
    for (int i = 0; i < k->n; i++) {
        x[i] = 1.0 / k->n;
    }

    // Hager's method: 1-norm of the inverse by solves
    for (int turn = 0; turn < 5; turn++) {
        double size = 0;
        int best = 0;
        solve(k, x);
        for (int i = 0; i < k->n; i++) {
            size += fabs(x[i]);
            x[i] = x[i] < 0 ? -1 : 1;
        }
        if (size <= bound) {
            break;
        }

        // the unit vector that promises most comes next
        bound = size;
        solve(k, x);
        for (int i = 1; i < k->n; i++) {
            best = fabs(x[i]) > fabs(x[best]) ? i : best;
        }
        if (best == last) {
            break;
        }
        last = best;
        memset(x, 0, (size_t)k->n * sizeof *x);
        x[best] = 1;
    }
    return bound * norm_of_columns(k);
}

// ---- the door ----

static hn_status solve_by_saddle(hn_kkt *k, const double *M, const double *J, const double *f,
                                 const double *gamma, double *a, double *lambda,
                                 hn_kkt_info *info) {
    hn_saddle_opts opts = hn_saddle_opts_default();
    hn_saddle_info saddle = {0};
    opts.rank_tol = k->opts.rank_tol;
    opts.residual_tol = k->opts.residual_tol;
    opts.noise = k->opts.noise;
    opts.motion = k->opts.motion;
    opts.row_floor = k->opts.row_floor;
    opts.row_unit = k->opts.row_unit;
    opts.max_refine = k->opts.max_refine;
    opts.want_cond = k->opts.want_cond;
    hn_status status = hn_saddle_factor(k->nv, k->nc, M, J, &saddle, &opts, k->saddle);
    info->rank = saddle.rank;
    if (status == HN_OK && k->way == HN_KKT_NULL_SPACE && saddle.rank < k->nc) {
        status = HN_ERR_SINGULAR;
    }
    HN_THEN(status, hn_saddle_apply(f, gamma, a, lambda, &saddle, k->saddle));
    info->residual = saddle.residual;
    info->refinements = saddle.refinements;
    info->cond = saddle.cond;
    return status;
}

static void give_back(const hn_kkt *k, const double *J, const double *gamma, double *a,
                      double *lambda, hn_kkt_info *info) {
    for (int j = 0; j < k->nv; j++) {
        a[j] = k->scale[j] * k->x[j];
    }
    for (int i = 0; i < k->nc; i++) {
        const double rest = hn_dot(k->nv, J + (size_t)i * (size_t)k->nv, a) + gamma[i];
        info->residual = fmax(info->residual, fabs(rest));
        if (lambda) {
            lambda[i] = -k->scale[k->nv + i] * k->x[k->nv + i];
        }
    }
}

static hn_status solve_once(hn_kkt *k, int max_refine, hn_kkt_info *info) {
    HN_TRY(factor(k));
    memcpy(k->x, k->b, (size_t)k->n * sizeof *k->x);
    solve(k, k->x);
    info->refinements += refine(k, max_refine);
    return HN_OK;
}

static hn_status solve_proximal(hn_kkt *k, hn_kkt_info *info) {
    hn_status status = HN_ERR_NO_CONVERGENCE;
    for (int i = 0; i < N_SHIFTS; i++) {
        k->shift = PROXIMAL_SHIFTS[i];
        status = solve_once(k, MAX_TURNS, info);
        if (status != HN_OK || k->moved <= PROXIMAL_TOL) {
            return status;
        }
    }
    return HN_ERR_NO_CONVERGENCE;
}

static hn_status solve_equilibrated(hn_kkt *k, const double *M, const double *J, const double *f,
                                    const double *gamma, double *a, double *lambda,
                                    hn_kkt_info *info) {
    int massless;
    HN_TRY(scale_coordinates(k, M, J, &massless));
    if (massless >= 0 && k->way == HN_KKT_RANGE_SPACE) {
        info->massless = massless;
        return HN_ERR_SINGULAR;
    }
    scale_rows(k, J);
    fill(k, M, J);
    for (int i = 0; i < k->n; i++) {
        k->b[i] = k->scale[i] * (i < k->nv ? f[i] : -gamma[i - k->nv]);
    }
    HN_TRY(k->way == HN_KKT_PROXIMAL ? solve_proximal(k, info)
                                     : solve_once(k, k->opts.max_refine, info));
    if (k->opts.want_cond) {
        info->cond = estimate_condition(k);
    }
    if (!hn_all_finite(k->n, k->x)) {
        return HN_ERR_SINGULAR;
    }
    give_back(k, J, gamma, a, lambda, info);
    return HN_OK;
}

hn_status hn_kkt_solve(hn_kkt *k, hn_kkt_way way, int nv, int nc, const double *M, const double *J,
                       const double *f, const double *gamma, double *a, double *lambda,
                       hn_kkt_info *info, const hn_kkt_opts *opts) {
    hn_kkt_info own;
    HN_ASSERT(nv <= k->nv_max && nc <= k->nc_max);
    info = info ? info : &own;
    *info = (hn_kkt_info){.rank = nc, .massless = -1};
    k->nv = nv;
    k->nc = nc;
    k->n = nv + nc;
    k->way = way;
    k->opts = opts ? *opts : hn_kkt_opts_default();
    if (!hn_all_finite(nv, f) || !hn_all_finite(nc, gamma) || !hn_all_finite(nv * nv, M) ||
        !hn_all_finite(nv * nc, J)) {
        return HN_ERR_DIVERGED;
    }
    return way == HN_KKT_NULL_SPACE || way == HN_KKT_LEAST_NORM
               ? solve_by_saddle(k, M, J, f, gamma, a, lambda, info)
               : solve_equilibrated(k, M, J, f, gamma, a, lambda, info);
}
