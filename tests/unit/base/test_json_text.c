// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

static hn_status check(const char *text, hn_diag *diag) {
    memset(diag, 0, sizeof *diag);
    return hn_json_text_check(text, strlen(text), 8, diag);
}

static void sound_texts_pass(void **state) {
    static const char *const sound[] = {
        "0",
        "-0.5e-3",
        "\"\"",
        "null",
        " [ ] ",
        "{}",
        "[1,2.5,-3e+2]",
        "true",
        "[[[[[[[[]]]]]]]]",
        "{\"a\":{\"b\":[null,false]}}",
        "\"\\u00e9\"",
        "\"\\ud83d\\ude00\"",
        "\"\xc3\xa9 \xf0\x9f\x98\x80\"",
        "1e308",
        "5e-324",
        "\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"",
    };
    (void)state;
    for (size_t i = 0; i < sizeof sound / sizeof sound[0]; i++) {
        hn_diag diag;
        if (check(sound[i], &diag) != HN_OK) {
            fail_msg("%s: %s", sound[i], diag.message);
        }
    }
}

static void unsound_texts_are_told_with_line_and_column(void **state) {
    static const struct {
        const char *text, *word;
    } bad[] = {
        {"", "empty"},
        {" \n ", "white space"},
        {"[1,]", "line 1, column 4"},
        {"{\"a\":1,}", "line 1, column 8"},
        {"[1 2]", "expected ',' or ']', found '2'"},
        {"{\"a\" 1}", "':' after the name"},
        {"{a:1}", "name in double quotes"},
        {"[1,,2]", "line 1, column 4"},
        {"01", "found '1'"},
        {"1.", "after the decimal point"},
        {".5", "a value"},
        {"+1", "a value"},
        {"-", "a digit"},
        {"1e", "in the exponent"},
        {"1e400", "1e400 is larger"},
        {"-1e999", "-1e999 is larger"},
        {"NaN", "a value"},
        {"nul", "a value"},
        {"True", "a value"},
        {"'a'", "a value"},
        {"\"a", "no closing"},
        {"\"a\nb\"", "control character 0x0A"},
        {"\"\\x\"", "after the backslash"},
        {"\"\\u12g4\"", "hexadecimal"},
        {"\"\\u0000\"", "zero character"},
        {"\"\\ud800\"", "stands alone"},
        {"\"\\ud800\\u0041\"", "stands alone"},
        {"\"\\udc00\"", "stands alone"},
        {"\"\xff\"", "UTF-8"},
        {"\"\xc0\x80\"", "UTF-8"},
        {"\"\xed\xa0\x80\"", "UTF-8"},
        {"\"\xf4\x90\x80\x80\"", "UTF-8"},
        {"\"\xe2\x82\"", "UTF-8"},
        {"{} x", "nothing after the value"},
        {"[[[[[[[[[]]]]]]]]]", "deeper than the 8 levels"},
        {"{\n  \"\xc3\xa9\xc3\xa9\": ?\n}", "line 2, column 9"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        hn_diag diag;
        hn_status status = check(bad[i].text, &diag);
        if (status == HN_OK || !strstr(diag.message, bad[i].word)) {
            fail_msg("%s: expected '%s', got '%s'", bad[i].text, bad[i].word, diag.message);
        }
        assert_int_equal(diag.status, status);
    }
}

static void a_zero_byte_is_no_white_space(void **state) {
    static const char text[] = "{\0}";
    hn_diag diag = {0};
    (void)state;
    assert_int_equal(hn_json_text_check(text, 3, 8, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.message, "0x00"));
}

static void bytes_behind_the_length_are_not_read(void **state) {
    hn_diag diag = {0};
    (void)state;
    assert_int_equal(hn_json_text_check("[1]x", 3, 8, &diag), HN_OK);
    assert_int_equal(hn_json_text_check("truex", 4, 8, &diag), HN_OK);
    assert_int_equal(hn_json_text_check("true", 3, 8, NULL), HN_ERR_INPUT);
}

static void the_byte_of_the_fault_is_told(void **state) {
    static const struct {
        const char *text;
        size_t offset;
    } rows[] = {{"", 0},     {"  ", 2},           {"{\"a\" 1}", 5}, {"[1,]", 3},
                {"{} x", 3}, {"{\"a\": nul}", 6}, {"\xc3\xa9", 0},  {"[\"\xc3\xa9\",", 6}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        size_t offset = 999;
        assert_int_equal(hn_json_text_locate(rows[i].text, strlen(rows[i].text), 8, &offset, NULL),
                         HN_ERR_INPUT);
        assert_int_equal(offset, rows[i].offset);
    }
    size_t untouched = 999;
    assert_int_equal(hn_json_text_locate("[1]", 3, 8, &untouched, NULL), HN_OK);
    assert_int_equal(untouched, 999);
}

static void depth_is_a_limit_of_its_own(void **state) {
    hn_diag diag;
    (void)state;
    assert_int_equal(check("[[[[[[[[[]]]]]]]]]", &diag), HN_ERR_LIMIT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sound_texts_pass),
        cmocka_unit_test(unsound_texts_are_told_with_line_and_column),
        cmocka_unit_test(a_zero_byte_is_no_white_space),
        cmocka_unit_test(bytes_behind_the_length_are_not_read),
        cmocka_unit_test(the_byte_of_the_fault_is_told),
        cmocka_unit_test(depth_is_a_limit_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
