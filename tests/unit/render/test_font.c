// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "render/canvas.h"
#include "render/font.h"

#include <string.h>

static void every_character_of_ascii_has_strokes_of_its_own_inside_its_cell(void **state) {
    (void)state;
    static hn_glyph glyphs[127];
    for (uint32_t code = ' '; code <= '~'; code++) {
        hn_glyph *g = &glyphs[code];
        hn_font_glyph(code, g);
        assert_true(hn_font_has(code));
        assert_near(g->advance, hn_font_advance(code), 0);
        assert_int_equal(g->n_points > 0, code != ' ');
        assert_int_equal(g->start[g->n_lines], g->n_points);
        for (int i = 0; i < g->n_points; i++) {
            assert_true(g->xy[2 * i] >= 0 && g->xy[2 * i] <= g->advance);
            assert_true(g->xy[2 * i + 1] >= -HN_FONT_DESCENT &&
                        g->xy[2 * i + 1] <= HN_FONT_CAP + 4);
        }
        for (uint32_t other = ' ' + 1; other < code; other++) {
            const hn_glyph *o = &glyphs[other];
            const size_t bytes = 2 * sizeof(double) * (size_t)g->n_points;
            assert_true(o->n_points != g->n_points || memcmp(o->xy, g->xy, bytes) != 0);
        }
    }
}

static void digits_have_one_width(void **state) {
    (void)state;
    for (uint32_t code = '0'; code <= '9'; code++) {
        assert_near(hn_font_advance(code), hn_font_advance('0'), 0);
    }
}

static void signs_of_captions_are_there_and_others_are_a_box(void **state) {
    (void)state;
    const char *text = "\xc2\xb0\xc2\xb7\xc3\x97\xc2\xb5\xe2\x80\x93\xe2\x88\x92\xe2\x80\xa6\xce"
                       "\x94\xce\xbb\xcf\x86\xc2\xb2";
    int n = 0;
    for (uint32_t code; (code = hn_utf8_next(&text)) != 0; n++) {
        assert_true(hn_font_has(code));
    }
    assert_int_equal(n, 11);
    hn_glyph unknown, replacement;
    hn_font_glyph(0x4E2D, &unknown);
    hn_font_glyph(0xFFFD, &replacement);
    assert_false(hn_font_has(0x4E2D));
    assert_int_equal(unknown.n_points, 5);
    assert_memory_equal(unknown.xy, replacement.xy, 10 * sizeof(double));
}

static void bad_utf8_moves_on_byte_by_byte(void **state) {
    (void)state;
    const char *text = "a\xff\xc3z\xe2\x88";
    const uint32_t expected[] = {'a', 0xFFFD, 0xFFFD, 'z', 0xFFFD, 0xFFFD, 0};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        assert_int_equal(hn_utf8_next(&text), expected[i]);
    }
    assert_int_equal(hn_utf8_next(&text), 0);
}

static void the_width_of_a_text_is_the_sum_of_its_parts_and_grows_with_size(void **state) {
    (void)state;
    const double a = hn_canvas_text_width(20, "gap "), b = hn_canvas_text_width(20, "4.2 mm");
    assert_near(hn_canvas_text_width(20, "gap 4.2 mm"), a + b, 1e-12);
    assert_near(hn_canvas_text_width(40, "gap "), 2 * a, 1e-12);
    assert_near(hn_canvas_text_width(20, ""), 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_character_of_ascii_has_strokes_of_its_own_inside_its_cell),
        cmocka_unit_test(digits_have_one_width),
        cmocka_unit_test(signs_of_captions_are_there_and_others_are_a_box),
        cmocka_unit_test(bad_utf8_moves_on_byte_by_byte),
        cmocka_unit_test(the_width_of_a_text_is_the_sum_of_its_parts_and_grows_with_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
