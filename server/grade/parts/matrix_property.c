// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/matrix_property.h"

#include "linalg/svd.h"

#include <math.h>
#include <string.h>

/// Rounding left by a sum or a product of sixteen entries at most, relative to its terms.
static const double ROUNDING = 1e-12;

typedef struct entry_place {
    int row, col;
} entry_place;

/// An entry, or 0 where it is rounding.
static double entry(const hn_matrix *m, const hn_matrix *size, entry_place at) {
    const int k = at.row * m->cols + at.col;
    return fabs(m->x[k]) <= ROUNDING * fabs(size->x[k]) ? 0 : m->x[k];
}

// ---- entries ----

static bool is_zero(const hn_matrix *m, const hn_matrix *size) {
    bool zero = true;
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < m->cols; j++) {
            zero &= entry(m, size, (entry_place){i, j}) == 0;
        }
    }
    return zero;
}

static bool is_nonzero(const hn_matrix *m, const hn_matrix *size) {
    return !is_zero(m, size);
}

static bool is_at_most_zero(const hn_matrix *m, const hn_matrix *size) {
    return m->rows == 1 && m->cols == 1 && entry(m, size, (entry_place){0, 0}) <= 0;
}

static bool has_no_zero_row(const hn_matrix *m, const hn_matrix *size) {
    for (int i = 0; i < m->rows; i++) {
        const hn_matrix row = {.rows = 1, .cols = m->cols, .x = m->x + i * m->cols};
        const hn_matrix its_size = {.rows = 1, .cols = m->cols, .x = size->x + i * m->cols};
        if (is_zero(&row, &its_size)) {
            return false;
        }
    }
    return true;
}

static bool is_symmetric(const hn_matrix *m, const hn_matrix *size) {
    bool symmetric = m->rows == m->cols;
    for (int i = 0; i < m->rows && symmetric; i++) {
        for (int j = 0; j < i && symmetric; j++) {
            const int k = i * m->cols + j, mirrored = j * m->cols + i;
            symmetric = fabs(m->x[k] - m->x[mirrored]) <=
                        ROUNDING * fmax(fabs(size->x[k]), fabs(size->x[mirrored]));
        }
    }
    return symmetric;
}

// ---- signs ----

/// Scales a symmetric matrix to ones on its diagonal. False when a diagonal entry is negative, or
/// zero beside one that is not: then some direction is negative.
static bool scale_symmetric(const hn_matrix *m, const hn_matrix *size, double *a) {
    const int n = m->rows;
    for (int i = 0; i < n; i++) {
        const double own = entry(m, size, (entry_place){i, i});
        for (int j = 0; j < n; j++) {
            const double other = entry(m, size, (entry_place){j, j});
            const double x = entry(m, size, (entry_place){i, j});
            if (own < 0 || (x != 0 && (own == 0 || other == 0))) {
                return false;
            }
            a[i * n + j] = x == 0 ? 0 : x / sqrt(own) / sqrt(other);
        }
    }
    return true;
}

/// The pivot with the largest diagonal entry among those that are left.
static int find_pivot(const double *a, int n, const bool *done) {
    int k = -1;
    for (int i = 0; i < n; i++) {
        k = !done[i] && (k < 0 || a[i * n + i] > a[k * n + k]) ? i : k;
    }
    return k;
}

/// Subtracts the pivot's row from the rows that are left.
static void eliminate(double *a, int n, int k, const bool *done) {
    for (int i = 0; i < n; i++) {
        const double factor = a[i * n + k] / a[k * n + k];
        for (int j = 0; j < n && !done[i]; j++) {
            a[i * n + j] -= factor * a[k * n + j];
        }
    }
}

/// Returns whether anything but rounding is left in the rows that are not done.
static bool is_left(const double *a, int n, const bool *done) {
    bool left = false;
    for (int k = 0; k < n * n; k++) {
        left |= !done[k / n] && !done[k % n] && fabs(a[k]) > ROUNDING;
    }
    return left;
}

typedef enum sign { INDEFINITE, SEMIDEFINITE, DEFINITE } sign;

/// Symmetric elimination with pivots from the diagonal. Once the largest diagonal entry that is
/// left is zero or negative, the matrix is semidefinite exactly when nothing is left.
static sign find_sign(const hn_matrix *m, const hn_matrix *size) {
    double a[HN_MATRIX_LARGEST * HN_MATRIX_LARGEST];
    bool done[HN_MATRIX_LARGEST] = {false};
    const int n = m->rows;
    if (!is_symmetric(m, size) || !scale_symmetric(m, size, a)) {
        return INDEFINITE;
    }
    for (int step = 0; step < n; step++) {
        const int k = find_pivot(a, n, done);
        if (a[k * n + k] <= ROUNDING) {
            return is_left(a, n, done) ? INDEFINITE : SEMIDEFINITE;
        }
        done[k] = true;
        eliminate(a, n, k, done);
    }
    return DEFINITE;
}

static bool is_definite(const hn_matrix *m, const hn_matrix *size) {
    return find_sign(m, size) == DEFINITE;
}

static bool is_semidefinite(const hn_matrix *m, const hn_matrix *size) {
    return find_sign(m, size) != INDEFINITE;
}

// ---- rank ----

/// Scales `n` entries, `step` apart, to length one; zeros stay.
static void scale_to_one(double *x, int n, int step) {
    double length = 0;
    for (int i = 0; i < n; i++) {
        length = hypot(length, x[i * step]);
    }
    for (int i = 0; i < n && length > 0; i++) {
        x[i * step] /= length;
    }
}

/// The rank; -1 without memory.
static int rank_of(const hn_matrix *m, const hn_matrix *size) {
    double a[HN_MATRIX_LARGEST * HN_MATRIX_LARGEST], sigma[HN_MATRIX_LARGEST];
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < m->cols; j++) {
            a[i * m->cols + j] = entry(m, size, (entry_place){i, j});
        }
        scale_to_one(a + i * m->cols, m->cols, 1);
    }
    for (int j = 0; j < m->cols; j++) {
        scale_to_one(a + j, m->rows, m->cols);
    }

    // what the singular values say of the scaled matrix
    hn_arena *arena = hn_arena_create(0);
    int rank = -1;
    if (arena && hn_singular_values(m->rows, m->cols, a, sigma, arena) == HN_OK) {
        rank = hn_rank_of(m->rows < m->cols ? m->rows : m->cols, sigma, ROUNDING);
    }
    hn_arena_free(arena);
    return rank;
}

static bool has_full_rank(const hn_matrix *m, const hn_matrix *size) {
    return rank_of(m, size) == m->cols;
}

static bool has_independent_rows(const hn_matrix *m, const hn_matrix *size) {
    return rank_of(m, size) == m->rows;
}

static bool has_dependent_rows(const hn_matrix *m, const hn_matrix *size) {
    const int rank = rank_of(m, size);
    return rank >= 0 && rank < m->rows;
}

static bool is_singular(const hn_matrix *m, const hn_matrix *size) {
    return m->rows == m->cols && has_dependent_rows(m, size);
}

static bool is_nonsingular(const hn_matrix *m, const hn_matrix *size) {
    return m->rows == m->cols && has_independent_rows(m, size);
}

hn_matrix_property *hn_matrix_property_find(const char *name) {
    static const struct {
        const char *name;
        hn_matrix_property *holds;
    } properties[] = {
        {"symmetric", is_symmetric},
        {"definite", is_definite},
        {"semidefinite", is_semidefinite},
        {"full-rank", has_full_rank},
        {"rows-independent", has_independent_rows},
        {"rows-dependent", has_dependent_rows},
        {"singular", is_singular},
        {"nonsingular", is_nonsingular},
        {"at-most-zero", is_at_most_zero},
        {"zero", is_zero},
        {"nonzero", is_nonzero},
        {"rows-nonzero", has_no_zero_row},
    };
    for (size_t i = 0; i < sizeof properties / sizeof *properties; i++) {
        if (strcmp(properties[i].name, name) == 0) {
            return properties[i].holds;
        }
    }
    return NULL;
}
