// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/diag.h"

#include <string.h>

static void a_fault_keeps_where_what_and_hint(void **state) {
    (void)state;
    hn_diags d = {0};
    const hn_status s = hn_diags_add(&d, HN_ERR_INPUT, "/joints/2/type", "did you mean 'revolute'?",
                                     "found '%s', allowed: %d types", "revolut", 2);
    assert_int_equal(s, HN_ERR_INPUT);
    assert_int_equal(d.n, 1);
    assert_int_equal(d.item[0].status, HN_ERR_INPUT);
    assert_string_equal(d.item[0].pointer, "/joints/2/type");
    assert_string_equal(d.item[0].message, "found 'revolut', allowed: 2 types");
    assert_string_equal(d.item[0].hint, "did you mean 'revolute'?");
    assert_int_equal(d.item[0].column, 0);
}

static void the_list_keeps_the_first_few_and_counts_all(void **state) {
    (void)state;
    hn_diags d = {0};
    for (int i = 0; i < HN_DIAG_MAX + 9; i++) {
        (void)hn_diags_add(&d, HN_ERR_INPUT, NULL, NULL, "fault %d", i);
    }
    assert_int_equal(d.n, HN_DIAG_MAX);
    assert_int_equal(d.found, HN_DIAG_MAX + 9);
    assert_string_equal(d.item[0].message, "fault 0");
    assert_string_equal(d.item[HN_DIAG_MAX - 1].message, "fault 15");
    assert_string_equal(d.item[3].pointer, "");
    assert_string_equal(d.item[3].hint, "");
}

static void without_a_place_to_write_the_status_still_comes_back(void **state) {
    (void)state;
    assert_int_equal(hn_diags_add(NULL, HN_ERR_LIMIT, "/a", NULL, "x"), HN_ERR_LIMIT);
    assert_int_equal(hn_diag_set(NULL, HN_ERR_IO, "/a", NULL, "x"), HN_ERR_IO);
}

// 'é' is two bytes, so for one of the two offsets the cut would fall inside of it
static void a_long_text_is_cut_between_characters_and_says_so(void **state) {
    (void)state;
    for (int offset = 0; offset < 2; offset++) {
        char text[4 * HN_DIAG_MESSAGE + 4] = "";
        strcpy(text, offset ? "x" : "");
        for (int i = 0; i < HN_DIAG_MESSAGE; i++) {
            strcat(text, "\xc3\xa9");
        }
        hn_diag d;
        (void)hn_diag_set(&d, HN_ERR_INPUT, text, text, "%s", text);
        const char *const kept[] = {d.message, d.pointer, d.hint};
        const size_t caps[] = {sizeof d.message, sizeof d.pointer, sizeof d.hint};
        for (int k = 0; k < 3; k++) {
            const size_t n = strlen(kept[k]);
            assert_true(n < caps[k] && n >= caps[k] - 6);
            assert_string_equal(kept[k] + n - 3, "...");
            assert_int_equal((n - 3 - (size_t)offset) % 2, 0);
            assert_memory_equal(kept[k], text, n - 3);
        }
    }
}

static void a_text_that_just_fits_is_kept_whole(void **state) {
    (void)state;
    char text[HN_DIAG_HINT];
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    hn_diag d;
    (void)hn_diag_set(&d, HN_ERR_INPUT, NULL, text, "m");
    assert_string_equal(d.hint, text);
}

static void the_nearest_name_forgives_small_slips_only(void **state) {
    (void)state;
    const char *const names[] = {"revolute", "prismatic", "fixed", "th1", "th2"};
    assert_string_equal(hn_nearest_name("revolut", names, 5), "revolute");
    assert_string_equal(hn_nearest_name("REVOLTUE", names, 5), "revolute");
    assert_string_equal(hn_nearest_name("prsmatik", names, 5), "prismatic");
    assert_string_equal(hn_nearest_name("fixde", names, 5), "fixed");
    assert_string_equal(hn_nearest_name("th3", names, 5), "th1");
    assert_null(hn_nearest_name("spherical", names, 5));
    assert_string_equal(hn_nearest_name("olute", names, 5), "revolute");
    assert_null(hn_nearest_name("lut", names, 5));
    assert_null(hn_nearest_name("x", names, 5));
    assert_null(hn_nearest_name("", names, 5));
    assert_null(hn_nearest_name("th1", names, 0));
}

// a transposition is one slip; as two substitutions it would be out of reach for a short word
static void swapped_letters_count_once(void **state) {
    (void)state;
    const char *const names[] = {"mass"};
    assert_string_equal(hn_nearest_name("amss", names, 1), "mass");
    assert_null(hn_nearest_name("axxs", names, 1));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fault_keeps_where_what_and_hint),
        cmocka_unit_test(the_list_keeps_the_first_few_and_counts_all),
        cmocka_unit_test(without_a_place_to_write_the_status_still_comes_back),
        cmocka_unit_test(a_long_text_is_cut_between_characters_and_says_so),
        cmocka_unit_test(a_text_that_just_fits_is_kept_whole),
        cmocka_unit_test(the_nearest_name_forgives_small_slips_only),
        cmocka_unit_test(swapped_letters_count_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
