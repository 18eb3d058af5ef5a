// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/hash.h"

#include <string.h>

// from the table of test vectors in draft-eastlake-fnv: FNV-1a, 64 bits
static void published_vectors_of_fnv1a_are_met(void **state) {
    (void)state;
    assert_true(hn_hash_bytes(HN_HASH_START, "", 0) == 0xcbf29ce484222325ull);
    assert_true(hn_hash_bytes(HN_HASH_START, "a", 1) == 0xaf63dc4c8601ec8cull);
    assert_true(hn_hash_bytes(HN_HASH_START, "foobar", 6) == 0x85944171f73967e8ull);
}

static void texts_hashed_in_a_row_keep_their_borders(void **state) {
    (void)state;
    const uint64_t one = hn_hash_text(hn_hash_text(HN_HASH_START, "ab"), "c");
    const uint64_t other = hn_hash_text(hn_hash_text(HN_HASH_START, "a"), "bc");
    assert_true(one != other);
}

static void both_zeros_hash_alike_and_neighbours_do_not(void **state) {
    (void)state;
    assert_true(hn_hash_double(7, 0.0) == hn_hash_double(7, -0.0));
    assert_true(hn_hash_double(7, 1.0) != hn_hash_double(7, 1.0 + 0x1p-52));
    assert_true(hn_hash_double(7, 1.0) != hn_hash_double(8, 1.0));
}

// a good finaliser flips half of the output bits when one input bit flips
static void one_flipped_bit_flips_about_half_of_the_mix(void **state) {
    (void)state;
    double flipped = 0;
    for (uint64_t k = 1; k <= 64; k++) {
        for (int bit = 0; bit < 64; bit++) {
            const uint64_t d = hn_hash_mix(k) ^ hn_hash_mix(k ^ (1ull << bit));
            flipped += __builtin_popcountll(d);
        }
    }
    assert_near(flipped / (64.0 * 64.0), 32, 0.5);
}

static void hex_has_sixteen_digits_with_leading_zeros(void **state) {
    (void)state;
    char text[17];
    memset(text, 'x', sizeof text);
    hn_hash_hex(0x0123456789abcdefull, text);
    assert_string_equal(text, "0123456789abcdef");
    hn_hash_hex(0xf, text);
    assert_string_equal(text, "000000000000000f");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_vectors_of_fnv1a_are_met),
        cmocka_unit_test(texts_hashed_in_a_row_keep_their_borders),
        cmocka_unit_test(both_zeros_hash_alike_and_neighbours_do_not),
        cmocka_unit_test(one_flipped_bit_flips_about_half_of_the_mix),
        cmocka_unit_test(hex_has_sixteen_digits_with_leading_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
