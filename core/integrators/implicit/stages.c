// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/stages.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MOST_TO_TOLERANCE = 10, MOST_TO_ROUNDING = 40, MOST_RELINEARISED = 6 };
// Corrections that no longer shrink are rounding when they are below this, else a reason to take
// the derivatives anew.
#define NEAR_ROUNDING 1e-9
#define STALLED 0.7
#define SLOW 0.3
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

    // one real or complex system per block of A^-1
    combine(nw, nw->col.T_inverse, nw->r, nw->parts);
    for (int block = 0; block < nw->col.n_real + nw->col.n_pairs; block++) {
        const int real = block < nw->col.n_real;
        double *first = stage_of(nw->parts, block, n);
        nw->eq.solve(nw->eq.self, (hn_parts){real ? 1 : 2, {first, real ? NULL : first + n}});
        nw->solves++;
    }

    // back to the stages
    combine(nw, nw->col.T, nw->parts, nw->r);
    hn_axpy(s * n, 1, nw->r, nw->u);

    // the largest correction of a stage in the error norm
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
                 "Newton's method at t = %.6g s converges too slowly: after %d iterations each "
                 "correction is %.2g times the one before; the step of %.3g s is too long for it",
                 t, n, ratio, h);
    } else {
        snprintf(
            nw->why, sizeof nw->why,
            "Newton's method at t = %.6g s does not converge: its corrections grow; the step of "
            "%.3g s is too long for it",
            t, h);
    }
    return HN_ERR_NO_CONVERGENCE;
}

/// The record of an iteration so far.
typedef struct progress {
    double size, ratio; ///< of the last correction, and against the one before
    double least;       ///< smallest correction so far
    int stalled, grown, relinearised;
} progress;

// 1 when what is left is below the tolerance, or is rounding
static bool is_done(const hn_stages *nw, const progress *p) {
    if (p->size <= nw->floor) {
        return true;
    }
    if (nw->tol > 0) {
        return p->ratio < 1 && p->ratio / (1 - p->ratio) * p->size <= nw->tol;
    }
    return p->stalled >= 2 && p->size <= NEAR_ROUNDING;
}

static void look(progress *p, double size, int first) {
    p->ratio = first ? HUGE_VAL : size / p->size;
    p->size = size;
    // rounding of stiff forces goes up and down at random: what counts is that it gets no smaller
    // than it has been
    p->stalled = !first && size > STALLED * p->least ? p->stalled + 1 : 0;
    p->least = first ? size : fmin(size, p->least);
    p->grown = !first && p->ratio >= HOPELESS && size > NEAR_ROUNDING ? p->grown + 1 : 0;
}

// on the way to rounding a slow iteration gets derivatives at the last stage it has
static hn_status help(hn_stages *nw, double t, double h, progress *p) {
    const int last = nw->col.stages - 1;
    if (nw->tol > 0 || !nw->eq.relinearise || !(p->ratio > SLOW) || isinf(p->ratio) ||
        p->size <= NEAR_ROUNDING || p->relinearised == MOST_RELINEARISED) {
        return HN_OK;
    }
    p->relinearised++;
    p->grown = 0;
    find_rates(nw, h);
    const hn_status status =
        nw->eq.relinearise(nw->eq.self, t + nw->col.c[last] * h, stage_of(nw->u, last, nw->n),
                           nw->rate + last * nw->eq.n_diff);
    return status == HN_OK ? factor(nw, t, h) : status;
}

hn_status hn_stages_solve(hn_stages *nw, double t, double h) {
    const int most = nw->tol > 0 ? MOST_TO_TOLERANCE : MOST_TO_ROUNDING;
    progress p = {0};
    nw->why[0] = '\0';

    hn_status status = factor(nw, t, h);

    // corrections until they are below the tolerance, or grow
    for (int k = 1; status == HN_OK && k <= most; k++) {
        status = residuals(nw, t, h);
        if (status != HN_OK) {
            return status;
        }
        look(&p, correct(nw), k == 1);
        nw->iterations++;
        if (!isfinite(p.size)) {
            return give_up(nw, t, h, k, HUGE_VAL);
        }
        if (is_done(nw, &p)) {
            find_rates(nw, h);
            return HN_OK;
        }

        // a slow iteration gets a new factor
        status = help(nw, t, h, &p);
        if (p.grown == 2) {
            break;
        }
    }
    return status == HN_OK ? give_up(nw, t, h, most, p.ratio) : status;
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
