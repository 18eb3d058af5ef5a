// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_ARENA_H
#define HN_BASE_ARENA_H
// Memory that is given out piece by piece and freed all at once. Blocks grow on demand while
// objects are built; a time step allocates nothing. hn_arena_used() says how much was given out.

#include <stdbool.h>
#include <stddef.h>

typedef struct hn_arena hn_arena;

/// Returns owned, or NULL when memory is out. `first_block` bytes are taken at once (0: 4096).
hn_arena *hn_arena_create(size_t first_block);
void hn_arena_free(hn_arena *arena); ///< NULL is legal

/// Zeroed, aligned to 64 bytes; NULL when memory is out (then hn_arena_failed() stays true). size 0
/// gives a valid pointer. Borrowed: lives until the arena is freed.
void *hn_arena_get(hn_arena *arena, size_t size);
/// n doubles / ints, zeroed; NULL on overflow or when memory is out.
double *hn_arena_doubles(hn_arena *arena, size_t n);
int *hn_arena_ints(hn_arena *arena, size_t n);
/// A copy of the text; NULL in, NULL out.
char *hn_arena_strdup(hn_arena *arena, const char *text);

/// True once any request failed: check once after building
bool hn_arena_failed(const hn_arena *arena);
size_t hn_arena_used(const hn_arena *arena); ///< bytes given out
#endif
