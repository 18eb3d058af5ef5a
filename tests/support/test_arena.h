// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_TEST_ARENA_H
#define HN_SUPPORT_TEST_ARENA_H
// An arena that each test of a file has anew.

#include "base/arena.h"

/// There between the two calls below.
extern hn_arena *hn_test_arena;
/// Setup and teardown of a test.
int hn_test_arena_open(void **state);
int hn_test_arena_close(void **state);

#endif
