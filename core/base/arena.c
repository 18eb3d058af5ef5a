// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/arena.h"

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { ALIGNMENT = 64, DEFAULT_BLOCK = 4096, LARGEST_DOUBLED = 16 << 20 };
// A smaller block is zeroed piece by piece: what is never given out is never touched, and a page
// that is touched costs a short run more than most of its arithmetic. Larger ones come as zeros
// from the system.
enum { ZEROED_AT_ONCE = 1 << 17 };

// Blocks form a list, newest first; only the newest is filled. `bytes` is aligned by hand because
// malloc promises 16.
typedef struct block {
    struct block *older;
    char *bytes;
    size_t size, used;
    bool is_zero; ///< what is still free in it
} block;

struct hn_arena {
    block *newest;
    size_t used;
    int failed;
};

static block *block_create(size_t size, block *older) {
    if (size > SIZE_MAX - sizeof(block) - ALIGNMENT) {
        return NULL;
    }
    const bool is_zero = size >= ZEROED_AT_ONCE;
    const size_t all = sizeof(block) + size + ALIGNMENT;
    block *b = is_zero ? calloc(1, all) : malloc(all);
    if (b != NULL) {
        const uintptr_t start = (uintptr_t)(b + 1);
        b->older = older;
        b->bytes = (char *)(b + 1) + (ALIGNMENT - start % ALIGNMENT) % ALIGNMENT;
        b->size = size;
        b->used = 0;
        b->is_zero = is_zero;
    }
    return b;
}

hn_arena *hn_arena_create(size_t first_block) {
    hn_arena *arena = calloc(1, sizeof *arena);
    if (arena == NULL) {
        return NULL;
    }
    arena->newest = block_create(first_block > 0 ? first_block : DEFAULT_BLOCK, NULL);
    if (arena->newest == NULL) {
        free(arena);
        return NULL;
    }
    return arena;
}

void hn_arena_free(hn_arena *arena) {
    if (arena == NULL) {
        return;
    }
    for (block *b = arena->newest; b != NULL;) {
        block *older = b->older;
        free(b);
        b = older;
    }
    free(arena);
}

/// A new block of at least `size` bytes, twice the last one's, so that n requests take O(log n)
/// blocks; beyond LARGEST_DOUBLED as large as that, so that a few large pieces do not ask for
/// gigabytes.
static bool grow(hn_arena *arena, size_t size) {
    const size_t last = arena->newest->size;
    const size_t doubled = last <= LARGEST_DOUBLED / 2 ? 2 * last : LARGEST_DOUBLED;
    block *b = block_create(size > doubled ? size : doubled, arena->newest);
    if (b == NULL) {
        arena->failed = 1;
        return false;
    }
    arena->newest = b;
    return true;
}

void *hn_arena_get(hn_arena *arena, size_t size) {
    HN_ASSERT(arena != NULL);
    if (size > SIZE_MAX - ALIGNMENT) {
        arena->failed = 1;
        return NULL;
    }

    // every piece takes whole lines of 64 bytes: two pieces never share one, and size 0 has an
    // address
    const size_t lines = size == 0 ? 1 : (size + ALIGNMENT - 1) / ALIGNMENT;
    const size_t rounded = lines * ALIGNMENT;
    if (arena->newest->size - arena->newest->used < rounded && !grow(arena, rounded)) {
        return NULL;
    }

    void *piece = arena->newest->bytes + arena->newest->used;
    arena->newest->used += rounded;
    arena->used += rounded;
    return arena->newest->is_zero ? piece : memset(piece, 0, rounded);
}

static void *get_items(hn_arena *arena, size_t n, size_t size) {
    HN_ASSERT(arena != NULL);
    if (n > SIZE_MAX / size) {
        arena->failed = 1;
        return NULL;
    }
    return hn_arena_get(arena, n * size);
}

double *hn_arena_doubles(hn_arena *arena, size_t n) {
    return get_items(arena, n, sizeof(double));
}

int *hn_arena_ints(hn_arena *arena, size_t n) {
    return get_items(arena, n, sizeof(int));
}

char *hn_arena_strdup(hn_arena *arena, const char *text) {
    if (text == NULL) {
        return NULL;
    }
    const size_t n = strlen(text) + 1;
    char *copy = hn_arena_get(arena, n);
    return copy == NULL ? NULL : memcpy(copy, text, n);
}

bool hn_arena_failed(const hn_arena *arena) {
    return arena->failed;
}

size_t hn_arena_used(const hn_arena *arena) {
    return arena->used;
}
