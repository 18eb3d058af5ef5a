// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of answers: right answers in many spellings, mistakes named, hostile input refused with a
// reason; the shipped exercises proved over a few seeds.
#include "grade/exercise_check.h"
#include "grade/grade.h"
#include "grade/parts/unit_text.h"
#include "grade/variant_text.h"

#include "support/alloc.h"
#include "support/near.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// one part of each kind of number and formula, small enough to see through
static const char VALUES[] =
    "{\"exercise\":2,\"id\":\"t\",\"title\":\"t\",\"lesson\":\"l\",\"section\":\"s\","
    "\"statement\":[\"A rod of {l} m.\"],"
    "\"draw\":{\"l\":{\"range\":[0.5,0.9],\"digits\":2,\"unit\":\"m\"},"
    "\"w\":{\"range\":[2,3],\"digits\":1,\"unit\":\"rad/s\"}},\"conditions\":[\"l-0.6\"],"
    "\"parts\":["
    "{\"id\":\"a\",\"ask\":\"v?\",\"kind\":\"number\",\"points\":2,\"unit\":\"m/s\","
    "\"answer\":\"l*w\",\"second\":\"sqrt(l^2*w^2)\","
    "\"faults\":[{\"id\":\"sum\",\"answer\":\"l+w\",\"says\":\"a product\",\"share\":0.5}]},"
    "{\"id\":\"b\",\"ask\":\"x?\",\"kind\":\"formula\",\"points\":2,"
    "\"states\":{\"th1\":{\"range\":[-3,3],\"unit\":\"rad\"},\"w1\":{\"range\":[1,2]}},"
    "\"answer\":\"-l*sin(th1)*w1\",\"second\":\"l*w1*cos(th1+pi/2)\"},"
    "{\"id\":\"c\",\"ask\":\"p?\",\"kind\":\"vector\",\"points\":2,\"unit\":\"m\","
    "\"answer\":[\"l\",\"2*l+1\"],\"second\":[\"l\",\"1+l+l\"]}]}";

static hn_exercise *load(const char *text) {
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    if (hn_exercise_load_json(text, strlen(text), &e, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    return e;
}

/// Grades {"PART": ANSWER} and returns the first entry of the part.
static hn_entry_verdict grade(const hn_exercise *e, const char *part, const char *answer) {
    static hn_verdict v;
    char text[4000];
    snprintf(text, sizeof text, "{\"%s\": %s}", part, answer);
    memset(&v, 0x5A, sizeof v);
    assert_int_equal(hn_grade_json(e, text, strlen(text), 7, &v), HN_OK);
    for (int k = 0; k < v.n_entries; k++) {
        if (strncmp(v.entry[k].name, part, strlen(part)) == 0) {
            return v.entry[k];
        }
    }
    return (hn_entry_verdict){.mistake = "none"};
}

static void expect(const hn_exercise *e, const char *part, const char *answer,
                   const char *mistake) {
    const hn_entry_verdict v = grade(e, part, answer);
    if (strcmp(v.mistake, mistake) != 0) {
        fail_msg("%s = %s: '%s' (%s), wanted '%s'", part, answer, v.mistake, v.explanation,
                 mistake);
    }
    assert_int_equal(v.right, mistake[0] == 0);
}

/// "1.234 unit" of the drawn numbers of seed 7.
static const char *with_number(const hn_exercise *e, const char *formula, const char *form) {
    static char text[100];
    hn_variant x;
    double value;
    assert_int_equal(hn_variant_init(&x, e, 7, NULL), HN_OK);
    assert_int_equal(hn_draw_value(&x.draw, formula, &value, NULL), HN_OK);
    snprintf(text, sizeof text, form, value);
    hn_variant_reset(&x);
    return text;
}

static void numbers_are_read_with_their_units(void **state) {
    hn_exercise *e = *state;
    expect(e, "a", with_number(e, "l*w", "%.4f"), "");
    expect(e, "a", with_number(e, "l*w", "\"%.4f m/s\""), "");
    expect(e, "a", with_number(e, "l*w*100", "\"%.3f cm/s\""), "");
    expect(e, "a", with_number(e, "l*w*3.6", "\"%.4f km/h\""), "");
    expect(e, "a", with_number(e, "l*w", "\"2*%.4f/2\""), "");
    expect(e, "a", with_number(e, "l*w", "\"%.4f m\""), "unit");
    expect(e, "a", "\"l*w\"", "unreadable");
    expect(e, "a", "\"fast\"", "unreadable");
    expect(e, "a", "[1, 2]", "shape");
    expect(e, "a", "null", "blank");
    expect(e, "a", "true", "unreadable");
}

static void a_number_without_an_end_is_refused_at_once(void **state) {
    enum { TERMS = 150000 };
    hn_strbuf b;
    static hn_verdict v;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, "{\"a\": \"");
    for (int i = 0; i < TERMS; i++) {
        hn_strbuf_add(&b, "1+");
    }
    hn_strbuf_add(&b, "\"}");

    // a unit is not looked for behind each digit: that would take 10 s of computing and more
    const clock_t start = clock();
    assert_int_equal(hn_grade_json(*state, hn_strbuf_text(&b), b.n, 7, &v), HN_OK);
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 5);
    assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
    hn_strbuf_reset(&b);
}

static void no_digit_of_a_number_is_taken_for_a_unit(void **state) {
    static const char *const units[] = {"m/s", " m/s", " m*1/s", "m s⁻¹", " meters/second"};
    hn_exercise *e = *state;
    for (int digit = 0; digit < 10; digit++) {
        for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
            char form[64]; // a number that ends in the digit, before the unit
            snprintf(form, sizeof form, "\"%%.6f*1%d/1%d%s\"", digit, digit, units[k]);
            expect(e, "a", with_number(e, "l*w", form), "");
        }
    }
    // some ten times as much
    expect(e, "a", with_number(e, "l*w", "\"%.0f1 m/s\""), "other");
}

static void mistakes_in_numbers_are_named(void **state) {
    hn_exercise *e = *state;
    expect(e, "a", with_number(e, "l+w", "%.4f"), "sum");
    expect(e, "a", with_number(e, "-l*w", "%.4f"), "sign");
    expect(e, "a", with_number(e, "l*w/2", "%.4f"), "half");
    expect(e, "a", with_number(e, "l*w*1000", "%.2f"), "milli");
    expect(e, "a", with_number(e, "l*w*180/pi", "%.4f"), "other"); // metres are no angle
    expect(e, "a", with_number(e, "l*w*1.1", "%.4f"), "other");

    // two at once: the listed mistake and the sign
    const hn_entry_verdict v = grade(e, "a", with_number(e, "-(l+w)", "%.4f"));
    assert_string_equal(v.mistake, "sum");
    assert_non_null(strstr(v.explanation, "the sign is wrong as well"));
    assert_near(v.points, 0.5, 1e-12);
}

/// The sentence about the entry `name` of an answer.
static const char *explain(const hn_exercise *e, const char *part, const char *answer) {
    static hn_entry_verdict v;
    v = grade(e, part, answer);
    return v.explanation;
}

static void a_mistake_that_chance_explains_is_called_likely(void **state) {
    const hn_exercise *e = *state;

    // a number that equals l by chance: the formula names l, so that l can be changed
    expect(e, "b", with_number(e, "l", "\"-l*sin(th1)*w1/%.2f\""), "wrong-factor");
    expect(e, "b", "\"-sin(th1)*w1\"", "missing-name");
    assert_null(strstr(explain(e, "b", "\"-sin(th1)*w1\""), "looks like"));
    assert_null(strstr(explain(e, "b", "\"l*sin(th1)*w1\""), "looks like"));

    // a number in its place cannot be changed
    assert_string_equal(explain(e, "b", with_number(e, "l", "\"%.2f*sin(th1)*w1\"")),
                        "probably this mistake: the sign is wrong");
    assert_string_equal(explain(e, "a", with_number(e, "l+w", "%.4f")),
                        "probably this mistake: a product");

    // two numbers that show the same mistake are more than chance
    char both[64];
    snprintf(both, sizeof both, "%s", with_number(e, "-l", "[%.4f, "));
    snprintf(both + strlen(both), sizeof both - strlen(both), "%s",
             with_number(e, "-2*l-1", "%.4f]"));
    assert_string_equal(explain(e, "c", both), "the sign is wrong");
}

static void two_mistakes_that_explain_a_number_are_both_named(void **state) {
    static const char EQUAL[] =
        "{\"exercise\":2,\"id\":\"t\",\"title\":\"t\",\"lesson\":\"l\",\"section\":\"s\","
        "\"statement\":[\"A rod of {l} m.\"],\"draw\":{\"l\":{\"choose\":[2]}},\"parts\":["
        "{\"id\":\"a\",\"ask\":\"v?\",\"kind\":\"number\",\"points\":2,"
        "\"answer\":\"l+7\",\"second\":\"7+l\",\"faults\":["
        "{\"id\":\"twice\",\"answer\":\"2*l\",\"says\":\"not two rods\",\"share\":0.25},"
        "{\"id\":\"sum\",\"answer\":\"l+l\",\"says\":\"not a sum\",\"share\":0.75},"
        "{\"id\":\"square\",\"answer\":\"l^2\",\"says\":\"not a square\",\"share\":0.5}]}]}";
    (void)state;
    hn_exercise *e = load(EQUAL);
    const hn_entry_verdict v = grade(e, "a", "4");

    // l + l is 2 l in every variant: that is one mistake, and the first of its names is taken
    assert_string_equal(v.mistake, "twice");
    assert_string_equal(v.explanation, "probably this mistake: not two rods; or: not a square");
    assert_near(v.points, 1, 1e-12);
    hn_exercise_free(e);
}

static void two_mistakes_in_formulas_are_named(void **state) {
    static const struct {
        const char *formula, *id, *words;
    } rows[] = {
        {"\"l*sin(th1*pi/180)*w1\"", "degrees", "and the sign is wrong as well"},
        {"\"sin(th1)*w1\"", "missing-name",
         "the factor l is missing; and the sign is wrong as well"},
        {"\"-sin(th1)\"", "missing-name", "the factors l and w1 are missing"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const hn_entry_verdict v = grade(*state, "b", rows[i].formula);
        if (strcmp(v.mistake, rows[i].id) != 0 || !strstr(v.explanation, rows[i].words)) {
            fail_msg("%s: %s, %s", rows[i].formula, v.mistake, v.explanation);
        }
        assert_true(v.points < 0.5 * v.max_points);
    }
}

static void formulas_are_right_in_any_form(void **state) {
    static const char *const right[] = {
        "\"-l*sin(th1)*w1\"",  "\"-l*np.sin(th1)*w1\"",           "\"-w1*l*Sin[th1]\"",
        "\"−l·sin(θ1)·w1\"",   "\"-l \\\\sin(\\\\theta_1) w_1\"", "\"l*w1*cos(th1+pi/2)\"",
        "\"-l*w1*sin(th_1)\"",
    };
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
        expect(*state, "b", right[i], "");
    }
}

static void mistakes_in_formulas_are_named(void **state) {
    expect(*state, "b", "\"l*sin(th1)*w1\"", "sign");
    expect(*state, "b", "\"-l*cos(th1)*w1\"", "sine");
    expect(*state, "b", "\"-l*sin(th1*pi/180)*w1\"", "degrees");
    expect(*state, "b", "\"-sin(th1)*w1\"", "missing-name");
    expect(*state, "b", "\"-l*sin(th1)\"", "missing-name");
    expect(*state, "b", "\"1/0*th1\"", "unreadable");
    expect(*state, "b", "\"sqrt(th1-9)\"", "not-finite");
    expect(*state, "b", "\"-l*sin(th2)*w1\"", "unreadable");
    expect(*state, "b", "\"((((\"", "unreadable");
}

static void vectors_are_graded_entry_by_entry(void **state) {
    hn_exercise *e = *state;
    hn_verdict v;
    char text[200];
    snprintf(text, sizeof text, "{\"c\": [%s, 9]}", with_number(e, "l", "%.4f"));
    assert_int_equal(hn_grade_json(e, text, strlen(text), 7, &v), HN_OK);
    assert_near(v.score, 1, 1e-12);
    assert_string_equal(v.entry[2].name, "c.1");
    assert_int_equal(v.entry[2].right, 1);
    assert_int_equal(v.entry[3].right, 0);
}

static void what_nobody_can_read_is_ungradable(void **state) {
    static const char *const texts[] = {"{}",
                                        "[]",
                                        "{\"x\": 1}",
                                        "{\"a\": \"??\"}",
                                        "{\"a\": tru}",
                                        "{\"problem\": \"p9\", \"a\": 1}",
                                        "{\"seed\": 8, \"a\": 1}"};
    hn_verdict v;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_int_equal(hn_grade_json(*state, texts[i], strlen(texts[i]), 7, &v), HN_OK);
        assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
        assert_true(v.reason[0] != 0);
    }
}

static void the_same_seed_gives_the_same_text(void **state) {
    hn_strbuf a, b;
    hn_variant x;
    hn_strbuf_init(&a);
    hn_strbuf_init(&b);
    assert_int_equal(hn_variant_init(&x, *state, 42, NULL), HN_OK);
    hn_variant_text(&a, &x);
    hn_variant_reset(&x);
    assert_int_equal(hn_variant_init(&x, *state, 42, NULL), HN_OK);
    assert_true(x.draw.value[0][0] > 0.6); // the condition
    hn_variant_text(&b, &x);
    hn_variant_reset(&x);
    assert_string_equal(hn_strbuf_text(&a), hn_strbuf_text(&b));
    assert_int_equal(hn_variant_seed(*state, "s1"), hn_variant_seed(*state, "s1"));
    assert_true(hn_variant_seed(*state, "s1") != hn_variant_seed(*state, "s2"));
    hn_strbuf_reset(&a);
    hn_strbuf_reset(&b);
}

static void units_are_what_they_measure(void **state) {
    (void)state;
    hn_unit a, b;
    assert_int_equal(hn_unit_parse("kg m^2/s^2", &a), 1);
    assert_int_equal(hn_unit_parse("N m", &b), 1);
    assert_int_equal(hn_unit_fits(&a, &b), 1);
    assert_int_equal(hn_unit_parse("rpm", &a), 1);
    assert_near(a.factor, acos(-1) / 30, 1e-15);
    assert_int_equal(hn_unit_parse("1/s", &b), 1);
    assert_int_equal(hn_unit_fits(&a, &b), 1);
    assert_int_equal(hn_unit_parse("m", &b), 1);
    assert_int_equal(hn_unit_fits(&a, &b), 0);
    assert_int_equal(hn_unit_parse("s⁻¹", &b), 1);
    assert_int_equal(b.power[2], -1);
    assert_int_equal(hn_unit_parse("degrees", &b), 1);
    assert_int_equal(hn_unit_parse("kNm", &a), 1);
    assert_int_equal(hn_unit_parse("J", &b), 1);
    assert_int_equal(hn_unit_fits(&a, &b), 1);
    assert_near(hn_unit_ratio(&a, &b), 1000, 1e-12);

    // cycles are turns beside radians only
    assert_int_equal(hn_unit_parse("Hz", &a), 1);
    assert_int_equal(hn_unit_parse("rad/sec", &b), 1);
    assert_near(hn_unit_ratio(&a, &b), 2 * acos(-1), 1e-14);
    assert_near(hn_unit_ratio(&b, &a), 0.5 / acos(-1), 1e-15);
    assert_int_equal(hn_unit_parse("1/s", &b), 1);
    assert_near(hn_unit_ratio(&a, &b), 1, 1e-15);
    assert_int_equal(hn_unit_parse("rev/min", &b), 1);
    assert_near(hn_unit_ratio(&a, &b), 60, 1e-13);
    assert_int_equal(hn_unit_parse("furlong", &a), 0);
    assert_int_equal(hn_unit_parse("m^99", &a), 0);
}

// ---- the shipped exercises ----

static void every_shipped_exercise_is_sound(void **state) {
    (void)state;
    glob_t files;
    hn_library *lib = NULL;
    assert_int_equal(hn_library_open(".", &lib, NULL), HN_OK);
    assert_int_equal(glob("lessons/*/problems/*.json", 0, NULL, &files), 0);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        hn_exercise *e = NULL;
        hn_diags diags = {0};
        if (hn_exercise_load_file(files.gl_pathv[i], &e, &diags) != HN_OK) {
            fail_msg("%s: %s: %s", files.gl_pathv[i], diags.item[0].pointer, diags.item[0].message);
        }
        e->lib = lib;
        hn_exercise_report report;
        if (e->n_parts) {
            assert_int_equal(hn_exercise_check(e, 1, 3, &report), HN_OK);
            if (report.bad) {
                fail_msg("%s: %s", files.gl_pathv[i], report.first);
            }
        }
        hn_exercise_free(e);
    }
    globfree(&files);
    hn_library_free(lib);
}

/// An exercise whose second means disagrees, and one whose listed mistake is right, are bad.
static void unsound_exercises_are_found(void **state) {
    (void)state;
    static const char *const swaps[][3] = {
        {"sqrt(l^2*w^2)", "l*w+1", "second means"},
        {"\"answer\":\"l+w\"", "\"answer\":\"w*l\"", "taken for right"},
        {"[\"l-0.6\"]", "[\"l-0.95\"]", "conditions"},
    };
    for (int i = 0; i < 3; i++) {
        char text[sizeof VALUES + 100];
        const char *at = strstr(VALUES, swaps[i][0]);
        assert_non_null(at);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - VALUES), VALUES, swaps[i][1],
                 at + strlen(swaps[i][0]));
        hn_exercise *e = load(text);
        hn_exercise_report report;
        assert_int_equal(hn_exercise_check(e, 1, 5, &report), HN_OK);
        assert_int_equal(report.bad, 5);
        assert_non_null(strstr(report.first, swaps[i][2]));
        hn_exercise_free(e);
    }
}

static void faults_of_a_file_are_named(void **state) {
    (void)state;
    static const char *const swaps[][3] = {
        {"\"kind\":\"number\"", "\"kind\":\"numbr\"", "there is no kind of answer 'numbr'"},
        {"\"unit\":\"m/s\"", "\"units\":\"m/s\"", "a field 'units'"},
        {"\"points\":2", "\"points\":-2", "points from 0"},
        {"\"draw\"", "\"drawn\"", "no such field"},
    };
    for (int i = 0; i < 4; i++) {
        char text[sizeof VALUES + 100];
        const char *at = strstr(VALUES, swaps[i][0]);
        assert_non_null(at);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - VALUES), VALUES, swaps[i][1],
                 at + strlen(swaps[i][0]));
        hn_exercise *e = NULL;
        hn_diags diags = {0};
        assert_int_equal(hn_exercise_load_json(text, strlen(text), &e, &diags), HN_ERR_INPUT);
        assert_non_null(strstr(diags.item[0].message, swaps[i][2]));
        assert_null(e);
    }
}

static int setup(void **state) {
    *state = load(VALUES);
    return 0;
}

static int teardown(void **state) {
    hn_exercise_free(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbers_are_read_with_their_units, setup, teardown),
        cmocka_unit_test_setup_teardown(no_digit_of_a_number_is_taken_for_a_unit, setup, teardown),
        cmocka_unit_test_setup_teardown(mistakes_in_numbers_are_named, setup, teardown),
        cmocka_unit_test_setup_teardown(formulas_are_right_in_any_form, setup, teardown),
        cmocka_unit_test_setup_teardown(a_mistake_that_chance_explains_is_called_likely, setup,
                                        teardown),
        cmocka_unit_test(two_mistakes_that_explain_a_number_are_both_named),
        cmocka_unit_test_setup_teardown(a_number_without_an_end_is_refused_at_once, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(two_mistakes_in_formulas_are_named, setup, teardown),
        cmocka_unit_test_setup_teardown(mistakes_in_formulas_are_named, setup, teardown),
        cmocka_unit_test_setup_teardown(vectors_are_graded_entry_by_entry, setup, teardown),
        cmocka_unit_test_setup_teardown(what_nobody_can_read_is_ungradable, setup, teardown),
        cmocka_unit_test_setup_teardown(the_same_seed_gives_the_same_text, setup, teardown),
        cmocka_unit_test(units_are_what_they_measure),
        cmocka_unit_test(every_shipped_exercise_is_sound),
        cmocka_unit_test(unsound_exercises_are_found),
        cmocka_unit_test(faults_of_a_file_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
