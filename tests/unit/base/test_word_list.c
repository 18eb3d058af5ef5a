// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/word_list.h"

static void the_last_two_words_are_joined_by_a_word(void **state) {
    (void)state;
    const char *const words[] = {"a", "b", "c"};
    const char *const expected[] = {"", "a", "a and b", "a, b and c"};
    for (int n = 0; n <= 3; n++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_word_list(&b, words, n, " and ");
        assert_string_equal(hn_strbuf_text(&b), expected[n]);
        hn_strbuf_reset(&b);
    }
}

static void joints_serve_lists_that_code_writes(void **state) {
    (void)state;
    assert_string_equal(hn_word_joint(0, 1, " or "), "");
    assert_string_equal(hn_word_joint(1, 2, " or "), " or ");
    assert_string_equal(hn_word_joint(1, 3, " or "), ", ");
    assert_string_equal(hn_word_joint(2, 3, " or "), " or ");
}

static void words_between_blanks_come_one_by_one(void **state) {
    (void)state;
    const char *list = "alpha  beta";
    char word[5] = "none";
    assert_true(hn_word_next(&list, word, sizeof word));
    assert_string_equal(word, "alph"); // cut at the size
    assert_true(hn_word_next(&list, word, sizeof word));
    assert_string_equal(word, "beta");
    assert_false(hn_word_next(&list, word, sizeof word));
    assert_string_equal(word, "beta");
    list = "";
    assert_false(hn_word_next(&list, word, sizeof word));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_two_words_are_joined_by_a_word),
        cmocka_unit_test(joints_serve_lists_that_code_writes),
        cmocka_unit_test(words_between_blanks_come_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
