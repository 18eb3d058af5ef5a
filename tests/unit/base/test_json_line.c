// SPDX-License-Identifier: GPL-3.0-or-later
// The line of a member of a JSON file.
#include "support/near.h"

#include "base/json_line.h"

static void a_pointer_has_the_line_of_its_value(void **state) {
    (void)state;
    static const char text[] =
        "{\n  \"a\": 1, \"b\":\n    [\n      {\"x\": \"}\\\"]\"},\n"
        "      {\"y\": [2, 3],\n       \"z\": {}}\n    ],\n  \"c\": null\n}\n";
    static const struct {
        const char *pointer;
        int line;
    } rows[] = {
        {"", 1},     {"/a", 2},       {"/b", 3},   {"/b/0", 4},     {"/b/0/x", 4},
        {"/b/1", 5}, {"/b/1/y/1", 5}, {"/c", 8},   {"/b/1/z", 6},   {"/b/1/nosuch", 5},
        {"/b/2", 3}, {"/nosuch", 1},  {"/a/b", 2}, {"/b/1/z/q", 6}, {"no pointer", 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(hn_json_line(text, rows[i].pointer), rows[i].line);
    }
    assert_int_equal(hn_json_line("", "/a"), 1);
    assert_int_equal(hn_json_line("[", "/0"), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pointer_has_the_line_of_its_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
