// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *piece, size_t size);
void __real_free(void *piece);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *piece, size_t size);
void __wrap_free(void *piece);

// The live pieces, a set by open addressing: memory that libc itself allocated (strdup) also comes
// to __wrap_free and must not be counted, so a plain counter would drift.
static struct {
    pthread_mutex_t lock;
    long calls, fail_at;
    int has_failed;
    uintptr_t *slots; ///< 0: free, 1: was used
    size_t n_slots, n_filled;
    long live;
} state = {.lock = PTHREAD_MUTEX_INITIALIZER};

static size_t slot_of(uintptr_t key) {
    return (size_t)(key >> 4) * 0x9e3779b97f4a7c15ull >> 20 & (state.n_slots - 1);
}

static void put(uintptr_t key) {
    size_t i = slot_of(key);
    while (state.slots[i] > 1) {
        i = (i + 1) & (state.n_slots - 1);
    }
    state.n_filled += state.slots[i] == 0;
    state.slots[i] = key;
}

/// Room for one more, at most half full; a test helper without memory may as well stop.
static void make_room(void) {
    if (2 * (state.n_filled + 1) < state.n_slots) {
        return;
    }
    uintptr_t *old = state.slots;
    const size_t n_old = state.n_slots;
    const size_t needed = 4 * ((size_t)state.live + 256);
    state.n_slots = 1024;
    while (state.n_slots < needed) {
        state.n_slots *= 2;
    }
    state.slots = __real_calloc(state.n_slots, sizeof *state.slots);
    if (state.slots == NULL) {
        abort();
    }
    state.n_filled = 0;
    for (size_t i = 0; i < n_old; i++) {
        if (old[i] > 1) {
            put(old[i]);
        }
    }
    __real_free(old);
}

static void note_given(void *piece) {
    if (piece != NULL) {
        make_room();
        put((uintptr_t)piece);
        state.live++;
    }
}

static void note_freed(uintptr_t key) {
    if (state.n_slots == 0) {
        return;
    }
    for (size_t i = slot_of(key); state.slots[i] != 0; i = (i + 1) & (state.n_slots - 1)) {
        if (state.slots[i] == key) {
            state.slots[i] = 1;
            state.live--;
            return;
        }
    }
}

/// Counts one call; 1 if it is the one that must fail. The lock is held.
static int count_call(void) {
    state.calls++;
    if (state.fail_at > 0 && --state.fail_at == 0) {
        state.has_failed = 1;
        return 1;
    }
    return 0;
}

void *__wrap_malloc(size_t size) {
    pthread_mutex_lock(&state.lock);
    void *piece = count_call() ? NULL : __real_malloc(size);
    note_given(piece);
    pthread_mutex_unlock(&state.lock);
    return piece;
}

void *__wrap_calloc(size_t n, size_t size) {
    pthread_mutex_lock(&state.lock);
    void *piece = count_call() ? NULL : __real_calloc(n, size);
    note_given(piece);
    pthread_mutex_unlock(&state.lock);
    return piece;
}

void *__wrap_realloc(void *piece, size_t size) {
    if (size == 0) {
        __wrap_free(piece);
        return NULL;
    }
    pthread_mutex_lock(&state.lock);
    const uintptr_t old = (uintptr_t)piece;
    void *moved = count_call() ? NULL : __real_realloc(piece, size);
    if (moved != NULL) {
        note_freed(old);
        note_given(moved);
    }
    pthread_mutex_unlock(&state.lock);
    return moved;
}

void __wrap_free(void *piece) {
    if (piece == NULL) {
        return;
    }
    pthread_mutex_lock(&state.lock);
    note_freed((uintptr_t)piece);
    pthread_mutex_unlock(&state.lock);
    __real_free(piece);
}

long hn_alloc_count(void) {
    pthread_mutex_lock(&state.lock);
    const long calls = state.calls;
    pthread_mutex_unlock(&state.lock);
    return calls;
}

void hn_alloc_fail_at(long n) {
    pthread_mutex_lock(&state.lock);
    state.fail_at = n;
    state.has_failed = 0;
    pthread_mutex_unlock(&state.lock);
}

int hn_alloc_has_failed(void) {
    pthread_mutex_lock(&state.lock);
    const int has_failed = state.has_failed;
    pthread_mutex_unlock(&state.lock);
    return has_failed;
}

long hn_alloc_live(void) {
    pthread_mutex_lock(&state.lock);
    const long live = state.live;
    pthread_mutex_unlock(&state.lock);
    return live;
}
