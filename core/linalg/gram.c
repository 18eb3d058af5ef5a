// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/gram.h"

#include "linalg/dense.h"
#include "linalg/sparse_spd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PRODUCTS = 64 }; // for each entry of A, on the average
enum { SIGMA_ITERATIONS = 60 };

// entry `sum` of A A' gets the product of entries a and b of A
typedef struct product {
    int sum, a, b;
} product;

struct hn_gram {
    int rows, cols, n_entries, n_products, n_sums;
    const int *row, *col;
    const double *entry;
    product *products;
    int *sum_row, *sum_col, *diagonal; ///< diagonal: of each row
    double *sums, *shifted;
    double *x, *y; ///< rows and cols: vectors of the iterations
    hn_sparse_spd *spd;
};

// ---- places ----

/// Scratch for listing the products.
typedef struct lister {
    int *start, *list; ///< entries of each column, their rows rising
    int *number;       ///< per row: 1 + its sum with the row at hand
    int *of_row;       ///< per row: the row for which that was said, plus 1
} lister;

/// Entries of each column, one after the other: list[start[j]] .. list[start[j + 1] - 1].
static void sort_by_column(const hn_gram *g, lister *l) {
    for (int k = 0; k < g->n_entries; k++) {
        l->start[g->col[k] + 2]++;
    }
    for (int j = 0; j < g->cols; j++) {
        l->start[j + 2] += l->start[j + 1];
    }
    for (int k = 0; k < g->n_entries; k++) {
        l->list[l->start[g->col[k] + 1]++] = k;
    }
}

static void add_sum(hn_gram *g, lister *l, int high, int low) {
    g->sum_row[g->n_sums] = high;
    g->sum_col[g->n_sums] = low;
    l->of_row[low] = high + 1;
    l->number[low] = g->n_sums++;
}

/// Products of entry a with all entries above it in its column, and with itself.
static void add_products(hn_gram *g, lister *l, int a) {
    const int high = g->row[a], j = g->col[a];
    for (int k = l->start[j]; k < l->start[j + 1] && l->list[k] <= a; k++) {
        const int b = l->list[k], low = g->row[b];
        if (l->of_row[low] != high + 1) {
            add_sum(g, l, high, low);
        }
        g->products[g->n_products++] = (product){l->number[low], a, b};
    }
}

static hn_status list_products(hn_gram *g) {
    lister l = {.start = calloc((size_t)g->cols + 3, sizeof *l.start),
                .list = calloc((size_t)g->n_entries + 1, sizeof *l.list),
                .number = calloc((size_t)g->rows + 1, sizeof *l.number),
                .of_row = calloc((size_t)g->rows + 1, sizeof *l.of_row)};
    const bool good = l.start && l.list && l.number && l.of_row;
    if (good) {
        sort_by_column(g, &l);
        int a = 0;
        for (int i = 0; i < g->rows; i++) {
            add_sum(g, &l, i, i);
            g->diagonal[i] = l.number[i];
            for (; a < g->n_entries && g->row[a] == i; a++) {
                add_products(g, &l, a);
            }
        }
        HN_ASSERT(a == g->n_entries);
    }
    free(l.start);
    free(l.list);
    free(l.number);
    free(l.of_row);
    return good ? HN_OK : HN_ERR_MEMORY;
}

/// Pairs of entries that stand in one column, -1: too many, or memory is out.
static int count_products(const hn_gram *g) {
    int *of_column = calloc((size_t)g->cols + 1, sizeof *of_column);
    long long n = of_column ? 0 : -1;
    for (int k = 0; of_column && k < g->n_entries; k++) {
        n += ++of_column[g->col[k]];
    }
    free(of_column);
    return n < 0 || n > (long long)MOST_PRODUCTS * g->n_entries ? -1 : (int)n;
}

hn_status hn_gram_create(hn_arena *arena, int rows, int cols, int n_entries, const int *row,
                         const int *col, hn_gram **out) {
    *out = NULL;
    hn_gram *g = hn_arena_get(arena, sizeof *g);
    if (!g) {
        return HN_ERR_MEMORY;
    }
    *g = (hn_gram){.rows = rows, .cols = cols, .n_entries = n_entries, .row = row, .col = col};
    const int n = count_products(g);
    if (n < 0) {
        return HN_OK;
    }

    // products of entries, and the places of their sums
    const size_t n_sums = (size_t)n + (size_t)rows;
    g->products = hn_arena_get(arena, ((size_t)n + 1) * sizeof *g->products);
    g->sum_row = hn_arena_ints(arena, n_sums);
    g->sum_col = hn_arena_ints(arena, n_sums);
    g->diagonal = hn_arena_ints(arena, (size_t)rows);
    g->sums = hn_arena_doubles(arena, n_sums);
    g->shifted = hn_arena_doubles(arena, n_sums);
    g->x = hn_arena_doubles(arena, (size_t)rows);
    g->y = hn_arena_doubles(arena, (size_t)cols);
    if (hn_arena_failed(arena) || list_products(g) != HN_OK) {
        return HN_ERR_MEMORY;
    }

    g->spd = hn_sparse_spd_create(arena, rows, g->n_sums, g->sum_row, g->sum_col);
    *out = g->spd ? g : NULL;
    return g->spd ? HN_OK : HN_ERR_MEMORY;
}

// ---- numbers ----

void hn_gram_fill(hn_gram *g, const double *entry) {
    g->entry = entry;
    memset(g->sums, 0, (size_t)g->n_sums * sizeof *g->sums);
    for (int k = 0; k < g->n_products; k++) {
        const product *p = &g->products[k];
        g->sums[p->sum] += entry[p->a] * entry[p->b];
    }
}

double hn_gram_largest(const hn_gram *g) {
    double largest = 0;
    for (int i = 0; i < g->rows; i++) {
        largest = fmax(largest, g->sums[g->diagonal[i]]);
    }
    return largest;
}

hn_status hn_gram_factor(hn_gram *g, double shift, double tol) {
    memcpy(g->shifted, g->sums, (size_t)g->n_sums * sizeof *g->sums);
    for (int i = 0; i < g->rows; i++) {
        g->shifted[g->diagonal[i]] += shift;
    }
    return hn_sparse_spd_factor(g->spd, g->shifted, tol);
}

void hn_gram_solve(hn_gram *g, double *x) {
    hn_sparse_spd_solve(g->spd, x);
}

void hn_gram_times(const hn_gram *g, const double *x, double *y) {
    memset(y, 0, (size_t)g->rows * sizeof *y);
    for (int k = 0; k < g->n_entries; k++) {
        y[g->row[k]] += g->entry[k] * x[g->col[k]];
    }
}

void hn_gram_times_transpose(const hn_gram *g, const double *x, double *y) {
    memset(y, 0, (size_t)g->cols * sizeof *y);
    for (int k = 0; k < g->n_entries; k++) {
        y[g->col[k]] += g->entry[k] * x[g->row[k]];
    }
}

double hn_gram_factor_ops(const hn_gram *g) {
    return 2.0 * g->n_products + hn_sparse_spd_factor_ops(g->spd);
}

// ---- singular values ----

/// One extreme singular value, squared: the growth of |x| per turn of x <- G x, or of x <- G^-1 x.
static double iterate(hn_gram *g, bool inverse) {
    double *x = g->x, growth = 0, phase = 0;
    for (int i = 0; i < g->rows; i++) { // golden-ratio steps never repeat: no direction is missed
        phase += 0.6180339887498949;
        phase -= floor(phase);
        x[i] = 0.5 + phase;
    }
    for (int turn = 0; turn < SIGMA_ITERATIONS; turn++) {
        const double norm = hn_norm2(g->rows, x);
        for (int i = 0; i < g->rows; i++) {
            x[i] /= norm;
        }

        // one turn, and by how much it lengthens x
        if (inverse) {
            hn_gram_solve(g, x);
        } else {
            hn_gram_times_transpose(g, x, g->y);
            hn_gram_times(g, g->y, x);
        }
        const double last = growth;
        growth = hn_norm2(g->rows, x);
        if (fabs(growth - last) <= 1e-10 * growth) {
            break;
        }
    }
    return inverse ? 1 / growth : growth;
}

void hn_gram_sigma(hn_gram *g, double *sigma_min, double *sigma_max) {
    *sigma_min = *sigma_max = 0;
    if (g->rows > 0) {
        *sigma_max = sqrt(iterate(g, 0));
        *sigma_min = sqrt(iterate(g, 1));
    }
}
