// SPDX-License-Identifier: GPL-3.0-or-later
// The heap of orders of elimination against a search over all numbers.

#include "linalg/least_heap.h"
#include "support/near.h"

#include <gsl/gsl_rng.h>

enum { MANY = 60, TURNS = 4000 };

static int search(const int *key, const int *in, int n) {
    int best = -1;
    for (int i = 0; i < n; i++) {
        if (in[i] && (best < 0 || key[i] < key[best])) {
            best = i;
        }
    }
    return best;
}

static void the_top_is_the_first_of_the_least_through_all_changes(void **state) {
    (void)state;
    int key[MANY] = {0}, in[MANY] = {0};
    hn_arena *arena = hn_arena_create(0);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    hn_least_heap heap;
    assert_true(hn_least_heap_init(&heap, arena, MANY));
    assert_int_equal(hn_least_heap_top(&heap), -1);
    for (int turn = 0; turn < TURNS; turn++) {
        const int i = (int)gsl_rng_uniform_int(rng, MANY);
        if (gsl_rng_uniform_int(rng, 3) == 0) {
            hn_least_heap_remove(&heap, i);
            in[i] = 0;
        } else {
            key[i] = (int)gsl_rng_uniform_int(rng, 9); // many are alike
            hn_least_heap_set(&heap, i, key[i]);
            in[i] = 1;
        }
        assert_int_equal(hn_least_heap_top(&heap), search(key, in, MANY));
    }
    gsl_rng_free(rng);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_top_is_the_first_of_the_least_through_all_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
