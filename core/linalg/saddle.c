// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/saddle.h"

#include "linalg/dense.h"
#include "linalg/equilibrate.h"
#include "linalg/qr.h"
#include "linalg/reflector.h"

#include <float.h>
#include <math.h>
#include <string.h>

// a scaled mass pivot counts as zero at or below this times nv
static const double MASS_TOL = 16 * DBL_EPSILON;

struct hn_saddle_ws {
    int nv_max, nc_max;
    int nv, nc;
    hn_saddle_opts opts;
    double *M, *J;  // copies, M with both triangles: refinement needs the unscaled system
    double *d, *r;  // equilibration: D of the coordinates, R of the rows
    double stretch; // how much longer R makes the shortest row, against the longest
    hn_qr qr;       // of (R J D)', nv x nc
    // Q' D M D Q, nv x nv; the lower triangle of its last block is replaced by its Cholesky factor
    double *T;
    hn_qr kernel;                  // orthonormal basis of ker J', nc x (nc - rank)
    hn_qr scaled_kernel;           // the same for R J D
    double *fs, *gs, *lam1, *work; // scratch of one solve: nv, nc, nc, nv
    double *a, *lambda;            // the iterate
    double *da, *dlambda;          // its correction
    double *r1, *r2;               // residuals of the two block rows of (1)
    double *b1, *b2;               // sizes |K| |x| + |b| of each row
};

hn_saddle_opts hn_saddle_opts_default(void) {
    return (hn_saddle_opts){
        .rank_tol = 1e-10, .residual_tol = 1e-8, .refine_tol = 2 * DBL_EPSILON, .max_refine = 4};
}

hn_saddle_ws *hn_saddle_ws_create(hn_arena *arena, int nv, int nc) {
    HN_ASSERT(nv >= 0 && nc >= 0);
    hn_saddle_ws *ws = hn_arena_get(arena, sizeof *ws);
    if (!ws) {
        return NULL;
    }
    size_t v = (size_t)nv, c = (size_t)nc;
    *ws = (hn_saddle_ws){.nv_max = nv, .nc_max = nc};
    ws->M = hn_arena_doubles(arena, v * v);
    ws->T = hn_arena_doubles(arena, v * v);
    ws->J = hn_arena_doubles(arena, c * v);
    double **of_nv[] = {&ws->d, &ws->fs, &ws->work, &ws->a, &ws->da, &ws->r1, &ws->b1};
    double **of_nc[] = {&ws->r, &ws->gs, &ws->lam1, &ws->lambda, &ws->dlambda, &ws->r2, &ws->b2};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, v);
        *of_nc[i] = hn_arena_doubles(arena, c);
    }
    int got = hn_qr_init(&ws->qr, arena, nv, nc) && hn_qr_init(&ws->kernel, arena, nc, nc) &&
              hn_qr_init(&ws->scaled_kernel, arena, nc, nc);
    return got && !hn_arena_failed(arena) ? ws : NULL;
}

// ---- factorisation ----

static int inputs_finite(int nv, int nc, const double *M, const double *J) {
    for (int i = 0; i < nv; i++) {
        if (!hn_all_finite(i + 1, M + (size_t)i * nv)) {
            return 0;
        }
    }
    return hn_all_finite(nc * nv, J);
}

/// D = diag(M)^-1/2. A massless coordinate is scaled so that the constraints see it as much as the
/// best seen massive one.
static hn_status scale_coordinates(hn_saddle_ws *ws) {
    int nv = ws->nv;
    double heaviest;
    HN_TRY(hn_heaviest_mass(nv, ws->M, &heaviest));

    // massless ones, scaled by what the constraints see of the others
    double seen = 0;
    for (int j = 0; j < nv; j++) {
        double m = ws->M[(size_t)j * nv + j];
        ws->d[j] = hn_is_massless(m, heaviest) ? 0 : 1 / sqrt(m);
        seen = fmax(seen, ws->d[j] * hn_column_size(nv, ws->nc, ws->J, j));
    }
    for (int j = 0; j < nv; j++) {
        if (ws->d[j] == 0) {
            double size = hn_column_size(nv, ws->nc, ws->J, j);
            ws->d[j] = size > 0 ? (seen > 0 ? seen : 1) / size : 1;
        }
    }
    return HN_OK;
}

static double row_unit(const hn_saddle_ws *ws, int i) {
    return ws->opts.row_unit ? ws->opts.row_unit[i] : 1;
}

/// R makes every row of J D of unit length, short ones less (row_floor); qr.a receives (R J D)'
/// (whose columns are the rows of J).
static void scale_rows(hn_saddle_ws *ws) {
    int nv = ws->nv;
    double longest = 0;

    // the rows of J D and their lengths
    for (int i = 0; i < ws->nc; i++) {
        const double *row = ws->J + (size_t)i * nv;
        double *col = ws->qr.a + (size_t)i * nv;
        for (int j = 0; j < nv; j++) {
            col[j] = row[j] * ws->d[j];
        }
        ws->r[i] = hn_norm2(nv, col);
        longest = fmax(longest, ws->r[i] / row_unit(ws, i));
    }

    // each stretched to length 1, but no further than its floor allows
    ws->stretch = 1;
    for (int i = 0; i < ws->nc; i++) {
        double norm = fmax(ws->r[i], ws->opts.row_floor * longest * row_unit(ws, i));
        ws->r[i] = norm > 0 ? 1 / norm : 1;
        ws->stretch = fmax(ws->stretch, longest * row_unit(ws, i) * ws->r[i]);
        for (int j = 0; j < nv; j++) {
            ws->qr.a[(size_t)i * nv + j] *= ws->r[i];
        }
    }
}

/// T = Q' D M D Q, and the Cholesky factor of its last block: the mass that the rows of J do not
/// see.
static hn_status factor_kernel_mass(hn_saddle_ws *ws) {
    int nv = ws->nv, rank = ws->qr.rank;
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            ws->T[(size_t)i * nv + j] = ws->d[i] * ws->M[(size_t)i * nv + j] * ws->d[j];
        }
    }
    for (int k = 0; k < rank; k++) {
        const int *rows, n = hn_qr_reflector(&ws->qr, k, &rows);
        const double tau = ws->qr.tau[k], *below = ws->qr.a + (size_t)k * nv;
        if (hn_qr_is_sparse(&ws->qr, k, n)) {
            hn_reflect_listed(nv, k, tau, below, n, rows, ws->T, ws->work, ws->fs);
        } else {
            hn_reflect_both_sides(nv, k, tau, below, ws->T, ws->work, ws->fs);
        }
    }
    return hn_cholesky(nv - rank, ws->T + (size_t)rank * nv + rank, nv, MASS_TOL * nv);
}

/// Orthonormal bases of the multipliers that make no force: columns P [-R11^-1 R12; I] of ker (R J
/// D)', and R times them.
static void factor_kernels(hn_saddle_ws *ws) {
    int nc = ws->nc, rank = ws->qr.rank, extra = nc - rank;
    for (int k = 0; k < extra; k++) {
        double *col = ws->scaled_kernel.a + (size_t)k * nc, *plain = ws->kernel.a + (size_t)k * nc;
        memcpy(ws->lam1, ws->qr.a + (size_t)(rank + k) * ws->nv, (size_t)rank * sizeof *col);
        hn_qr_solve_r(&ws->qr, ws->lam1);
        memset(col, 0, (size_t)nc * sizeof *col);
        for (int i = 0; i < rank; i++) {
            col[ws->qr.perm[i]] = -ws->lam1[i];
        }
        col[ws->qr.perm[rank + k]] = 1;
        for (int i = 0; i < nc; i++) {
            plain[i] = ws->r[i] * col[i];
        }
    }
    // both bases have full column rank by construction
    hn_qr_factor(&ws->kernel, nc, extra, 0);
    hn_qr_factor(&ws->scaled_kernel, nc, extra, 0);
}

static double estimate_condition(hn_saddle_ws *ws);

hn_status hn_saddle_factor(int nv, int nc, const double *M, const double *J, hn_saddle_info *info,
                           const hn_saddle_opts *opts, hn_saddle_ws *ws) {
    HN_ASSERT(ws && nv >= 0 && nc >= 0 && nv <= ws->nv_max && nc <= ws->nc_max);
    ws->opts = opts ? *opts : hn_saddle_opts_default();
    if (!inputs_finite(nv, nc, M, J)) {
        return HN_ERR_DIVERGED;
    }

    // copies, since refinement needs the matrices as they came
    ws->nv = nv;
    ws->nc = nc;
    memcpy(ws->M, M, (size_t)nv * nv * sizeof *M);
    memcpy(ws->J, J, (size_t)nc * nv * sizeof *J);
    hn_mirror_lower(nv, ws->M);

    HN_TRY(scale_coordinates(ws));

    // rank from J, then the mass on its kernel
    scale_rows(ws);
    hn_qr_factor(&ws->qr, nv, nc, fmax(ws->opts.rank_tol, 1e3 * DBL_EPSILON * (nv > nc ? nv : nc)));
    if (info) {
        *info = (hn_saddle_info){.rank = ws->qr.rank,
                                 .pivot_ratio = hn_qr_pivot_ratio(&ws->qr),
                                 .dropped = ws->qr.dropped};
    }
    HN_TRY(factor_kernel_mass(ws));
    factor_kernels(ws);
    if (info && ws->opts.want_cond) {
        info->cond = estimate_condition(ws);
    }
    return HN_OK;
}

// ---- one solve with the factor ----

/// Equations (2) for scaled right-hand sides: fs (nv), gs (nc, in range of R J D) -> a_s in fs,
/// lambda_1 in lam1 (rank).
static void solve_scaled(hn_saddle_ws *ws) {
    int nv = ws->nv, rank = ws->qr.rank, rest = nv - rank;
    const double *T = ws->T;
    double *x = ws->work; // [y; z]
    hn_qr_apply_qt(&ws->qr, ws->fs);

    for (int i = 0; i < rank; i++) {
        x[i] = -ws->gs[ws->qr.perm[i]];
    }
    hn_qr_solve_rt(&ws->qr, x);
    for (int i = rank; i < nv; i++) {
        x[i] = ws->fs[i] - hn_dot(rank, T + (size_t)i * nv, x);
    }
    hn_cholesky_solve(rest, T + (size_t)rank * nv + rank, nv, x + rank);

    // the upper triangle of T's last block is untouched, and so are T11 and T12
    for (int i = 0; i < rank; i++) {
        ws->lam1[i] = hn_dot(nv, T + (size_t)i * nv, x) - ws->fs[i];
    }
    hn_qr_solve_r(&ws->qr, ws->lam1);
    memcpy(ws->fs, x, (size_t)nv * sizeof *x);
    hn_qr_apply_q(&ws->qr, ws->fs);
}

/// One unrefined solve of (1). Returns how far gamma stands outside range J, in scaled rows.
static double solve_once(hn_saddle_ws *ws, const double *f, const double *gamma, double *a,
                         double *lambda) {
    int nv = ws->nv, nc = ws->nc, rank = ws->qr.rank;

    // scaled right-hand sides, gamma without what no acceleration can meet
    for (int j = 0; j < nv; j++) {
        ws->fs[j] = ws->d[j] * f[j];
    }
    for (int i = 0; i < nc; i++) {
        ws->gs[i] = ws->r[i] * gamma[i];
    }
    double outside = rank < nc ? hn_qr_remove_range(&ws->scaled_kernel, ws->gs) : 0;
    solve_scaled(ws);

    // back to the user's units
    for (int j = 0; j < nv; j++) {
        a[j] = ws->d[j] * ws->fs[j];
    }
    memset(lambda, 0, (size_t)nc * sizeof *lambda);
    for (int i = 0; i < rank; i++) {
        int row = ws->qr.perm[i];
        lambda[row] = ws->r[row] * ws->lam1[i];
    }
    if (rank < nc) {
        (void)hn_qr_remove_range(&ws->kernel, lambda);
    }
    return outside;
}

/// The scale that decides whether rows contradict each other: gamma, J a and f in equilibrated
/// units, which are all alike.
static double consistency_scale(const hn_saddle_ws *ws, const double *f, const double *gamma) {
    double scale = ws->opts.motion, of_ja = 0;
    for (int j = 0; j < ws->nv; j++) {
        scale = fmax(scale, fabs(ws->d[j] * f[j]));
        of_ja = fmax(of_ja, fabs(ws->a[j] / ws->d[j]));
    }
    for (int i = 0; i < ws->nc; i++) {
        scale = fmax(scale, fabs(ws->r[i] * gamma[i]));
    }
    return scale + of_ja;
}

// ---- refinement ----

/// Residual of the force rows: r1 = f - M a + J' lambda, and b1 its size, row by row, in twice the
/// precision.
static void force_residual(hn_saddle_ws *ws, const double *f) {
    int nv = ws->nv, nc = ws->nc;
    for (int i = 0; i < nv; i++) {
        const double *row = ws->M + (size_t)i * nv;
        hn_sum2 sum = {f[i], 0};
        double size = fabs(f[i]);
        for (int j = 0; j < nv; j++) {
            hn_sum2_add_product(&sum, -row[j], ws->a[j]);
            size += fabs(row[j] * ws->a[j]);
        }
        for (int k = 0; k < nc; k++) {
            double entry = ws->J[(size_t)k * nv + i];
            hn_sum2_add_product(&sum, entry, ws->lambda[k]);
            size += fabs(entry * ws->lambda[k]);
        }
        ws->r1[i] = hn_sum2_value(&sum);
        ws->b1[i] = size;
    }
}

/// Residual of the constraint rows: r2 = gamma + J a.
static void row_residual(hn_saddle_ws *ws, const double *gamma) {
    for (int i = 0; i < ws->nc; i++) {
        const double *row = ws->J + (size_t)i * ws->nv;
        hn_sum2 sum = {gamma[i], 0};
        double size = fabs(gamma[i]);
        for (int j = 0; j < ws->nv; j++) {
            hn_sum2_add_product(&sum, row[j], ws->a[j]);
            size += fabs(row[j] * ws->a[j]);
        }
        ws->r2[i] = hn_sum2_value(&sum);
        ws->b2[i] = size;
    }
}

/// Largest residual of a row relative to its size. Rows that cannot be met (gamma's part outside
/// range J) do not count.
static double backward_error(hn_saddle_ws *ws) {
    double worst = 0;
    for (int i = 0; i < ws->nv; i++) {
        if (ws->r1[i] != 0) {
            worst = fmax(worst, fabs(ws->r1[i]) / ws->b1[i]);
        }
    }
    if (ws->qr.rank == ws->nc) {
        for (int i = 0; i < ws->nc; i++) {
            if (ws->r2[i] != 0) {
                worst = fmax(worst, fabs(ws->r2[i]) / ws->b2[i]);
            }
        }
        return worst;
    }

    // dependent rows: only what lies in the range of J can be met
    double size = 0;
    for (int i = 0; i < ws->nc; i++) {
        ws->gs[i] = ws->r[i] * ws->r2[i];
        size = fmax(size, ws->r[i] * ws->b2[i]);
    }
    (void)hn_qr_remove_range(&ws->scaled_kernel, ws->gs);
    double left = hn_norm_max(ws->nc, ws->gs);
    return left > 0 ? fmax(worst, left / size) : worst;
}

static double measure(hn_saddle_ws *ws, const double *f, const double *gamma) {
    force_residual(ws, f);
    row_residual(ws, gamma);
    return backward_error(ws);
}

/// Largest entry of a scaled vector: accelerations by 1/d, multipliers by 1/r, which gives both the
/// same unit.
static double scaled_size(int n, const double *x, const double *scale) {
    double size = 0;
    for (int i = 0; i < n; i++) {
        size = fmax(size, fabs(x[i] / scale[i]));
    }
    return size;
}

/// Corrections while they pay. The residual is exact to working precision, so they converge to the
/// solution itself, not only to a small backward error; one that is not half its predecessor is
/// rounding, and is not applied.
static int refine(hn_saddle_ws *ws, const double *f, const double *gamma, double *error) {
    double tol = ws->opts.refine_tol, last_a = HUGE_VAL, last_l = HUGE_VAL;
    int kept = 0;
    while (kept < ws->opts.max_refine) {
        (void)solve_once(ws, ws->r1, ws->r2, ws->da, ws->dlambda);
        double size_a = scaled_size(ws->nv, ws->a, ws->d),
               step_a = scaled_size(ws->nv, ws->da, ws->d);
        double size_l = scaled_size(ws->nc, ws->lambda, ws->r),
               step_l = scaled_size(ws->nc, ws->dlambda, ws->r);

        // a correction is worth applying, converges, and is small
        int moves = step_a > tol * size_a || step_l > tol * size_l;
        int shrinks = step_a < 0.5 * last_a || step_l < 0.5 * last_l;
        int sane = fmax(step_a, step_l) <= 0.5 * (size_a + size_l);
        if (!moves || !shrinks || !sane) {
            break;
        }

        hn_axpy(ws->nv, 1, ws->da, ws->a);
        hn_axpy(ws->nc, 1, ws->dlambda, ws->lambda);
        *error = measure(ws, f, gamma);
        last_a = step_a;
        last_l = step_l;
        kept++;
    }
    return kept;
}

hn_status hn_saddle_apply(const double *f, const double *gamma, double *a, double *lambda,
                          hn_saddle_info *info, hn_saddle_ws *ws) {
    int nv = ws->nv, nc = ws->nc;
    if (!hn_all_finite(nv, f) || !hn_all_finite(nc, gamma)) {
        return HN_ERR_DIVERGED;
    }
    double outside = solve_once(ws, f, gamma, ws->a, ws->lambda);
    if (!hn_all_finite(nv, ws->a) || !hn_all_finite(nc, ws->lambda)) {
        return HN_ERR_SINGULAR;
    }
    double noise = ws->opts.noise * ws->stretch / hn_qr_pivot_ratio(&ws->qr);
    if (outside > fmax(ws->opts.residual_tol, noise) * consistency_scale(ws, f, gamma)) {
        return HN_ERR_INCONSISTENT;
    }

    // outputs are written only now, when nothing can fail any more
    double error = measure(ws, f, gamma);
    int refinements = refine(ws, f, gamma, &error);
    memcpy(a, ws->a, (size_t)nv * sizeof *a);
    if (lambda) {
        memcpy(lambda, ws->lambda, (size_t)nc * sizeof *lambda);
    }
    if (info) {
        info->residual = hn_norm_max(nc, ws->r2);
        info->backward_error = error;
        info->refinements = refinements;
    }
    return HN_OK;
}

hn_status hn_saddle_solve(int nv, int nc, const double *M, const double *J, const double *f,
                          const double *gamma, double *a, double *lambda, hn_saddle_info *info,
                          const hn_saddle_opts *opts, hn_saddle_ws *ws) {
    HN_ASSERT(ws && nv <= ws->nv_max && nc <= ws->nc_max);
    if (!hn_all_finite(nv, f) || !hn_all_finite(nc, gamma)) {
        return HN_ERR_DIVERGED;
    }
    HN_TRY(hn_saddle_factor(nv, nc, M, J, info, opts, ws));
    return hn_saddle_apply(f, gamma, a, lambda, info, ws);
}

// ---- condition ----

/// x <- K_s^-1 x for the equilibrated K on its kept rows (nv + rank entries), by one solve of the
/// scaled equations.
static void solve_equilibrated(hn_saddle_ws *ws, double *x1, double *x2) {
    int rank = ws->qr.rank;
    memcpy(ws->fs, x1, (size_t)ws->nv * sizeof *x1);
    for (int i = 0; i < rank; i++) {
        ws->gs[ws->qr.perm[i]] = -x2[i];
    }
    solve_scaled(ws);
    memcpy(x1, ws->fs, (size_t)ws->nv * sizeof *x1);
    for (int i = 0; i < rank; i++) {
        x2[i] = -ws->lam1[i];
    }
}

static double norm_equilibrated(const hn_saddle_ws *ws) {
    int nv = ws->nv, rank = ws->qr.rank;
    double worst = 0;

    // columns of M over those of J
    for (int j = 0; j < nv; j++) {
        double sum = 0;
        for (int i = 0; i < nv; i++) {
            sum += fabs(ws->d[i] * ws->M[(size_t)i * nv + j] * ws->d[j]);
        }
        for (int i = 0; i < rank; i++) {
            int row = ws->qr.perm[i];
            sum += fabs(ws->r[row] * ws->J[(size_t)row * nv + j] * ws->d[j]);
        }
        worst = fmax(worst, sum);
    }

    // columns of J'
    for (int i = 0; i < rank; i++) {
        int row = ws->qr.perm[i];
        double sum = 0;
        for (int j = 0; j < nv; j++) {
            sum += fabs(ws->r[row] * ws->J[(size_t)row * nv + j] * ws->d[j]);
        }
        worst = fmax(worst, sum);
    }
    return worst;
}

static double sum_abs(int n, const double *x) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += fabs(x[i]);
    }
    return sum;
}

/// |K_s|_1 times Hager's lower bound of |K_s^-1|_1 (Higham 1988, ACM TOMS 14, algorithm 674); K_s
/// is symmetric.
static double estimate_condition(hn_saddle_ws *ws) {
    int nv = ws->nv, rank = ws->qr.rank, n = nv + rank;
    double *x1 = ws->a, *x2 = ws->lambda, bound = 0;
    for (int i = 0; i < n; i++) {
        *(i < nv ? x1 + i : x2 + (i - nv)) = 1.0 / n;
    }

    int last = -1;
    for (int it = 0; it < 5; it++) {
        solve_equilibrated(ws, x1, x2);
        double size = sum_abs(nv, x1) + sum_abs(rank, x2);
        if (size <= bound) {
            break;
        }
        bound = size;

        // gradient of the norm: the signs, solved once more; its largest entry names the next unit
        // vector
        for (int i = 0; i < n; i++) {
            double *x = i < nv ? x1 + i : x2 + (i - nv);
            *x = *x < 0 ? -1 : 1;
        }
        solve_equilibrated(ws, x1, x2);
        int best = 0;
        double largest = -1;
        for (int i = 0; i < n; i++) {
            double *x = i < nv ? x1 + i : x2 + (i - nv);
            if (fabs(*x) > largest) {
                largest = fabs(*x);
                best = i;
            }
            *x = 0;
        }
        if (best == last) {
            break;
        }
        last = best;
        *(best < nv ? x1 + best : x2 + (best - nv)) = 1;
    }
    return bound * norm_equilibrated(ws);
}
