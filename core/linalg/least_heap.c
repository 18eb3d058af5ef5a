// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/least_heap.h"

bool hn_least_heap_init(hn_least_heap *h, hn_arena *arena, int n_max) {
    *h = (hn_least_heap){.key = hn_arena_ints(arena, (size_t)n_max),
                         .heap = hn_arena_ints(arena, (size_t)n_max),
                         .place = hn_arena_ints(arena, (size_t)n_max)};
    if (!h->key || !h->heap || !h->place) {
        return false;
    }
    for (int i = 0; i < n_max; i++) {
        h->place[i] = -1;
    }
    return true;
}

static bool goes_before(const hn_least_heap *h, int i, int j) {
    return h->key[i] < h->key[j] || (h->key[i] == h->key[j] && i < j);
}

static void put(hn_least_heap *h, int at, int i) {
    h->heap[at] = i;
    h->place[i] = at;
}

/// Moves number i, whose key has changed, to where it belongs.
static void settle(hn_least_heap *h, int i) {
    int at = h->place[i];
    while (at > 0 && goes_before(h, i, h->heap[(at - 1) / 2])) {
        put(h, at, h->heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    for (int below = 2 * at + 1; below < h->n; below = 2 * at + 1) {
        below += below + 1 < h->n && goes_before(h, h->heap[below + 1], h->heap[below]);
        if (!goes_before(h, h->heap[below], i)) {
            break;
        }
        put(h, at, h->heap[below]);
        at = below;
    }
    put(h, at, i);
}

void hn_least_heap_set(hn_least_heap *h, int i, int key) {
    h->key[i] = key;
    if (h->place[i] < 0) {
        put(h, h->n++, i);
    }
    settle(h, i);
}

void hn_least_heap_remove(hn_least_heap *h, int i) {
    const int at = h->place[i];
    if (at < 0) {
        return;
    }
    const int last = h->heap[--h->n];
    h->place[i] = -1;
    if (last != i) {
        put(h, at, last);
        settle(h, last);
    }
}

int hn_least_heap_top(const hn_least_heap *h) {
    return h->n > 0 ? h->heap[0] : -1;
}
