// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/newton_matrix.h"

#include "linalg/compressed.h"
#include "linalg/curtis_reid.h"
#include "linalg/dense.h"
#include "linalg/square.h"

#include <stdbool.h>
#include <suitesparse/klu.h>

#include <math.h>
#include <string.h>

static const double GROWTH = 1e-8; // of entries against factors, below which pivots are chosen anew
static const double THRESHOLD = 0.1;  // of the largest entry of a column: what may be its pivot
static const double SINGULAR = 1e-15; // smallest pivot over the largest, rows of length one
// a complex product and sum are eight operations against two
// of pivots: below this other units may show more digits
static const double DOUBTFUL = 1e-11;
static const double COMPLEX_WEIGHT = 4;

struct hn_newton_matrix {
    int parts; // 1: real, 2: complex
    int n_max, n;
    double ops;
    // dense
    hn_square square;
    hn_complex *dense;
    int *pivot;
    double *scale;
    // sparse
    int sparse;
    hn_compressed places;
    double *values; // of the columns, parts each
    klu_common common;
    klu_symbolic *symbolic;
    klu_numeric *numeric;
    // scales of a matrix that looks singular in its own units, see curtis_reid.h
    int is_scaled;
    double *kept;            // the entries of a dense matrix, which its factor overwrites
    double *by_row, *by_col; // exponents of two
    double *sum;
    int *count;
    double factor_ops, solve_ops;
    long long nnz;
};

bool hn_newton_matrix_wants_sparse(int n, long long n_entries) {
    return n >= HN_NEWTON_SPARSE_FROM && 4 * n_entries <= (long long)n * n;
}

static int allocate_dense(hn_newton_matrix *m, hn_arena *arena) {
    const size_t n = (size_t)m->n_max;
    if (m->parts == 1) {
        return hn_square_init(&m->square, arena, m->n_max);
    }
    m->dense = hn_arena_get(arena, (n * n + 1) * sizeof *m->dense);
    m->pivot = hn_arena_ints(arena, n);
    m->scale = hn_arena_doubles(arena, n);
    return m->dense && m->pivot && m->scale;
}

static bool allocate_sparse(hn_newton_matrix *m, hn_arena *arena, int entries_max) {
    m->values = hn_arena_doubles(arena, (size_t)(m->parts * entries_max));
    const int good = klu_defaults(&m->common);
    m->common.tol = THRESHOLD;
    return good && m->values && hn_compressed_init(&m->places, arena, m->n_max, entries_max);
}

static bool allocate_scales(hn_newton_matrix *m, hn_arena *arena) {
    const size_t n = (size_t)m->n_max;
    m->by_row = hn_arena_doubles(arena, n);
    m->by_col = hn_arena_doubles(arena, n);
    m->sum = hn_arena_doubles(arena, n);
    m->count = hn_arena_ints(arena, n);
    m->kept = m->sparse ? NULL : hn_arena_doubles(arena, (size_t)m->parts * n * n);
    return m->by_row && m->by_col && m->sum && m->count && (m->sparse || m->kept);
}

hn_newton_matrix *hn_newton_matrix_create(hn_arena *arena, hn_number_field field, bool sparse,
                                          int n_max, int entries_max) {
    hn_newton_matrix *m = hn_arena_get(arena, sizeof *m);
    if (!m) {
        return NULL;
    }
    *m = (hn_newton_matrix){.parts = field == HN_COMPLEX ? 2 : 1, .n_max = n_max, .sparse = sparse};
    const int good = sparse ? allocate_sparse(m, arena, entries_max) : allocate_dense(m, arena);
    return good && allocate_scales(m, arena) ? m : NULL;
}

static void free_numeric(hn_newton_matrix *m) {
    if (m->parts == 1) {
        klu_free_numeric(&m->numeric, &m->common);
    } else {
        klu_z_free_numeric(&m->numeric, &m->common);
    }
}

static void forget(hn_newton_matrix *m) {
    free_numeric(m);
    klu_free_symbolic(&m->symbolic, &m->common);
}

void hn_newton_matrix_free(hn_newton_matrix *m) {
    if (m && m->sparse) {
        forget(m);
    }
}

// ---- filling ----

void hn_newton_matrix_begin(hn_newton_matrix *m, int n) {
    HN_ASSERT(n >= 0 && n <= m->n_max);
    const size_t size = (size_t)n * (size_t)n;
    m->n = n;
    if (m->sparse) {
        hn_compressed_begin(&m->places, n);
    } else if (m->parts == 1) {
        memset(m->square.lu, 0, size * sizeof *m->square.lu);
    } else {
        memset(m->dense, 0, size * sizeof *m->dense);
    }
}

void hn_newton_matrix_put(hn_newton_matrix *m, int row, int col, double re, double im) {
    const size_t at = (size_t)row * (size_t)m->n + (size_t)col;
    if (m->sparse) {
        hn_compressed_put(&m->places, row, col, re, im);
    } else if (m->parts == 1) {
        m->square.lu[at] += re;
    } else {
        m->dense[at].re += re;
        m->dense[at].im += im;
    }
}

void hn_newton_matrix_copy(const hn_newton_matrix *m, double *out) {
    const size_t n = (size_t)m->n;
    HN_ASSERT(m->parts == 1);
    if (m->sparse) {
        hn_compressed_copy(&m->places, out);
    } else {
        memcpy(out, m->square.lu, n * n * sizeof *out);
    }
}

// ---- factoring ----

static hn_status factor_dense(hn_newton_matrix *m) {
    const double n = m->n;
    m->nnz = (long long)m->n * m->n;
    m->ops += (m->parts == 1 ? 1 : COMPLEX_WEIGHT) * 2.0 / 3 * n * n * n;
    return m->parts == 1 ? hn_square_factor(&m->square, m->n)
                         : hn_lu_factor_complex(m->n, m->dense, m->pivot, m->scale);
}

static void count_work(hn_newton_matrix *m) {
    if (m->parts == 1) {
        klu_flops(m->symbolic, m->numeric, &m->common);
    } else {
        klu_z_flops(m->symbolic, m->numeric, &m->common);
    }
    const double weight = m->parts == 1 ? 1 : COMPLEX_WEIGHT;
    m->nnz = (long long)m->numeric->lnz + m->numeric->unz + m->numeric->nzoff;
    m->factor_ops = weight * m->common.flops;
    m->solve_ops = weight * (2.0 * (double)m->nnz + m->n);
}

static hn_status choose_pivots(hn_newton_matrix *m) {
    hn_compressed *p = &m->places;
    free_numeric(m);
    m->numeric = m->parts == 1 ? klu_factor(p->start, p->row, m->values, m->symbolic, &m->common)
                               : klu_z_factor(p->start, p->row, m->values, m->symbolic, &m->common);
    if (!m->numeric) {
        return m->common.status == KLU_OUT_OF_MEMORY ? HN_ERR_MEMORY : HN_ERR_SINGULAR;
    }
    count_work(m);
    return HN_OK;
}

static bool grows(hn_newton_matrix *m) {
    hn_compressed *p = &m->places;
    const int good =
        m->parts == 1
            ? klu_rgrowth(p->start, p->row, m->values, m->symbolic, m->numeric, &m->common)
            : klu_z_rgrowth(p->start, p->row, m->values, m->symbolic, m->numeric, &m->common);
    return !good || !(m->common.rgrowth > GROWTH);
}

// 1 when the pivots of before serve the new entries
static bool keep_pivots(hn_newton_matrix *m) {
    hn_compressed *p = &m->places;
    if (!m->numeric) {
        return false;
    }
    m->ops += m->factor_ops;
    const int good =
        m->parts == 1
            ? klu_refactor(p->start, p->row, m->values, m->symbolic, m->numeric, &m->common)
            : klu_z_refactor(p->start, p->row, m->values, m->symbolic, m->numeric, &m->common);
    return good && m->common.status == KLU_OK && !grows(m);
}

static bool is_singular(hn_newton_matrix *m) {
    const int good = m->parts == 1 ? klu_rcond(m->symbolic, m->numeric, &m->common)
                                   : klu_z_rcond(m->symbolic, m->numeric, &m->common);
    return !good || !(m->common.rcond > SINGULAR);
}

// pivots that pass for regular and yet hold few digits
static bool is_doubtful(const hn_newton_matrix *m) {
    if (m->sparse) {
        return m->common.rcond < DOUBTFUL;
    }
    return m->parts == 1 && m->square.pivot_ratio < DOUBTFUL;
}

static hn_status factor_sparse(hn_newton_matrix *m, int known) {
    if (!hn_all_finite(m->parts * m->places.start[m->n], m->values)) {
        return HN_ERR_DIVERGED;
    }
    if (!known || !m->symbolic) {
        forget(m);
        m->symbolic = klu_analyze(m->n, m->places.start, m->places.row, &m->common);
        if (!m->symbolic) {
            return m->common.status == KLU_OUT_OF_MEMORY ? HN_ERR_MEMORY : HN_ERR_SINGULAR;
        }
    }
    // pivots that were chosen in other units, or long ago, may be poor ones by now
    if (!keep_pivots(m) || is_singular(m) || is_doubtful(m)) {
        const hn_status status = choose_pivots(m);
        if (status != HN_OK) {
            return status;
        }
        m->ops += m->factor_ops;
    }
    return is_singular(m) ? HN_ERR_SINGULAR : HN_OK;
}

static double *entries_of_dense(hn_newton_matrix *m) {
    return m->parts == 1 ? m->square.lu : (double *)(void *)m->dense;
}

static hn_status factor_as_is(hn_newton_matrix *m) {
    if (m->sparse) {
        return factor_sparse(m, hn_compressed_end(&m->places, m->parts, m->values));
    }
    const size_t size = (size_t)m->parts * (size_t)m->n * (size_t)m->n;
    memcpy(m->kept, entries_of_dense(m), size * sizeof *m->kept);
    return factor_dense(m);
}

// The same matrix in units in which its entries are of size 1. In tiny or huge units a regular
// saddle matrix has masses that look like rounding beside the constraints.
static hn_status factor_scaled(hn_newton_matrix *m) {
    const int *start = m->sparse ? m->places.start : NULL;
    double *values = m->sparse ? m->values : entries_of_dense(m);
    const double *from = m->sparse ? m->values : m->kept;
    hn_curtis_reid(m->n, m->parts, start, m->places.row, from, m->by_row, m->by_col, m->sum,
                   m->count);
    for (int j = 0; j < m->n; j++) {
        const int first = start ? start[j] : 0, end = start ? start[j + 1] : m->n;
        for (int k = first; k < end; k++) {
            const int i = start ? m->places.row[k] : k;
            const size_t at = start ? (size_t)k : (size_t)i * (size_t)m->n + (size_t)j;
            for (int part = 0; part < m->parts; part++) {
                const size_t e = at * (size_t)m->parts + (size_t)part;
                values[e] = ldexp(from[e], (int)(m->by_row[i] + m->by_col[j]));
            }
        }
    }
    m->is_scaled = 1;
    return m->sparse ? factor_sparse(m, 1) : factor_dense(m);
}

static void scale(const hn_newton_matrix *m, const double *exponents, double *x) {
    for (int i = 0; i < m->parts * m->n; i++) {
        x[i] = ldexp(x[i], (int)exponents[i / m->parts]);
    }
}

hn_status hn_newton_matrix_factor(hn_newton_matrix *m) {
    if (m->n == 0) {
        return HN_OK;
    }
    m->is_scaled = 0;
    const hn_status status = factor_as_is(m);
    if (status == HN_ERR_SINGULAR || (status == HN_OK && is_doubtful(m))) {
        return factor_scaled(m);
    }
    return status;
}

static void solve_factored(hn_newton_matrix *m, double *x) {
    const double n = m->n;
    if (!m->sparse) {
        m->ops += (m->parts == 1 ? 1 : COMPLEX_WEIGHT) * 2 * n * n;
        if (m->parts == 1) {
            hn_square_solve(&m->square, x);
        } else {
            hn_lu_solve_complex(m->n, m->dense, m->pivot, (hn_complex *)(void *)x);
        }
        return;
    }
    m->ops += m->solve_ops;
    if (m->parts == 1) {
        klu_solve(m->symbolic, m->numeric, m->n, 1, x, &m->common);
    } else {
        klu_z_solve(m->symbolic, m->numeric, m->n, 1, x, &m->common);
    }
}

void hn_newton_matrix_solve(hn_newton_matrix *m, double *x) {
    if (m->n == 0) {
        return;
    }
    if (m->is_scaled) {
        scale(m, m->by_row, x);
    }
    solve_factored(m, x);
    if (m->is_scaled) {
        scale(m, m->by_col, x);
    }
}

double hn_newton_matrix_ops(const hn_newton_matrix *m) {
    return m->ops;
}

long long hn_newton_matrix_nnz(const hn_newton_matrix *m) {
    return m->nnz;
}
