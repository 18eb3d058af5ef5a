// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices that were pasted as one text from a program.
#include "grade/parts/list_text.h"

#include "support/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void lists_of_every_program_are_read(void **state) {
    (void)state;
    static const struct {
        const char *text, *list;
    } rows[] = {
        {"[[a, b], [c, d]]", "[[\"a\",\"b\"],[\"c\",\"d\"]]"},
        {"np.array([[1, 2], [3, 4]])", "[[1,2],[3,4]]"},
        {"np.array([[1, 2], [3, 4]], dtype=float)", "[[1,2],[3,4]]"},
        {"J = sympy.Matrix([[-l1*sin(th1), 2]])", "[[\"-l1*sin(th1)\",2]]"},
        {"{{Sin[x], b}, {c, Cos[x]}}", "[[\"Sin[x]\",\"b\"],[\"c\",\"Cos[x]\"]]"},
        {"[a, b; c, d]", "[[\"a\",\"b\"],[\"c\",\"d\"]]"},
        {"J = [a b; c d];", "[[\"a\",\"b\"],[\"c\",\"d\"]]"},
        {"[a -b; c - d 2]", "[[\"a\",\"-b\"],[\"c - d\",2]]"},
        {"[f(a, b) g * h; 1e-3 -.5]", "[[\"f(a, b)\",\"g * h\"],[0.001,-0.5]]"},
        {"[-l1*sin(th1) l2 * cos(th2); 0 1]", "[[\"-l1*sin(th1)\",\"l2 * cos(th2)\"],[0,1]]"},
        {"[[1. 2.]\n [3. 4.]]", "[[1,2],[3,4]]"},
        {"[1 2\n 3 4]", "[[1,2],[3,4]]"},
        {"[a .* b .5; c' d]", "[[\"a .* b\",0.5],[\"c'\",\"d\"]]"},
        {"\\begin{pmatrix} a & -\\sin x \\\\ c & 2 \\end{pmatrix}",
         "[[\"a\",\"-\\\\sin x\"],[\"c\",2]]"},
        {"J = \\begin{bmatrix} a \\ b \\end{bmatrix}", "[[\"a\"],[\"b\"]]"},
        {"[a; b]", "[[\"a\"],[\"b\"]]"},
        {" [1.5, 2,] ", "[1.5,2]"},
        {"[a, , b]", "[\"a\",\"\",\"b\"]"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        cJSON *list = hn_list_text_read(rows[i].text);
        char *text = cJSON_PrintUnformatted(list);
        if (!text || strcmp(text, rows[i].list) != 0) {
            fail_msg("%s is read as %s", rows[i].text, text ? text : "no list");
        }
        cJSON_free(text);
        cJSON_Delete(list);
    }
}

static void formulas_and_broken_brackets_are_no_lists(void **state) {
    (void)state;
    static const char *const rows[] = {"",
                                       "[",
                                       "[]",
                                       "[a + b]",
                                       "[a+b]*c",
                                       "[a, b",
                                       "a, b]",
                                       "(a, b)",
                                       "[1, 2] + 1",
                                       "N' M N",
                                       "\\begin{pmatrix} a",
                                       "\\begin{cases} a & b \\end{cases}",
                                       "\\begin{pmatrix} a \\end{pmatrix} b",
                                       "\\begin{}\\end{}",
                                       "\\begin{pmatrix} a \\end{bmatrix}",
                                       "\\begin{",
                                       "1.2 kg",
                                       "[[a, b]",
                                       "=",
                                       "[a](b)",
                                       "]["};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        cJSON *list = hn_list_text_read(rows[i]);
        if (list) {
            fail_msg("%s is taken for a list", rows[i]);
        }
    }

    // nesting and length are bounded
    char deep[20001];
    memset(deep, '[', 10000);
    memset(deep + 10000, ']', 10000);
    deep[20000] = '\0';
    cJSON_Delete(hn_list_text_read(deep));
    memset(deep, ',', 20000);
    deep[0] = '[';
    deep[19999] = ']';
    assert_null(hn_list_text_read(deep));
}

static void only_answers_are_expanded(void **state) {
    (void)state;
    char name[16];
    int n_empty;
    cJSON *root = cJSON_Parse("{\"student\":\"[a, b]\",\"comment\":\"[1, 2]\",\"a\":\"[1, 2]\","
                              "\"b\":{\"M\":\"[1 0; 0 1]\",\"x\":\"2\"},\"c\":\"x + 1\"}");
    assert_int_equal(hn_list_text_expand(root, name, sizeof name, &n_empty), 2);
    assert_int_equal(n_empty, 0);
    assert_string_equal(name, "a");
    char *text = cJSON_PrintUnformatted(root);
    assert_string_equal(text, "{\"student\":\"[a, b]\",\"comment\":\"[1, 2]\",\"a\":[1,2],"
                              "\"b\":{\"M\":[[1,0],[0,1]],\"x\":\"2\"},\"c\":\"x + 1\"}");
    cJSON_free(text);
    cJSON_Delete(root);
}

static void empty_entries_are_counted(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int n_empty;
    } rows[] = {{"[[1, , 2], [3, 4, 5]]", 1},
                {"[, a; b, c]", 1},
                {"[[1, 2], , [3, 4]]", 1},
                {"[a, , , b]", 2},
                {"[1, 2, ]", 0},
                {"\\begin{pmatrix} a & & b \\end{pmatrix}", 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char name[16];
        int n_empty;
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "J", rows[i].text);
        assert_int_equal(hn_list_text_expand(root, name, sizeof name, &n_empty), 1);
        if (n_empty != rows[i].n_empty) {
            fail_msg("%s has %d empty entries", rows[i].text, n_empty);
        }
        cJSON_Delete(root);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_of_every_program_are_read),
        cmocka_unit_test(formulas_and_broken_brackets_are_no_lists),
        cmocka_unit_test(only_answers_are_expanded),
        cmocka_unit_test(empty_entries_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
