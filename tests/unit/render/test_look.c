// SPDX-License-Identifier: GPL-3.0-or-later
// Contrast by WCAG 2.2 ("contrast ratio", "relative luminance"); distance as CIE 1976 Lab under
// D65. Sight without one kind of cone by two models: Vienot, Brettel & Mollon, Color Research &
// Application 24 (1999) 243-252, and Machado, Oliveira & Fernandes, IEEE TVCG 15 (2009) 1291-1298,
// table 1, severity 1.
#include "support/near.h"

#include "render/look.h"

#include <math.h>
#include <string.h>

static const double LEAST_CONTRAST = 3, LEAST_TEXT_CONTRAST = 4.5, LEAST_DISTANCE = 20;

typedef struct triple {
    double x[3];
} triple;

typedef struct matrix {
    double m[3][3];
} matrix;

static triple apply(const matrix *a, triple v) {
    triple out = {{0, 0, 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.x[i] += a->m[i][j] * v.x[j];
        }
    }
    return out;
}

// sRGB of IEC 61966-2-1
static triple linear(uint32_t rgb) {
    triple out;
    for (int i = 0; i < 3; i++) {
        const double c = (rgb >> (16 - 8 * i) & 0xff) / 255.0;
        out.x[i] = c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
    }
    return out;
}

static double luminance(uint32_t rgb) {
    const triple l = linear(rgb);
    return 0.2126 * l.x[0] + 0.7152 * l.x[1] + 0.0722 * l.x[2];
}

static double contrast(uint32_t a, uint32_t b) {
    const double la = luminance(a), lb = luminance(b);
    return (fmax(la, lb) + 0.05) / (fmin(la, lb) + 0.05);
}

static double lab_f(double t) {
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

static triple lab(triple l) {
    static const matrix to_xyz = {{{0.4124564, 0.3575761, 0.1804375},
                                   {0.2126729, 0.7151522, 0.0721750},
                                   {0.0193339, 0.1191920, 0.9503041}}};
    const triple xyz = apply(&to_xyz, l);
    const double x = lab_f(xyz.x[0] / 0.95047), y = lab_f(xyz.x[1]), z = lab_f(xyz.x[2] / 1.08883);
    return (triple){{116 * y - 16, 500 * (x - y), 200 * (y - z)}};
}

// Vienot's projection in LMS (his Smith & Pokorny matrix), multiplied out for linear RGB
static const matrix sights[] = {
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {{{0.112382, 0.887618, 0}, {0.112382, 0.887618, 0}, {0.004006, -0.004006, 1}}},
    {{{0.292750, 0.707250, 0}, {0.292750, 0.707250, 0}, {-0.022337, 0.022337, 1}}},
    {{{0.152286, 1.052583, -0.204868},
      {0.114503, 0.786281, 0.099216},
      {-0.003882, -0.048116, 1.051998}}},
    {{{0.367322, 0.860646, -0.227968},
      {0.280085, 0.672501, 0.047413},
      {-0.011820, 0.042940, 0.968881}}},
};
enum { N_SIGHTS = sizeof sights / sizeof *sights };

static double distance_seen(const matrix *sight, uint32_t a, uint32_t b) {
    triple seen[2] = {apply(sight, linear(a)), apply(sight, linear(b))};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            seen[k].x[i] = fmin(1, fmax(0, seen[k].x[i]));
        }
    }
    const triple p = lab(seen[0]), q = lab(seen[1]);
    return sqrt(pow(p.x[0] - q.x[0], 2) + pow(p.x[1] - q.x[1], 2) + pow(p.x[2] - q.x[2], 2));
}

// known values, so that the yardsticks themselves are checked
static void the_yardsticks_give_published_values(void **state) {
    (void)state;
    assert_near(contrast(0x000000, 0xFFFFFF), 21, 1e-12);
    assert_near(contrast(0x777777, 0xFFFFFF), 4.48, 0.005);
    const triple red = lab(linear(0xFF0000));
    assert_near(red.x[0], 53.24, 0.01);
    assert_near(red.x[1], 80.09, 0.01);
    assert_near(red.x[2], 67.20, 0.01);

    // greys look the same to everybody; red and green of one lightness do not stay apart
    for (int k = 0; k < N_SIGHTS; k++) {
        const triple white = apply(&sights[k], linear(0xFFFFFF));
        for (int i = 0; i < 3; i++) {
            assert_near(white.x[i], 1, 1e-5);
        }
    }
    assert_true(distance_seen(&sights[0], 0xB46A00, 0x7C8A00) > 25);
    assert_true(distance_seen(&sights[2], 0xB46A00, 0x7C8A00) < 10);
}

static void every_colour_stands_out_from_its_paper(void **state) {
    (void)state;
    for (int theme = 0; theme < HN_THEME_COUNT; theme++) {
        const hn_surface *s = hn_surface_get((hn_theme)theme);
        for (int slot = 0; slot < HN_LOOK_SLOTS; slot++) {
            const uint32_t colour = hn_look_get(slot)->colour[theme];
            assert_true(contrast(colour, s->paper) >= LEAST_CONTRAST);
        }
        assert_true(contrast(s->tear, s->paper) >= LEAST_CONTRAST);
        assert_true(contrast(s->ink, s->raised) >= LEAST_TEXT_CONTRAST);
        assert_true(contrast(s->ink, s->paper) >= LEAST_TEXT_CONTRAST);
        assert_true(contrast(s->muted, s->raised) >= LEAST_TEXT_CONTRAST);
        assert_true(contrast(s->muted, s->paper) >= LEAST_TEXT_CONTRAST);
    }
    assert_int_equal(hn_surface_get(HN_THEME_LIGHT)->paper, 0xFCFCFA);
    assert_int_equal(hn_surface_get(HN_THEME_DARK)->paper, 0x14171B);
}

static void any_two_slots_differ_to_every_sight(void **state) {
    (void)state;
    for (int theme = 0; theme < HN_THEME_COUNT; theme++) {
        for (int a = 0; a < HN_LOOK_SLOTS; a++) {
            for (int b = 0; b < a; b++) {
                for (int k = 0; k < N_SIGHTS; k++) {
                    const double d = distance_seen(&sights[k], hn_look_get(a)->colour[theme],
                                                   hn_look_get(b)->colour[theme]);
                    if (d < LEAST_DISTANCE) {
                        print_error("slots %d and %d, sight %d, theme %d: %.1f apart\n", a, b, k,
                                    theme, d);
                    }
                    assert_true(d >= LEAST_DISTANCE);
                }
            }
        }
    }
}

static void any_two_methods_differ_without_colour_too(void **state) {
    (void)state;
    for (int a = 0; a < HN_LOOK_METHODS; a++) {
        const hn_look *x = hn_look_get(a);
        for (int b = 0; b < a; b++) {
            const hn_look *y = hn_look_get(b);
            assert_true(x->n_dash != y->n_dash || memcmp(x->dash, y->dash, sizeof x->dash) != 0);
            assert_true(x->marker != y->marker);
            assert_string_not_equal(x->glyph, y->glyph);
        }
        assert_int_equal(x->n_dash % 2, 0);
    }
}

static void thirteen_methods_have_glyphs_of_their_own(void **state) {
    (void)state;
    for (int a = 0; a < HN_LOOK_GLYPHS; a++) {
        for (int b = 0; b < a; b++) {
            assert_string_not_equal(hn_look_glyph(a), hn_look_glyph(b));
        }
    }
    for (int slot = 0; slot < HN_LOOK_METHODS; slot++) {
        assert_string_equal(hn_look_glyph(slot), hn_look_get(slot)->glyph);
    }
    assert_string_equal(hn_look_glyph(HN_LOOK_GLYPHS), hn_look_glyph(0));
}

static void more_methods_than_slots_begin_again(void **state) {
    (void)state;
    assert_int_equal(hn_look_slot(0), 0);
    assert_int_equal(hn_look_slot(7), 7);
    assert_int_equal(hn_look_slot(8), 0);
}

static void the_json_says_what_the_table_says(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_look_json(&b);
    const char *text = hn_strbuf_text(&b);
    assert_non_null(strstr(text, "\"light\":{\"paper\":\"#FCFCFA\""));
    assert_non_null(strstr(text, "\"dark\":{\"paper\":\"#14171B\""));
    for (int slot = 0; slot < HN_LOOK_SLOTS; slot++) {
        const hn_look *look = hn_look_get(slot);
        hn_strbuf row;
        hn_strbuf_init(&row);
        hn_strbuf_printf(
            &row, "{\"slot\":%d,\"name\":\"%s\",\"light\":\"#%06X\",\"dark\":\"#%06X\",\"dash\":[",
            slot, look->name, (unsigned)look->colour[0], (unsigned)look->colour[1]);
        assert_non_null(strstr(text, hn_strbuf_text(&row)));
        hn_strbuf_reset(&row);
    }
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_yardsticks_give_published_values),
        cmocka_unit_test(every_colour_stands_out_from_its_paper),
        cmocka_unit_test(any_two_slots_differ_to_every_sight),
        cmocka_unit_test(any_two_methods_differ_without_colour_too),
        cmocka_unit_test(thirteen_methods_have_glyphs_of_their_own),
        cmocka_unit_test(more_methods_than_slots_begin_again),
        cmocka_unit_test(the_json_says_what_the_table_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
