// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/table.h"

#include "support/near.h"

#include <math.h>

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
    assert_string_equal(hn_strbuf_text(&b), "name      value  end\n"
                                            "a       1.30 µs  x\n"
                                            "longer        -  y\n");
    hn_strbuf_reset(&b);
    hn_table_reset(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_stand_left_numbers_right_and_widths_count_characters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
