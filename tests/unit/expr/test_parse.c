// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/strbuf.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/parse.h"
#include "expr/print.h"
#include "support/alloc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const KNOWN[] = {"l1", "l2", "th1", "th2", "w1", "x", "d", "m1"};
enum { N_KNOWN = sizeof KNOWN / sizeof *KNOWN };

static int look_up(void *user, const char *name, hn_ex *out) {
    for (int i = 0; i < N_KNOWN; i++) {
        if (strcmp(name, KNOWN[i]) == 0) {
            *out = hn_symbol(user, name, NULL);
            return 1;
        }
    }
    return 0;
}

static hn_parse_opts opts_for(hn_graph *g) {
    return (hn_parse_opts){.lookup = look_up, .user = g, .known = KNOWN, .n_known = N_KNOWN};
}

static hn_ex parse(hn_graph *g, const char *text) {
    hn_ex e = hn_num(999);
    hn_diag diag = {0};
    const hn_parse_opts opts = opts_for(g);
    if (hn_parse(g, text, &opts, &e, &diag) != HN_OK) {
        fail_msg("%s: %s", text, diag.message);
    }
    return e;
}

static void assert_same(hn_graph *g, const char *a, const char *b) {
    if (!hn_ex_same(parse(g, a), parse(g, b))) {
        fail_msg("%s and %s are not the same node", a, b);
    }
}

static void powers_signs_and_products_bind_as_in_mathematics(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    assert_same(g, "-x^2", "-(x^2)");
    assert_same(g, "2^3^2", "512");
    assert_same(g, "x^-1", "1/x");
    assert_same(g, "x**3", "x*x*x");
    assert_same(g, "l1*l2/d*x", "((l1*l2)/d)*x");
    assert_same(g, "l1 - l2 - d", "-d - l2 + l1");
    assert_same(g, "--x", "x");
    assert_same(g, "2*-x", "-2*x");
    assert_same(g, "1e-3*x", "x/1000");
    assert_same(g, "hypot(x, d)", "sqrt(x^2 + d^2)");
    assert_same(g, "x^0.5", "sqrt(x)");
    assert_near(parse(g, "pi").c, acos(-1), 0);
    assert_near(parse(g, "e").c, exp(1), 0);
    assert_near(parse(g, ".5e1 + 2.").c, 7, 0);
    hn_graph_free(g);
}

typedef struct fault {
    const char *text;
    int column;
    const char *message, *hint; ///< a piece of each; "" matches all
} fault;

static const fault FAULTS[] = {
    {"", 1, "empty", ""},
    {"   ", 1, "empty", ""},
    {"3 l1", 3, "'*'", "3*x"},
    {"2x", 2, "'*'", ""},
    {"2(x)", 2, "'*'", ""},
    {"x y", 3, "'y'", "a*b"},
    {"x (d)", 1, "no function 'x'", ""},
    {"(x)(d)", 4, "'('", "a*b"},
    {"(x", 3, "')'", ""},
    {"x)", 2, "')'", ""},
    {"()", 2, "')'", ""},
    {"(", 2, "end of the formula", ""},
    {")", 1, "')'", ""},
    {"x +", 4, "end of the formula", ""},
    {"* x", 1, "'*'", ""},
    {"x ^", 4, "end of the formula", ""},
    {"x // d", 4, "'/'", ""},
    {"x / 0", 3, "division by 0", ""},
    {"x / (1 - 1)", 3, "division by 0", ""},
    {"0^-1", 2, "not a finite", ""},
    {"10^400", 3, "not a finite", ""},
    {"(-1)^0.5", 5, "not a finite", ""},
    {"1e400", 1, "too large", ""},
    {"1e308*10", 6, "too large", ""},
    {"1e308 + 1e308", 7, "too large", ""},
    {"nan", 1, "nan", ""},
    {"inf", 1, "inf", ""},
    {"Infinity", 1, "Infinity", ""},
    {"log(-1)", 1, "log(-1)", ""},
    {"log(0)", 1, "log(0)", ""},
    {"sqrt(-2)", 1, "sqrt(-2)", ""},
    {"asin(2)", 1, "asin(2)", ""},
    {"thh1 + 1", 1, "'thh1'", "th1"},
    {"TH1", 1, "'TH1'", "th1"},
    {"x + unknown_thing", 5, "'unknown_thing'", ""},
    {"sinn(x)", 1, "'sinn'", "sin"},
    {"Sin(x)", 1, "'Sin'", "sin"},
    {"foo(x)", 1, "'foo'", ""},
    {"cos", 1, "'cos'", "cos(x)"},
    {"cos()", 1, "takes 1 argument", ""},
    {"cos(x, d)", 1, "takes 1 argument", ""},
    {"atan2(x)", 1, "takes 2 arguments", ""},
    {"cos(x", 6, "','", ""},
    {"0,5*x", 2, "','", "0.5"},
    {"(0,5)*x", 3, "','", "0.5"},
    {"5..2", 3, "second '.'", ""},
    {"1.5.2", 4, "second '.'", ""},
    {".", 1, "lone '.'", ""},
    {"x = 3", 3, "'='", "difference"},
    {"0x10", 2, "'*'", ""},
    {"\xce\xb8"
     "1",
     1, "ASCII", "ASCII"},
    {"x\x01", 2, "control", ""},
    {"x; d", 2, "';'", ""},
    {"\"x\"", 1, "'\"'", ""},
    {"[x]", 1, "'['", ""},
    {"x!", 2, "'!'", ""},
};

static void every_fault_has_its_column_and_a_word_of_help(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof FAULTS / sizeof *FAULTS; i++) {
        hn_graph *g = hn_graph_create();
        const hn_parse_opts opts = opts_for(g);
        hn_ex e = {999, 7};
        hn_diag diag = {0};
        const hn_status status = hn_parse(g, FAULTS[i].text, &opts, &e, &diag);
        if (status != HN_ERR_INPUT || diag.column != FAULTS[i].column ||
            !strstr(diag.message, FAULTS[i].message) || !strstr(diag.hint, FAULTS[i].hint)) {
            fail_msg("'%s': status %d column %d (expected %d): %s [%s]", FAULTS[i].text,
                     (int)status, diag.column, FAULTS[i].column, diag.message, diag.hint);
        }
        assert_true(e.c == 999 && e.n == 7); // untouched
        hn_graph_free(g);
    }
}

static void nesting_and_length_are_bounded(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    const hn_parse_opts opts = opts_for(g);
    hn_ex e;
    hn_diag diag = {0};
    char *text = malloc(60001);
    assert_non_null(text);
    memset(text, '(', 5000);
    strcpy(text + 5000, "x");
    assert_int_equal(hn_parse(g, text, &opts, &e, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.message, "deep"));
    memset(text, '-', 5000);
    assert_int_equal(hn_parse(g, text, &opts, &e, &diag), HN_ERR_INPUT);
    memset(text, ' ', 60000);
    strcpy(text + 59990, "x");
    assert_int_equal(hn_parse(g, text, &opts, &e, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.message, "at most"));
    free(text);
    hn_graph_free(g);
}

/// Powers are printed as calls, which nest deeper than the signs ^ that were read.
static void the_deepest_tower_of_powers_reads_back(void **state) {
    (void)state;
    char text[1024] = "x";
    hn_status status = HN_OK;
    int n = 0;
    for (; status == HN_OK && n < 300; n++) {
        hn_graph *g = hn_graph_create();
        const hn_parse_opts opts = opts_for(g);
        hn_ex e, again;
        hn_diag diag = {0};
        hn_strbuf b;
        hn_strbuf_init(&b);
        status = hn_parse(g, text, &opts, &e, &diag);
        if (status == HN_OK) {
            hn_print(&b, g, e, HN_PRINT_TEXT, 0);
            assert_int_equal(hn_parse(g, hn_strbuf_text(&b), &opts, &again, &diag), HN_OK);
            assert_true(again.n == e.n);
        } else {
            assert_non_null(strstr(diag.message, "deep"));
        }
        hn_strbuf_reset(&b);
        hn_graph_free(g);
        strcat(text, "^x");
    }
    assert_true(n > 50 && n < 300);
}

/// A random formula as text, of nesting `depth`.
static void write_formula(hn_strbuf *b, unsigned *seed, int depth) {
    static const char *const calls[] = {"sin", "cos", "tan", "sqrt", "exp", "tanh", "atan", "abs"};
    *seed = *seed * 1664525u + 1013904223u;
    const unsigned r = *seed >> 10;
    if (depth == 0 || r % 7 == 0) {
        if (r % 3 == 0 && r % 2 == 0) {
            hn_strbuf_printf(b, "(%u/%u)", 1 + r % 97, 3 + r % 11);
        } else if (r % 3 == 0) {
            hn_strbuf_printf(b, "%g", (double)(r % 97) / 8 + 0.125);
        } else {
            hn_strbuf_add(b, KNOWN[r % N_KNOWN]);
        }
        return;
    }
    switch (r % 6) {
    case 0:
        hn_strbuf_printf(b, "%s(", calls[(r / 6) % 8]);
        write_formula(b, seed, depth - 1);
        hn_strbuf_add(b, ")");
        return;
    case 1:
        hn_strbuf_add(b, "-(");
        write_formula(b, seed, depth - 1);
        hn_strbuf_printf(b, ")^%u", r / 6 % 4);
        return;
    case 2:
        hn_strbuf_add(b, "atan2(");
        write_formula(b, seed, depth - 1);
        hn_strbuf_add(b, ", 1 + abs(");
        write_formula(b, seed, depth - 1);
        hn_strbuf_add(b, "))");
        return;
    default:
        hn_strbuf_add(b, "(");
        write_formula(b, seed, depth - 1);
        hn_strbuf_add(b, r % 6 == 3 ? " + " : r % 6 == 4 ? " - " : r / 6 % 2 ? "*" : "/(2 + (");
        write_formula(b, seed, depth - 1);
        hn_strbuf_add(b, r % 6 == 5 && !(r / 6 % 2) ? ")^2))" : ")");
    }
}

// what is printed reads back as the very node it came from
static void printed_formulas_read_back(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    const hn_parse_opts opts = opts_for(g);
    for (int i = 0; i < N_KNOWN; i++) {
        hn_symbol(g, KNOWN[i], NULL);
    }
    double values[N_KNOWN];
    for (int i = 0; i < N_KNOWN; i++) {
        values[i] = 0.3 + 0.17 * i;
    }
    int tried = 0;
    for (unsigned seed = 1; seed <= 3000; seed++) {
        unsigned s = seed * 7919u;
        hn_strbuf text, again;
        hn_strbuf_init(&text);
        hn_strbuf_init(&again);
        hn_ex e, back;
        hn_diag diag = {0};
        write_formula(&text, &s, 4);
        if (hn_parse(g, hn_strbuf_text(&text), &opts, &e, &diag) == HN_OK) {
            hn_print(&again, g, e, HN_PRINT_TEXT, 0);
            if (hn_parse(g, hn_strbuf_text(&again), &opts, &back, &diag) != HN_OK) {
                fail_msg("%s -> %s: %s", hn_strbuf_text(&text), hn_strbuf_text(&again),
                         diag.message);
            }
            const double a = hn_graph_eval(g, e, values), b = hn_graph_eval(g, back, values);
            if (isfinite(a)) {
                assert_near(b, a, 1e-9 * (1 + fabs(a)));
            }
            if (!hn_ex_same(e, back)) {
                fail_msg("%s -> %s is another node", hn_strbuf_text(&text), hn_strbuf_text(&again));
            }
            tried++;
        }
        hn_strbuf_reset(&text);
        hn_strbuf_reset(&again);
    }
    assert_true(tried > 2500);
    hn_graph_free(g);
}

// near the ends of the range of numbers no coefficient is lost, and the text is still a sum
static void numbers_at_the_ends_of_the_range_read_back(void **state) {
    (void)state;
    static const char *const texts[] = {
        "l1 + 1e-308",     "l1 + 5e-324",       "1e+308*l1 + x",       "1e-320*l1 + x",
        "3*l1 + 1e-310*x", "2*(1e-320*l1 + x)", "1e-310*l1 + 1e+10*x", "1e+300*l1 + 1e-300*x"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        hn_graph *g = hn_graph_create();
        const hn_parse_opts opts = opts_for(g);
        hn_ex e, back;
        hn_diag diag = {0};
        hn_strbuf text;
        hn_strbuf_init(&text);
        assert_int_equal(hn_parse(g, texts[i], &opts, &e, &diag), HN_OK);
        hn_print(&text, g, e, HN_PRINT_TEXT, 0);
        assert_string_equal(hn_strbuf_text(&text), texts[i]);
        if (hn_parse(g, hn_strbuf_text(&text), &opts, &back, &diag) != HN_OK) {
            fail_msg("%s: %s", texts[i], diag.message);
        }
        assert_true(hn_ex_same(e, back));
        hn_strbuf_reset(&text);
        hn_graph_free(g);
    }
}

// fractions read better than long decimals, in whatever stands around them
static void fractions_read_as_people_write_them(void **state) {
    (void)state;
    static const char *const texts[][2] = {{"m1*l1^2/3", "1/3*m1*l1^2"},
                                           {"x^(1/3) - 2/3", "pow(x, 1/3) - 2/3"},
                                           {"(2/3)^x", "pow(2/3, x)"},
                                           {"0.625*x + 0.3333", "0.625*x + 0.3333"},
                                           {"0.333333333333*x", "0.333333333333*x"}};
    hn_graph *g = hn_graph_create();
    const hn_parse_opts opts = opts_for(g);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        hn_ex e;
        hn_diag diag = {0};
        hn_strbuf text;
        hn_strbuf_init(&text);
        assert_int_equal(hn_parse(g, texts[i][0], &opts, &e, &diag), HN_OK);
        hn_print(&text, g, e, HN_PRINT_TEXT, 0);
        assert_string_equal(hn_strbuf_text(&text), texts[i][1]);
        hn_strbuf_reset(&text);
    }
    hn_graph_free(g);
}

static void sums_beyond_the_range_are_refused(void **state) {
    (void)state;
    static const char *const texts[] = {"x-1e308-1e308", "1e308+1e308", "l1 + (1e308*x + 1e308*x)"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        hn_graph *g = hn_graph_create();
        const hn_parse_opts opts = opts_for(g);
        hn_ex e;
        hn_diag diag = {0};
        assert_int_equal(hn_parse(g, texts[i], &opts, &e, &diag), HN_ERR_INPUT);
        assert_non_null(strstr(diag.message, "the sum of the numbers here is too large"));
        hn_graph_free(g);
    }
}

static void assert_printed(hn_graph *g, const char *text, hn_print_form form,
                           const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_print(&b, g, parse(g, text), form, 6);
    assert_string_equal(hn_strbuf_text(&b), expected);
    hn_strbuf_reset(&b);
}

static void latex_and_c_read_as_people_write_them(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    assert_printed(g, "l1*l2/(x*(d+1))", HN_PRINT_LATEX,
                   "\\frac{l_{1}\\, l_{2}}{x\\, \\left(d + 1\\right)}");
    assert_printed(g, "m1*l1^2/12", HN_PRINT_LATEX, "\\tfrac{1}{12}\\, l_{1}^{2}\\, m_{1}");
    assert_printed(g, "sin(th1)^2", HN_PRINT_LATEX, "\\sin^{2} \\theta_{1}");
    assert_printed(g, "cos(th1 - th2)", HN_PRINT_LATEX,
                   "\\cos\\left(\\theta_{1} - \\theta_{2}\\right)");
    assert_printed(g, "(x+1)^2.5", HN_PRINT_LATEX, "{\\left(x + 1\\right)}^{\\tfrac{5}{2}}");
    assert_printed(g, "3*x + 1", HN_PRINT_C, "3.0*x + 1.0");
    assert_printed(g, "x^3/d", HN_PRINT_C, "x*x*x/d");
    assert_printed(g, "-x", HN_PRINT_TEXT, "-x");
    hn_graph_free(g);
}

static void text_that_would_explode_marks_the_buffer(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex e = hn_symbol(g, "x", NULL);
    for (int i = 0; i < 60; i++) { // each level writes the one below twice: 2^60 characters
        e = hn_add(g, hn_mul(g, hn_sin(g, e), hn_cos(g, e)), hn_num(1));
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_print(&b, g, e, HN_PRINT_TEXT, 0);
    assert_true(b.failed);
    hn_strbuf_reset(&b);
    hn_graph_free(g);
}

static void random_bytes_never_crash_the_parser(void **state) {
    (void)state;
    static const char alphabet[] = "x d1(2)+-*/^.,e sincosqrt\t\xce\xb8=!_0";
    hn_graph *g = hn_graph_create();
    const hn_parse_opts opts = opts_for(g);
    unsigned seed = 4711;
    for (int k = 0; k < 20000; k++) {
        char text[40];
        const int n = 1 + k % 38;
        for (int i = 0; i < n; i++) {
            seed = seed * 1664525u + 1013904223u;
            text[i] = alphabet[(seed >> 10) % (sizeof alphabet - 1)];
        }
        text[n] = 0;
        hn_ex e = hn_num(0);
        hn_diag diag = {0};
        const hn_status status = hn_parse(g, text, &opts, &e, &diag);
        assert_true(status == HN_OK || status == HN_ERR_INPUT);
        if (status != HN_OK) {
            assert_true(diag.column >= 1 && diag.column <= n + 1 && diag.message[0]);
        } else {
            assert_true(isfinite(e.c));
        }
    }
    hn_graph_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(powers_signs_and_products_bind_as_in_mathematics),
        cmocka_unit_test(every_fault_has_its_column_and_a_word_of_help),
        cmocka_unit_test(nesting_and_length_are_bounded),
        cmocka_unit_test(the_deepest_tower_of_powers_reads_back),
        cmocka_unit_test(printed_formulas_read_back),
        cmocka_unit_test(numbers_at_the_ends_of_the_range_read_back),
        cmocka_unit_test(fractions_read_as_people_write_them),
        cmocka_unit_test(sums_beyond_the_range_are_refused),
        cmocka_unit_test(latex_and_c_read_as_people_write_them),
        cmocka_unit_test(text_that_would_explode_marks_the_buffer),
        cmocka_unit_test(random_bytes_never_crash_the_parser),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
