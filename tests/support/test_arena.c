// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/test_arena.h"

hn_arena *hn_test_arena;

int hn_test_arena_open(void **state) {
    (void)state;
    hn_test_arena = hn_arena_create(0);
    return hn_test_arena ? 0 : -1;
}

int hn_test_arena_close(void **state) {
    (void)state;
    hn_arena_free(hn_test_arena);
    hn_test_arena = NULL;
    return 0;
}
