// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/table.h"

#include "cli/shell/fold.h"

#include "support/near.h"

#include <math.h>
#include <string.h>

static void words_stand_left_numbers_right_and_widths_count_characters(void **state) {
    hn_table t;
    hn_strbuf b;
    (void)state;
    hn_table_init(&t);
    hn_strbuf_init(&b);
    hn_table_column(&t, "name", 0);
    hn_table_column(&t, "value", 1);
    hn_table_column(&t, "end", 0);
    hn_table_cell(&t, "a");
    hn_table_quantity(&t, 1.3e-6, "s");
    hn_table_cell(&t, "x");
    hn_table_cell(&t, "longer");
    hn_table_quantity(&t, (double)NAN, "s");
    hn_table_cell(&t, "y");
    hn_table_write(&b, &t);
    assert_string_equal(hn_strbuf_text(&b), "name    value [µs]  end\n"
                                            "a             1.30  x\n"
                                            "longer        -     y\n");
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

/// Two methods with sizes near each other and far apart.
static void fill(hn_table *t) {
    hn_table_init(t);
    t->width = 0;
    t->colours = false;
    hn_table_column(t, "method", 0);
    hn_table_column(t, "status", 0);
    hn_table_column(t, "gap", 1);
    hn_table_column(t, "cost", 1);
    hn_table_column(t, "evals", 1);
    hn_table_spare(t, 1);
    hn_table_cell(t, "index1@rk4");
    hn_table_cell(t, "stopped where the loop had opened");
    hn_table_bad(t);
    hn_table_quantity(t, 2.74e-6, "m");
    hn_table_quantity(t, 741e-9, "s");
    hn_table_quantity(t, 400, "op");
    hn_table_cell(t, "reduced@rk4");
    hn_table_cell(t, "ok");
    hn_table_quantity(t, 7.97e-16, "m");
    hn_table_quantity(t, 12.4e-6, "s");
    hn_table_quantity(t, 123456, "op");
}

static void a_column_has_one_unit_and_its_points_stand_below_each_other(void **state) {
    hn_table t;
    hn_strbuf b;
    (void)state;
    hn_strbuf_init(&b);
    fill(&t);
    hn_table_write(&b, &t);
    assert_string_equal(
        hn_strbuf_text(&b),
        "method       status                              gap [m]  cost [µs]   evals\n"
        "index1@rk4   stopped where the loop had opened  2.74e-06      0.741     400\n"
        "reduced@rk4  ok                                 7.97e-16     12.4    123456\n");
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

static void a_narrow_terminal_folds_words_then_loses_columns_and_names_them(void **state) {
    hn_table t;
    hn_strbuf b;
    (void)state;
    hn_strbuf_init(&b);
    fill(&t);
    t.width = 56;
    hn_table_write(&b, &t);
    assert_string_equal(hn_strbuf_text(&b),
                        "method       status           gap [m]  cost [µs]   evals\n"
                        "index1@rk4   stopped where   2.74e-06      0.741     400\n"
                        "             the loop had\n"
                        "             opened\n"
                        "reduced@rk4  ok              7.97e-16     12.4    123456\n");
    hn_strbuf_clear(&b);
    t.width = 50;
    hn_table_write(&b, &t);
    assert_non_null(
        strstr(hn_strbuf_text(&b), "not shown in 50 columns: evals (--wide shows it)\n"));
    assert_null(strstr(hn_strbuf_text(&b), "123456"));
    assert_non_null(strstr(hn_strbuf_text(&b), "12.4"));
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

static void colours_mark_the_head_and_bad_news_and_take_no_room(void **state) {
    hn_table t;
    hn_strbuf b;
    (void)state;
    hn_strbuf_init(&b);
    fill(&t);
    t.colours = true;
    hn_table_write(&b, &t);
    assert_non_null(strstr(hn_strbuf_text(&b), "\033[31mstopped where the loop had opened\033[0m"));
    assert_int_equal(hn_fold_width(hn_strbuf_text(&b), strcspn(hn_strbuf_text(&b), "\n")), 75);
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

static void a_cell_of_two_lines_takes_two_lines(void **state) {
    hn_table t;
    hn_strbuf b;
    (void)state;
    hn_table_init(&t);
    hn_strbuf_init(&b);
    t.width = 40;
    hn_table_column(&t, "name", 0);
    hn_table_column(&t, "end", 0);
    hn_table_cell(&t, "two\nlines");
    hn_table_cell(&t, "\nends");
    hn_table_write(&b, &t);
    assert_non_null(strstr(hn_strbuf_text(&b), "two"));
    assert_non_null(strstr(hn_strbuf_text(&b), "\nlines"));
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

static void lines_are_folded_at_blanks_with_their_indent(void **state) {
    hn_strbuf b;
    (void)state;
    hn_strbuf_init(&b);
    hn_fold_add(&b, "  one two three\nfour\n\nunbreakableword x\n", 9);
    assert_string_equal(hn_strbuf_text(&b), "  one two\n    three\nfour\n\nunbreakableword\n  x\n");
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_stand_left_numbers_right_and_widths_count_characters),
        cmocka_unit_test(a_column_has_one_unit_and_its_points_stand_below_each_other),
        cmocka_unit_test(a_narrow_terminal_folds_words_then_loses_columns_and_names_them),
        cmocka_unit_test(colours_mark_the_head_and_bad_news_and_take_no_room),
        cmocka_unit_test(a_cell_of_two_lines_takes_two_lines),
        cmocka_unit_test(lines_are_folded_at_blanks_with_their_indent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
