// SPDX-License-Identifier: GPL-3.0-or-later
// A verdict on Problem 3 in each form: the same score, and the fields that a platform knows.
#include "grade/grade.h"

#include "p3.h"
#include "support/near.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <string.h>

static const char *text_of(const cJSON *node, const char *key) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(node, key);
    assert_true(cJSON_IsString(m));
    return m->valuestring;
}

static void gradescope_gets_its_fields_and_the_same_score(void **state) {
    static const char *const top[] = {"score",         "execution_time",     "output",
                                      "output_format", "test_output_format", "test_name_format",
                                      "visibility",    "stdout_visibility",  "extra_data",
                                      "tests",         "leaderboard"};
    static const char *const inner[] = {"score",       "max_score",  "status",    "name",
                                        "name_format", "number",     "output",    "output_format",
                                        "tags",        "visibility", "extra_data"};
    hn_verdict v;
    hn_strbuf b;
    hn_strbuf_init(&b);
    grade_with(*state, 2, "-l3*sin(th3)", &v);
    hn_verdict_gradescope(&b, &v, 0.25);
    cJSON *root = parse(&b);
    double sum = 0;
    for (const cJSON *m = root->child; m; m = m->next) {
        int known = 0;
        for (size_t i = 0; i < sizeof top / sizeof top[0]; i++) {
            known |= strcmp(m->string, top[i]) == 0;
        }
        assert_true(known);
    }
    const cJSON *tests = cJSON_GetObjectItemCaseSensitive(root, "tests"), *test;
    cJSON_ArrayForEach(test, tests) {
        for (const cJSON *m = test->child; m; m = m->next) {
            int known = 0;
            for (size_t i = 0; i < sizeof inner / sizeof inner[0]; i++) {
                known |= strcmp(m->string, inner[i]) == 0;
            }
            assert_true(known);
        }
        sum += number_of(test, "score");
        assert_near(number_of(test, "max_score"), 1, 0);
    }
    assert_int_equal(cJSON_GetArraySize(tests), 8);
    assert_near(sum, 7.5, 0);
    assert_near(number_of(root, "score"), sum, 0);
    assert_near(number_of(root, "execution_time"), 0.25, 0);
    const cJSON *third = cJSON_GetArrayItem(tests, 2);
    assert_string_equal(text_of(third, "status"), "failed");
    assert_string_equal(text_of(third, "number"), "1.3");
    assert_string_equal(text_of(third, "name"), "J13 = d phi_1 / d th3");
    assert_non_null(strstr(text_of(third, "output"), "the sign is wrong"));
    assert_string_equal(text_of(cJSON_GetArrayItem(tests, 0), "status"), "passed");
    assert_string_equal(text_of(cJSON_GetObjectItemCaseSensitive(root, "extra_data"), "status"),
                        "graded");
    cJSON_Delete(root);

    grade(*state, "{}", &v);
    hn_verdict_gradescope(&b, &v, -1);
    root = parse(&b);
    assert_near(number_of(root, "score"), 0, 0);
    assert_null(cJSON_GetObjectItemCaseSensitive(root, "execution_time"));
    assert_non_null(strstr(text_of(root, "output"), "cannot be graded"));
    assert_string_equal(text_of(cJSON_GetObjectItemCaseSensitive(root, "extra_data"), "status"),
                        "ungradable");
    cJSON_Delete(root);
}

static void json_and_text_tell_the_same_verdict(void **state) {
    hn_verdict v;
    hn_strbuf b;
    hn_strbuf_init(&b);
    grade_with(*state, 0, "l1*sin(th1)", &v);
    v.show_expected = true;
    hn_verdict_json(&b, &v);
    cJSON *root = parse(&b);
    assert_near(number_of(root, "score"), 7.5, 0);
    assert_string_equal(text_of(root, "status"), "graded");
    assert_string_equal(text_of(root, "shown_entry"), "J11");
    assert_string_equal(text_of(root, "shown_scene"), "four-angles-as-printed");
    const cJSON *at = cJSON_GetObjectItemCaseSensitive(root, "shown_state"),
                *entry = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(root, "entries"), 0);
    assert_near(number_of(entry, "expected_value"),
                -number_of(at, "l1") * sin(number_of(at, "th1")), 1e-15);
    cJSON_Delete(root);
    hn_verdict_text(&b, &v);
    const char *text = hn_strbuf_text(&b);
    assert_non_null(strstr(text, "score 7.5 of 8"));
    assert_non_null(strstr(text, "the sign is wrong"));
    assert_non_null(strstr(text, "at        l1 = "));
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradescope_gets_its_fields_and_the_same_score),
        cmocka_unit_test(json_and_text_tell_the_same_verdict),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
