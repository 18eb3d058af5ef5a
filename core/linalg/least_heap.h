// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_LEAST_HEAP_H
#define HN_LINALG_LEAST_HEAP_H
// Numbers 0 .. n-1 by keys that change, the one of the least key on top, of equal keys the lowest
// number: what orders of elimination by minimum degree ask for at every step.
// Source: Williams 1964, algorithm 232 (heapsort).

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

typedef struct hn_least_heap {
    int n; ///< numbers in it
    int *key;
    int *heap, *place; ///< place: of each number, -1: not in it
} hn_least_heap;

/// Empty, for numbers below n_max. Returns false when memory is out.
HN_MUST_CHECK bool hn_least_heap_init(hn_least_heap *h, hn_arena *arena, int n_max);
/// Number i has this key, in the heap or from now on.
void hn_least_heap_set(hn_least_heap *h, int i, int key);
void hn_least_heap_remove(hn_least_heap *h, int i); ///< nothing where it is not in it
int hn_least_heap_top(const hn_least_heap *h);      ///< -1: empty

#endif
