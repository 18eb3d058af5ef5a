// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/method/catalogue.h"
#include "support/near.h"

#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/method/method_spec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static hn_status parse(const char *text, hn_method_spec *spec, hn_diag *diag) {
    memset(diag, 0x5a, sizeof *diag);
    return hn_method_parse(text, spec, diag);
}

static void options_are_read_and_the_rest_keeps_its_default(void **state) {
    (void)state;
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("baumgarte:alpha=20@rk4:h=1e-3", &s, &d), HN_OK);
    assert_string_equal(s.formulation->name, "baumgarte");
    assert_string_equal(s.stepper->name, "rk4");
    assert_near(hn_method_option(&s, "alpha", 0), 20, 0);
    assert_near(hn_method_option(&s, "beta", 0), 5, 0);
    assert_near(hn_method_option(&s, "h", 0), 1e-3, 0);
    assert_near(hn_method_option(&s, "rtol", -7), -7, 0);
    assert_string_equal(d.message, "");
    assert_int_equal(parse("projection:weight=euclidean,what=velocity@dopri5", &s, &d), HN_OK);
    assert_near(hn_method_option(&s, "weight", -1), 1, 0);
    assert_near(hn_method_option(&s, "what", -1), 2, 0);
}

static void step_sizes_may_carry_a_unit_or_a_decimal_comma(void **state) {
    (void)state;
    static const char *const texts[] = {
        "index1@rk4:h=0.02",   "index1@rk4:h=2e-2 s",  "index1@rk4:h=0,02",
        "index1@rk4:h=20 ms",  "index1@rk4:h=20000us", " index1 @ rk4 : h = 0.02 s ",
        "index1@rk4:h=0,02 s", "index1@rk4:h=+.02",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        hn_method_spec s;
        hn_diag d;
        assert_int_equal(parse(texts[i], &s, &d), HN_OK);
        assert_near(hn_method_option(&s, "h", 0), 0.02, 0);
    }
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("baumgarte:alpha=0,5,beta=2,25@rk4:h=0,01", &s, &d), HN_OK);
    assert_near(hn_method_option(&s, "alpha", 0), 0.5, 0);
    assert_near(hn_method_option(&s, "beta", 0), 2.25, 0);
}

static void each_fault_has_its_column_and_its_hint(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int column;
        const char *message, *hint;
    } faults[] = {
        {"", 1, "'@'", "projection@rk4"},
        {"index1", 7, "'@'", "list methods"},
        {"index1", 7, "'@'", "index1@rk4"},
        {"baumgart", 9, "'@'", "baumgarte@rk4"},
        {"projecton@rk4", 1, "'projecton'", "'projection'"},
        {"index1@rk5:h=1", 8, "'rk5'", "'rk4'"},
        {"baumgarte:alpa=1@rk4", 11, "'alpa'", "'alpha'"},
        {"baumgarte:alpha=1,alpha=2@rk4", 19, "twice", ""},
        {"index1@rk4:h=fast", 14, "number", ""},
        {"index1@rk4:h=nan", 14, "number", ""},
        {"index1@rk4:h=inf", 14, "number", ""},
        {"index1@rk4:h=0x10", 14, "x10", ""},
        {"index1@rk4:h=0", 14, "than 0 s; it is 0", ""},
        {"index1@rk4:h=-1e-3", 14, "than 0 s; it is -0.001", ""},
        {"index1@rk4:h=1e9", 14, "out of range", ""},
        {"index1@rk4:h=1e999", 14, "finite", ""},
        {"index1@rk4:h=1 m", 14, "'m'", ""},
        {"index1@rk4:h", 12, "'h' has no value", "key=value"},
        {"index1@rk4:h=1,,", 16, "missing", "key=value"},
        {"index1@rk4:", 12, "missing", "key=value"},
        {"index1:alpha=1@rk4", 8, "'alpha'", ""},
        {"nullspace-as-printed:basis=unit@rk4", 28, "'unit'", ""},
        {"projection:what=positon@rk4", 17, "'positon'", "'position'"},
        {"index1@rk4@rk4", 8, "'rk4@rk4'", ""},
        {"rattle@index3", 1, "'rattle' is an integrator", "FORMULATION@INTEGRATOR"},
        {"index1@ggl:h=1", 8, "'ggl' is a formulation", "FORMULATION@INTEGRATOR"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        hn_method_spec s;
        hn_diag d;
        memset(&s, 0x5a, sizeof s);
        const hn_method_spec before = s;
        assert_int_equal(parse(faults[i].text, &s, &d), HN_ERR_INPUT);
        if (d.column != faults[i].column || !strstr(d.message, faults[i].message) ||
            !strstr(d.hint, faults[i].hint)) {
            fail_msg("%s: column %d: %s (%s)", faults[i].text, d.column, d.message, d.hint);
        }
        assert_memory_equal(&s, &before, sizeof s);
    }
}

static void a_negative_alpha_is_allowed_and_told(void **state) {
    (void)state;
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("baumgarte:alpha=-5@rk4", &s, &d), HN_OK);
    assert_near(hn_method_option(&s, "alpha", 0), -5, 0);
    assert_non_null(strstr(d.message, "drives the loop open"));
}

static void normal_spelling_reads_back_to_the_same_spec(void **state) {
    (void)state;
    static const char *const pairs[][2] = {
        {"index1@rk4", "index1@rk4:h=0.001"},
        {"baumgarte:beta=5,alpha=20@rk4:h=1e-3", "baumgarte:alpha=20@rk4:h=0.001"},
        {"baumgarte:rule=auto@heun:h=0,1", "baumgarte:rule=auto@heun:h=0.1"},
        {"projection:what=both,weight=euclidean@dopri5:atol=1e-9",
         "projection:weight=euclidean@dopri5:rtol=1e-06,atol=1e-09"},
        {"reduced:coordinate=2@euler:h=0.123456789012345660",
         "reduced:coordinate=2@euler:h=0.12345678901234566"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        hn_method_spec a, b;
        hn_diag d;
        char text[HN_SPEC_MAX], again[HN_SPEC_MAX];
        assert_int_equal(parse(pairs[i][0], &a, &d), HN_OK);
        hn_method_format(&a, text);
        assert_string_equal(text, pairs[i][1]);
        assert_int_equal(parse(text, &b, &d), HN_OK);
        hn_method_format(&b, again);
        assert_string_equal(text, again);
        assert_memory_equal(a.formulation_set, b.formulation_set, sizeof a.formulation_set);
        assert_memory_equal(a.stepper_set, b.stepper_set, sizeof a.stepper_set);
    }
}

static void a_pair_is_read_exactly_when_the_integrator_serves_the_formulation(void **state) {
    (void)state;
    for (int i = 0; i < hn_formulation_count(); i++) {
        for (int j = 0; j < hn_stepper_count(); j++) {
            char text[HN_SPEC_MAX];
            hn_method_spec s;
            hn_diag d;
            const hn_formulation *f = hn_formulation_at(i);
            const hn_stepper *integrator = hn_stepper_at(j);
            snprintf(text, sizeof text, "%s@%s", f->name, integrator->name);
            if (!hn_method_fits(f, integrator)) {
                assert_int_equal(parse(text, &s, &d), HN_ERR_INPUT);
                assert_non_null(strstr(d.message, f->name));
                assert_non_null(strstr(d.hint, integrator->name));
                assert_int_equal(d.column, strlen(f->name) + 2);
                continue;
            }
            assert_int_equal(parse(text, &s, &d), HN_OK);
            assert_ptr_equal(s.formulation, f);
            assert_ptr_equal(s.stepper, integrator);
        }
    }
}

static void a_refused_pair_names_what_fits_on_either_side(void **state) {
    (void)state;
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("index3@rk4:h=0.01", &s, &d), HN_ERR_INPUT);
    assert_non_null(strstr(d.message, "the formulation index3 gives a differential-algebraic "
                                      "system, which the integrator rk4 does not solve"));
    assert_non_null(strstr(d.hint, "rk4 serves index1, baumgarte"));
    assert_null(strstr(d.hint, "index3,"));
}

static void an_option_on_the_wrong_side_names_the_side_that_has_it(void **state) {
    (void)state;
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("baumgarte@rk4:h=0.01,alpha=5", &s, &d), HN_ERR_INPUT);
    assert_string_equal(d.message, "option 'alpha' belongs to baumgarte, not to rk4");
    assert_string_equal(d.hint, "write it behind that name: baumgarte:alpha=VALUE");
    assert_int_equal(d.column, 22);
    assert_int_equal(parse("baumgarte:h=0.01@rk4", &s, &d), HN_ERR_INPUT);
    assert_string_equal(d.message, "option 'h' belongs to rk4, not to baumgarte");
    assert_int_equal(parse("baumgarte@rk4:omega=3", &s, &d), HN_ERR_INPUT);
    assert_string_equal(d.message, "option 'omega' is not known; there are: h, sum");
}

static void a_file_is_answered_with_the_spelling_of_a_program(void **state) {
    (void)state;
    hn_method_spec s;
    hn_diag d;
    assert_int_equal(parse("./mine.py@rk4:h=0.01", &s, &d), HN_ERR_INPUT);
    assert_string_equal(d.hint, "a program of your own is spelled program:./mine.py@rk4:h=1e-3");
    assert_int_equal(parse("mine.py", &s, &d), HN_ERR_INPUT);
    assert_string_equal(d.hint, "a program of your own is spelled program:mine.py@rk4:h=1e-3");
    assert_int_equal(parse("baumgarte@rk4:h.x=3", &s, &d), HN_ERR_INPUT);
    assert_null(strstr(d.hint, "program:"));
}

static int n_words(const char *text) {
    int n = 0;
    for (; *text; n++) {
        text += strcspn(text, " ");
        text += strspn(text, " ");
    }
    return n;
}

static void cards_keep_to_their_space_and_choices_to_their_range(void **state) {
    (void)state;
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        assert_true(strlen(f->short_name) <= 14);
        assert_true(n_words(f->rule) <= 35);
        for (int k = 0; k < f->n_options; k++) {
            const hn_option *s = &f->options[k];
            assert_true(isnan(s->initial) || (s->initial >= s->min && s->initial <= s->max));
            assert_true(!s->choices || s->max == s->n_choices - 1);
        }
    }
}

static void json_names_choices_and_never_holds_infinity(void **state) {
    (void)state;
    hn_strbuf b;
    hn_method_spec s;
    hn_diag d;
    hn_strbuf_init(&b);
    assert_int_equal(parse("projection:what=velocity@rk4:h=0.01", &s, &d), HN_OK);
    hn_method_json(&b, &s);
    assert_non_null(
        strstr(hn_strbuf_text(&b), "\"spelling\":\"projection:what=velocity@rk4:h=0.01\""));
    assert_non_null(strstr(hn_strbuf_text(&b), "\"what\":\"velocity\""));
    hn_strbuf_clear(&b);
    hn_methods_json(&b);
    assert_int_equal(b.failed, 0);
    assert_null(strstr(hn_strbuf_text(&b), ":inf"));
    assert_null(strstr(hn_strbuf_text(&b), ":nan"));
    for (int i = 0; i < hn_formulation_count(); i++) {
        assert_non_null(strstr(hn_strbuf_text(&b), hn_formulation_at(i)->title));
    }
    hn_strbuf_reset(&b);
}

static unsigned next_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 16;
}

// any text: either refused with a column inside it, or a spec whose spelling reads back
static void random_text_is_refused_or_reads_back(void **state) {
    (void)state;
    static const char *const bits[] = {"index1",
                                       "baumgarte",
                                       "projection",
                                       "@",
                                       "rk4",
                                       "dopri5",
                                       ":",
                                       "=",
                                       ",",
                                       "alpha",
                                       "h",
                                       "rtol",
                                       "1e-3",
                                       "0",
                                       "5",
                                       " ",
                                       "-",
                                       ".",
                                       "what",
                                       "both",
                                       "\xc3\xa9",
                                       "e",
                                       "s",
                                       "@rk4:h=",
                                       "index1@dopri5:rtol=",
                                       "baumgarte:alpha=",
                                       "projection@rk4"};
    const unsigned n_bits = sizeof bits / sizeof bits[0];
    unsigned seed = 12345, good = 0;
    for (int i = 0; i < 200000; i++) {
        char text[2 * HN_SPEC_MAX] = "", again[HN_SPEC_MAX], third[HN_SPEC_MAX];
        const unsigned n = next_random(&seed) % 12;
        for (unsigned k = 0; k < n; k++) {
            strcat(text, bits[next_random(&seed) % n_bits]);
        }
        hn_method_spec s, b;
        hn_diag d;
        if (parse(text, &s, &d) != HN_OK) {
            assert_true(d.column >= 1 && d.column <= (int)strlen(text) + 1);
            assert_true(d.message[0] != '\0');
            continue;
        }
        good++;
        hn_method_format(&s, again);
        assert_int_equal(parse(again, &b, &d), HN_OK);
        hn_method_format(&b, third);
        assert_string_equal(again, third);
    }
    assert_true(good > 100);
}

static void a_spelling_that_is_too_long_is_refused(void **state) {
    (void)state;
    char text[2000];
    hn_method_spec s;
    hn_diag d;
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    assert_int_equal(parse(text, &s, &d), HN_ERR_INPUT);
    assert_non_null(strstr(d.message, "255"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_are_read_and_the_rest_keeps_its_default),
        cmocka_unit_test(step_sizes_may_carry_a_unit_or_a_decimal_comma),
        cmocka_unit_test(each_fault_has_its_column_and_its_hint),
        cmocka_unit_test(a_negative_alpha_is_allowed_and_told),
        cmocka_unit_test(normal_spelling_reads_back_to_the_same_spec),
        cmocka_unit_test(a_pair_is_read_exactly_when_the_integrator_serves_the_formulation),
        cmocka_unit_test(a_refused_pair_names_what_fits_on_either_side),
        cmocka_unit_test(an_option_on_the_wrong_side_names_the_side_that_has_it),
        cmocka_unit_test(a_file_is_answered_with_the_spelling_of_a_program),
        cmocka_unit_test(cards_keep_to_their_space_and_choices_to_their_range),
        cmocka_unit_test(json_names_choices_and_never_holds_infinity),
        cmocka_unit_test(random_text_is_refused_or_reads_back),
        cmocka_unit_test(a_spelling_that_is_too_long_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
