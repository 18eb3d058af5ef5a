// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/matrix.h"

#include "linalg/lu.h"

#include <string.h>

hn_matrix hn_matrix_new(hn_arena *arena, int rows, int cols) {
    return (hn_matrix){
        .rows = rows, .cols = cols, .x = hn_arena_doubles(arena, (size_t)rows * (size_t)cols)};
}

static hn_status shapes(const hn_matrix_desk *p, const char *what, const hn_matrix *a,
                        const hn_matrix *b) {
    return hn_diag_set(p->diag, HN_ERR_UNSUPPORTED, NULL, "a transpose may be missing",
                       "%s of %d x %d and %d x %d does not exist", what, a->rows, a->cols, b->rows,
                       b->cols);
}

static hn_status make(const hn_matrix_desk *p, int rows, int cols, hn_matrix *out) {
    *out = hn_matrix_new(p->arena, rows, cols);
    return out->x ? HN_OK : HN_ERR_MEMORY;
}

/// a + sign * b
hn_status hn_matrix_add(const hn_matrix_desk *p, const hn_matrix *a, const hn_matrix *b,
                        double sign, hn_matrix *out) {
    // the number 0 fits every shape
    if (a->number && a->x[0] == 0 && !b->number) {
        HN_TRY(make(p, b->rows, b->cols, out));
        for (int i = 0; i < b->rows * b->cols; i++) {
            out->x[i] = sign * b->x[i];
        }
        return HN_OK;
    }
    if (b->number && b->x[0] == 0) {
        *out = *a;
        return HN_OK;
    }

    // all else entry by entry, in one shape
    if (a->rows != b->rows || a->cols != b->cols) {
        return shapes(p, "the sum", a, b);
    }
    HN_TRY(make(p, a->rows, a->cols, out));
    out->number = a->number && b->number;
    for (int i = 0; i < a->rows * a->cols; i++) {
        out->x[i] = a->x[i] + sign * b->x[i];
    }
    return HN_OK;
}

hn_status hn_matrix_multiply(const hn_matrix_desk *p, const hn_matrix *a, const hn_matrix *b,
                             hn_matrix *out) {
    // a number scales
    if (a->number || b->number) {
        const hn_matrix *m = a->number ? b : a;
        const double factor = a->number ? a->x[0] : b->x[0];
        HN_TRY(make(p, m->rows, m->cols, out));
        out->number = a->number && b->number;
        for (int i = 0; i < m->rows * m->cols; i++) {
            out->x[i] = factor * m->x[i];
        }
        return HN_OK;
    }

    // rows by columns
    if (a->cols != b->rows) {
        return shapes(p, "the product", a, b);
    }
    HN_TRY(make(p, a->rows, b->cols, out));
    for (int i = 0; i < a->rows; i++) {
        for (int j = 0; j < b->cols; j++) {
            for (int k = 0; k < a->cols; k++) {
                out->x[i * b->cols + j] += a->x[i * a->cols + k] * b->x[k * b->cols + j];
            }
        }
    }
    return HN_OK;
}

/// Entry by entry, in one shape; a number scales.
hn_status hn_matrix_multiply_entries(const hn_matrix_desk *p, const hn_matrix *a,
                                     const hn_matrix *b, hn_matrix *out) {
    if (a->number || b->number) {
        return hn_matrix_multiply(p, a, b, out);
    }
    if (a->rows != b->rows || a->cols != b->cols) {
        return shapes(p, "the product entry by entry", a, b);
    }
    HN_TRY(make(p, a->rows, a->cols, out));
    for (int i = 0; i < a->rows * a->cols; i++) {
        out->x[i] = a->x[i] * b->x[i];
    }
    return HN_OK;
}

hn_status hn_matrix_transpose(const hn_matrix_desk *p, const hn_matrix *a, hn_matrix *out) {
    HN_TRY(make(p, a->cols, a->rows, out));
    out->number = a->number;
    for (int i = 0; i < a->rows; i++) {
        for (int j = 0; j < a->cols; j++) {
            out->x[j * a->rows + i] = a->x[i * a->cols + j];
        }
    }
    return HN_OK;
}

hn_status hn_matrix_invert(const hn_matrix_desk *p, const hn_matrix *a, hn_matrix *out) {
    const int n = a->rows;
    double lu[HN_MATRIX_LARGEST * HN_MATRIX_LARGEST], scale[HN_MATRIX_LARGEST];
    double column[HN_MATRIX_LARGEST];
    int pivot[HN_MATRIX_LARGEST];

    // square, and small enough for the arrays above
    if (n != a->cols || n > HN_MATRIX_LARGEST) {
        return hn_diag_set(p->diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "a matrix of %d x %d has no inverse: it is not square", a->rows,
                           a->cols);
    }

    // the factors, of a copy: a stays as it is
    memcpy(lu, a->x, sizeof(double) * (size_t)(n * n));
    HN_TRY(make(p, n, n, out));
    out->number = a->number;
    if (hn_lu_factor(n, lu, pivot, scale) != HN_OK) {
        return hn_diag_set(p->diag, HN_ERR_SINGULAR, NULL, NULL,
                           "a matrix that is inverted here is singular");
    }

    // column j of the inverse solves A x = e_j
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            column[i] = i == j;
        }
        hn_lu_solve(n, lu, pivot, column);
        for (int i = 0; i < n; i++) {
            out->x[i * n + j] = column[i];
        }
    }
    return HN_OK;
}
