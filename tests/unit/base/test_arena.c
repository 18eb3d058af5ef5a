// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/arena.h"
#include "support/alloc.h"

#include <stdint.h>
#include <string.h>

static void pieces_are_zeroed_aligned_and_do_not_overlap(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(100);
    assert_non_null(arena);
    unsigned char *piece[200];
    for (size_t i = 0; i < 200; i++) {
        const size_t size = i * 7 % 190 + 1;
        piece[i] = hn_arena_get(arena, size);
        assert_non_null(piece[i]);
        assert_int_equal((uintptr_t)piece[i] % 64, 0);
        for (size_t k = 0; k < size; k++) {
            assert_int_equal(piece[i][k], 0);
        }
        memset(piece[i], (int)i + 1, size);
    }
    for (size_t i = 0; i < 200; i++) {
        const size_t size = i * 7 % 190 + 1;
        for (size_t k = 0; k < size; k++) {
            assert_int_equal(piece[i][k], (i + 1) % 256);
        }
    }
    hn_arena_free(arena);
}

// memory that was used before and given back is what the next arena may get
static void pieces_are_zeroed_in_blocks_of_every_size(void **state) {
    (void)state;
    for (size_t block = 64; block <= 1 << 20; block *= 4) {
        for (int turn = 0; turn < 3; turn++) {
            hn_arena *arena = hn_arena_create(block);
            for (size_t taken = 0; taken < 3 * block; taken += block / 4 + 8) {
                unsigned char *piece = hn_arena_get(arena, block / 4 + 8);
                assert_non_null(piece);
                for (size_t k = 0; k < block / 4 + 8; k++) {
                    assert_int_equal(piece[k], 0);
                }
                memset(piece, 0xa5, block / 4 + 8);
            }
            hn_arena_free(arena);
        }
    }
}

static void a_request_inside_the_first_block_does_not_allocate(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(64 * 10);
    const long before = hn_alloc_count();
    for (int i = 0; i < 10; i++) {
        assert_non_null(hn_arena_get(arena, 64));
    }
    assert_int_equal(hn_alloc_count(), before);
    assert_non_null(hn_arena_get(arena, 1));
    assert_int_equal(hn_alloc_count(), before + 1);
    assert_int_equal(hn_arena_used(arena), 64 * 11);
    hn_arena_free(arena);
}

static void requests_that_overflow_fail_and_the_flag_stays(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    assert_int_equal(hn_arena_failed(arena), 0);
    assert_null(hn_arena_doubles(arena, SIZE_MAX / 4));
    assert_int_equal(hn_arena_failed(arena), 1);
    assert_non_null(hn_arena_doubles(arena, 3));
    assert_int_equal(hn_arena_failed(arena), 1);
    assert_null(hn_arena_get(arena, SIZE_MAX - 8));
    hn_arena_free(arena);
}

static void size_zero_has_an_address_of_its_own(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    void *a = hn_arena_get(arena, 0), *b = hn_arena_get(arena, 0);
    assert_non_null(a);
    assert_non_null(b);
    assert_ptr_not_equal(a, b);
    hn_arena_free(arena);
}

static void strdup_copies_and_passes_null_on(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    char text[] = "crank";
    const char *copy = hn_arena_strdup(arena, text);
    text[0] = 'X';
    assert_string_equal(copy, "crank");
    assert_null(hn_arena_strdup(arena, NULL));
    assert_int_equal(hn_arena_failed(arena), 0);
    hn_arena_free(arena);
}

static void every_failing_allocation_is_reported_and_nothing_leaks(void **state) {
    (void)state;
    const long live = hn_alloc_live();
    int failures = 0;
    for (long n = 1;; n++) {
        hn_alloc_fail_at(n);
        hn_arena *arena = hn_arena_create(64);
        int complete = 0;
        if (arena != NULL) {
            for (int i = 0; i < 40; i++) {
                if (hn_arena_ints(arena, 30) == NULL) {
                    assert_true(hn_alloc_has_failed());
                }
            }
            complete = !hn_arena_failed(arena);
            assert_int_equal(complete, !hn_alloc_has_failed());
            hn_arena_free(arena);
        }
        hn_alloc_fail_at(0);
        assert_int_equal(hn_alloc_live(), live);
        if (complete) {
            break;
        }
        failures++;
    }
    assert_true(failures >= 3);
    hn_arena_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_are_zeroed_aligned_and_do_not_overlap),
        cmocka_unit_test(pieces_are_zeroed_in_blocks_of_every_size),
        cmocka_unit_test(a_request_inside_the_first_block_does_not_allocate),
        cmocka_unit_test(requests_that_overflow_fail_and_the_flag_stays),
        cmocka_unit_test(size_zero_has_an_address_of_its_own),
        cmocka_unit_test(strdup_copies_and_passes_null_on),
        cmocka_unit_test(every_failing_allocation_is_reported_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
