// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/row_groups.h"

#include <math.h>

hn_status hn_row_groups_init(const hn_system *sys, hn_arena *arena, hn_row_groups *g) {
    const int n = hn_system_get_info(sys).nc;
    *g = (hn_row_groups){.n = n,
                         .group = hn_arena_ints(arena, (size_t)n),
                         .largest = hn_arena_doubles(arena, (size_t)n)};
    int loops = 0;
    for (int i = 0; i < n; i++) {
        const int loop = hn_system_row_loop(sys, i);
        loops = loop >= loops ? loop + 1 : loops;
    }
    int *first = hn_arena_ints(arena, 2 * (size_t)loops + 1); // 1 + the row, 0: none yet
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // a group goes by its first row
    for (int i = 0; i < n; i++) {
        int *of = &first[2 * hn_system_row_loop(sys, i) + hn_system_row_is_length(sys, i)];
        *of = *of ? *of : i + 1;
        g->group[i] = *of - 1;
    }
    return HN_OK;
}

double hn_row_groups_ratio(hn_row_groups *g, const double *square, const uint16_t *slots) {
    double least = 1;
    for (int i = 0; i < g->n; i++) {
        g->largest[i] = 0;
    }
    for (int i = 0; i < g->n; i++) {
        double *largest = &g->largest[g->group[i]];
        const double size = fabs(square[slots[i]]);
        *largest = size > *largest ? size : *largest;
    }
    for (int i = 0; i < g->n; i++) {
        const double size = fabs(square[slots[i]]), largest = g->largest[g->group[i]];
        if (size < least * largest && size > 0) {
            least = size / largest;
        }
    }
    return least;
}
