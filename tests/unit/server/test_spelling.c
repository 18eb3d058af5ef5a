// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas as students type them, in the parser's spelling.
#include "grade/parts/spelling.h"

#include "support/near.h"

#include <stdlib.h>
#include <string.h>

static void check(const char *typed, const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diag diag = {0};
    if (hn_spelling_normalise(&b, typed, &diag) != HN_OK) {
        fail_msg("%s: %s", typed, diag.message);
    }
    if (strcmp(hn_strbuf_text(&b), expected) != 0) {
        fail_msg("%s: '%s', expected '%s'", typed, hn_strbuf_text(&b), expected);
    }
    hn_strbuf_reset(&b);
}

static void a_formula_of_the_parser_stays_as_it_is(void **state) {
    static const char *const formulas[] = {
        "-l1*sin(th1)",
        "2^-3^2",
        "1e-3 + 2.5E+7*x_1",
        "atan2(y, x)",
        "-l1 * sin( th1 )",
        "(a+b)*(c - d)^2",
        "pi/180*th1",
        "l1**2",
        ".5*a",
        "max(a, b)",
        "sin 2*th1",
        "((((",
        "1 000",
        "",
        "\t a\n+ b",
        "hypot(a,b)",
    };
    (void)state;
    for (size_t i = 0; i < sizeof formulas / sizeof *formulas; i++) {
        check(formulas[i], formulas[i]);
    }
}

static void spellings_of_programs_become_the_parsers(void **state) {
    (void)state;
    check("-l1*np.sin(th1)", "-l1*sin(th1)");
    check("math.sin(math.pi/2)", "sin(pi/2)");
    check("Math.sin(x)", "sin(x)");
    check("l1 Sin[th1]", "l1 *sin(th1)");
    check("l1*Sin[th1 + Pi]", "l1*sin(th1 + pi)");
    check("ArcTan[x]", "atan(x)");
    check("np.arctan2(y, x)", "atan2(y, x)");
    check("sin^2(th1)", "sin(th1)^2");
}

static void typographic_characters_become_ascii(void **state) {
    (void)state;
    check("−l₁·sin(θ₁)", "-l1*sin(theta1)");
    check("–l1×cos(θ1)", "-l1*cos(theta1)");
    check("sin²(θ)", "sin(theta)^2");
    check("\xef\xbb\xbfl1", "l1");
    check("l1\xc2\xa0* l2", "l1 * l2");
    check("π", "pi");
    check("ℓ₁", "l1");
    check("½ m v²", "(1/2) *m *v^2");
    check("¾l1", "(3/4)*l1");
    check("2½", "2½");       // a sum; 2(1/2) would be a product
    check("ж\xff", "ж\xff"); // the parser reports what is no formula
}

static void latex_is_read(void **state) {
    (void)state;
    check("-l_1\\sin\\theta_1", "-l_1*sin(theta_1)");
    check("-l_{1} \\sin(\\theta_{12})", "-l_1 *sin(theta_12)");
    check("\\frac{l_1}{2}\\cos\\left(\\theta_1\\right)", "((l_1)/(2))*cos(theta_1)");
    check("\\frac12 m", "(1/2) *m");
    check("\\tfrac{1}2", "((1)/2)");
    check("\\frac\\pi2", "(pi/2)");
    check("\\frac12m_2l_1\\cos\\theta_1", "(1/2)*m_2*l_1*cos(theta_1)");
    check("$\\sqrt{x}$", "sqrt(x)");
    check("2\\pi", "2*pi");
    check("\\sin^2\\theta", "sin(theta)^2");
    check("\\cos^{2}{x} \\cdot y", "cos(x)^2 * y");
    check("l_1 \\, \\theta_1", "l_1  *theta_1");
    check("-\\ell_1\\operatorname{sin}(\\vartheta_1)", "-l_1*sin(theta_1)");
    check("\\mathrm{cos}^2\\varphi", "cos(phi)^2");
    check("\\ell_{12} \\ell", "l_12 *l");
    check("\\mathrm{l}_1\\omega_1", "l_1*omega_1");
    check("\\dot{\\theta}_1 + \\dot\\theta_2", "thetadot_1 + thetadot_2");
    check("l_1 \\sin\\theta_1\\cos\\theta_2", "l_1 *sin(theta_1)*cos(theta_2)");
    // an argument whose end would be a guess is left to the parser to refuse
    check("\\sin 2\\theta", "sin 2*theta");
}

static void factors_side_by_side_are_multiplied(void **state) {
    (void)state;
    check("a b", "a *b");
    check("2exp(x)", "2*exp(x)");
    check("l_1 sin th1", "l_1 *sin(th1)");
    check("2(a+b)(c)", "2*(a+b)*(c)");
    check("1/2 m v^2", "1/2 *m *v^2");
    check("m_2 l_1 l_2 cos(θ_1-θ_2)", "m_2 *l_1 *l_2 *cos(theta_1-theta_2)");
}

static void what_reads_in_two_ways_is_refused_at_its_column(void **state) {
    static const char *const rows[][2] = {
        {"l1 + \\foo x", "column 6, at '\\foo x'"},
        {"θ1·\\m", "column 4, at '\\m'"},
        {"2\\*3", "column 2, at '\\*3'"},
        {"a/b c", "column 5, at 'c': a/b c may be"},
        {"1/2m", "column 4, at 'm': a/b c may be"},
        {"\\sin\\omega t", "column 12, at 't': sin a b may be"},
        {"sin a b", "column 7, at 'b': sin a b may be"},
        {"\\sqrt[3]{8}", "column 6"},
        {"\\ellipse", "column 1, at '\\ellipse'"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_strbuf b;
        hn_diag diag = {0};
        hn_strbuf_init(&b);
        assert_int_equal(hn_spelling_normalise(&b, rows[i][0], &diag), HN_ERR_INPUT);
        if (!strstr(diag.message, rows[i][1])) {
            fail_msg("%s: %s", rows[i][0], diag.message);
        }
        hn_strbuf_reset(&b);
    }
}

/// A text that repeats a word, rewritten: the stack must hold it, however long it is.
static void check_repeated(const char *word) {
    enum { TIMES = 100000 };
    hn_strbuf text, out;
    hn_strbuf_init(&text);
    hn_strbuf_init(&out);
    for (int i = 0; i < TIMES; i++) {
        hn_strbuf_add(&text, word);
    }
    const hn_status status = hn_spelling_normalise(&out, hn_strbuf_text(&text), NULL);
    assert_true(status == HN_OK || status == HN_ERR_INPUT);
    assert_true(out.n < 12 * text.n);
    hn_strbuf_reset(&text);
    hn_strbuf_reset(&out);
}

static void words_without_end_do_not_exhaust_the_stack(void **state) {
    static const char *const words[] = {"sin ", "\\sin",  "\\frac", "\\frac{",
                                        "sin(", "\\sqrt", "((",     "\\frac\\sin"};
    (void)state;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        check_repeated(words[i]);
    }
}

static void a_function_before_a_sum_is_remarked(void **state) {
    static const char *const quiet[] = {"cos(th1)-th2",  "cos(th1-th2)",
                                        "cos th1",       "cos th1*th2",
                                        "(cos th1)-th2", "\\cos\\left(\\theta_1-\\theta_2\\right)"};
    static const char *const bare[][2] = {{"m2 cos th1-th2", "'cos th1' was read without"},
                                          {"cos th1 + th2", "'cos th1' was read without"},
                                          {"2*(\\sin\\theta_1-\\theta_2)", "'\\sin\\theta_1' was"}};
    (void)state;
    for (size_t i = 0; i < sizeof quiet / sizeof *quiet; i++) {
        char said[200] = "wrong";
        hn_spelling_remark_bare(quiet[i], said, sizeof said);
        if (strcmp(said, "wrong") != 0) {
            fail_msg("%s: %s", quiet[i], said);
        }
    }
    for (size_t i = 0; i < sizeof bare / sizeof *bare; i++) {
        char said[200] = "wrong", few[12] = "wrong";
        hn_spelling_remark_bare(bare[i][0], said, sizeof said);
        assert_non_null(strstr(said, bare[i][1]));
        hn_spelling_remark_bare(bare[i][0], few, sizeof few); // cut, never beyond its end
        assert_int_equal(strlen(few), sizeof few - 1);
    }
}

static void a_name_stands_for_shorter_ones(void **state) {
    char out[16];
    (void)state;
    assert_true(hn_spelling_alias("omega1", 0, out, sizeof out));
    assert_string_equal(out, "w1");
    assert_true(hn_spelling_alias("omega1", 1, out, sizeof out));
    assert_string_equal(out, "om1");
    assert_true(hn_spelling_alias("omega1", 2, out, sizeof out));
    assert_string_equal(out, "u1");
    assert_false(hn_spelling_alias("omega1", 3, out, sizeof out));
    // the dot of a rate stands before the index or behind it
    static const char *const rates[] = {"thetadot1", "theta1dot", "theta1_dot", "th1dot",
                                        "dtheta1",   "qdot1",     "dq1"};
    for (int i = 0; i < 7; i++) {
        assert_true(hn_spelling_alias(rates[i], 0, out, sizeof out));
        assert_string_equal(out, "w1");
    }
    assert_false(hn_spelling_alias("xdot", 0, out, sizeof out));
    assert_true(hn_spelling_alias("thetadot1", 0, out, sizeof out));
    assert_string_equal(out, "w1");
    assert_false(hn_spelling_alias("thetas", 0, out, sizeof out));
}

static void any_bytes_end_and_grow_by_a_factor_alone(void **state) {
    static const char alphabet[] = "\\{}[]()^_.$abcsin fracleft12\xce\xb8\xe2\x88\x92pi-+*";
    char text[401];
    unsigned long seed = 12345;
    (void)state;
    for (int k = 0; k < 3000; k++) {
        for (size_t i = 0; i < sizeof text - 1; i++) {
            seed = seed * 6364136223846793005ul + 1442695040888963407ul;
            text[i] = alphabet[(seed >> 33) % (sizeof alphabet - 1)];
        }
        text[sizeof text - 1] = 0;
        hn_strbuf b;
        hn_strbuf_init(&b);
        const hn_status status = hn_spelling_normalise(&b, text, NULL);
        assert_true(status == HN_OK || status == HN_ERR_INPUT);
        // the longest replacement makes seven bytes of two, with brackets and a product sign round
        // it
        assert_true(b.n < 8 * sizeof text);
        hn_strbuf_reset(&b);
    }
}

static void an_index_is_part_of_the_name(void **state) {
    char out[16];
    (void)state;
    assert_true(hn_spelling_join("theta_1", out, sizeof out));
    assert_string_equal(out, "theta1");
    assert_false(hn_spelling_join("theta1", out, sizeof out));
    assert_false(hn_spelling_join("_", out, sizeof out));
    assert_false(hn_spelling_join("a_name_that_is_far_too_long", out, sizeof out));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_formula_of_the_parser_stays_as_it_is),
        cmocka_unit_test(spellings_of_programs_become_the_parsers),
        cmocka_unit_test(typographic_characters_become_ascii),
        cmocka_unit_test(latex_is_read),
        cmocka_unit_test(factors_side_by_side_are_multiplied),
        cmocka_unit_test(what_reads_in_two_ways_is_refused_at_its_column),
        cmocka_unit_test(words_without_end_do_not_exhaust_the_stack),
        cmocka_unit_test(a_function_before_a_sum_is_remarked),
        cmocka_unit_test(a_name_stands_for_shorter_ones),
        cmocka_unit_test(any_bytes_end_and_grow_by_a_factor_alone),
        cmocka_unit_test(an_index_is_part_of_the_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
