// SPDX-License-Identifier: GPL-3.0-or-later
// Lessons: Markdown and its special blocks as a tree, formulas as text, the whole for a terminal.
#include "lesson/lesson.h"
#include "lesson/lesson_text.h"
#include "lesson/tex_ascii.h"
#include "lesson/tex_text.h"

#include "support/alloc.h"
#include "support/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect_tex(const char *tex, const char *wanted) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_tex_text(&b, tex);
    assert_string_equal(hn_strbuf_text(&b), wanted);
    hn_strbuf_reset(&b);
}

static void formulas_become_text(void **state) {
    (void)state;
    expect_tex("M\\ddot q + h = Q + J^{\\top}\\lambda", "Mq\u0308 + h = Q + Jᵀλ");
    expect_tex("\\tfrac12 m\\ell_1^2", "½ mℓ₁²");
    expect_tex("\\frac{a+b}{2c}", "(a+b)/2c");
    expect_tex("\\tfrac13\\ell^2 + \\tfrac1{12}m\\ell^2", "⅓ℓ² + 1/12 mℓ²");
    expect_tex("\\Bigl(\\frac{a}{b}\\Bigr)^2 p \\otimes q", "(a/b)² p ⊗ q");
    expect_tex("\\begin{bmatrix} M & -J^{\\top} \\\\ J & 0 \\end{bmatrix}", "[ M, -Jᵀ; J, 0 ]");
    expect_tex("\\ell_1\\sin\\theta_1", "ℓ₁ sin θ₁");
    expect_tex("-\\sin x", "-sin x");
    expect_tex("2\\cdot 3\\times4", "2 · 3 × 4");
    expect_tex("x^{-12}", "x⁻¹²");
}

static void expect_ascii(const char *tex, const char *wanted) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_tex_ascii(&b, tex);
    assert_string_equal(hn_strbuf_text(&b), wanted);
    hn_strbuf_reset(&b);
}

static void formulas_are_spelled_out_in_ascii(void **state) {
    (void)state;
    expect_ascii("\\tfrac12 m\\ell_1^2\\dot\\theta_1^2", "1/2 m l_1^2 thetadot_1^2");
    expect_ascii("M\\ddot q + h = Q + J^{\\top}\\lambda", "M qddot + h = Q + J' lambda");
    expect_ascii("\\ell_1\\sin\\theta_1\\ell_{12}", "l_1 sin theta_1 l_12");
    expect_ascii("N^{\\top}M x^{-12}y", "N' M x^-12 y");
    expect_ascii("2\\cdot 3 \\ne 7", "2 * 3 != 7");
}

static void formulas_that_are_torn_end(void **state) {
    (void)state;
    static const char *const torn[] = {
        "\\end{x} a",     "\\frac{", "{{{{", "}}}", "\\", "^", "_{", "\\begin{bmatrix} a & ",
        "\\sqrt\\sqrt\\", "x^"};
    for (size_t i = 0; i < sizeof torn / sizeof *torn; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_tex_text(&b, torn[i]);
        assert_true(b.n < 200);
        hn_strbuf_reset(&b);
    }
}

/// The blocks of a text; the test fails when it cannot be read.
static cJSON *parse(const char *text) {
    cJSON *blocks = NULL;
    hn_diags diags = {0};
    if (hn_lesson_parse(text, strlen(text), &blocks, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    return blocks;
}

static const char *text_of(const cJSON *node, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(node, key));
    return text ? text : "";
}

static void an_exhibit_says_its_command(void **state) {
    (void)state;
    cJSON *blocks = parse("```exhibit\nscene: four-bar\nmethods: a@rk4:h=1 b@rk4:h=1\n"
                          "set: l1=0.5\ntime: 20\n\nLook.\n```\n");
    const cJSON *node = cJSON_GetArrayItem(blocks, 0);
    assert_string_equal(text_of(node, "kind"), "exhibit");
    assert_string_equal(text_of(node, "command"),
                        "compare four-bar --set l1=0.5 --methods a@rk4:h=1 b@rk4:h=1 --time 20");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(node, "methods")), 2);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(node, "children")), 1);
    cJSON_Delete(blocks);
}

static void a_prediction_has_its_right_choice(void **state) {
    (void)state;
    cJSON *blocks = parse("```predict\nHow far?\n- $1$ m\n+ two\n\nSeen.\n\nAnd why.\n```\n");
    const cJSON *node = cJSON_GetArrayItem(blocks, 0);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(node, "choices")), 2);
    assert_near(cJSON_GetNumberValue(cJSON_GetObjectItem(node, "right")), 1, 0);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(node, "after")), 2);

    // the answer stands behind the lesson, not beside the question
    cJSON *lesson = cJSON_CreateObject();
    cJSON_AddItemToObject(lesson, "blocks", blocks);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_text(&b, lesson, 80);
    const char *question = strstr(hn_strbuf_text(&b), "(b) two");
    assert_non_null(question);
    assert_non_null(strstr(question, "1. (b) Seen.\n\n    And why.\n"));
    hn_strbuf_reset(&b);
    cJSON_Delete(lesson);
}

static void emphasis_leaves_no_asterisks(void **state) {
    (void)state;
    cJSON *lesson = cJSON_CreateObject();
    cJSON_AddItemToObject(lesson, "blocks", parse("**Why.** The loop *is* **open**.\n"));
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_text(&b, lesson, 80);
    assert_non_null(strstr(hn_strbuf_text(&b), "Why. The loop is open.\n"));
    hn_strbuf_reset(&b);
    cJSON_Delete(lesson);
}

static void pictures_of_one_paragraph_have_lines_of_their_own(void **state) {
    (void)state;
    cJSON *lesson = cJSON_CreateObject();
    cJSON_AddItemToObject(lesson, "blocks", parse("Two.\n\n![One](a.png)\n![Two](b.png)\n"));
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_text(&b, lesson, 80);
    assert_non_null(strstr(hn_strbuf_text(&b), "\n[picture] One\n[picture] Two\n"));
    hn_strbuf_reset(&b);
    cJSON_Delete(lesson);
}

static void faults_of_a_text_are_named(void **state) {
    (void)state;
    static const char *const texts[][2] = {
        {"```exhibit\nscne: four-bar\n```\n", "the line 'scne' of an exhibit cannot be read"},
        {"```predict\nHow?\n- a\n- b\n```\n", "one of them with '+'"},
    };
    for (int i = 0; i < 2; i++) {
        cJSON *blocks = NULL;
        hn_diags diags = {0};
        assert_int_equal(hn_lesson_parse(texts[i][0], strlen(texts[i][0]), &blocks, &diags),
                         HN_ERR_INPUT);
        assert_null(blocks);
        assert_non_null(strstr(diags.item[0].message, texts[i][1]));
    }
}

static void lines_keep_to_the_width(void **state) {
    (void)state;
    cJSON *lesson = cJSON_CreateObject();
    cJSON_AddItemToObject(
        lesson, "blocks",
        parse("# T\n\nOne two three four five six seven eight nine ten eleven twelve.\n\n"
              "* an item of a list that is longer than a line of this width\n"));
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_text(&b, lesson, 30);
    for (const char *p = hn_strbuf_text(&b); *p;) {
        const size_t n = strcspn(p, "\n");
        assert_true(n <= 30);
        p += n + (p[n] == '\n');
    }
    assert_non_null(strstr(hn_strbuf_text(&b), "\n* an item"));
    assert_non_null(strstr(hn_strbuf_text(&b), "\n  longer"));
    hn_strbuf_reset(&b);
    cJSON_Delete(lesson);
}

/// A table's cells are folded, each within its column; a command goes on behind a backslash.
static void tables_and_commands_keep_to_the_width(void **state) {
    (void)state;
    cJSON *lesson = cJSON_CreateObject();
    cJSON_AddItemToObject(
        lesson, "blocks",
        parse("| step | what is seen in a long cell | another long cell |\n| --- | --- | ---: |\n"
              "| 0.01 | one two three four five six | seven eight |\n\n"
              "```exhibit\nscene: four-bar\nmethods: a@rk4:h=1 b@rk4:h=1\ntime: 20\n\nLook.\n"
              "```\n"));
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_text(&b, lesson, 40);
    for (const char *p = hn_strbuf_text(&b); *p;) {
        const size_t n = strcspn(p, "\n");
        assert_true(n <= 40);
        p += n + (p[n] == '\n');
    }

    // the second line of a row stands below its own cells
    assert_non_null(strstr(hn_strbuf_text(&b), "\n0.01  one two three"));
    assert_non_null(strstr(hn_strbuf_text(&b), "\n      four five six"));
    assert_non_null(strstr(hn_strbuf_text(&b), " --methods \\\n        a@rk4:h=1 b@rk4:h=1"));
    hn_strbuf_reset(&b);
    cJSON_Delete(lesson);
}

static void deep_nesting_is_refused(void **state) {
    (void)state;
    char text[400];
    memset(text, '>', 200);
    snprintf(text + 200, 100, " a\n");
    cJSON *blocks = NULL;
    assert_int_equal(hn_lesson_parse(text, strlen(text), &blocks, NULL), HN_ERR_LIMIT);
}

static void every_shipped_lesson_can_be_read(void **state) {
    (void)state;
    hn_library *lib = NULL;
    assert_int_equal(hn_library_open(".", &lib, NULL), HN_OK);
    cJSON *lesson = NULL;
    hn_diags diags = {0};
    assert_int_equal(hn_lesson_load(lib, "1", &lesson, &diags), HN_OK);
    assert_near(cJSON_GetNumberValue(cJSON_GetObjectItem(lesson, "number")), 1, 0);
    cJSON_Delete(lesson);

    assert_int_equal(hn_lesson_load(lib, "01-closed-lops", &lesson, &diags), HN_ERR_INPUT);
    assert_non_null(strstr(diags.item[0].hint, "01-closed-loops"));
    hn_library_free(lib);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formulas_become_text),
        cmocka_unit_test(formulas_are_spelled_out_in_ascii),
        cmocka_unit_test(formulas_that_are_torn_end),
        cmocka_unit_test(an_exhibit_says_its_command),
        cmocka_unit_test(a_prediction_has_its_right_choice),
        cmocka_unit_test(emphasis_leaves_no_asterisks),
        cmocka_unit_test(pictures_of_one_paragraph_have_lines_of_their_own),
        cmocka_unit_test(faults_of_a_text_are_named),
        cmocka_unit_test(lines_keep_to_the_width),
        cmocka_unit_test(tables_and_commands_keep_to_the_width),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(every_shipped_lesson_can_be_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
