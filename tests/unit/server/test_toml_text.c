// SPDX-License-Identifier: GPL-3.0-or-later
// TOML that is written is read again as the same object, whatever its names and texts hold.
#include "grade/toml_text.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

/// Writes an object as TOML and reads it again; fails where the two differ.
static void assert_same_again(const char *json) {
    cJSON *root = cJSON_Parse(json);
    assert_non_null(root);
    hn_strbuf toml, again;
    hn_diag diag = {0};
    hn_strbuf_init(&toml);
    hn_strbuf_init(&again);
    hn_toml_write(&toml, root);
    if (hn_toml_to_json(&again, hn_strbuf_text(&toml), &diag) != HN_OK) {
        fail_msg("%s: %s\n%s", json, diag.message, hn_strbuf_text(&toml));
    }
    cJSON *back = cJSON_Parse(hn_strbuf_text(&again));
    if (!back || !cJSON_Compare(root, back, 1)) {
        fail_msg("%s is read again as %s", json, hn_strbuf_text(&again));
    }
    cJSON_Delete(root);
    cJSON_Delete(back);
    hn_strbuf_reset(&toml);
    hn_strbuf_reset(&again);
}

static void names_and_texts_are_the_same_again(void **state) {
    (void)state;
    static const char *const rows[] = {
        "{\"a\": 1, \"b-c\": \"x\"}",
        "{\"a b\": 1, \"it's\": 2, \"\": 3, \"x.y\": 4}",
        "{\"say \\\"a\\\"\": 1, \"a\\\\b\": 2, \"\\\\\": 3, \"tab\\t, line\\n\": 4, \"\\u0007\": "
        "5}",
        "{\"say \\\"a\\\"\": {\"C:\\\\x\": \"C:\\\\x \\\"y\\\"\", \"b\": {\"\\\"\": [1, "
        "\"\\\\\"]}}}",
        "{\"grün\": {\"#\": true, \"=\": false, \"[a]\": {}}}",
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_same_again(rows[i]);
    }
}

static void quoted_names_are_read(void **state) {
    (void)state;
    static const struct {
        const char *toml, *json; ///< NULL: refused
    } rows[] = {
        {"\"a\\\"b\" = 1", "{\"a\\\"b\": 1}"},
        {"'a\\b\"' = 1", "{\"a\\\\b\\\"\": 1}"},
        {"['a'.\"b\"]\nc = 1\n", "{\"a\": {\"b\": {\n\"c\": 1\n}}}"},
        {"\"a = 1", NULL},
        {"= 1", NULL},
        {"\"a\\", NULL},
        {"n23456789012345678901234567890123456789012345678901234567890123456789012345678 = 1",
         "{\"n23456789012345678901234567890123456789012345678901234567890123456789012345678\": 1}"},
        {"n234567890123456789012345678901234567890123456789012345678901234567890123456789 = 1",
         NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_strbuf json;
        hn_diag diag = {0};
        hn_strbuf_init(&json);
        const hn_status status = hn_toml_to_json(&json, rows[i].toml, &diag);
        if (status != (rows[i].json ? HN_OK : HN_ERR_INPUT) ||
            (rows[i].json && strcmp(hn_strbuf_text(&json), rows[i].json) != 0)) {
            fail_msg("%s is read as %s", rows[i].toml, hn_strbuf_text(&json));
        }
        hn_strbuf_reset(&json);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_texts_are_the_same_again),
        cmocka_unit_test(quoted_names_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
