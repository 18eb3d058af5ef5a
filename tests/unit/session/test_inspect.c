// SPDX-License-Identifier: GPL-3.0-or-later
// The parts that the compiler kept and left out, of scenes for which it can be counted by hand.
#include "session/model/inspect_json.h"
#include "session/model/lists.h"
#include "session/model/model.h"

#include "support/near.h"
#include "support/shipped_library.h"

#include <cjson/cJSON.h>
#include <string.h>

static cJSON *inspect_with(const char *scene, const hn_setting *setting) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    const hn_model_source source = {
        .name = scene, .settings = setting, .n_settings = setting ? 1 : 0};
    assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_OK);
    assert_int_equal(hn_model_inspect_json(&b, model, &diags), HN_OK);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(document);
    hn_strbuf_reset(&b);
    hn_model_free(model);
    return document;
}

static cJSON *inspect(const char *scene) {
    return inspect_with(scene, NULL);
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

// three moving bodies on three tree joints; the fourth joint of the plane leaves 2 of its rows
static void four_bar_has_three_speeds_two_rows_one_freedom(void **state) {
    (void)state;
    cJSON *d = inspect("four-bar");
    const cJSON *sizes = cJSON_GetObjectItemCaseSensitive(d, "sizes");
    assert_true(number(sizes, "speeds") == 3);
    assert_true(number(sizes, "rows") == 2);
    const cJSON *start = cJSON_GetObjectItemCaseSensitive(d, "start");
    const cJSON *modes = cJSON_GetObjectItemCaseSensitive(start, "assembly_modes");
    assert_string_equal(modes->valuestring, "+");
    const cJSON *motors = cJSON_GetObjectItemCaseSensitive(d, "actuation");
    assert_true(number(motors, "dof") == 1);
    assert_true(number(start, "rank") == 2);
    assert_true(number(start, "dof") == 1);
    // the ground and three bodies; three of five closure rows say nothing in a plane
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(d, "tree")), 4);
    assert_true(number(find(d, "left_out", "what", "closure rows"), "count") == 3);
    // M couples crank and coupler only: three diagonal entries and two beside them
    const cJSON *nonzeros = cJSON_GetObjectItemCaseSensitive(d, "nonzeros");
    assert_true(number(nonzeros, "M") == 5);
    assert_true(number(nonzeros, "M_of") == 9);
    assert_true(number(find(d, "left_out", "what", "entries of M"), "count") == 4);
    cJSON_Delete(d);
}

static void a_pendulum_has_no_rows_and_a_constant_mass_matrix(void **state) {
    (void)state;
    cJSON *d = inspect("pendulum");
    assert_true(number(cJSON_GetObjectItemCaseSensitive(d, "sizes"), "rows") == 0);
    const cJSON *operations = cJSON_GetObjectItemCaseSensitive(d, "operations");
    assert_true(number(operations, "M") == 0);
    assert_true(number(operations, "phi") == 0);
    // no loop: stabilising it costs nothing
    assert_true(number(operations, "solve") == number(operations, "solve_baumgarte"));
    cJSON_Delete(d);
}

static void list_is(const cJSON *object, const char *key, int n, const char *const *names) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_int_equal(cJSON_GetArraySize(list), n);
    for (int i = 0; i < n; i++) {
        assert_string_equal(cJSON_GetArrayItem(list, i)->valuestring, names[i]);
    }
}

// a plane says: no way along its normal, no tilt; the compiler sees it also where the plane is
// oblique
static void rows_that_a_plane_leaves_out_are_named(void **state) {
    static const char *const oblique[] = {"B: 3rd axis", "B: tilt 1", "B: tilt 2"},
                             *const upright[] = {"B: z", "B: tilt 1", "B: tilt 2"};
    (void)state;
    cJSON *d = inspect("oblique-four-bar"), *p = inspect("parallelogram");
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(d, "redundant_rows");
    list_is(rows, "vanish", 3, oblique);
    list_is(rows, "follow", 0, NULL);
    rows = cJSON_GetObjectItemCaseSensitive(p, "redundant_rows");
    list_is(rows, "vanish", 3, upright);
    list_is(rows, "follow", 0, NULL);
    cJSON_Delete(p);
    cJSON_Delete(d);
}

// teeth of sun, planet and ring fix each planet and the carrier: the second and third planet's ring
// teeth add nothing. With the first planet's two rows and its own sun row the carrier and the
// planet are known, so that is what each follows from.
static void the_teeth_of_further_planets_follow_from_the_first(void **state) {
    static const char *const second[] = {"sun and planet 1", "sun and planet 2",
                                         "ring and planet 1"};
    static const char *const third[] = {"sun and planet 1", "sun and planet 3",
                                        "ring and planet 1"};
    (void)state;
    cJSON *d = inspect("planetary-gear");
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(d, "redundant_rows");
    list_is(rows, "vanish", 0, NULL);
    list_is(find(rows, "follow", "row", "ring and planet 2"), "from", 3, second);
    list_is(find(rows, "follow", "row", "ring and planet 3"), "from", 3, third);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(rows, "follow")), 2);
    cJSON_Delete(d);
}

// two shafts that are parallel, five closure rows of which a spatial loop of one freedom has room
// for two
static void dependent_rows_of_shaft_and_bennett_are_named(void **state) {
    static const char *const first[] = {"U2: 1st axis"};
    static const char *const two[] = {"J3: 1st axis", "J3: 2nd axis"};
    static const char *const more[] = {"J3: 3rd axis", "J3: tilt 1", "J3: tilt 2"};
    (void)state;
    cJSON *d = inspect("cardan-shaft"), *b = inspect("bennett");
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(d, "redundant_rows");
    list_is(find(rows, "follow", "row", "U2: 3rd axis"), "from", 1, first);
    rows = cJSON_GetObjectItemCaseSensitive(b, "redundant_rows");
    for (int i = 0; i < 3; i++) {
        list_is(find(rows, "follow", "row", more[i]), "from", 2, two);
    }
    cJSON_Delete(b);
    cJSON_Delete(d);
}

// a flat parallelogram has a row less than the same one a little further on; the row that Bennett's
// linkage can spare is redundant all the way round
static void rows_that_follow_only_at_the_start_are_called_singular(void **state) {
    (void)state;
    static const hn_setting flat = {.name = "th_0", .value = 0};
    cJSON *there = inspect_with("parallelogram", &flat), *all_round = inspect("bennett");
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(there, "redundant_rows");
    assert_true(cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(rows, "singular")));
    rows = cJSON_GetObjectItemCaseSensitive(all_round, "redundant_rows");
    assert_true(cJSON_IsFalse(cJSON_GetObjectItemCaseSensitive(rows, "singular")));
    cJSON_Delete(all_round);
    cJSON_Delete(there);
}

// elimination in the order of the rows and pivoted QR count alike, in every scene
static void as_many_rows_follow_as_assembly_counts(void **state) {
    (void)state;
    for (int i = 0; i < hn_library_n_scenes(hn_test_library); i++) {
        cJSON *d = inspect(hn_library_scene_id(hn_test_library, i));
        const cJSON *rows = cJSON_GetObjectItemCaseSensitive(d, "redundant_rows");
        const cJSON *start = cJSON_GetObjectItemCaseSensitive(d, "start");
        const int n = cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(rows, "follow"));
        assert_int_equal(n, (int)number(start, "redundant"));
        cJSON_Delete(d);
    }
}

// the nine unknowns of two four-bars are dense, forty-one of ten are few against the square of
// their number
static void who_factors_newton_matrices_is_told(void **state) {
    (void)state;
    static const hn_setting settings[] = {{.name = "N", .value = 2}, {.name = "N", .value = 10}};
    static const char *const words[] = {"dense", "sparse"};
    for (int k = 0; k < 2; k++) {
        cJSON *d = inspect_with("n-four-bar", &settings[k]);
        const cJSON *solver = cJSON_GetObjectItemCaseSensitive(d, "solver");
        const cJSON *who = cJSON_GetObjectItemCaseSensitive(solver, "newton");
        assert_true(cJSON_IsString(who));
        assert_memory_equal(who->valuestring, words[k], strlen(words[k]));
        assert_true(number(solver, "newton_size") == (k ? 41 : 9));
        cJSON_Delete(d);
    }
}

static void sharing_and_leaving_out_never_cost(void **state) {
    static const char *const terms[] = {"M", "f", "phi", "J", "gamma"};
    (void)state;
    for (int i = 0; i < hn_library_n_scenes(hn_test_library); i++) {
        cJSON *d = inspect(hn_library_scene_id(hn_test_library, i));
        const cJSON *operations = cJSON_GetObjectItemCaseSensitive(d, "operations"), *row;
        double separate = 0;
        for (size_t k = 0; k < sizeof terms / sizeof *terms; k++) {
            separate += number(operations, terms[k]);
        }
        assert_true(number(operations, "together") <= separate);
        cJSON_ArrayForEach(row, cJSON_GetObjectItemCaseSensitive(d, "left_out")) {
            const cJSON *saved = cJSON_GetObjectItemCaseSensitive(row, "operations");
            assert_true(!saved || saved->valuedouble >= 0);
        }
        cJSON_Delete(d);
    }
}

static void every_scene_and_problem_belongs_to_one_lesson(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lessons_json(&b, hn_test_library);
    cJSON *d = cJSON_Parse(hn_strbuf_text(&b));
    int scenes = 0, problems = 0;
    const cJSON *lesson;
    cJSON_ArrayForEach(lesson, cJSON_GetObjectItemCaseSensitive(d, "lessons")) {
        scenes += cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(lesson, "scenes"));
        problems += cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(lesson, "problems"));
        assert_true(strlen(cJSON_GetObjectItemCaseSensitive(lesson, "title")->valuestring) > 0);
    }
    assert_int_equal(scenes, hn_library_n_scenes(hn_test_library));
    assert_int_equal(problems, hn_library_n_problems(hn_test_library));
    cJSON_Delete(d);
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_bar_has_three_speeds_two_rows_one_freedom),
        cmocka_unit_test(a_pendulum_has_no_rows_and_a_constant_mass_matrix),
        cmocka_unit_test(rows_that_a_plane_leaves_out_are_named),
        cmocka_unit_test(the_teeth_of_further_planets_follow_from_the_first),
        cmocka_unit_test(dependent_rows_of_shaft_and_bennett_are_named),
        cmocka_unit_test(rows_that_follow_only_at_the_start_are_called_singular),
        cmocka_unit_test(as_many_rows_follow_as_assembly_counts),
        cmocka_unit_test(who_factors_newton_matrices_is_told),
        cmocka_unit_test(sharing_and_leaving_out_never_cost),
        cmocka_unit_test(every_scene_and_problem_belongs_to_one_lesson),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
