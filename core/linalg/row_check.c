// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/row_check.h"

#include "linalg/newton_matrix.h"
#include "linalg/sparse_spd.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PRODUCTS = 64 }; // for each entry of J, on the average

// entry `sum` of J J' gets the product of entries a and b of J
typedef struct product {
    int sum, a, b;
} product;

struct hn_row_check {
    int nc, nv, n_entries, n_products, n_sums;
    const int *row, *col;
    product *products;
    int *sum_row, *sum_col;
    double *entry, *sums, *size;
    hn_sparse_spd *spd;
    double ops;
};

// of pairs of entries in one column, the lower row second
static int count_products(const hn_row_check *c) {
    int *of_column = calloc((size_t)c->nv + 1, sizeof *of_column);
    long long n = -1;
    if (of_column) {
        n = 0;
        for (int k = 0; k < c->n_entries; k++) {
            n += ++of_column[c->col[k]];
        }
    }
    free(of_column);
    return n < 0 || n > (long long)MOST_PRODUCTS * c->n_entries ? -1 : (int)n;
}

// entries of each column, one after the other: list[start[j]] .. list[start[j + 1] - 1]
static void sort_by_column(const hn_row_check *c, int *start, int *list) {
    for (int k = 0; k < c->n_entries; k++) {
        start[c->col[k] + 2]++;
    }
    for (int j = 0; j < c->nv; j++) {
        start[j + 2] += start[j + 1];
    }
    for (int k = 0; k < c->n_entries; k++) {
        list[start[c->col[k] + 1]++] = k;
    }
}

static void add_product(hn_row_check *c, int *number, int a, int b) {
    const int high = c->row[a] >= c->row[b] ? a : b, low = high == a ? b : a;
    int *at = &number[(size_t)c->row[high] * (size_t)c->nc + (size_t)c->row[low]];
    if (*at == 0) {
        c->sum_row[c->n_sums] = c->row[high];
        c->sum_col[c->n_sums] = c->row[low];
        *at = ++c->n_sums;
    }
    c->products[c->n_products++] = (product){*at - 1, a, b};
}

static hn_status list_products(hn_row_check *c) {
    int *start = calloc((size_t)c->nv + 3, sizeof *start);
    int *list = calloc((size_t)c->n_entries + 1, sizeof *list);
    int *number = calloc((size_t)c->nc * (size_t)c->nc + 1, sizeof *number);
    const int good = start && list && number;
    if (good) {
        sort_by_column(c, start, list);
        for (int j = 0; j < c->nv; j++) {
            for (int a = start[j]; a < start[j + 1]; a++) {
                for (int b = start[j]; b <= a; b++) {
                    add_product(c, number, list[a], list[b]);
                }
            }
        }
    }
    free(start);
    free(list);
    free(number);
    return good ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_row_check_create(hn_arena *arena, int nc, int nv, int n_entries, const int *row,
                              const int *col, hn_row_check **out) {
    *out = NULL;
    if (!hn_newton_matrix_wants_sparse(nc + nv, 2LL * n_entries)) {
        return HN_OK;
    }

    hn_row_check *c = hn_arena_get(arena, sizeof *c);
    if (!c) {
        return HN_ERR_MEMORY;
    }
    *c = (hn_row_check){.nc = nc, .nv = nv, .n_entries = n_entries, .row = row, .col = col};
    const int n = count_products(c);
    if (n < 0) {
        return HN_OK;
    }

    // products of entries, and the places of their sums
    c->products = hn_arena_get(arena, ((size_t)n + 1) * sizeof *c->products);
    c->sum_row = hn_arena_ints(arena, (size_t)n);
    c->sum_col = hn_arena_ints(arena, (size_t)n);
    c->entry = hn_arena_doubles(arena, (size_t)n_entries);
    c->sums = hn_arena_doubles(arena, (size_t)n);
    c->size = hn_arena_doubles(arena, (size_t)nc);
    if (hn_arena_failed(arena) || list_products(c) != HN_OK) {
        return HN_ERR_MEMORY;
    }

    c->spd = hn_sparse_spd_create(arena, nc, c->n_sums, c->sum_row, c->sum_col);
    *out = c->spd ? c : NULL;
    return c->spd ? HN_OK : HN_ERR_MEMORY;
}

static void take_unit_rows(hn_row_check *c, const double *J, const double *unit) {
    memset(c->size, 0, (size_t)c->nc * sizeof *c->size);
    for (int k = 0; k < c->n_entries; k++) {
        c->entry[k] =
            J[(size_t)c->row[k] * (size_t)c->nv + (size_t)c->col[k]] * (unit ? unit[c->col[k]] : 1);
        c->size[c->row[k]] += c->entry[k] * c->entry[k];
    }
    for (int i = 0; i < c->nc; i++) {
        c->size[i] = c->size[i] > 0 ? 1 / sqrt(c->size[i]) : 0;
    }
    for (int k = 0; k < c->n_entries; k++) {
        c->entry[k] *= c->size[c->row[k]];
    }
}

bool hn_row_check_run(hn_row_check *c, const double *J, const double *unit) {
    take_unit_rows(c, J, unit);
    memset(c->sums, 0, (size_t)c->n_sums * sizeof *c->sums);
    for (int k = 0; k < c->n_products; k++) {
        const product *p = &c->products[k];
        c->sums[p->sum] += c->entry[p->a] * c->entry[p->b];
    }
    c->ops +=
        3.0 * c->n_entries + 2.0 * c->nc + 2.0 * c->n_products + hn_sparse_spd_factor_ops(c->spd);
    return hn_sparse_spd_factor(c->spd, c->sums, HN_ROW_CHECK_DISTANCE * HN_ROW_CHECK_DISTANCE) ==
           HN_OK;
}

double hn_row_check_ops(const hn_row_check *c) {
    return c->ops;
}
