// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/sha256.h"

#include "support/near.h"

#include <stdlib.h>
#include <string.h>

static void assert_hash(const char *text, size_t n, const char *expected) {
    char out[HN_SHA256_BASE64];
    memset(out, 'x', sizeof out);
    hn_sha256_base64(text, n, out);
    assert_string_equal(out, expected);
}

// the examples of FIPS 180-2, appendix B, in base64
static void published_examples_are_met(void **state) {
    (void)state;
    assert_hash("", 0, "47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
    assert_hash("abc", 3, "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
    assert_hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 56,
                "JI1qYdIGOLjlwCaTDD5gOaM85Flk/yFn9uzt1BnbBsE=");
}

static void a_million_letters_are_met(void **state) {
    (void)state;
    enum { MILLION = 1000000 };
    char *text = malloc(MILLION);
    assert_non_null(text);
    memset(text, 'a', MILLION);
    assert_hash(text, MILLION, "zcduXJkU+5KBocfihNc+Z/GAmkiklyAOBG05zMcRLNA=");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_examples_are_met),
        cmocka_unit_test(a_million_letters_are_met),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
