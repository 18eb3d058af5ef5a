// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/sparse_spd.h"

#include "linalg/dense.h"

#include <stdbool.h>
#include <string.h>

struct hn_sparse_spd {
    int n, n_entries, nnz;
    int *order, *at; ///< pivot k is unknown order[k]; at is the inverse
    // entries of A by rows of P A P': a_entry[a_start[k] ..], in columns a_col
    int *a_start, *a_entry, *a_col;
    // L by rows (columns rising, for the order of elimination) and by columns (rows rising, for the
    // values)
    int *row_start, *row_col, *col_start, *col_row;
    int *filled; ///< entries of each column that have their values by now
    double *L, *D, *work;
    double factor_ops;
};

// ---- order and pattern ----

typedef struct graph {
    int n;
    char *joined; // n x n
    int *degree, *gone;
} graph;

static int find_lowest(const graph *g) {
    int best = -1;
    for (int i = 0; i < g->n; i++) {
        if (!g->gone[i] && (best < 0 || g->degree[i] < g->degree[best])) {
            best = i;
        }
    }
    return best;
}

// takes out unknown i; its neighbours (into list) all become neighbours of each other. Returns how
// many there are.
static int take_out(graph *g, int i, int *list) {
    const size_t n = (size_t)g->n;
    int count = 0;
    for (int j = 0; j < g->n; j++) {
        if (g->joined[(size_t)i * n + (size_t)j] && !g->gone[j] && j != i) {
            list[count++] = j;
        }
    }
    g->gone[i] = 1;
    for (int a = 0; a < count; a++) {
        g->degree[list[a]]--;
        for (int b = 0; b < count; b++) {
            char *edge = &g->joined[(size_t)list[a] * n + (size_t)list[b]];
            if (a != b && !*edge) {
                *edge = 1;
                g->degree[list[a]]++;
            }
        }
    }
    return count;
}

static bool graph_init(graph *g, hn_arena *scratch, int n, int n_entries, const int *row,
                       const int *col) {
    *g = (graph){.n = n,
                 .joined = hn_arena_get(scratch, (size_t)n * (size_t)n + 1),
                 .degree = hn_arena_ints(scratch, (size_t)n),
                 .gone = hn_arena_ints(scratch, (size_t)n)};
    if (hn_arena_failed(scratch)) {
        return false;
    }
    for (int k = 0; k < n_entries; k++) {
        const size_t i = (size_t)row[k], j = (size_t)col[k];
        if (i != j) {
            g->joined[i * (size_t)n + j] = g->joined[j * (size_t)n + i] = 1;
            g->degree[i]++;
            g->degree[j]++;
        }
    }
    return true;
}

// the order, and the number of entries of each row of L in row_start[k + 1]; the entries themselves
// stay in the graph
static void choose_order(hn_sparse_spd *spd, graph *g, int *list) {
    for (int k = 0; k < spd->n; k++) {
        const int i = find_lowest(g);
        spd->order[k] = i;
        spd->at[i] = k;
        const int count = take_out(g, i, list);
        spd->nnz += count;
        // a row loses its entries of unknowns taken out later: what is left joined to i is its
        // column of L
        for (int j = 0; j < spd->n; j++) {
            g->joined[(size_t)i * (size_t)spd->n + (size_t)j] = 0;
        }
        for (int a = 0; a < count; a++) {
            g->joined[(size_t)i * (size_t)spd->n + (size_t)list[a]] = 1;
        }
        spd->factor_ops += (double)count * (count + 3);
    }
}

static bool list_pattern(hn_sparse_spd *spd, const graph *g, hn_arena *arena) {
    const size_t n = (size_t)spd->n;
    spd->row_col = hn_arena_ints(arena, (size_t)spd->nnz);
    spd->col_row = hn_arena_ints(arena, (size_t)spd->nnz);
    spd->L = hn_arena_doubles(arena, (size_t)spd->nnz);
    if (hn_arena_failed(arena)) {
        return false;
    }

    // joined unknowns: entries of L by rows and by columns
    int n_row = 0, n_col = 0;
    for (int k = 0; k < spd->n; k++) {
        spd->row_start[k] = n_row;
        spd->col_start[k] = n_col;
        for (int m = 0; m < k; m++) {
            if (g->joined[(size_t)spd->order[m] * n + (size_t)spd->order[k]]) {
                spd->row_col[n_row++] = m;
            }
        }
        for (int m = k + 1; m < spd->n; m++) {
            if (g->joined[(size_t)spd->order[k] * n + (size_t)spd->order[m]]) {
                spd->col_row[n_col++] = m;
            }
        }
    }

    spd->row_start[spd->n] = n_row;
    spd->col_start[spd->n] = n_col;
    return true;
}

static void list_entries(hn_sparse_spd *spd, const int *row, const int *col) {
    const int n = spd->n;
    int *next = spd->filled;
    for (int e = 0; e < spd->n_entries; e++) {
        const int i = spd->at[row[e]], j = spd->at[col[e]];
        spd->a_start[(i > j ? i : j) + 1]++;
    }
    for (int k = 0; k < n; k++) {
        next[k] = spd->a_start[k];
        spd->a_start[k + 1] += spd->a_start[k];
    }
    for (int e = 0; e < spd->n_entries; e++) {
        const int i = spd->at[row[e]], j = spd->at[col[e]];
        const int place = next[i > j ? i : j]++;
        spd->a_entry[place] = e;
        spd->a_col[place] = i > j ? j : i;
    }
}

hn_sparse_spd *hn_sparse_spd_create(hn_arena *arena, int n, int n_entries, const int *row,
                                    const int *col) {
    hn_sparse_spd *spd = hn_arena_get(arena, sizeof *spd);
    hn_arena *scratch = hn_arena_create(0);
    graph g;
    int ok = 0;
    if (spd && scratch && graph_init(&g, scratch, n, n_entries, row, col)) {
        *spd = (hn_sparse_spd){.n = n, .n_entries = n_entries};

        int **of_n[] = {&spd->order,     &spd->at,        &spd->a_start,
                        &spd->row_start, &spd->col_start, &spd->filled};
        for (size_t i = 0; i < sizeof of_n / sizeof *of_n; i++) {
            *of_n[i] = hn_arena_ints(arena, (size_t)n + 1);
        }
        spd->a_entry = hn_arena_ints(arena, (size_t)n_entries);
        spd->a_col = hn_arena_ints(arena, (size_t)n_entries);
        spd->D = hn_arena_doubles(arena, (size_t)n);
        spd->work = hn_arena_doubles(arena, (size_t)n);

        // the order first: everything else follows it
        if (!hn_arena_failed(arena)) {
            choose_order(spd, &g, spd->filled);
            list_entries(spd, row, col);
            ok = list_pattern(spd, &g, arena);
        }
    }
    hn_arena_free(scratch);
    return ok ? spd : NULL;
}

// ---- numbers ----

// row k of L from the rows before it: solves (L D)(rows before) l = a
static void factor_row(hn_sparse_spd *spd, int k, const double *values) {
    double *w = spd->work, pivot = 0;

    // the row of A in the work array, zero where it fills in
    for (int i = spd->row_start[k]; i < spd->row_start[k + 1]; i++) {
        w[spd->row_col[i]] = 0;
    }
    for (int i = spd->a_start[k]; i < spd->a_start[k + 1]; i++) {
        if (spd->a_col[i] == k) {
            pivot = values[spd->a_entry[i]];
        } else {
            w[spd->a_col[i]] = values[spd->a_entry[i]];
        }
    }

    // rows above it, in order; each adds one entry to its column of L
    for (int i = spd->row_start[k]; i < spd->row_start[k + 1]; i++) {
        const int m = spd->row_col[i], end = spd->col_start[m] + spd->filled[m];
        const double y = w[m], l = y / spd->D[m];
        for (int p = spd->col_start[m]; p < end; p++) {
            w[spd->col_row[p]] -= spd->L[p] * y;
        }
        spd->L[end] = l;
        spd->filled[m]++;
        pivot -= l * y;
    }

    spd->D[k] = pivot;
}

hn_status hn_sparse_spd_factor(hn_sparse_spd *spd, const double *values, double tol) {
    if (!hn_all_finite(spd->n_entries, values)) {
        return HN_ERR_DIVERGED;
    }
    memset(spd->filled, 0, (size_t)spd->n * sizeof *spd->filled);
    for (int k = 0; k < spd->n; k++) {
        factor_row(spd, k, values);
        if (!(spd->D[k] > tol)) {
            return HN_ERR_SINGULAR;
        }
    }
    return HN_OK;
}

void hn_sparse_spd_solve(hn_sparse_spd *spd, double *x) {
    double *y = spd->work;
    for (int k = 0; k < spd->n; k++) {
        y[k] = x[spd->order[k]];
    }
    for (int k = 0; k < spd->n; k++) {
        for (int p = spd->col_start[k]; p < spd->col_start[k + 1]; p++) {
            y[spd->col_row[p]] -= spd->L[p] * y[k];
        }
    }
    for (int k = spd->n - 1; k >= 0; k--) {
        y[k] /= spd->D[k];
        for (int p = spd->col_start[k]; p < spd->col_start[k + 1]; p++) {
            y[k] -= spd->L[p] * y[spd->col_row[p]];
        }
        x[spd->order[k]] = y[k];
    }
}

int hn_sparse_spd_nnz(const hn_sparse_spd *spd) {
    return spd->nnz;
}

double hn_sparse_spd_factor_ops(const hn_sparse_spd *spd) {
    return spd->factor_ops;
}

double hn_sparse_spd_solve_ops(const hn_sparse_spd *spd) {
    return 4.0 * spd->nnz + spd->n;
}
