// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/column_choice.h"

#include "linalg/least_heap.h"

#include <math.h>
#include <stdbool.h>

enum { MOST_FILL = 40 }; // entries of the factor for each entry of A

struct hn_column_choice {
    int rows, cols, n_entries;
    const int *row;
    int *start, *list; ///< entries of each column: list[start[j]] .. list[start[j + 1] - 1]
    // columns taken: what they take from others, below their pivots
    int n_taken, n_factor, most_factor;
    int *first, *factor_row; ///< first: rows + 1
    double *factor;
    int *pivot_row, *pivot_of; ///< of a column taken; of a row: 1 + that column, 0: none yet
    // the column at hand
    double *x; ///< rows, zero where nothing is
    int *touched, *is_touched, n_touched;
    hn_least_heap due; ///< columns taken that have to be subtracted still
};

static void sort_by_column(hn_column_choice *c, const int *col, int *next) {
    for (int k = 0; k < c->n_entries; k++) {
        c->start[col[k] + 1]++;
    }
    for (int j = 0; j < c->cols; j++) {
        c->start[j + 1] += c->start[j];
        next[j] = c->start[j];
    }
    for (int k = 0; k < c->n_entries; k++) {
        c->list[next[col[k]]++] = k;
    }
}

hn_column_choice *hn_column_choice_create(hn_arena *arena, int rows, int cols, int n_entries,
                                          const int *row, const int *col) {
    hn_column_choice *c = hn_arena_get(arena, sizeof *c);
    if (!c) {
        return NULL;
    }
    *c = (hn_column_choice){.rows = rows, .cols = cols, .n_entries = n_entries, .row = row};
    const size_t m = (size_t)rows, most = (size_t)MOST_FILL * (size_t)n_entries;
    c->most_factor = (int)most;
    c->start = hn_arena_ints(arena, (size_t)cols + 1);
    c->list = hn_arena_ints(arena, (size_t)n_entries);
    c->first = hn_arena_ints(arena, m + 1);
    c->factor_row = hn_arena_ints(arena, most);
    c->factor = hn_arena_doubles(arena, most);
    c->pivot_row = hn_arena_ints(arena, m);
    c->pivot_of = hn_arena_ints(arena, m);
    c->x = hn_arena_doubles(arena, m);
    c->touched = hn_arena_ints(arena, m);
    c->is_touched = hn_arena_ints(arena, m);
    int *next = hn_arena_ints(arena, (size_t)cols);
    if (!hn_least_heap_init(&c->due, arena, rows) || hn_arena_failed(arena)) {
        return NULL;
    }
    sort_by_column(c, col, next);
    return c;
}

/// Adds to row i of the column at hand.
static void add(hn_column_choice *c, int i, double value) {
    if (!c->is_touched[i]) {
        c->is_touched[i] = 1;
        c->touched[c->n_touched++] = i;
        if (c->pivot_of[i]) {
            hn_least_heap_set(&c->due, c->pivot_of[i] - 1, c->pivot_of[i] - 1);
        }
    }
    c->x[i] += value;
}

/// The column at hand less its part along the columns taken; its largest entry at first.
static double eliminate(hn_column_choice *c, const double *entry, int column) {
    double size = 0;
    for (int k = c->start[column]; k < c->start[column + 1]; k++) {
        add(c, c->row[c->list[k]], entry[c->list[k]]);
        size = fmax(size, fabs(entry[c->list[k]]));
    }
    for (int k = hn_least_heap_top(&c->due); k >= 0; k = hn_least_heap_top(&c->due)) {
        const double along = c->x[c->pivot_row[k]];
        hn_least_heap_remove(&c->due, k);
        for (int e = c->first[k]; e < c->first[k + 1] && along != 0; e++) {
            add(c, c->factor_row[e], -along * c->factor[e]);
        }
    }
    return size;
}

static int find_pivot(const hn_column_choice *c) {
    int best = -1;
    for (int e = 0; e < c->n_touched; e++) {
        const int i = c->touched[e];
        if (!c->pivot_of[i] && (best < 0 || fabs(c->x[i]) > fabs(c->x[best]))) {
            best = i;
        }
    }
    return best;
}

static bool has_room(const hn_column_choice *c) {
    return c->n_factor + c->n_touched <= c->most_factor;
}

/// The column at hand is taken: what it takes from later ones for each unit in its pivot's row.
static void take(hn_column_choice *c, int pivot) {
    for (int e = 0; e < c->n_touched; e++) {
        const int i = c->touched[e];
        if (i != pivot && !c->pivot_of[i] && c->x[i] != 0) {
            c->factor_row[c->n_factor] = i;
            c->factor[c->n_factor++] = c->x[i] / c->x[pivot];
        }
    }
    c->pivot_row[c->n_taken++] = pivot;
    c->pivot_of[pivot] = c->n_taken;
    c->first[c->n_taken] = c->n_factor;
}

static void clear(hn_column_choice *c) {
    for (int e = 0; e < c->n_touched; e++) {
        c->x[c->touched[e]] = 0;
        c->is_touched[c->touched[e]] = 0;
    }
    c->n_touched = 0;
}

int hn_column_choice_run(hn_column_choice *c, const double *entry, const int *order, int n_order,
                         double tol, int *taken) {
    c->n_taken = c->n_factor = 0;
    for (int i = 0; i < c->rows; i++) {
        c->pivot_of[i] = 0;
    }
    for (int k = 0; k < n_order && c->n_taken < c->rows; k++) {
        const double size = eliminate(c, entry, order[k]);
        const int pivot = find_pivot(c);
        if (!has_room(c)) {
            clear(c);
            break;
        }
        if (pivot >= 0 && fabs(c->x[pivot]) > tol * size) {
            taken[c->n_taken] = order[k];
            take(c, pivot);
        }
        clear(c);
    }
    return c->n_taken;
}
