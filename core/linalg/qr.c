// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/qr.h"

#include "linalg/dense.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

enum { SIGMA_ITERATIONS = 60 };
// a list is gone over more slowly than a row, and costs as much to make
enum { SHORT_ROWS = 32, LISTED_OF = 4 };

bool hn_qr_init(hn_qr *qr, hn_arena *arena, int m_max, int n_max) {
    size_t m = (size_t)m_max, n = (size_t)n_max;
    *qr = (hn_qr){.m_max = m_max, .n_max = n_max};
    qr->a = hn_arena_doubles(arena, m * n);
    qr->tau = hn_arena_doubles(arena, n);
    qr->perm = hn_arena_ints(arena, n);
    qr->norm = hn_arena_doubles(arena, 2 * n);
    qr->work = hn_arena_doubles(arena, m > n ? m : n);
    qr->at = hn_arena_ints(arena, m);
    return qr->a && qr->tau && qr->perm && qr->norm && qr->work && qr->at;
}

static double *column(const hn_qr *qr, int k) {
    return qr->a + (size_t)k * qr->m;
}

static void swap_columns(hn_qr *qr, int k, int p) {
    if (k == p) {
        return;
    }
    double *x = column(qr, k), *y = column(qr, p);
    for (int i = 0; i < qr->m; i++) {
        double keep = x[i];
        x[i] = y[i];
        y[i] = keep;
    }
    int keep = qr->perm[k];
    qr->perm[k] = qr->perm[p];
    qr->perm[p] = keep;

    // entry k is not needed any more, so the norms only move down
    qr->norm[p] = qr->norm[k];
    qr->norm[qr->n + p] = qr->norm[qr->n + k];
}

/// Householder vector of column k below row k: v_k = 1 is implied, the rest is stored, R_kk
/// replaces the head.
static void reflect_column(hn_qr *qr, int k) {
    double *x = column(qr, k) + k;
    int tail = qr->m - k - 1;
    double rest = hn_norm2(tail, x + 1);
    if (rest == 0) {
        qr->tau[k] = 0;
        return;
    }
    double beta = -copysign(hypot(x[0], rest), x[0]);
    qr->tau[k] = (beta - x[0]) / beta;
    double scale = 1 / (x[0] - beta);
    for (int i = 1; i <= tail; i++) {
        x[i] *= scale;
    }
    x[0] = beta;
}

/// x <- (I - tau v v') x for the rows from k on
static void apply_reflector(const hn_qr *qr, int k, double *x) {
    const double *v = column(qr, k) + k;
    int tail = qr->m - k - 1;
    double s = qr->tau[k] * (x[k] + hn_dot(tail, v + 1, x + k + 1));
    x[k] -= s;
    hn_axpy(tail, -s, v + 1, x + k + 1);
}

int hn_qr_reflector(const hn_qr *qr, int k, const int **rows) {
    const double *v = column(qr, k);
    int n = 0;
    for (int i = k + 1; i < qr->m; i++) {
        if (v[i] != 0) {
            qr->at[n++] = i;
        }
    }
    *rows = qr->at;
    return n;
}

bool hn_qr_is_sparse(const hn_qr *qr, int k, int n) {
    const int tail = qr->m - k - 1;
    return tail > SHORT_ROWS && n < tail / LISTED_OF;
}

/// The same over the n rows where v is not zero: the other terms of the sum are zero.
static void apply_listed(const hn_qr *qr, int k, int n, const int *rows, double *x) {
    const double *v = column(qr, k);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += v[rows[i]] * x[rows[i]];
    }
    const double s = qr->tau[k] * (x[k] + sum);
    x[k] -= s;
    for (int i = 0; i < n; i++) {
        x[rows[i]] += -s * v[rows[i]];
    }
}

/// Applies reflector k to the columns behind it.
static void reflect_others(hn_qr *qr, int k) {
    const int *rows;
    const int n = hn_qr_reflector(qr, k, &rows);
    const bool listed = hn_qr_is_sparse(qr, k, n);
    for (int j = k + 1; j < qr->n; j++) {
        if (listed) {
            apply_listed(qr, k, n, rows, column(qr, j));
        } else {
            apply_reflector(qr, k, column(qr, j));
        }
    }
}

/// Norm of the part of column j below row k, from its norm before step k; computed afresh once too
/// much has cancelled.
static void downdate_norm(hn_qr *qr, int k, int j) {
    double *norm = qr->norm, *fresh = qr->norm + qr->n;
    if (norm[j] == 0) {
        return;
    }
    double gone = fabs(column(qr, j)[k]) / norm[j];
    double left = fmax(0, (1 + gone) * (1 - gone));
    double since = norm[j] / fresh[j];
    if (left * since * since <= sqrt(DBL_EPSILON)) {
        norm[j] = hn_norm2(qr->m - k - 1, column(qr, j) + k + 1);
        fresh[j] = norm[j];
    } else {
        norm[j] *= sqrt(left);
    }
}

static int largest_norm(const hn_qr *qr, int from) {
    int best = from;
    for (int j = from + 1; j < qr->n; j++) {
        if (qr->norm[j] > qr->norm[best]) {
            best = j;
        }
    }
    return best;
}

void hn_qr_factor(hn_qr *qr, int m, int n, double rank_tol) {
    HN_ASSERT(m >= 0 && n >= 0 && m <= qr->m_max && n <= qr->n_max);
    qr->m = m;
    qr->n = n;
    qr->rank = 0;
    qr->dropped = 0;
    for (int j = 0; j < n; j++) {
        qr->perm[j] = j;
        qr->norm[j] = qr->norm[n + j] = hn_norm2(m, column(qr, j));
    }

    // column by column, the longest of what is left first
    double limit = 0, first = 0;
    for (int k = 0; k < n && k < m; k++) {
        int p = largest_norm(qr, k);
        double norm = qr->norm[p];
        if (k == 0) {
            first = norm;
            limit = rank_tol * norm;
        }
        if (!(norm > limit)) {
            qr->dropped = first > 0 ? norm / first : 0;
            return;
        }
        swap_columns(qr, k, p);
        reflect_column(qr, k);
        reflect_others(qr, k);
        for (int j = k + 1; j < n; j++) {
            downdate_norm(qr, k, j);
        }
        qr->rank = k + 1;
    }
}

void hn_qr_apply_qt(const hn_qr *qr, double *x) {
    for (int k = 0; k < qr->rank; k++) {
        apply_reflector(qr, k, x);
    }
}

void hn_qr_apply_q(const hn_qr *qr, double *x) {
    for (int k = qr->rank - 1; k >= 0; k--) {
        apply_reflector(qr, k, x);
    }
}

void hn_qr_solve_r(const hn_qr *qr, double *x) {
    for (int k = qr->rank - 1; k >= 0; k--) {
        const double *col = column(qr, k);
        x[k] /= col[k];
        hn_axpy(k, -x[k], col, x);
    }
}

void hn_qr_solve_rt(const hn_qr *qr, double *x) {
    for (int k = 0; k < qr->rank; k++) {
        const double *col = column(qr, k);
        x[k] = (x[k] - hn_dot(k, col, x)) / col[k];
    }
}

double hn_qr_pivot_ratio(const hn_qr *qr) {
    if (qr->rank == 0) {
        return 1;
    }
    return fabs(column(qr, qr->rank - 1)[qr->rank - 1] / qr->a[0]);
}

void hn_qr_least_norm(hn_qr *qr, const double *b, double *x) {
    for (int i = 0; i < qr->m; i++) {
        x[i] = i < qr->rank ? b[qr->perm[i]] : 0;
    }
    hn_qr_solve_rt(qr, x);
    hn_qr_apply_q(qr, x);
}

double hn_qr_remove_range(const hn_qr *qr, double *x) {
    hn_qr_apply_qt(qr, x);
    double removed = hn_norm2(qr->rank, x);
    for (int i = 0; i < qr->rank; i++) {
        x[i] = 0;
    }
    hn_qr_apply_q(qr, x);
    return removed;
}

/// y = R x and y = R' x in place, kept block only
static void multiply_r(const hn_qr *qr, double *x) {
    for (int i = 0; i < qr->rank; i++) {
        double sum = 0;
        for (int k = i; k < qr->rank; k++) {
            sum += column(qr, k)[i] * x[k];
        }
        x[i] = sum;
    }
}

static void multiply_rt(const hn_qr *qr, double *x) {
    for (int k = qr->rank - 1; k >= 0; k--) {
        x[k] = hn_dot(k + 1, column(qr, k), x);
    }
}

static void start_vector(int n, double *x) {
    // no direction of a mechanism is favoured or missed: golden-ratio steps never repeat
    double phase = 0;
    for (int i = 0; i < n; i++) {
        phase += 0.6180339887498949;
        phase -= floor(phase);
        x[i] = 0.5 + phase;
    }
}

/// One extreme singular value: `inverse` iterates with (R'R)^-1. Growth of |x| per half sweep tends
/// to sigma or 1 / sigma.
static double iterate_sigma(const hn_qr *qr, int inverse) {
    double *x = qr->work, growth = 0;
    start_vector(qr->rank, x);
    for (int it = 0; it < SIGMA_ITERATIONS; it++) {
        double norm = hn_norm2(qr->rank, x);
        for (int i = 0; i < qr->rank; i++) {
            x[i] /= norm;
        }

        // one half step: the growth is the singular value or its inverse
        if (inverse) {
            hn_qr_solve_rt(qr, x);
        } else {
            multiply_r(qr, x);
        }
        double last = growth;
        growth = hn_norm2(qr->rank, x);
        if (fabs(growth - last) <= 1e-10 * growth) {
            break;
        }

        // the other half
        if (inverse) {
            hn_qr_solve_r(qr, x);
        } else {
            multiply_rt(qr, x);
        }
    }
    return inverse ? 1 / growth : growth;
}

void hn_qr_sigma(const hn_qr *qr, double *sigma_min, double *sigma_max) {
    *sigma_min = *sigma_max = 0;
    if (qr->rank > 0) {
        *sigma_max = iterate_sigma(qr, 0);
        *sigma_min = iterate_sigma(qr, 1);
    }
}
