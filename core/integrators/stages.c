#include "integrators/stages.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_TO_TOLERANCE = 10, MOST_TO_ROUNDING = 40 };
#define ROUNDING 1e-14     // of the scale: corrections at or below are rounding
#define NEAR_ROUNDING 1e-9 // corrections below, that no longer shrink, are what rounding leaves
#define STALLED 0.3
#define HOPELESS 2 // corrections that grow by this twice in a row

hn_status hn_stages_init(hn_stages *nw, const hn_collocation *col, const hn_stage_equations *eq,
                         hn_arena *arena) {
    const size_t s = (size_t)col->stages, n = (size_t)(eq->n_diff + eq->n_alg);
    *nw = (hn_stages){.col = *col, .eq = *eq, .n = (int)n};
    nw->u = hn_arena_doubles(arena, s * n);
    nw->rate = hn_arena_doubles(arena, s * (size_t)eq->n_diff);
    nw->r = hn_arena_doubles(arena, s * n);
    nw->parts = hn_arena_doubles(arena, s * n);
    nw->scale = hn_arena_doubles(arena, (size_t)eq->n_diff);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static double *stage_of(double *u, int i, int n) {
    return u + (size_t)i * (size_t)n;
}

// out_i = sum_j W_ij in_j over stages
static void combine(const hn_stages *nw, double (*W)[HN_IMPLICIT_STAGES], const double *in,
                    double *out) {
    const int s = nw->col.stages, n = nw->n;
    for (int i = 0; i < s; i++) {
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int j = 0; j < s; j++) {
                sum += W[i][j] * in[j * n + k];
            }
            out[i * n + k] = sum;
        }
    }
}

static void find_rates(hn_stages *nw, double h) {
    const int s = nw->col.stages, n = nw->n, nd = nw->eq.n_diff;
    for (int i = 0; i < s; i++) {
        for (int k = 0; k < nd; k++) {
            double sum = 0;
            for (int j = 0; j < s; j++) {
                sum += nw->col.A_inverse[i][j] * nw->u[j * n + k];
            }
            nw->rate[i * nd + k] = sum / h;
        }
    }
}

static hn_status factor(hn_stages *nw, double t, double h) {
    const hn_collocation *col = &nw->col;
    hn_status status = HN_OK;
    if (col->n_real) {
        status = nw->eq.factor(nw->eq.self, 0, col->gamma / h, 0);
    }
    if (status == HN_OK && col->n_pairs) {
        status = nw->eq.factor(nw->eq.self, 1, col->alpha / h, -col->beta / h);
    }
    nw->factorisations += col->n_real + col->n_pairs;
    if (status != HN_OK) {
        snprintf(nw->why, sizeof nw->why, "Newton's matrix at t = %.6g s, step %.3g s: %s", t, h,
                 hn_status_text(status));
    }
    return status;
}

static hn_status residuals(hn_stages *nw, double t, double h) {
    find_rates(nw, h);
    for (int i = 0; i < nw->col.stages; i++) {
        const hn_status status =
            nw->eq.residual(nw->eq.self, i, t + nw->col.c[i] * h, stage_of(nw->u, i, nw->n),
                            nw->rate + i * nw->eq.n_diff, stage_of(nw->r, i, nw->n));
        nw->residuals++;
        if (status != HN_OK) {
            nw->why[0] = '\0'; // the equations have their own reason
            return status;
        }
    }
    return HN_OK;
}

// u += correction; returns its size
static double correct(hn_stages *nw) {
    const int s = nw->col.stages, n = nw->n, nd = nw->eq.n_diff;
    combine(nw, nw->col.T_inverse, nw->r, nw->parts);
    for (int block = 0; block < nw->col.n_real + nw->col.n_pairs; block++) {
        const int real = block < nw->col.n_real;
        double *first = stage_of(nw->parts, block, n);
        nw->eq.solve(nw->eq.self, (hn_parts){real ? 1 : 2, {first, real ? NULL : first + n}});
        nw->solves++;
    }
    combine(nw, nw->col.T, nw->parts, nw->r);
    hn_axpy(s * n, 1, nw->r, nw->u);
    double worst = 0;
    for (int i = 0; i < s; i++) {
        double sum = 0;
        for (int k = 0; k < nd; k++) {
            const double d = nw->r[i * n + k] / nw->scale[k];
            sum += d * d;
        }
        const double size = nd > 0 ? sqrt(sum / nd) : 0;
        worst = size > worst || !isfinite(size) ? size : worst;
    }
    return worst;
}

static hn_status give_up(hn_stages *nw, double t, double h, int n, double ratio) {
    if (ratio < 1) {
        snprintf(nw->why, sizeof nw->why,
                 "Newton's method at t = %.6g s: after %d iterations each correction is still %.2g "
                 "of the one before; the step of %.3g s is too large",
                 t, n, ratio, h);
    } else {
        snprintf(nw->why, sizeof nw->why,
                 "Newton's method at t = %.6g s: corrections grow; the step of %.3g s is too large",
                 t, h);
    }
    return HN_ERR_NO_CONVERGENCE;
}

// 1 when what is left is below the tolerance, or is rounding
static int is_done(const hn_stages *nw, double size, double ratio) {
    if (size <= ROUNDING) {
        return 1;
    }
    if (nw->tol > 0 && ratio < 1) {
        return ratio / (1 - ratio) * size <= nw->tol;
    }
    return nw->tol <= 0 && ratio > STALLED && size <= NEAR_ROUNDING;
}

hn_status hn_stages_solve(hn_stages *nw, double t, double h) {
    const int most = nw->tol > 0 ? MOST_TO_TOLERANCE : MOST_TO_ROUNDING;
    double last = 0, ratio = HUGE_VAL;
    int grown = 0;
    nw->why[0] = '\0';
    hn_status status = factor(nw, t, h);
    for (int k = 1; status == HN_OK && k <= most; k++) {
        status = residuals(nw, t, h);
        if (status != HN_OK) {
            return status;
        }
        const double size = correct(nw);
        nw->iterations++;
        if (!isfinite(size)) {
            return give_up(nw, t, h, k, HUGE_VAL);
        }
        ratio = k > 1 ? size / last : size <= ROUNDING ? 0 : HUGE_VAL;
        if (is_done(nw, size, ratio)) {
            find_rates(nw, h);
            return HN_OK;
        }
        grown = k > 1 && ratio >= HOPELESS ? grown + 1 : 0;
        if (grown == 2) {
            break;
        }
        last = size;
    }
    return status == HN_OK ? give_up(nw, t, h, most, ratio) : status;
}

static void weigh(const hn_stages *nw, const double *w, double *z) {
    for (int k = 0; k < nw->eq.n_diff; k++) {
        double sum = 0;
        for (int i = 0; i < nw->col.stages; i++) {
            sum += w[i] * nw->u[i * nw->n + k];
        }
        z[k] = sum;
    }
}

void hn_stages_end(const hn_stages *nw, double *z) {
    weigh(nw, nw->col.end, z);
}

void hn_stages_dense(const hn_stages *nw, double theta, double *z) {
    double w[HN_IMPLICIT_STAGES];
    hn_collocation_dense(&nw->col, theta, w);
    weigh(nw, w, z);
}
