// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/diag.h"
#include "base/strbuf.h"
#include "support/alloc.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void text_grows_piece_by_piece(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_string_equal(hn_strbuf_text(&b), "");
    for (int i = 0; i < 1000; i++) {
        hn_strbuf_printf(&b, "%d,", i % 10);
    }
    assert_int_equal(b.n, 2000);
    assert_int_equal(strlen(b.text), 2000);
    assert_memory_equal(b.text + 1990, "5,6,7,8,9,", 10);
    hn_strbuf_clear(&b);
    assert_string_equal(hn_strbuf_text(&b), "");
    hn_strbuf_add(&b, "again");
    char *owned = hn_strbuf_take(&b);
    assert_string_equal(owned, "again");
    assert_string_equal(hn_strbuf_text(&b), "");
    free(owned);
    owned = hn_strbuf_take(&b);
    assert_string_equal(owned, "");
    free(owned);
}

static void bytes_with_a_zero_inside_are_kept(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add_n(&b, "a\0b", 3);
    assert_int_equal(b.n, 3);
    assert_memory_equal(b.text, "a\0b", 4);
    hn_strbuf_reset(&b);
}

static void once_memory_ran_out_the_buffer_stays_failed(void **state) {
    (void)state;
    const long live = hn_alloc_live();
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, "kept");
    hn_alloc_fail_at(1);
    hn_strbuf_printf(&b, "%0500d", 1);
    assert_true(hn_alloc_has_failed());
    hn_alloc_fail_at(0);
    assert_int_equal(b.failed, 1);
    hn_strbuf_add(&b, "ignored");
    assert_string_equal(hn_strbuf_text(&b), "kept");
    assert_null(hn_strbuf_take(&b));
    assert_int_equal(hn_alloc_live(), live);

    // emptied, it can be used again
    hn_strbuf_add(&b, "fresh");
    assert_string_equal(hn_strbuf_text(&b), "fresh");
    hn_strbuf_reset(&b);
    assert_int_equal(hn_alloc_live(), live);
}

static void commas_and_nesting_are_kept_by_the_writer(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "n", 2);
    hn_json_key(&b, "rows");
    hn_json_array(&b);
    hn_json_array(&b);
    hn_json_end_array(&b);
    hn_json_numbers(&b, (const double[]){1, 0.5}, 2);
    hn_json_object(&b);
    hn_json_end_object(&b);
    hn_json_end_array(&b);
    hn_json_put_bool(&b, "ok", 1);
    hn_json_put_string(&b, "name", NULL);
    hn_json_key(&b, "tags");
    hn_json_strings(&b, (const char *const[]){"a", "b"}, 2);
    hn_json_key(&b, "raw");
    hn_json_raw(&b, "{\"x\":1}");
    hn_json_end_object(&b);
    assert_string_equal(hn_strbuf_text(&b),
                        "{\"n\":2,\"rows\":[[],[1,0.5],{}],\"ok\":true,\"name\":null,"
                        "\"tags\":[\"a\",\"b\"],\"raw\":{\"x\":1}}");
    hn_strbuf_reset(&b);
}

static void texts_are_escaped_and_bad_utf8_is_replaced(void **state) {
    (void)state;
    const struct {
        const char *text, *json;
    } cases[] = {
        {"plain", "\"plain\""},
        {"q\"\\/", "\"q\\\"\\\\/\""},
        {"\b\f\n\r\t\x01\x1f", "\"\\b\\f\\n\\r\\t\\u0001\\u001f\""},
        {"\xc2\xb5m \xe2\x82\xac \xf0\x9f\x98\x80", "\"\xc2\xb5m \xe2\x82\xac \xf0\x9f\x98\x80\""},
        {"\xff", "\"\xef\xbf\xbd\""},
        {"a\xc3", "\"a\xef\xbf\xbd\""},               // cut short
        {"\xc0\xaf", "\"\xef\xbf\xbd\xef\xbf\xbd\""}, // overlong '/'
        {"\xe0\x80\xaf", "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\""},
        {"\xed\xa0\x80", "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\""}, // a surrogate
        {"\xf4\x90\x80\x80", "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_json_string(&b, cases[i].text);
        assert_string_equal(hn_strbuf_text(&b), cases[i].json);
        hn_strbuf_reset(&b);
    }
}

static void numbers_read_back_to_the_same_bits(void **state) {
    (void)state;
    const double values[] = {0,
                             -0.0,
                             1,
                             0.1,
                             1.0 / 3,
                             5e-324,
                             1.7976931348623157e308,
                             1e15,
                             123456,
                             -2.5e-17,
                             0x1p-52,
                             9007199254740993.0,
                             3.14159265358979312};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_json_number(&b, values[i]);
        const double back = strtod(hn_strbuf_text(&b), NULL);
        assert_memory_equal(&back, &values[i], sizeof back);
        hn_strbuf_reset(&b);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_numbers(&b, (const double[]){0.1, 1e22, 42}, 3);
    assert_string_equal(hn_strbuf_text(&b), "[0.1,1e+22,42]");
    hn_strbuf_reset(&b);
}

static void numbers_that_are_not_finite_become_null(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_numbers(&b, (const double[]){(double)NAN, (double)INFINITY, -(double)INFINITY, 1}, 4);
    assert_string_equal(hn_strbuf_text(&b), "[null,null,null,1]");
    hn_strbuf_reset(&b);
}

// the Makefile makes a locale with a comma beside the programs
static void the_decimal_point_does_not_follow_the_locale(void **state) {
    (void)state;
    setenv("LOCPATH", "build/locale", 1);
    assert_non_null(setlocale(LC_NUMERIC, "de_DE.UTF-8"));
    char comma[8];
    snprintf(comma, sizeof comma, "%g", 0.5);
    assert_string_equal(comma, "0,5");
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_number(&b, 0.5);
    setlocale(LC_NUMERIC, "C");
    assert_string_equal(hn_strbuf_text(&b), "0.5");
    hn_strbuf_reset(&b);
}

static void a_fault_is_told_with_pointer_detail_and_hint(void **state) {
    (void)state;
    hn_diags d = {0};
    (void)hn_diags_add(&d, HN_ERR_INPUT, "/kinetic", NULL, "unknown name '%s'", "th9");
    d.item[0].column = 4;
    (void)hn_diags_add(&d, HN_ERR_LIMIT, "/x", "fewer", "too many");
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_diags(&b, &d);
    assert_string_equal(
        hn_strbuf_text(&b),
        "[{\"status\":\"input\",\"pointer\":\"/kinetic\",\"detail\":\"unknown name "
        "'th9'\",\"hint\":\"\",\"column\":4},{\"status\":\"limit\",\"pointer\":\"/x\","
        "\"detail\":\"too many\",\"hint\":\"fewer\"}]");
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_grows_piece_by_piece),
        cmocka_unit_test(bytes_with_a_zero_inside_are_kept),
        cmocka_unit_test(once_memory_ran_out_the_buffer_stays_failed),
        cmocka_unit_test(commas_and_nesting_are_kept_by_the_writer),
        cmocka_unit_test(texts_are_escaped_and_bad_utf8_is_replaced),
        cmocka_unit_test(numbers_read_back_to_the_same_bits),
        cmocka_unit_test(numbers_that_are_not_finite_become_null),
        cmocka_unit_test(the_decimal_point_does_not_follow_the_locale),
        cmocka_unit_test(a_fault_is_told_with_pointer_detail_and_hint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
