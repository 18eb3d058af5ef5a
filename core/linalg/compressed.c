// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/compressed.h"

#include <stdbool.h>
#include <string.h>

bool hn_compressed_init(hn_compressed *c, hn_arena *arena, int n_max, int entries_max) {
    const size_t n = (size_t)n_max, m = (size_t)entries_max;
    *c = (hn_compressed){.n_max = n_max, .entries_max = entries_max, .n_known = -1, .n_sorted = -1};
    int **of_m[] = {&c->row, &c->put_row, &c->put_col, &c->place, &c->by_row};
    for (size_t i = 0; i < sizeof of_m / sizeof *of_m; i++) {
        *of_m[i] = hn_arena_ints(arena, m);
    }
    c->start = hn_arena_ints(arena, n + 1);
    c->next = hn_arena_ints(arena, n + 1);
    c->value = hn_arena_doubles(arena, 2 * m);
    return !hn_arena_failed(arena);
}

void hn_compressed_begin(hn_compressed *c, int n) {
    HN_ASSERT(n <= c->n_max);
    c->n = n;
    c->n_puts = 0;
    c->changed = 0;
    if (n != c->n_sorted) {
        c->n_known = -1;
    }
}

void hn_compressed_put(hn_compressed *c, int row, int col, double re, double im) {
    const int k = c->n_puts++;
    HN_ASSERT(k < c->entries_max && row < c->n && col < c->n);
    if (k >= c->n_known || row != c->put_row[k] || col != c->put_col[k]) {
        c->changed = 1;
        c->n_known = -1; // what is sorted belongs to another sequence
    }
    c->put_row[k] = row;
    c->put_col[k] = col;
    c->value[2 * k] = re;
    c->value[2 * k + 1] = im;
}

// puts in the order of `key`, those of equal keys in the order of `from` (NULL: as they came)
static void sort_by(hn_compressed *c, const int *key, const int *from, int *to) {
    memset(c->next, 0, ((size_t)c->n + 1) * sizeof *c->next);
    for (int k = 0; k < c->n_puts; k++) {
        c->next[key[k] + 1]++;
    }
    for (int i = 0; i < c->n; i++) {
        c->next[i + 1] += c->next[i];
    }
    for (int i = 0; i < c->n_puts; i++) {
        const int k = from ? from[i] : i;
        to[c->next[key[k]]++] = k;
    }
}

static void sort_places(hn_compressed *c) {
    int *by_column = c->row; // overwritten from the front, behind where it is read
    sort_by(c, c->put_row, NULL, c->by_row);
    sort_by(c, c->put_col, c->by_row, by_column);

    // equal row and column: one place
    int places = 0, col = -1, row = -1;
    for (int i = 0; i < c->n_puts; i++) {
        const int k = by_column[i];
        if (c->put_col[k] != col || c->put_row[k] != row) {
            for (; col < c->put_col[k]; col++) {
                c->start[col + 1] = places;
            }
            row = c->put_row[k];
            c->row[places++] = row;
        }
        c->place[k] = places - 1;
    }

    for (; col < c->n; col++) {
        c->start[col + 1] = places;
    }
    c->n_sorted = c->n;
    c->n_known = c->n_puts;
}

bool hn_compressed_end(hn_compressed *c, int parts, double *values) {
    const int known = !c->changed && c->n_puts == c->n_known;
    if (!known) {
        sort_places(c);
    }
    memset(values, 0, (size_t)(parts * c->start[c->n]) * sizeof *values);
    for (int k = 0; k < c->n_puts; k++) {
        for (int p = 0; p < parts; p++) {
            values[parts * c->place[k] + p] += c->value[2 * k + p];
        }
    }
    return known;
}

void hn_compressed_copy(const hn_compressed *c, double *out) {
    const size_t n = (size_t)c->n;
    memset(out, 0, n * n * sizeof *out);
    for (int k = 0; k < c->n_puts; k++) {
        out[(size_t)c->put_row[k] * n + (size_t)c->put_col[k]] += c->value[2 * k];
    }
}
