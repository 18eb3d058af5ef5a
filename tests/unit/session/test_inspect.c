// What the compiler kept and left out, told of scenes for which it can be counted by hand.
#include "session/lists.h"
#include "session/model.h"

#include "support/near.h"

#include <cjson/cJSON.h>
#include <string.h>

static cJSON *inspect(const hn_library *lib, const char *scene) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    const hn_model_source source = {.name = scene};
    assert_int_equal(hn_model_load(lib, &source, &model, &diags), HN_OK);
    assert_int_equal(hn_model_inspect_json(&b, model, &diags), HN_OK);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(document);
    hn_strbuf_reset(&b);
    hn_model_free(model);
    return document;
}

static double number(const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

/// The object of the list whose member `key` begins with `text`.
static const cJSON *find(const cJSON *document, const char *list, const char *key,
                         const char *text) {
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(document, list)) {
        const cJSON *name = cJSON_GetObjectItemCaseSensitive(item, key);
        if (strncmp(name->valuestring, text, strlen(text)) == 0) {
            return item;
        }
    }
    fail_msg("%s has no %s", list, text);
    return NULL;
}

static hn_library *open_library(void) {
    hn_library *lib = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_library_open(".", &lib, &diag), HN_OK);
    return lib;
}

// three moving bodies on three tree joints; the fourth joint of the plane leaves 2 of its rows
static void four_bar_has_three_speeds_two_rows_one_freedom(void **state) {
    (void)state;
    hn_library *lib = open_library();
    cJSON *d = inspect(lib, "four-bar");
    const cJSON *sizes = cJSON_GetObjectItemCaseSensitive(d, "sizes");
    assert_true(number(sizes, "speeds") == 3);
    assert_true(number(sizes, "rows") == 2);
    assert_true(number(sizes, "rank") == 2);
    assert_true(number(sizes, "freedoms") == 1);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(d, "tree")), 3);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(d, "closures")), 2);
    // M couples crank and coupler only: three diagonal entries and one beside them
    const cJSON *M = find(d, "left_out", "what", "entries of M");
    assert_true(number(M, "kept") == 4);
    assert_true(number(M, "of") == 6);
    cJSON_Delete(d);
    hn_library_free(lib);
}

static void a_pendulum_has_no_rows_and_a_constant_mass_matrix(void **state) {
    (void)state;
    hn_library *lib = open_library();
    cJSON *d = inspect(lib, "pendulum");
    assert_true(number(cJSON_GetObjectItemCaseSensitive(d, "sizes"), "rows") == 0);
    assert_true(number(find(d, "operations", "question", "mass matrix"), "operations") == 0);
    assert_true(number(find(d, "operations", "question", "gap phi"), "operations") == 0);
    // no loop, no multipliers: nothing is saved by not asking for them
    assert_true(number(find(d, "left_out", "what", "operations when multipliers"), "left_out") ==
                0);
    cJSON_Delete(d);
    hn_library_free(lib);
}

static void counts_add_up_and_sharing_never_costs(void **state) {
    static const char *const kinds[] = {"add", "mul", "div", "sincos", "sqrt", "other"};
    (void)state;
    hn_library *lib = open_library();
    for (int i = 0; i < hn_library_n_scenes(lib); i++) {
        cJSON *d = inspect(lib, hn_library_scene_id(lib, i));
        const cJSON *row;
        cJSON_ArrayForEach(row, cJSON_GetObjectItemCaseSensitive(d, "operations")) {
            double sum = 0;
            for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
                sum += number(row, kinds[k]);
            }
            assert_true(sum == number(row, "operations"));
        }
        cJSON_ArrayForEach(row, cJSON_GetObjectItemCaseSensitive(d, "left_out")) {
            assert_true(number(row, "left_out") == number(row, "of") - number(row, "kept"));
            assert_true(number(row, "left_out") >= 0);
        }
        cJSON_Delete(d);
    }
    hn_library_free(lib);
}

static void every_scene_and_problem_belongs_to_one_lesson(void **state) {
    (void)state;
    hn_library *lib = open_library();
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lessons_json(&b, lib);
    cJSON *d = cJSON_Parse(hn_strbuf_text(&b));
    int scenes = 0, problems = 0;
    const cJSON *lesson;
    cJSON_ArrayForEach(lesson, cJSON_GetObjectItemCaseSensitive(d, "lessons")) {
        scenes += cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(lesson, "scenes"));
        problems += cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(lesson, "problems"));
        assert_true(strlen(cJSON_GetObjectItemCaseSensitive(lesson, "title")->valuestring) > 0);
    }
    assert_int_equal(scenes, hn_library_n_scenes(lib));
    assert_int_equal(problems, hn_library_n_problems(lib));
    cJSON_Delete(d);
    hn_strbuf_reset(&b);
    hn_library_free(lib);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_bar_has_three_speeds_two_rows_one_freedom),
        cmocka_unit_test(a_pendulum_has_no_rows_and_a_constant_mass_matrix),
        cmocka_unit_test(counts_add_up_and_sharing_never_costs),
        cmocka_unit_test(every_scene_and_problem_belongs_to_one_lesson),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
