// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions as statements: what is shared is computed once, and text keeps the order of
// operations.
#include "export/code.h"

#include "base/strbuf.h"
#include "expr/construct.h"
#include "support/near.h"

#include <stdlib.h>
#include <string.h>

typedef struct fixture {
    hn_graph *g;
    hn_ex x, y;
    hn_strbuf b;
} fixture;

static void begin(fixture *f) {
    f->g = hn_graph_create();
    assert_non_null(f->g);
    f->x = hn_symbol(f->g, "x", NULL);
    f->y = hn_symbol(f->g, "y", NULL);
    hn_strbuf_init(&f->b);
}

static void end(fixture *f) {
    hn_strbuf_reset(&f->b);
    hn_graph_free(f->g);
}

/// The text of one entry m[0] = e.
static const char *code_of(fixture *f, const char *language, hn_ex e) {
    const hn_code_entry entry = {.array = "m", .row = 0, .column = -1, .value = e};
    hn_strbuf_clear(&f->b);
    assert_int_equal(hn_code_write(&f->b, f->g, hn_language_find(language), NULL, &entry, 1, 0),
                     HN_OK);
    return hn_strbuf_text(&f->b);
}

static void what_two_entries_share_is_computed_once(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    const hn_ex s = hn_sin(f.g, hn_add(f.g, f.x, f.y));
    const hn_code_entry entries[] = {{"m", 0, 1, s}, {"m", 1, 0, hn_add(f.g, s, hn_num(2))}};
    assert_int_equal(hn_code_write(&f.b, f.g, hn_language_find("python"), NULL, entries, 2, 4),
                     HN_OK);
    assert_string_equal(hn_strbuf_text(&f.b),
                        "    k1 = sin(x + y)\n    m[0, 1] = k1\n    m[1, 0] = k1 + 2\n");
    end(&f);
}

static void a_sum_inside_a_product_has_parentheses(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    const hn_ex sum = hn_add(f.g, f.x, f.y), z = hn_symbol(f.g, "z", NULL);
    assert_non_null(strstr(code_of(&f, "c", hn_mul(f.g, z, sum)), "(x + y)"));
    assert_string_equal(code_of(&f, "c", hn_neg(hn_mul(f.g, f.x, f.y))), "m[0] = -(x*y);\n");
    assert_string_equal(code_of(&f, "c", hn_sub(f.g, f.x, f.y)), "m[0] = x - y;\n");
    end(&f);
}

static void whole_numbers_do_not_divide_in_c(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    assert_string_equal(code_of(&f, "c", hn_scale(3, f.x)), "m[0] = 3.0*x;\n");
    assert_string_equal(code_of(&f, "octave", hn_scale(3, f.x)), "m(1) = 3*x;\n");
    assert_string_equal(code_of(&f, "julia", hn_num(0.1)), "m[1] = 0.1\n");
    end(&f);
}

static void a_reserved_word_is_no_name(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    assert_string_equal(code_of(&f, "python", hn_symbol(f.g, "lambda", NULL)), "m[0] = lambda_\n");
    assert_string_equal(code_of(&f, "c", hn_symbol(f.g, "lambda", NULL)), "m[0] = lambda;\n");
    assert_string_equal(code_of(&f, "c", hn_symbol(f.g, "mass", NULL)), "m[0] = mass_;\n");
    end(&f);
}

static void variables_keep_clear_of_the_scenes_names(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    const hn_ex k1 = hn_symbol(f.g, "k1", NULL), s = hn_sin(f.g, k1);
    const char *text = code_of(&f, "python", hn_mul(f.g, s, hn_add(f.g, s, f.x)));
    assert_non_null(strstr(text, "kk1 = sin(k1)\n"));
    end(&f);
}

static void a_number_reads_back_to_the_same_double(void **state) {
    (void)state;
    static const double numbers[] = {0.1, 1.0 / 3, 1e300, -2.2250738585072014e-308, 123456789.0};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_code_number(&b, hn_language_find("c"), numbers[i]);
        assert_true(strtod(hn_strbuf_text(&b), NULL) == numbers[i]);
        hn_strbuf_reset(&b);
    }
}

/// Returns what a function writes for a language, kept until the next call.
static const char *words_of(fixture *f, const char *language,
                            void (*put)(hn_strbuf *, const hn_language *, const char *),
                            const char *text) {
    hn_strbuf_clear(&f->b);
    put(&f->b, hn_language_find(language), text);
    return hn_strbuf_text(&f->b);
}

static void names_and_numbers_are_spelled_as_the_language_reads_them(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    assert_string_equal(words_of(&f, "wolfram", hn_code_name, "th_1"), "th$1");
    assert_string_equal(words_of(&f, "wolfram", hn_code_name, "K"), "K$");
    assert_string_equal(words_of(&f, "latex", hn_code_name, "th12"), "\\theta_{12}");
    assert_string_equal(code_of(&f, "wolfram", hn_num(-1e-7)), "m[[1]] = -1*^-7;\n");
    // numbers to read: fractions that are exact, and no power of ten where a few digits do
    assert_string_equal(code_of(&f, "latex", hn_num(1.0 / 3)),
                        "\\eq{\\term{m}_{1}}{\\tfrac{1}{3}}\n");
    assert_string_equal(code_of(&f, "latex", hn_num(-1.0 / 6)),
                        "\\eq{\\term{m}_{1}}{-\\tfrac{1}{6}}\n");
    assert_string_equal(code_of(&f, "latex", hn_num(10)), "\\eq{\\term{m}_{1}}{10}\n");
    assert_string_equal(code_of(&f, "latex", hn_num(0.25)), "\\eq{\\term{m}_{1}}{0.25}\n");
    assert_string_equal(code_of(&f, "latex", hn_num(2.5e+20)),
                        "\\eq{\\term{m}_{1}}{\\ensuremath{2.5\\cdot 10^{20}}}\n");
    end(&f);
}

static void a_formula_to_read_has_powers_fractions_and_no_short_pieces(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;
    const hn_ex m = hn_symbol(g, "m1", NULL), l = hn_symbol(g, "l1", NULL);
    const hn_ex ml2 = hn_mul(g, m, hn_mul(g, l, l));

    // a shared piece that is short stands where it is used, a number goes into the sum
    const hn_ex sum = hn_add(g, ml2, hn_scale(3, hn_mul(g, f.x, hn_mul(g, l, l))));
    const hn_code_entry entries[] = {{"m", 0, -1, hn_scale(1.0 / 3, sum)}, {"m", 1, -1, sum}};
    assert_int_equal(hn_code_write(&f.b, g, hn_language_find("latex"), NULL, entries, 2, 0), HN_OK);
    assert_string_equal(
        hn_strbuf_text(&f.b),
        "\\eq{\\term{m}_{1}}{\\tfrac{1}{3}\\, m_{1}\\, l_{1}^{2} + x\\, l_{1}^{2}}\n"
        "\\eq{\\term{m}_{2}}{m_{1}\\, l_{1}^{2} + 3\\, x\\, l_{1}^{2}}\n");

    // quotients, powers of functions and of sums
    const hn_ex s = hn_sin(g, f.x), d = hn_sub(g, f.x, f.y);
    assert_string_equal(code_of(&f, "latex", hn_scale(-0.5, hn_div(g, hn_mul(g, s, s), f.y))),
                        "\\eq{\\term{m}_{1}}{-\\tfrac{1}{2}\\, \\frac{\\sin^{2}(x)}{y}}\n");
    assert_string_equal(code_of(&f, "latex", hn_mul(g, d, d)),
                        "\\eq{\\term{m}_{1}}{(x - y)^{2}}\n");
    assert_string_equal(words_of(&f, "latex", hn_code_name, "theta_coupler"),
                        "\\theta_{\\mathrm{coupler}}");
    end(&f);
}

static void words_of_a_scene_do_not_leave_their_comment(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    assert_string_equal(words_of(&f, "python", hn_code_words, "a\"\"\"\nb\\c"), "a''' b/c");
    assert_string_equal(words_of(&f, "wolfram", hn_code_words, "a *) b"), "a * ) b");
    assert_string_equal(words_of(&f, "latex", hn_code_words, "5 % of m_1^2"),
                        "5 \\% of m\\_1\\char`\\^{}2");
    end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_two_entries_share_is_computed_once),
        cmocka_unit_test(a_sum_inside_a_product_has_parentheses),
        cmocka_unit_test(whole_numbers_do_not_divide_in_c),
        cmocka_unit_test(a_reserved_word_is_no_name),
        cmocka_unit_test(variables_keep_clear_of_the_scenes_names),
        cmocka_unit_test(a_number_reads_back_to_the_same_double),
        cmocka_unit_test(names_and_numbers_are_spelled_as_the_language_reads_them),
        cmocka_unit_test(a_formula_to_read_has_powers_fractions_and_no_short_pieces),
        cmocka_unit_test(words_of_a_scene_do_not_leave_their_comment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
