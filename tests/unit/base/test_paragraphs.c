// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/paragraphs.h"

static void lines_of_a_paragraph_are_joined_and_formulas_stay(void **state) {
    (void)state;
    static const struct {
        const char *text, *expected;
    } rows[] = {
        {"", ""},
        {"one", "one"},
        {"one\ntwo\nthree\n", "one two three\n"},
        {"one\n\ntwo\n", "one\n\ntwo\n"},
        {"so that\n    a = b,\n    c = d\nwhere a\nis b\n",
         "so that\n    a = b,\n    c = d\nwhere a is b\n"},
        {"\n\none\n", "\n\none\n"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_paragraphs_join(&b, rows[i].text);
        assert_string_equal(hn_strbuf_text(&b), rows[i].expected);
        hn_strbuf_reset(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_of_a_paragraph_are_joined_and_formulas_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
