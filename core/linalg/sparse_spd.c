// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/sparse_spd.h"

#include "linalg/dense.h"
#include "linalg/least_heap.h"

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

// The rest of the matrix during the elimination: each unknown with the list of its neighbours.
typedef struct graph {
    int n;
    hn_arena *arena;
    int **list, *degree, *room; ///< degree[i] unknowns in list[i], room for room[i]
    int *seen;                  ///< marks of the step under way
    hn_least_heap left;         ///< unknowns by degree
} graph;

// false when memory is out
static bool join(graph *g, int i, int j) {
    if (g->degree[i] == g->room[i]) {
        const int room = 2 * g->room[i] + 4;
        int *list = hn_arena_ints(g->arena, (size_t)room);
        if (!list) {
            return false;
        }
        if (g->degree[i] > 0) {
            memcpy(list, g->list[i], (size_t)g->degree[i] * sizeof *list);
        }
        g->list[i] = list;
        g->room[i] = room;
    }
    g->list[i][g->degree[i]++] = j;
    return true;
}

static void part(graph *g, int i, int j) {
    int *list = g->list[i], k = 0;
    while (list[k] != j) {
        k++;
    }
    list[k] = list[--g->degree[i]];
}

// takes out unknown i: its neighbours, which stay in its list, all become neighbours of each other.
// Returns false when memory is out.
static bool take_out(graph *g, int i) {
    const int count = g->degree[i], *list = g->list[i];
    for (int a = 0; a < count; a++) {
        const int j = list[a];
        part(g, j, i);

        // joined to those of the list that it was not joined to
        g->seen[j] = j + 1;
        for (int k = 0; k < g->degree[j]; k++) {
            g->seen[g->list[j][k]] = j + 1;
        }
        for (int b = 0; b < count; b++) {
            if (g->seen[list[b]] != j + 1 && !join(g, j, list[b])) {
                return false;
            }
        }
        hn_least_heap_set(&g->left, j, g->degree[j]);
    }
    return true;
}

static bool graph_init(graph *g, hn_arena *scratch, int n, int n_entries, const int *row,
                       const int *col) {
    *g = (graph){.n = n,
                 .arena = scratch,
                 .list = hn_arena_get(scratch, ((size_t)n + 1) * sizeof *g->list),
                 .degree = hn_arena_ints(scratch, (size_t)n),
                 .room = hn_arena_ints(scratch, (size_t)n),
                 .seen = hn_arena_ints(scratch, (size_t)n)};
    if (!hn_least_heap_init(&g->left, scratch, n) || hn_arena_failed(scratch)) {
        return false;
    }
    for (int k = 0; k < n_entries; k++) {
        if (row[k] != col[k] && (!join(g, row[k], col[k]) || !join(g, col[k], row[k]))) {
            return false;
        }
    }
    for (int i = 0; i < n; i++) {
        hn_least_heap_set(&g->left, i, g->degree[i]);
    }
    return true;
}

// the order; what an unknown was joined to when it was taken out stays in its list: its column of L
static bool choose_order(hn_sparse_spd *spd, graph *g) {
    for (int k = 0; k < spd->n; k++) {
        const int i = hn_least_heap_top(&g->left), count = g->degree[i];
        hn_least_heap_remove(&g->left, i);
        spd->order[k] = i;
        spd->at[i] = k;
        spd->nnz += count;
        spd->factor_ops += (double)count * (count + 3);
        if (!take_out(g, i)) {
            return false;
        }
    }
    return true;
}

// the columns of L by rows, and then the rows by columns: either way what is listed rises
static bool list_pattern(hn_sparse_spd *spd, const graph *g, hn_arena *arena) {
    const int n = spd->n;
    int *next = spd->filled;
    spd->row_col = hn_arena_ints(arena, (size_t)spd->nnz);
    spd->col_row = hn_arena_ints(arena, (size_t)spd->nnz);
    spd->L = hn_arena_doubles(arena, (size_t)spd->nnz);
    if (hn_arena_failed(arena)) {
        return false;
    }

    // how many there are in each
    for (int k = 0; k < n; k++) {
        const int i = spd->order[k];
        spd->col_start[k + 1] = spd->col_start[k] + g->degree[i];
        for (int e = 0; e < g->degree[i]; e++) {
            spd->row_start[spd->at[g->list[i][e]] + 1]++;
        }
    }
    for (int k = 0; k < n; k++) {
        next[k] = spd->row_start[k];
        spd->row_start[k + 1] += spd->row_start[k];
    }

    // rows, column after column
    for (int k = 0; k < n; k++) {
        const int i = spd->order[k];
        for (int e = 0; e < g->degree[i]; e++) {
            spd->row_col[next[spd->at[g->list[i][e]]]++] = k;
        }
    }

    // columns, row after row
    memcpy(next, spd->col_start, (size_t)n * sizeof *next);
    for (int k = 0; k < n; k++) {
        for (int e = spd->row_start[k]; e < spd->row_start[k + 1]; e++) {
            spd->col_row[next[spd->row_col[e]]++] = k;
        }
    }
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
        if (!hn_arena_failed(arena) && choose_order(spd, &g)) {
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
