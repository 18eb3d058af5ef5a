// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "cli/shell/braille.h"

#include <string.h>

static void expect_row(const hn_braille *c, int row, const char *text) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_braille_row(&b, c, row);
    assert_string_equal(hn_strbuf_text(&b), text);
    hn_strbuf_reset(&b);
}

// one cell has 2 x 4 dots: U+2801 is the upper left one, U+2880 the lower right one
static void corners_of_a_cell_are_its_corner_dots(void **state) {
    (void)state;
    static hn_braille c;
    hn_braille_init(&c, 1, 1);
    hn_braille_line(&c, 0, 0, 0, 0);
    expect_row(&c, 0, "\xe2\xa0\x81");
    hn_braille_line(&c, 1, 1, 1, 1);
    expect_row(&c, 0, "\xe2\xa2\x81");
}

static void a_level_line_goes_through_every_cell_of_its_row(void **state) {
    (void)state;
    static hn_braille c;
    hn_braille_init(&c, 3, 2);
    hn_braille_line(&c, 0, 0, 1, 0);
    expect_row(&c, 0, "\xe2\xa0\x89\xe2\xa0\x89\xe2\xa0\x89"); // both upper dots
    expect_row(&c, 1, "   ");
}

static void a_glyph_hides_the_line_and_the_first_one_stays(void **state) {
    (void)state;
    static hn_braille c;
    hn_braille_init(&c, 2, 1);
    hn_braille_line(&c, 0, 0, 1, 0);
    hn_braille_put(&c, 1, 1, "x");
    hn_braille_put(&c, 0.9, 0.1, "y");
    expect_row(&c, 0, "\xe2\xa0\x89x");
}

static void what_lies_outside_is_left_out(void **state) {
    (void)state;
    static hn_braille c;
    hn_braille_init(&c, 2, 1);
    hn_braille_line(&c, -3, -2, -1, -1);
    hn_braille_put(&c, 1.5, 0, "x");
    hn_braille_put(&c, -0.1, 0, "x");
    expect_row(&c, 0, "  ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_of_a_cell_are_its_corner_dots),
        cmocka_unit_test(a_level_line_goes_through_every_cell_of_its_row),
        cmocka_unit_test(a_glyph_hides_the_line_and_the_first_one_stays),
        cmocka_unit_test(what_lies_outside_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
