// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TESTS_SPARSE_ROWS_H
#define HN_TESTS_SPARSE_ROWS_H
// A matrix by its entries, beside the same one in full.

enum { SPARSE_ROWS_MOST = 30 * 45 };

typedef struct sparse_rows {
    int columns, n; ///< n entries so far
    int row[SPARSE_ROWS_MOST], col[SPARSE_ROWS_MOST];
    double value[SPARSE_ROWS_MOST];
    double dense[SPARSE_ROWS_MOST]; ///< rows x columns
} sparse_rows;

/// Adds an entry at a place that has none.
static inline void put(sparse_rows *m, int row, int col, double value) {
    m->row[m->n] = row;
    m->col[m->n] = col;
    m->value[m->n++] = value;
    m->dense[row * m->columns + col] = value;
}

#endif
