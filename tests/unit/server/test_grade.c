// SPDX-License-Identifier: GPL-3.0-or-later
// Grading of Problem 3: right answers in many spellings, each known mistake named, unreadable files
// refused with a reason.
#include "grade/exercise_text.h"
#include "grade/grade.h"

#include "p3.h"
#include "support/alloc.h"
#include "support/near.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void the_lessons_jacobian_has_full_score(void **state) {
    hn_verdict v;
    grade_with(*state, -1, "", &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_near(v.score, 8, 0);
    assert_near(v.max_score, 8, 0);
    assert_int_equal(v.n_right, 8);
    assert_int_equal(v.shown_entry, -1);
    assert_true(v.n_states >= 20);
    assert_string_equal(v.entry[6].name, "J23");
    assert_string_equal(v.summary, "all 8 entries are right");
}

/// Every spelling of the first entry, -l1 sin(th1), is right, everywhere.
static void check_spellings(void *state, const char *const *spellings, size_t n) {
    for (size_t i = 0; i < n; i++) {
        hn_verdict v;
        grade_with(state, 0, spellings[i], &v);
        if (!v.entry[0].right) {
            fail_msg("%s: %s", spellings[i], v.entry[0].explanation);
        }
        assert_false(v.entry[0].closed_only);
    }
}

static void a_right_entry_is_right_in_any_spelling(void **state) {
    static const char *const spellings[] = {"-sin(th1)*l1",
                                            "-(l1)*sin(th1) + 0",
                                            "l1*cos(th1 + pi/2)",
                                            "-l1*sqrt(1-cos(th1)^2)*sign(sin(th1))",
                                            "-l1 * sin(th1 + 2*3.141592654)",
                                            "-l1*sin(theta1)",
                                            "l1*sin(-th1)",
                                            "-l1*sin(th1)^2/sin(th1)",
                                            "0.5*(-l1*sin(th1)) - l1*sin(th1)/2"};
    check_spellings(*state, spellings, sizeof spellings / sizeof spellings[0]);
}

static void a_right_entry_is_right_in_the_spelling_of_other_languages(void **state) {
    static const char *const spellings[] = {"-l_1*np.sin(theta_1)",
                                            "-l1*math.sin(th_1)",
                                            "-l1*Sin[theta1]",
                                            "−l₁·sin(θ₁)",
                                            "-l_1 \\\\sin\\\\theta_1",
                                            "-l_{1}\\\\sin\\\\left(\\\\theta_{1}\\\\right)",
                                            "-\\\\frac{2 l_1}{2}\\\\sin{\\\\theta_1}",
                                            "\xef\xbb\xbf-l1*sin(th1)"};
    check_spellings(*state, spellings, sizeof spellings / sizeof spellings[0]);
}

static void a_constant_of_seven_digits_passes_in_every_entry_and_with_every_seed(void **state) {
    // sin(x) = cos(x - pi/2): the error of 3.141593 shows most where the entry itself crosses zero
    static const char *const form = "%s%s*%s(%s %s 3.141593/2)";
    static const struct {
        const char *sign, *function, *turn;
    } rows[2] = {{"-", "cos", "-"}, {"", "sin", "+"}};
    for (uint64_t seed = 1; seed <= 100; seed++) {
        char text[1024] = "{\"J\": [[";
        for (int k = 0; k < 8; k++) {
            const int row = k / 4, side = k % 4 < 2, j = k % 4 + 1;
            char entry[80], l[4], th[5];
            snprintf(l, sizeof l, "l%d", j);
            snprintf(th, sizeof th, "th%d", j);
            const char *sign = side ? rows[row].sign : rows[row].sign[0] ? "" : "-";
            snprintf(entry, sizeof entry, form, sign, l, rows[row].function, th, rows[row].turn);
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s\"%s\"",
                     k == 4 ? "],["
                     : k    ? ","
                            : "",
                     entry);
        }
        strcat(text, "]]}");
        hn_verdict v;
        assert_int_equal(hn_grade_json(*state, text, strlen(text), seed, &v), HN_OK);
        if (v.n_right != 8) {
            fail_msg("seed %llu: %s", (unsigned long long)seed, v.summary);
        }
    }
}

static void a_constant_of_four_digits_does_not_pass(void **state) {
    hn_verdict v;
    grade_with(*state, 0, "-l1*sin(th1 + 2*3.1416)", &v);
    assert_false(v.entry[0].right);
}

static void unreadable_formulas_are_in_the_summary(void **state) {
    hn_verdict v;
    grade_with(*state, 2, "l3*sen(th3)", &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_int_equal(v.n_unreadable, 1);
    assert_string_equal(v.summary, "7 of 8 entries are right; 1 cannot be read: J13");
}

static void a_submission_without_a_readable_formula_is_ungradable(void **state) {
    hn_verdict v;
    grade(*state, "{\"J\": [[\"a\",\"b\",\"\",null],[\"(\",\"c d\",\"g\",\"f\"]]}", &v);
    assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
    assert_non_null(strstr(v.reason, "none of the 6 formulas can be read (J11)"));
    assert_near(v.score, 0, 0);
}

static void the_encoding_of_a_file_is_no_reason_to_refuse_it(void **state) {
    hn_verdict v;
    grade(*state, "\xef\xbb\xbf{\"J\": [[1,1,1,1],[1,1,1,1]]}", &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);

    // UTF-16 of both orders, with a mark and without
    static const char text[] = "{\"J\": [[1,1,1,1],[1,1,1,1]]}";
    for (int k = 0; k < 4; k++) {
        char wide[2 * sizeof text + 2] = {0};
        const int big = k & 1, mark = k < 2 ? 2 : 0;
        memcpy(wide, big ? "\xfe\xff" : "\xff\xfe", (size_t)mark);
        for (size_t i = 0; i + 1 < sizeof text; i++) {
            wide[(size_t)mark + 2 * i + (size_t)big] = text[i];
        }
        const size_t n = (size_t)mark + 2 * (sizeof text - 1);
        assert_int_equal(hn_grade_json(*state, wide, n, 0, &v), HN_OK);
        if (v.kind != HN_VERDICT_GRADED) {
            fail_msg("encoding %d: %s", k, v.reason);
        }
        assert_non_null(strstr(v.note, "UTF-16"));
        assert_string_equal(v.submission, text);
        assert_int_equal(hn_grade_json(*state, wide, n - 1, 0, &v), HN_OK);
        assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
    }
}

static void two_slips_of_json_are_put_right_with_a_remark(void **state) {
    hn_verdict v;
    grade(*state, "{\"J\": [[1,1,1,1,],[1,1,1,1, ],\n],}", &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_non_null(strstr(v.note, "commas before a closing bracket were left out: 4"));
    assert_string_equal(v.submission, "{\"J\": [[1,1,1,1,],[1,1,1,1, ],\n],}");

    // \t and \s: a tabulator, and an escape that JSON does not know
    grade(*state, "{\"J\": [[\"-l_1 \\sin(\\theta_1)\",\"a,]\",1,1],[1,1,1,1]]}", &v);
    assert_true(v.entry[0].right);
    assert_non_null(strstr(v.note, "single backslashes were read as LaTeX: 2"));
    assert_string_equal(v.entry[1].given, "a,]");
}

static void the_right_answers_are_shown_to_teachers_alone(void **state) {
    hn_verdict v;
    grade(*state, "{\"J\": [[1,1,1,1],[1,1,1,\"(\"]]}", &v);
    for (int shown = 0; shown < 2; shown++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        v.show_expected = shown != 0;
        hn_verdict_text(&b, &v);
        hn_verdict_json(&b, &v);
        hn_verdict_gradescope(&b, &v, 0);
        assert_int_equal(strstr(hn_strbuf_text(&b), "\"expected") != NULL, shown);
        assert_int_equal(strstr(hn_strbuf_text(&b), "expected  ") != NULL, shown);
        assert_int_equal(strstr(hn_strbuf_text(&b), v.entry[0].expected) != NULL, shown);
        hn_strbuf_reset(&b);
    }
}

static void a_formula_that_uses_the_closed_loop_is_right_and_told(void **state) {
    hn_verdict v;
    // phi_2 = 0 says -l1 sin th1 = l2 sin th2 - l3 sin th3 - l4 sin th4
    grade_with(*state, 0, "l2*sin(th2) - l3*sin(th3) - l4*sin(th4)", &v);
    assert_true(v.entry[0].right);
    assert_true(v.entry[0].closed_only);
    assert_non_null(strstr(v.entry[0].explanation, "closed"));
    assert_near(v.score, 8, 0);
}

static void two_mistakes_at_once_are_named(void **state) {
    static const struct {
        const char *formula, *mistake, *words;
        double points;
    } rows[] = {
        // the right entry is -l1 sin th1, one of 8 points
        {"2*sin(th1)", "length", "a factor of 2 is wrong as well", 0},
        {"l1*cos(th1)/2", "row", "a factor of 1/2 is wrong as well", 0},
        {"l2*cos(th1)", "variable", "sine and cosine are exchanged as well", 0},
        {"-l1*sin(th2*pi/180)", "variable", "degrees as well", 0.125},
        {"-l1*sin(th1)^2", "other", "wrong; the cause is none of the known mistakes", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_verdict v;
        grade_with(*state, 0, rows[i].formula, &v);
        const hn_entry_verdict *e = &v.entry[0];
        if (strcmp(e->mistake, rows[i].mistake) != 0 || !strstr(e->explanation, rows[i].words)) {
            fail_msg("%s: %s, %s", rows[i].formula, e->mistake, e->explanation);
        }
        assert_near(e->points, rows[i].points, 1e-12);
    }
}

static void a_term_that_was_not_differentiated_is_suspected_in_both_rows(void **state) {
    static const char *const formulas[] = {"l1*cos(th1)", "l1*sin(th1)", "-l1*cos(th1)"};
    static const int entries[] = {0, 4, 0};
    for (int i = 0; i < 3; i++) {
        hn_verdict v;
        grade_with(*state, entries[i], formulas[i], &v);
        const char *says = v.entry[entries[i]].explanation;
        const bool suspected = strstr(says, "not differentiated looks like that too") != NULL;
        if (suspected != (i < 2)) {
            fail_msg("%s: %s", formulas[i], says);
        }
    }
}

static void each_known_mistake_is_named_and_shown_at_a_state(void **state) {
    static const struct {
        int entry;
        const char *formula, *mistake;
        double points;
    } rows[] = {
        {0, "l1*sin(th1)", "sign", 0.5},
        {2, "-l3*sin(th3)", "sign", 0.5},
        {7, "l4*cos(th4)", "sign", 0.5},
        {0, "-l1*cos(th1)", "swapped", 0},
        {2, "l3*cos(th3)", "swapped", 0},
        {0, "l1*cos(th1)", "row", 0.25},
        {4, "-l1*sin(th1)", "row", 0.25},
        {0, "-l1*sin(th1*pi/180)", "degrees", 0.5},
        {5, "l2*cos(180*th2/pi)", "degrees", 0.5},
        {5, "pi/180*l2*cos(th2*pi/180)", "degrees", 0.5},
        {0, "-sin(th1)", "length", 0.25},
        {6, "-cos(th3)", "length", 0.25},
        {0, "-l1*sin(th2)", "variable", 0.25},
        {4, "l3*cos(th1)", "variable", 0.25},
        {1, "-l1*sin(th1)", "column", 0},
        {0, "l1*cos(th1) + l2*cos(th2) - l3*cos(th3) - l4*cos(th4)", "undifferentiated", 0},
        {0, "-2*l1*sin(th1)", "factor", 0},
        {0, "0", "zero", 0},
        {0, "-0.84", "number", 0},
        {0, "", "blank", 0},
        {0, "th1^2", "other", 0},
        {0, "l1*sin(th1", "unreadable", 0},
        {0, "-l1*sin(theta)", "unreadable", 0},
        {0, "1/(th1 - th1)", "unreadable", 0},
        {0, "sqrt(-l1^2)", "not-finite", 0},
        {0, "log(sin(th1))", "not-finite", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hn_verdict v;
        grade_with(*state, rows[i].entry, rows[i].formula, &v);
        const hn_entry_verdict *e = &v.entry[rows[i].entry];
        if (e->right || strcmp(e->mistake, rows[i].mistake) != 0) {
            fail_msg("%s: '%s' (%s), expected '%s'", rows[i].formula, e->mistake, e->explanation,
                     rows[i].mistake);
        }
        assert_true(e->explanation[0]);
        assert_near(e->points, rows[i].points, 0);
        assert_near(v.score, 7 + rows[i].points, 0);
        assert_int_equal(v.n_right, 7);
        if (e->state < 0) {
            assert_true(strcmp(e->mistake, "blank") == 0 || strcmp(e->mistake, "unreadable") == 0);
            assert_int_equal(v.shown_entry, -1);
        } else {
            assert_int_equal(v.shown_entry, rows[i].entry);
            assert_false(fabs(e->given_value - e->expected_value) <= e->allowed);
        }
    }
}

static void the_state_shown_closes_the_loop_and_holds_the_expected_value(void **state) {
    hn_verdict v;
    grade_with(*state, 3, "l4*cos(th4)", &v);
    assert_int_equal(v.shown_entry, 3);
    assert_int_equal(v.n_names, 8);
    assert_int_equal(v.n_params, 4);
    double l[5] = {0}, th[5] = {0};
    for (int i = 0; i < 8; i++) {
        int k = v.names[i][strlen(v.names[i]) - 1] - '0';
        *(i < 4 ? &l[k] : &th[k]) = v.values[i];
    }
    double x = 0, y = 0;
    for (int k = 1; k <= 4; k++) {
        x += (k < 3 ? 1 : -1) * l[k] * cos(th[k]);
        y += (k < 3 ? 1 : -1) * l[k] * sin(th[k]);
        assert_true(l[k] >= 0.3 && l[k] <= 3);
    }
    assert_near(hypot(x, y), 0, 1e-14);
    assert_near(v.entry[3].expected_value, l[4] * sin(th[4]), 1e-15);
    assert_near(v.entry[3].given_value, l[4] * cos(th[4]), 1e-15);
}

static void right_entries_are_never_accused_whatever_the_seed(void **state) {
    const char *text =
        "{\"J\": [[\"-l1*sin(th1)\",\"-l2*sin(th2)\",\"l3*sin(th3)\",\"l4*sin(th4)\"],"
        "[\"l1*cos(th1)\",\"l2*cos(th2)\",\"-l3*cos(th3)\",\"l4*cos(th4)\"]]}";
    for (uint64_t seed = 1; seed <= 200; seed++) {
        hn_verdict v;
        assert_int_equal(hn_grade_json(*state, text, strlen(text), seed, &v), HN_OK);
        assert_int_equal(v.n_right, 7);
        assert_string_equal(v.entry[7].mistake, "sign");
        assert_near(v.score, 7.5, 0);
    }
}

static void a_transposed_matrix_earns_its_share_and_is_told(void **state) {
    hn_verdict v;
    grade(*state,
          "{\"J\": [[\"-l1*sin(th1)\",\"l1*cos(th1)\"],[\"-l2*sin(th2)\",\"l2*cos(th2)\"],"
          "[\"l3*sin(th3)\",\"-l3*cos(th3)\"],[\"l4*sin(th4)\",\"-l4*cos(th4)\"]]}",
          &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_near(v.score, 4, 0);
    assert_non_null(strstr(v.summary, "transposed"));
    assert_string_equal(v.entry[0].mistake, "transposed");
}

static void links_on_the_wrong_side_of_the_loop_are_told_by_column(void **state) {
    hn_verdict v;
    grade(*state,
          "{\"J\": [[\"-l1*sin(th1)\",\"-l2*sin(th2)\",\"-l3*sin(th3)\",\"-l4*sin(th4)\"],"
          "[\"l1*cos(th1)\",\"l2*cos(th2)\",\"l3*cos(th3)\",\"l4*cos(th4)\"]]}",
          &v);
    assert_near(v.score, 6, 0);
    assert_non_null(strstr(v.summary, "columns 3, 4: wrong sign in every row"));
}

static void files_that_cannot_be_graded_say_why(void **state) {
    static const struct {
        const char *text, *word;
    } rows[] = {
        {"", "empty"},
        {"   ", "white space"},
        {"\n# Heading\n", "is not JSON: it begins with '#'"},
        {"l1 = 3", "it begins with 'l'"},
        {"\xE2\x80\x93", "hand in a JSON file, which begins with '{'; "
                         "'holonom problem p3' shows the form"},
        {"{}", "'J' is missing: the object is empty"},
        {"{\"j\": []}", "'J' is missing"},
        {"[]", "is a list, expected an object"},
        {"\"J\"", "is a text"},
        {"null", "is null"},
        {"{\"J\": NaN}", "NaN"},
        {"{\"J\": [[1e400,0,0,0],[0,0,0,0]]}", "1e400"},
        {"{\"J\": [[\"a\",\"b\"", "line 1"},
        {"{\"J\": 3}", "is a number, expected a list of 2 rows"},
        {"{\"J\": []}", "0 rows"},
        {"{\"J\": [1, 2]}", "row 1 of 'J' is a number"},
        {"{\"J\": [[1,2,3,4],[1,2,3]]}", "row 2 of 'J' has 3 entries"},
        {"{\"J\": [[1,2,3],[1,2,3]]}", "2 rows of 3 entries, expected 2 rows of 4"},
        {"{\"J\": [[1,2,3,4]]}", "1 rows of 4"},
        {"{\"J\": [[1,2,3,{}],[1,2,3,4]]}", "is an object"},
        {"{\"J\": [[1,2,3,true],[1,2,3,4]]}", "true or false"},
        {"{\"problem\": \"p5\", \"J\": []}", "answers problem 'p5'"},
        {"[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]", "nested deeper"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hn_verdict v;
        grade(*state, rows[i].text, &v);
        if (v.kind != HN_VERDICT_UNGRADABLE ||
            (!strstr(v.reason, rows[i].word) && !strstr(v.hint, rows[i].word))) {
            fail_msg("%s: '%s' (%s), expected '%s'", rows[i].text, v.reason, v.hint, rows[i].word);
        }
        assert_near(v.score, 0, 0);
        assert_int_equal(v.n_entries, 0);
    }
}

static void numbers_and_null_are_entries_that_are_wrong_not_unreadable_files(void **state) {
    hn_verdict v;
    grade(*state,
          "{\"J\": [[1, null, -2.5, 0], [\"l1*cos(th1)\", \" \", 0, 1e300]], \"student\": \"s\", "
          "\"extra\": 1}",
          &v);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_near(v.score, 1, 0);
    assert_string_equal(v.entry[0].mistake, "number");
    assert_string_equal(v.entry[1].mistake, "blank");
    assert_string_equal(v.entry[3].mistake, "zero");
    assert_string_equal(v.entry[5].mistake, "blank");
    assert_non_null(strstr(v.note, "'extra'"));
}

static void huge_and_malicious_formulas_are_bounded(void **state) {
    static char text[HN_GRADE_MAX_BYTES + 10];
    hn_verdict v;
    memset(text, ' ', sizeof text - 1);
    grade(*state, text, &v);
    assert_non_null(strstr(v.reason, "1048576 bytes"));
    // deep parentheses, a tower of powers, a long sum
    char formula[4096] = "";
    memset(formula, '(', 1500);
    formula[1500] = '\0';
    grade_with(*state, 0, formula, &v);
    assert_string_equal(v.entry[0].mistake, "unreadable");
    snprintf(formula, sizeof formula, "(th1+1)");
    for (int i = 0; i < 200; i++) {
        strcat(formula, "^9");
    }
    grade_with(*state, 0, formula, &v);
    assert_false(v.entry[0].right);
    formula[0] = '\0';
    for (int i = 0; i < 90; i++) {
        strcat(formula, "((");
    }
    strcat(formula, "th1+l1");
    for (int i = 0; i < 90; i++) {
        strcat(formula, ")^9+th2)");
    }
    grade_with(*state, 0, formula, &v);
    assert_false(v.entry[0].right);
    memset(formula, '1', sizeof formula);
    formula[HN_GRADE_MAX_FORMULA + 1] = '\0';
    grade_with(*state, 0, formula, &v);
    assert_string_equal(v.entry[0].mistake, "unreadable");
}

static void the_shipped_answer_has_full_score(void **state) {
    hn_verdict v;
    assert_int_equal(hn_grade_file(*state, "lessons/01-closed-loops/answers/p3.json", 0, &v),
                     HN_OK);
    assert_int_equal(v.kind, HN_VERDICT_GRADED);
    assert_near(v.score, 8, 0);
    assert_string_equal(v.note, "");
}

static void a_file_that_is_missing_is_ungradable(void **state) {
    hn_verdict v;
    assert_int_equal(hn_grade_file(*state, "tests/no/such/file.json", 0, &v), HN_OK);
    assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
    assert_non_null(strstr(v.reason, "tests/no/such/file.json"));
}

static void every_prefix_of_a_submission_ends_in_a_verdict(void **state) {
    const char *text = "{\"J\": "
                       "[[\"-l1*sin(th1)\",\"-l2*sin(th2)\",3,null],[\"l1*cos(th1)\",\"l2*cos(th2)"
                       "\",\"-l3*cos(th3)\",\"\\u0078\"]]}";
    for (size_t n = 0; n < strlen(text); n++) {
        hn_verdict v;
        char *exact = malloc(n + 1);
        memcpy(exact, text, n);
        assert_int_equal(hn_grade_json(*state, exact, n, 0, &v), HN_OK);
        assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
        free(exact);
    }
}

static void the_statement_says_that_the_ground_is_held_and_how_to_hand_in(void **state) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_exercise_text(&b, *state, 0, NULL);
    assert_non_null(strstr(hn_strbuf_text(&b), "two degrees of freedom"));
    assert_non_null(
        strstr(hn_strbuf_text(&b), "{\"J\": [[\"...\", \"...\", \"...\", \"...\"], [\"...\""));
    hn_strbuf_clear(&b);
    hn_exercise_json(&b, *state, 0, NULL);
    cJSON *root = parse(&b);
    assert_near(number_of(root, "points"), 8, 0);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(root, "entries")), 8);
    cJSON_Delete(root);
}

/// The right Jacobian by hand, at the numbers of a document.
static void each_variant_has_numbers_that_close_the_loop_and_a_velocity_of_j(void **state) {
    double first = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        double l[4], c[4], s[4], v[4], phi[2] = {0, 0}, jv[2] = {0, 0}, size = 0;
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_exercise_json(&b, *state, seed, NULL);
        cJSON *root = parse(&b);
        const cJSON *numbers = cJSON_GetObjectItemCaseSensitive(root, "numbers");
        for (int i = 0; i < 4; i++) {
            char length[16], angle[16];
            snprintf(length, sizeof length, "l%d", i + 1);
            snprintf(angle, sizeof angle, "th%d", i + 1);
            l[i] = (i < 2 ? 1 : -1) * number_of(numbers, length);
            c[i] = cos(number_of(numbers, angle));
            s[i] = sin(number_of(numbers, angle));
            v[i] = number_of(cJSON_GetObjectItemCaseSensitive(root, "velocity"), angle);
            phi[0] += l[i] * c[i];
            phi[1] += l[i] * s[i];
            jv[0] -= l[i] * s[i] * v[i];
            jv[1] += l[i] * c[i] * v[i];
            size += fabs(v[i]);
        }

        // lengths of up to 3 m: rounding is far below
        for (int k = 0; k < 2; k++) {
            assert_near(phi[k], 0, 1e-13);
            assert_near(jv[k], 0, 1e-13);
        }
        assert_true(size > 0.05);
        assert_true(number_of(numbers, "l1") != first);
        first = number_of(numbers, "l1");
        cJSON_Delete(root);
    }
}

static void a_faulty_problem_is_told(void **state) {
    static const char *const bad[] = {"", "[]", "{}", "{\"id\":\"x\",\"phi\":[\"l1*(\"]}"};
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        hn_exercise *p;
        hn_diags diags = {0};
        assert_int_equal(hn_exercise_load_json(bad[i], strlen(bad[i]), &p, &diags), HN_ERR_INPUT);
        assert_null(p);
        assert_true(diags.n > 0);
    }
}

static void memory_that_runs_out_is_the_graders_failure_and_nothing_leaks(void **state) {
    cJSON_Hooks hooks = {malloc, free};
    const char *text = "{\"J\": "
                       "[[\"-l1*sin(th1)\",\"l2*sin(th2)\",\"x\",0],[\"l1*cos(th1)\",\"\",\"-l3*"
                       "cos(th3)\",\"th1^2.5\"]]}";
    hn_exercise *p = load_p3();
    (void)state;
    cJSON_InitHooks(&hooks);
    long live = hn_alloc_live(), n = 0;
    int failed;
    do {
        hn_verdict v;
        hn_alloc_fail_at(++n);
        hn_status status = hn_grade_json(p, text, strlen(text), 0, &v);
        failed = hn_alloc_has_failed();
        hn_alloc_fail_at(0);
        assert_true(status == HN_ERR_MEMORY || status == HN_OK);
        assert_true(status == HN_ERR_MEMORY || v.kind == HN_VERDICT_GRADED);
        assert_int_equal(hn_alloc_live(), live);
        n += n > 300 ? n / 10 : 0; // the many evaluations are alike
    } while (failed);
    cJSON_InitHooks(NULL);
    hn_exercise_free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lessons_jacobian_has_full_score),
        cmocka_unit_test(a_right_entry_is_right_in_any_spelling),
        cmocka_unit_test(a_right_entry_is_right_in_the_spelling_of_other_languages),
        cmocka_unit_test(a_constant_of_seven_digits_passes_in_every_entry_and_with_every_seed),
        cmocka_unit_test(a_constant_of_four_digits_does_not_pass),
        cmocka_unit_test(unreadable_formulas_are_in_the_summary),
        cmocka_unit_test(a_submission_without_a_readable_formula_is_ungradable),
        cmocka_unit_test(the_encoding_of_a_file_is_no_reason_to_refuse_it),
        cmocka_unit_test(two_slips_of_json_are_put_right_with_a_remark),
        cmocka_unit_test(the_right_answers_are_shown_to_teachers_alone),
        cmocka_unit_test(a_formula_that_uses_the_closed_loop_is_right_and_told),
        cmocka_unit_test(each_known_mistake_is_named_and_shown_at_a_state),
        cmocka_unit_test(a_term_that_was_not_differentiated_is_suspected_in_both_rows),
        cmocka_unit_test(two_mistakes_at_once_are_named),
        cmocka_unit_test(the_state_shown_closes_the_loop_and_holds_the_expected_value),
        cmocka_unit_test(right_entries_are_never_accused_whatever_the_seed),
        cmocka_unit_test(a_transposed_matrix_earns_its_share_and_is_told),
        cmocka_unit_test(links_on_the_wrong_side_of_the_loop_are_told_by_column),
        cmocka_unit_test(files_that_cannot_be_graded_say_why),
        cmocka_unit_test(numbers_and_null_are_entries_that_are_wrong_not_unreadable_files),
        cmocka_unit_test(huge_and_malicious_formulas_are_bounded),
        cmocka_unit_test(the_shipped_answer_has_full_score),
        cmocka_unit_test(a_file_that_is_missing_is_ungradable),
        cmocka_unit_test(every_prefix_of_a_submission_ends_in_a_verdict),
        cmocka_unit_test(the_statement_says_that_the_ground_is_held_and_how_to_hand_in),
        cmocka_unit_test(each_variant_has_numbers_that_close_the_loop_and_a_velocity_of_j),
        cmocka_unit_test(a_faulty_problem_is_told),
        cmocka_unit_test(memory_that_runs_out_is_the_graders_failure_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
