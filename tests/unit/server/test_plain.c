// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "cli/shell/plain.h"
#include "render/look.h"
#include "terminal/dots.h"

#include <string.h>

static void ascii_is_wanted_where_the_first_name_that_speaks_is_not_utf8(void **state) {
    (void)state;
    assert_int_equal(hn_plain_wanted(NULL, NULL, NULL), 0);
    assert_int_equal(hn_plain_wanted("", "", ""), 0);
    assert_int_equal(hn_plain_wanted("C", NULL, "de_DE.UTF-8"), 1);
    assert_int_equal(hn_plain_wanted(NULL, "POSIX", "de_DE.UTF-8"), 1);
    assert_int_equal(hn_plain_wanted("", "", "de_DE.ISO-8859-1"), 1);
    assert_int_equal(hn_plain_wanted("", "", "de_DE.UTF-8"), 0);
    assert_int_equal(hn_plain_wanted("C.utf8", "C", "C"), 0);
}

static void assert_plain(const char *utf8, const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_plain_add(&b, utf8);
    assert_string_equal(hn_strbuf_text(&b), expected);
    hn_strbuf_reset(&b);
}

static void every_character_becomes_one_of_ascii(void **state) {
    (void)state;
    assert_plain("gap 4 nm, 1 of 3", "gap 4 nm, 1 of 3");
    assert_plain("1 freedom (3 \xe2\x88\x92 2), 4 \xc2\xb5s", "1 freedom (3 - 2), 4 us");
    assert_plain("\xe2\x94\xa4\xe2\x94\x82 \xe2\x89\xa4 2", "|| < 2");
    assert_plain("\xe4\xb8\xad", "?"); // no likeness
    // a power of ten is no product with 1010, and what stands behind it stays where it is
    assert_plain("2.5×10⁻¹⁰ m│ ×10⁶ ×10 m²", "2.5e-10   m| e6   x10 m2");
    char power[] = "gap 2.5×10⁻¹⁰ m, 3×10";
    hn_plain_powers(power);
    assert_string_equal(power, "gap 2.5e-10 m, 3×10");
    // bytes that are no UTF-8 stand for themselves, and no text is read beyond its end
    assert_plain("a\xff"
                 "b\xe2",
                 "a?b?");
}

static void assert_text(const char *utf8, const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_plain_text(&b, utf8);
    assert_string_equal(hn_strbuf_text(&b), expected);
    hn_strbuf_reset(&b);
}

static void texts_are_spelled_out_and_their_columns_stay(void **state) {
    (void)state;
    assert_text("the angles θ₁ and φ of ℓ₂", "the angles theta_1 and phi of l_2");
    assert_text("ρ1 = σ1*sqrt(-κ1^2)\n", "rho1 = sigma1*sqrt(-kappa1^2)\n");
    assert_text("α ≤ β, q̇ → q̈, 2 m/s², 5 N·m − 1",
                "alpha <= beta, qdot -> qddot, 2 m/s^2, 5 N*m - 1");
    assert_text("gap 2.5×10⁻¹⁰ m, 4 µs", "gap 2.5e-10 m, 4 us");
    // blanks between columns give way, but not the last of them; a shorter power is filled up
    assert_text("θ     1\nab    2\n", "theta 1\nab    2\n");
    assert_text("θ  1    2\n", "theta 1 2\n");
    assert_text("×10⁻³  1\n", "e-3    1\n");
}

static void marks_of_methods_stay_apart(void **state) {
    (void)state;
    char seen[HN_LOOK_SLOTS + 1] = "";
    for (int i = 0; i < HN_LOOK_SLOTS; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_plain_add(&b, hn_look_get(i)->glyph);
        assert_int_equal(b.n, 1);
        assert_true(b.text[0] != '?' && !strchr(seen, b.text[0]));
        seen[i] = b.text[0];
        hn_strbuf_reset(&b);
    }
}

static void lines_stay_where_they_are(void **state) {
    (void)state;
    hn_dots dots = {0};
    hn_cells cells = {0};
    hn_strbuf utf8, plain;
    const hn_area all = {0, 0, 20, 4};
    assert_true(hn_dots_resize(&dots, 20, 4) && hn_cells_resize(&cells, 20, 4));
    hn_dots_line(&dots, 0, 0, 39, 0, 0, 1, 0);
    hn_dots_line(&dots, 0, 15, 39, 15, 0, 1, 0);
    hn_dots_line(&dots, 0, 0, 0, 15, 0, 1, 0);
    hn_dots_show(&cells, all, &dots, HN_DOTS_BRAILLE);
    hn_strbuf_init(&utf8);
    hn_strbuf_init(&plain);
    hn_cells_text(&utf8, &cells, false);
    hn_plain_add(&plain, hn_strbuf_text(&utf8));
    assert_string_equal(hn_strbuf_text(&plain),
                        "|'''''''''''''''''''\n|\n|\n|...................\n");
    hn_strbuf_reset(&utf8);
    hn_strbuf_reset(&plain);
    hn_dots_free(&dots);
    hn_cells_free(&cells);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ascii_is_wanted_where_the_first_name_that_speaks_is_not_utf8),
        cmocka_unit_test(every_character_becomes_one_of_ascii),
        cmocka_unit_test(texts_are_spelled_out_and_their_columns_stay),
        cmocka_unit_test(marks_of_methods_stay_apart),
        cmocka_unit_test(lines_stay_where_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
