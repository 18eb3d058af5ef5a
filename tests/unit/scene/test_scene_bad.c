// SPDX-License-Identifier: GPL-3.0-or-later
// Malformed scenes: each file of tests/scenes/bad is told with the pointer and the words that
// expected.tsv asks for.
#include "scene/scene.h"

#include "support/near.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// Returns whether the file is refused as expected; otherwise prints what was found.
static bool is_told(const char *file, const char *pointer, const char *word) {
    char path[256];
    hn_scene *scene = (hn_scene *)&path;
    hn_diags diags = {0};
    snprintf(path, sizeof path, "tests/scenes/bad/%s", file);
    hn_status status = hn_scene_load_file(path, NULL, 0, &scene, &diags);
    const hn_diag *first = &diags.item[0];
    if ((status != HN_ERR_INPUT && status != HN_ERR_LIMIT) || scene || diags.n == 0) {
        print_error("%s: status %s with %d faults\n", file, hn_status_name(status), diags.n);
    } else if (strcmp(first->pointer, pointer) != 0) {
        print_error("%s: told at '%s', expected '%s' (%s)\n", file, first->pointer, pointer,
                    first->message);
    } else if (!strstr(first->message, word) && !strstr(first->hint, word)) {
        print_error("%s: expected '%s', got '%s' (%s)\n", file, word, first->message, first->hint);
    } else {
        return true;
    }
    return false;
}

static void every_malformed_scene_is_told_where_and_why(void **state) {
    FILE *table = fopen("tests/scenes/bad/expected.tsv", "r");
    char line[512];
    int n = 0, told = 0;
    (void)state;
    assert_non_null(table);
    while (fgets(line, sizeof line, table)) {
        line[strcspn(line, "\n")] = '\0';
        char *pointer = strchr(line, '\t'), *word = pointer ? strchr(pointer + 1, '\t') : NULL;
        if (line[0] == '#') {
            continue;
        }
        assert_non_null(word);
        *pointer++ = '\0';
        *word++ = '\0';
        told += is_told(line, pointer, word);
        n++;
    }
    fclose(table);
    assert_int_equal(told, n);
    assert_true(n >= 40);
}

static hn_status load(const char *text, hn_diags *diags) {
    hn_scene *scene = NULL;
    memset(diags, 0, sizeof *diags);
    hn_status status = hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, diags);
    hn_scene_free(scene);
    return status;
}

static void several_faults_are_told_at_once(void **state) {
    hn_diags diags;
    (void)state;
    assert_int_equal(load("{\"holonom\":2, \"nmae\":\"x\", \"duration\":-1, \"gravity\":[0],"
                          "\"bodies\":[{\"name\":\"b\"}], \"joints\":[]}",
                          &diags),
                     HN_ERR_INPUT);
    assert_true(diags.n >= 5);
    int n = 0;
    static const char *const pointers[] = {"/nmae", "/holonom", "/duration", "/gravity",
                                           "/bodies/0"};
    for (size_t k = 0; k < 5; k++) {
        for (int i = 0; i < diags.n; i++) {
            n += strcmp(diags.item[i].pointer, pointers[k]) == 0;
        }
    }
    assert_int_equal(n, 5);
}

static void a_missing_file_is_an_io_error_that_names_it(void **state) {
    hn_scene *scene;
    hn_diags diags = {0};
    (void)state;
    assert_int_equal(hn_scene_load_file("tests/scenes/nowhere.json", NULL, 0, &scene, &diags),
                     HN_ERR_IO);
    assert_null(scene);
    assert_non_null(strstr(diags.item[0].message, "tests/scenes/nowhere.json"));
}

static void more_than_four_megabytes_are_refused_unread(void **state) {
    static char text[HN_SCENE_MAX_BYTES + 1];
    hn_scene *scene;
    hn_diags diags = {0};
    (void)state;
    memset(text, ' ', sizeof text);
    assert_int_equal(hn_scene_load_json(text, sizeof text, NULL, NULL, 0, &scene, &diags),
                     HN_ERR_LIMIT);
    assert_non_null(strstr(diags.item[0].message, "4194305"));
}

static void too_many_bodies_are_refused(void **state) {
    hn_diags diags;
    (void)state;
    assert_int_equal(load("{\"holonom\":1, \"name\":\"x\", \"joints\":[],"
                          "\"bodies\":[{\"for\":{\"i\":[1,5000]}, \"name\":\"b{i}\", \"mass\":1}]}",
                          &diags),
                     HN_ERR_LIMIT);
    assert_non_null(strstr(diags.item[0].message, "4000 bodies"));
    assert_string_equal(diags.item[0].pointer, "/bodies/0");
}

static void settings_are_checked_like_the_file(void **state) {
    static const struct {
        hn_setting set;
        const char *word;
    } bad[] = {{{"l9", 1}, "did you mean"},
               {{"l1", -7}, "must be above 0"},
               {{"N", 2.5}, "whole"},
               {{"N", 9}, "outside its range"}};
    static const char text[] =
        "{\"holonom\":1, \"name\":\"x\", "
        "\"parameters\":{\"l1\":{\"value\":1,\"min\":0.1,\"max\":5}, \"l2\":1,"
        "\"N\":{\"value\":2,\"integer\":true,\"max\":8}}, \"bodies\":[{\"name\":\"b\",\"mass\":1}],"
        "\"joints\":[{\"name\":\"j\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},"
        "\"child\":{\"body\":\"b\"}}]}";
    (void)state;

    // a range is that of a slider: beyond it a length is a length still
    const hn_setting longer = {"l1", 700};
    hn_scene *beyond;
    hn_diags none = {0};
    assert_int_equal(hn_scene_load_json(text, strlen(text), NULL, &longer, 1, &beyond, &none),
                     HN_OK);
    assert_true(beyond->params[0].beyond && beyond->params[0].value == 700);
    assert_false(beyond->params[1].beyond);
    hn_scene_free(beyond);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        hn_scene *scene;
        hn_diags diags = {0};
        assert_int_equal(
            hn_scene_load_json(text, strlen(text), NULL, &bad[i].set, 1, &scene, &diags),
            HN_ERR_INPUT);
        if (!strstr(diags.item[0].message, bad[i].word) &&
            !strstr(diags.item[0].hint, bad[i].word)) {
            fail_msg("%s: %s %s", bad[i].set.name, diags.item[0].message, diags.item[0].hint);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_malformed_scene_is_told_where_and_why),
        cmocka_unit_test(several_faults_are_told_at_once),
        cmocka_unit_test(a_missing_file_is_an_io_error_that_names_it),
        cmocka_unit_test(more_than_four_megabytes_are_refused_unread),
        cmocka_unit_test(too_many_bodies_are_refused),
        cmocka_unit_test(settings_are_checked_like_the_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
