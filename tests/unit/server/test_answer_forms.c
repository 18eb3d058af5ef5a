// SPDX-License-Identifier: GPL-3.0-or-later
// Forms of a submission other than the one that is asked for: members that are there twice,
// other ways to write a choice with its reason, fields that nobody reads, rounded numbers.
#include "grade/grade.h"
#include "grade/variant.h"

#include "p3.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

// one choice with a reason, whose letters seed 7 deals out, a number and a formula
static const char ASKED[] =
    "{\"exercise\":2,\"id\":\"t\",\"title\":\"t\",\"lesson\":\"l\",\"section\":\"s\","
    "\"hints\":[\"one\",\"two\"],\"statement\":[\"A rod of {l} m.\"],"
    "\"draw\":{\"l\":{\"range\":[0.5,0.9],\"digits\":2,\"unit\":\"m\"}},\"parts\":["
    "{\"id\":\"a\",\"ask\":\"which?\",\"kind\":\"choice\",\"points\":2,"
    "\"options\":[{\"text\":\"yes\",\"right\":true},{\"text\":\"no\",\"says\":\"not no\"}],"
    "\"reasons\":[{\"text\":\"so\",\"right\":true},{\"text\":\"thus\",\"says\":\"not thus\"}]},"
    "{\"id\":\"b\",\"ask\":\"x?\",\"kind\":\"number\",\"points\":1,\"answer\":\"l\","
    "\"second\":\"l\"},"
    "{\"id\":\"c\",\"ask\":\"f?\",\"kind\":\"formula\",\"points\":2,"
    "\"states\":{\"th1\":{\"range\":[-3,3],\"unit\":\"rad\"}},\"answer\":\"l/3*sin(th1)\","
    "\"second\":\"sin(th1)*l/3\","
    "\"faults\":[{\"id\":\"third\",\"answer\":\"l*sin(th1)\",\"says\":\"a third\"}]},"
    "{\"id\":\"d\",\"ask\":\"sum?\",\"kind\":\"number\",\"points\":1,\"answer\":\"0\","
    "\"second\":\"l-l\",\"tolerance\":{\"relative\":0.005,\"absolute\":1e-6},"
    "\"faults\":[{\"id\":\"one\",\"answer\":\"l\",\"says\":\"only one\"}]}]}";

static const uint64_t SEED = 7;

static int load_asked(void **state) {
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    if (hn_exercise_load_json(ASKED, strlen(ASKED), &e, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    *state = e;
    return 0;
}

static const hn_verdict *verdict_on(const hn_exercise *e, const char *text) {
    static hn_verdict v;
    memset(&v, 0x5A, sizeof v);
    assert_int_equal(hn_grade_json(e, text, strlen(text), SEED, &v), HN_OK);
    return &v;
}

static const hn_entry_verdict *entry_of(const hn_verdict *v, const char *name) {
    for (int k = 0; k < v->n_entries; k++) {
        if (strcmp(v->entry[k].name, name) == 0) {
            return &v->entry[k];
        }
    }
    fail_msg("no entry '%s' (%s)", name, v->reason);
    return NULL;
}

/// The letters of the right option and the right reason with this seed.
static void find_right(const hn_exercise *e, char letters[2]) {
    for (int i = 0; i < 4; i++) {
        char text[80];
        snprintf(text, sizeof text, "{\"a\":{\"choice\":\"%c\",\"reason\":\"%c\"}}", 'a' + i / 2,
                 'a' + i % 2);
        if (verdict_on(e, text)->n_right == 2) {
            letters[0] = (char)('a' + i / 2);
            letters[1] = (char)('a' + i % 2);
            return;
        }
    }
    fail_msg("no pair of letters is right");
}

static void a_choice_with_its_reason_is_read_in_any_clear_form(void **state) {
    static const char *const forms[] = {
        "{\"a\":{\"choice\":\"%c\",\"reason\":\"%c\"}}",
        "{\"a\":{\"Choice\":\"(%c)\",\"REASON\":\"%c.\"}}",
        "{\"a\":[\"%c\",\"%c\"]}",
        "{\"a\":\"%c,%c\"}",
        "{\"a\":\"%c %c\"}",
        "{\"a\":\"(%c), (%c)\"}",
    };
    char right[2];
    find_right(*state, right);
    for (size_t i = 0; i < 2 * sizeof forms / sizeof *forms; i++) {
        // small letters, then capitals
        const int capital = i % 2 ? 'A' - 'a' : 0;
        char text[80];
        snprintf(text, sizeof text, forms[i / 2], right[0] + capital, right[1] + capital);
        const hn_verdict *v = verdict_on(*state, text);
        if (v->n_right != 2) {
            fail_msg("%s: %s %s", text, v->summary, v->reason);
        }
    }
}

static void another_form_of_a_choice_is_refused_with_the_form_to_write(void **state) {
    static const struct {
        const char *answer, *entry, *word;
    } rows[] = {
        {"{\"answer\":\"a\"}", "a.choice", "write choice and reason as {\"choice\": \"a\""},
        {"[\"a\"]", "a.reason", "write choice and reason as {\"choice\": \"a\""},
        {"3", "a.choice", "write choice and reason as"},
        {"\"a, since it moves\"", "a.choice", "is not one letter from a to b, in quotes"},
        {"\"ab\"", "a.choice", "is not one letter from a to b, in quotes"},
        {"\"z\"", "a.choice", "'z' is not one letter from a to b, in quotes"},
        {"{\"choice\":1,\"reason\":\"a\"}", "a.choice", "is not one letter from a to b, in quotes"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[120];
        snprintf(text, sizeof text, "{\"a\":%s,\"b\":1}", rows[i].answer);
        const hn_verdict *v = verdict_on(*state, text);
        const hn_entry_verdict *e = entry_of(v, rows[i].entry);
        assert_string_equal(e->mistake, "unreadable");
        if (!strstr(e->explanation, rows[i].word)) {
            fail_msg("%s: '%s'", text, e->explanation);
        }
    }
}

static void a_choice_without_reasons_is_a_letter_or_a_member(void **state) {
    (void)state;
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    static const char one[] =
        "{\"exercise\":2,\"id\":\"t\",\"title\":\"t\",\"lesson\":\"l\",\"section\":\"s\","
        "\"statement\":[\"A rod.\"],\"parts\":[{\"id\":\"a\",\"ask\":\"which?\",\"points\":1,"
        "\"kind\":\"choice\",\"options\":[{\"text\":\"yes\",\"right\":true},"
        "{\"text\":\"no\",\"says\":\"not no\"}]}]}";
    assert_int_equal(hn_exercise_load_json(one, strlen(one), &e, &diags), HN_OK);
    int n_right = 0;
    for (int i = 0; i < 2; i++) {
        char plain[40], member[60], list[40];
        snprintf(plain, sizeof plain, "{\"a\":\"(%c)\"}", 'a' + i);
        snprintf(member, sizeof member, "{\"a\":{\"Choice\":\"%c\"}}", 'A' + i);
        snprintf(list, sizeof list, "{\"a\":[\"%c\"]}", 'a' + i);
        assert_true(verdict_on(e, plain)->n_entries == 1);
        const int right = verdict_on(e, plain)->n_right;
        assert_int_equal(verdict_on(e, member)->n_right, right);
        assert_int_equal(verdict_on(e, list)->n_right, right);
        n_right += right;
    }
    assert_int_equal(n_right, 1);
    assert_string_equal(
        verdict_on(e, "{\"a\":[\"a\",\"b\"]}")->hint,
        "the choice '[\"a\",\"b\"]' is not one letter from a to b, in quotes: \"a\"");
    hn_exercise_free(e);
}

static void a_part_that_is_answered_twice_is_not_guessed(void **state) {
    char right[2], text[160];
    find_right(*state, right);
    snprintf(text, sizeof text, "{\"a\":[\"%c\",\"%c\"],\"b\":0.5,\"b\":0.6,\"b\":0.5}", right[0],
             right[1]);
    const hn_verdict *v = verdict_on(*state, text);
    assert_int_equal(v->kind, HN_VERDICT_GRADED);
    assert_near(v->score, 2, 0); // the other parts keep their points
    assert_string_equal(entry_of(v, "b")->mistake, "unreadable");
    assert_non_null(strstr(entry_of(v, "b")->explanation, "'b' is there more than once"));

    // a member of the answer
    snprintf(text, sizeof text,
             "{\"b\":1,\"a\":{\"choice\":\"%c\",\"reason\":\"a\",\"reason\":\"b\"}}", right[0]);
    v = verdict_on(*state, text);
    assert_string_equal(entry_of(v, "a.choice")->mistake, "unreadable");
    assert_non_null(strstr(entry_of(v, "a.reason")->explanation, "'reason' is there more than"));
}

static void the_same_answer_twice_is_accepted_with_a_remark(void **state) {
    char right[2], text[160];
    find_right(*state, right);
    snprintf(
        text, sizeof text,
        "{\"a\":{\"choice\":\"%c\",\"choice\":\"%c\",\"reason\":\"%c\"},\"c\":\"l/3*sin(th1)\","
        "\"c\":\"l/3*sin(th1)\"}",
        right[0], right[0], right[1]);
    const hn_verdict *v = verdict_on(*state, text);
    assert_near(v->score, 4, 0);
    assert_non_null(strstr(v->note, "fields that repeat another one with the same value: 2"));
}

static void a_submission_that_says_two_things_of_itself_is_ungradable(void **state) {
    static const char *const fields[] = {"seed", "student", "hints", "problem"};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        char text[120], said[60];
        snprintf(text, sizeof text, "{\"%s\":1,\"b\":1,\"%s\":2}", fields[i], fields[i]);
        snprintf(said, sizeof said, "'%s' is there more than once", fields[i]);
        const hn_verdict *v = verdict_on(*state, text);
        assert_int_equal(v->kind, HN_VERDICT_UNGRADABLE);
        assert_non_null(strstr(v->reason, said));
    }
}

static void a_matrix_that_is_there_twice_is_ungradable(void **state) {
    (void)state;
    hn_exercise *p = load_p3();
    hn_verdict v;
    grade(p, "{\"J\": [], \"J\": [1]}", &v);
    assert_int_equal(v.kind, HN_VERDICT_UNGRADABLE);
    assert_non_null(strstr(v.reason, "'J' is there more than once, with different values"));
    hn_exercise_free(p);
}

static void a_flood_of_members_is_refused_before_they_are_compared(void **state) {
    static char text[20000];
    size_t used = (size_t)snprintf(text, sizeof text, "{\"b\":1");
    for (int i = 0; i < 200; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, ",\"x%d\":%d", i, i);
    }
    snprintf(text + used, sizeof text - used, "}");
    const hn_verdict *v = verdict_on(*state, text);
    assert_int_equal(v->kind, HN_VERDICT_UNGRADABLE);
    assert_string_equal(v->reason, "an object has 201 members; at most 128 are read");
}

static void every_field_that_is_not_read_is_named(void **state) {
    assert_string_equal(verdict_on(*state, "{\"b\":1,\"x\":2}")->note,
                        "the field 'x' was not read");
    assert_string_equal(verdict_on(*state, "{\"x\":2,\"b\":1,\"B\":3,\"sum\":4}")->note,
                        "the fields 'x', 'B', 'sum' were not read");
}

static void a_formula_with_a_rounded_number_gets_half_and_is_told(void **state) {
    static const struct {
        const char *formula, *mistake;
        double points;
    } rows[] = {
        {"l/3*sin(th1)", "", 2},
        {"0.33333333*l*sin(th1)", "", 2},
        {"0.333*l*sin(th1)", "rounded", 1},
        {"0.3345*l*sin(th1)", "rounded", 1},
        {"0.34*l*sin(th1)", "wrong-factor", 0.5},
        {"l*sin(th1)", "third", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[80];
        snprintf(text, sizeof text, "{\"c\":\"%s\"}", rows[i].formula);
        const hn_entry_verdict *e = entry_of(verdict_on(*state, text), "c");
        if (strcmp(e->mistake, rows[i].mistake) != 0) {
            fail_msg("%s: '%s' (%s)", text, e->mistake, e->explanation);
        }
        assert_near(e->points, rows[i].points, 0);
    }
    const hn_entry_verdict *e = entry_of(verdict_on(*state, "{\"c\":\"0.333*l*sin(th1)\"}"), "c");
    assert_non_null(strstr(e->explanation, "right to 0.1 % of its size"));
    assert_non_null(strstr(e->explanation, "more digits, or by their names"));
}

static void a_number_that_should_be_zero_is_not_accused_of_every_mistake(void **state) {
    static const struct {
        const char *answer, *mistake;
    } rows[] = {{"0", ""}, {"1e-7", ""}, {"123", "other"}, {"-4", "other"}, {"\"l\"", "one"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[60];
        hn_variant x;
        double l;
        assert_int_equal(hn_variant_init(&x, *state, SEED, NULL), HN_OK);
        assert_int_equal(hn_draw_value(&x.draw, "l", &l, NULL), HN_OK);
        hn_variant_reset(&x);
        snprintf(text, sizeof text, "{\"d\":%s}", rows[i].answer);
        if (strcmp(rows[i].answer, "\"l\"") == 0) {
            snprintf(text, sizeof text, "{\"d\":%.17g}", l);
        }
        const hn_entry_verdict *e = entry_of(verdict_on(*state, text), "d");
        if (strcmp(e->mistake, rows[i].mistake) != 0) {
            fail_msg("%s: '%s' (%s)", text, e->mistake, e->explanation);
        }
    }
}

static void a_rounded_constant_in_the_matrix_is_told(void **state) {
    (void)state;
    hn_exercise *p = load_p3();
    hn_verdict v;
    grade_with(p, 0, "-l1*sin(th1 + 2*3.1416)", &v);
    assert_string_equal(v.entry[0].mistake, "rounded");
    assert_near(v.entry[0].points, 0.5, 0);
    grade_with(p, 0, "-l1*sin(th1 + 2*3.2)", &v);
    assert_string_equal(v.entry[0].mistake, "other");
    hn_exercise_free(p);
}

static int free_asked(void **state) {
    hn_exercise_free(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_choice_with_its_reason_is_read_in_any_clear_form),
        cmocka_unit_test(another_form_of_a_choice_is_refused_with_the_form_to_write),
        cmocka_unit_test(a_choice_without_reasons_is_a_letter_or_a_member),
        cmocka_unit_test(a_part_that_is_answered_twice_is_not_guessed),
        cmocka_unit_test(the_same_answer_twice_is_accepted_with_a_remark),
        cmocka_unit_test(a_submission_that_says_two_things_of_itself_is_ungradable),
        cmocka_unit_test(a_matrix_that_is_there_twice_is_ungradable),
        cmocka_unit_test(a_flood_of_members_is_refused_before_they_are_compared),
        cmocka_unit_test(every_field_that_is_not_read_is_named),
        cmocka_unit_test(a_formula_with_a_rounded_number_gets_half_and_is_told),
        cmocka_unit_test(a_number_that_should_be_zero_is_not_accused_of_every_mistake),
        cmocka_unit_test(a_rounded_constant_in_the_matrix_is_told),
    };
    return cmocka_run_group_tests(tests, load_asked, free_asked);
}
