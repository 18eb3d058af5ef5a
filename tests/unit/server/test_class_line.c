// SPDX-License-Identifier: GPL-3.0-or-later
// The mistakes of a submission in its line of the class.
#include "class/class_line.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

static hn_entry_verdict transposed(const char *name, int n_whole) {
    hn_entry_verdict e = {.mistake = "transposed", .n_whole = n_whole};
    snprintf(e.name, sizeof e.name, "%s", name);
    return e;
}

static void expect_mistakes(hn_verdict *v, const char *expected) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_class_line_put_mistakes(&b, v);
    hn_json_end_object(&b);
    assert_string_equal(hn_strbuf_text(&b), expected);
    hn_strbuf_reset(&b);
}

static void a_transposed_matrix_is_one_mistake_under_its_whole_name(void **state) {
    (void)state;
    static hn_verdict v;
    v.n_entries = 2;
    v.entry[0] = transposed("J11", 1);
    v.entry[1] = transposed("J12", 1);
    expect_mistakes(&v, "{\"mistakes\":[\"transposed in J\"]}");

    // parts with digits in their names
    v.entry[0] = transposed("a2.11", 2);
    v.entry[1] = transposed("a3.11", 2);
    expect_mistakes(&v, "{\"mistakes\":[\"transposed in a2\",\"transposed in a3\"]}");

    // a name that begins with the name of another part
    v.n_entries = 3;
    v.entry[0] = transposed("ab.1", 2);
    v.entry[1] = transposed("a", 1);
    v.entry[2] = transposed("ab.2", 2);
    expect_mistakes(&v, "{\"mistakes\":[\"transposed in ab\",\"transposed in a\"]}");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_transposed_matrix_is_one_mistake_under_its_whole_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
