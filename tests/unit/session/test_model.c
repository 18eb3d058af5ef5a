// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/shipped_library.h"

#include "dynamics/compile/drawing.h"
#include "session/compare/picture.h"
#include "session/model/caption.h"
#include "session/model/envelope.h"
#include "session/model/equations.h"
#include "session/model/model.h"
#include "session/model/model_json.h"
#include "session/model/terms_json.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static hn_model *load(const hn_model_source *source) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    if (hn_model_load(hn_test_library, source, &model, &diags) != HN_OK) {
        fail_msg("%s %s", diags.item[0].pointer, diags.item[0].message);
    }
    return model;
}

static void assert_caption(const char *scene, const hn_setting *settings, int n,
                           const char *expected) {
    hn_model *model =
        load(&(hn_model_source){.name = scene, .settings = settings, .n_settings = n});
    char caption[160];
    hn_model_caption(model, caption, sizeof caption);
    assert_string_equal(caption, expected);
    hn_model_free(model);
}

static void captions_follow_grashof_and_count_freedoms(void **state) {
    (void)state;
    assert_caption("four-bar", NULL, 0,
                   "crank-rocker, 1 degree of freedom (3 \xe2\x88\x92 2 independent constraints)");
    assert_caption("double-pendulum", NULL, 0, "2 degrees of freedom");
    assert_caption("four-angles-as-printed", NULL, 0,
                   "2 degrees of freedom (4 \xe2\x88\x92 2 independent constraints)");
    assert_caption("five-bar", NULL, 0,
                   "2 degrees of freedom (4 \xe2\x88\x92 2 independent constraints)");
    assert_caption("slider-crank", NULL, 0,
                   "1 degree of freedom (3 \xe2\x88\x92 2 independent constraints)");
    assert_caption("n-four-bar", NULL, 0,
                   "1 degree of freedom (5 \xe2\x88\x92 4 independent constraints)");
    assert_caption("double-rocker", NULL, 0,
                   "double-rocker, 1 degree of freedom (3 \xe2\x88\x92 2 independent constraints)");
    assert_caption("triple-rocker", NULL, 0,
                   "triple-rocker, 1 degree of freedom (3 \xe2\x88\x92 2 independent constraints)");
    assert_caption("parallelogram", NULL, 0,
                   "change-point parallelogram, 1 degree of freedom (3 \xe2\x88\x92 2 independent "
                   "constraints)");
    // four hinges in space, opposite links equal: no plane parallelogram
    assert_caption("bennett", NULL, 0,
                   "1 degree of freedom (3 \xe2\x88\x92 2 independent constraints, 3 redundant)");
}

static void an_unknown_scene_gets_the_nearest_name(void **state) {
    (void)state;
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_model_source source = {.name = "fuor-bar"};
    assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_ERR_INPUT);
    assert_non_null(strstr(diags.item[0].hint, "four-bar"));
}

static cJSON *parse_and_reset(hn_strbuf *b) {
    cJSON *doc = cJSON_Parse(hn_strbuf_text(b));
    if (!doc) {
        fail_msg("not JSON: %.200s", hn_strbuf_text(b));
    }
    hn_strbuf_reset(b);
    return doc;
}

static void every_shipped_scene_loads_and_describes_itself(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_scenes_json(&b, hn_test_library);
    cJSON *doc = parse_and_reset(&b);
    const cJSON *scenes = cJSON_GetObjectItem(doc, "scenes");
    assert_int_equal(cJSON_GetArraySize(scenes), hn_library_n_scenes(hn_test_library));
    assert_true(cJSON_GetArraySize(scenes) >= 8);
    const cJSON *scene;
    cJSON_ArrayForEach(scene, scenes) {
        const char *id = cJSON_GetObjectItem(scene, "id")->valuestring;
        if (cJSON_GetObjectItem(scene, "errors")) {
            fail_msg("%s does not load", id);
        }
        assert_true(strlen(cJSON_GetObjectItem(scene, "title")->valuestring) > 3);
        assert_true(strlen(cJSON_GetObjectItem(scene, "about")->valuestring) > 20);
        hn_model *model = load(&(hn_model_source){.name = id});
        assert_true(hn_model_assembly(model)->ok);
        hn_model_json(&b, model);
        cJSON *one = parse_and_reset(&b);
        const cJSON *box = cJSON_GetObjectItem(one, "envelope");
        assert_int_equal(cJSON_GetArraySize(box), 4);
        assert_true(cJSON_GetArrayItem(box, 2)->valuedouble >
                    cJSON_GetArrayItem(box, 0)->valuedouble);
        assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(one, "methods")) >= 1);
        cJSON_Delete(one);
        hn_model_free(model);
    }
    cJSON_Delete(doc);
}

static double entry(const cJSON *object, const char *key, int i, int j) {
    const cJSON *row = cJSON_GetArrayItem(cJSON_GetObjectItem(object, key), i);
    const cJSON *item = j < 0 ? row : cJSON_GetArrayItem(row, j);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

/// M a - f - J' lambda and J a + gamma vanish in the scene's own coordinates.
static void assert_balanced(const char *scene, const hn_state_entry *entries, int n_entries) {
    hn_model *model = load(&(hn_model_source){.name = scene});
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    assert_int_equal(hn_model_terms_json(&b, model, 0.3, entries, n_entries, &diags), HN_OK);
    cJSON *doc = parse_and_reset(&b);
    const int n = cJSON_GetArraySize(cJSON_GetObjectItem(doc, "q"));
    const int m = cJSON_GetArraySize(cJSON_GetObjectItem(doc, "phi"));
    double scale = 1;
    for (int i = 0; i < n; i++) {
        scale = fmax(scale, fabs(entry(doc, "f", i, -1)));
    }
    for (int i = 0; i < n; i++) {
        double sum = -entry(doc, "f", i, -1);
        for (int j = 0; j < n; j++) {
            sum += entry(doc, "M", i, j) * entry(doc, "a", j, -1);
            assert_near(entry(doc, "M", i, j), entry(doc, "M", j, i), 1e-13 * scale);
        }
        for (int k = 0; k < m; k++) {
            sum -= entry(doc, "J", k, i) * entry(doc, "lambda", k, -1);
        }
        assert_near(sum, 0, 1e-11 * scale); // a dozen roundings of terms of that size
    }
    for (int k = 0; k < m; k++) {
        double sum = entry(doc, "gamma", k, -1);
        for (int j = 0; j < n; j++) {
            sum += entry(doc, "J", k, j) * entry(doc, "a", j, -1);
        }
        assert_near(sum, 0, 1e-11 * scale);
    }
    cJSON_Delete(doc);
    hn_model_free(model);
}

static void terms_balance_in_the_coordinates_of_the_scene(void **state) {
    (void)state;
    assert_balanced("four-bar", NULL, 0);
    assert_balanced("fb0-lagrangian", NULL, 0);
    assert_balanced("five-bar", NULL, 0);
    assert_balanced("slider-crank", NULL, 0);
    assert_balanced("double-pendulum", NULL, 0);
    assert_balanced("n-four-bar", NULL, 0);
}

static void reactions_of_joints_and_efforts_of_formulas_are_listed(void **state) {
    (void)state;
    static const struct {
        const char *scene, *told;
    } rows[] = {{"four-bar", "\"joint_force\":["},
                {"four-bar", "\"efforts\":[]"},
                {"fb0-lagrangian", "\"reactions\":[],\"efforts\":[{\"name\":\"loop x\","
                                   "\"kind\":\"constraint\",\"coordinate\":\"th1\","
                                   "\"unit\":\"N m\",\"value\":"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        hn_model *model = NULL;
        hn_diags diags = {0};
        hn_strbuf b;
        hn_strbuf_init(&b);
        const hn_model_source source = {.name = rows[k].scene};
        assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_OK);
        assert_int_equal(hn_model_terms_json_with_reactions(&b, model, 0, NULL, 0, &diags), HN_OK);
        assert_non_null(strstr(hn_strbuf_text(&b), rows[k].told));
        hn_strbuf_reset(&b);
        hn_model_free(model);
    }
}

static void a_state_with_an_unknown_name_is_refused_with_a_hint(void **state) {
    (void)state;
    hn_model *model = load(&(hn_model_source){.name = "fb0-lagrangian"});
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    const hn_state_entry wrong = {"th11", 0.3};
    assert_int_equal(hn_model_terms_json(&b, model, 0, &wrong, 1, &diags), HN_ERR_INPUT);
    assert_string_equal(diags.item[0].pointer, "/state/th11");
    assert_non_null(strstr(diags.item[0].hint, "th1"));
    assert_int_equal(b.n, 0);
    const hn_state_entry right = {"th1", 0.7};
    diags = (hn_diags){0};
    assert_int_equal(hn_model_terms_json(&b, model, 0, &right, 1, &diags), HN_OK);
    cJSON *doc = parse_and_reset(&b);
    assert_near(entry(doc, "q", 0, -1), 0.7, 1e-15);
    // only the named entry moved: the loop is open by the chord of 0.3 rad on a 1 m crank, and that
    // is told
    assert_near(cJSON_GetObjectItem(doc, "gap")->valuedouble, 2 * sin(0.15), 1e-12);
    cJSON_Delete(doc);
    hn_model_free(model);
}

static void equations_say_which_quaternion_an_orientation_is(void **state) {
    (void)state;
    hn_model *model = load(&(hn_model_source){.name = "stewart-6-6"});
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    assert_int_equal(hn_model_equations(&b, model, HN_EQUATIONS_TEXT, &diags), HN_OK);
    // coordinates behind the platform's orientation keep their own symbols, one entry of q further
    // on than of v
    assert_non_null(strstr(hn_strbuf_text(&b),
                           "y of the rotation vector of the unit quaternion (e0_platform, "
                           "e1_platform, e2_platform, e3_platform)"));
    assert_null(strstr(hn_strbuf_text(&b), "\nb1 = ")); // a coordinate that is itself
    assert_non_null(strstr(hn_strbuf_text(&b), "(the same where not listed):\n"));
    hn_strbuf_reset(&b);
    hn_model_free(model);
}

static void equations_keep_the_names_of_parameters(void **state) {
    (void)state;
    hn_model *model = load(&(hn_model_source){.name = "fb0"});
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    assert_int_equal(hn_model_equations(&b, model, HN_EQUATIONS_TEXT, &diags), HN_OK);
    assert_non_null(strstr(hn_strbuf_text(&b), "l1"));
    assert_non_null(strstr(hn_strbuf_text(&b), "M[1][1] = "));
    hn_strbuf_clear(&b);
    assert_int_equal(hn_model_equations(&b, model, HN_EQUATIONS_LATEX, &diags), HN_OK);
    assert_non_null(strstr(hn_strbuf_text(&b), "\\begin{align*}"));
    hn_strbuf_clear(&b);
    assert_int_equal(hn_model_equations(&b, model, HN_EQUATIONS_JSON, &diags), HN_OK);
    cJSON *doc = parse_and_reset(&b);
    assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(doc, "entries")) > 10);
    cJSON_Delete(doc);
    hn_model_free(model);
}

static void a_picture_is_a_png_and_says_what_it_shows(void **state) {
    (void)state;
    hn_model *model = load(&(hn_model_source){.name = "four-bar"});
    hn_strbuf png, words;
    hn_strbuf_init(&png);
    hn_strbuf_init(&words);
    hn_diags diags = {0};
    hn_status ended = HN_ERR_INTERNAL;
    const char *const methods[] = {"index1@rk4:h=0.02", "projection@rk4:h=0.02"};
    const hn_picture_request request = {
        .methods = methods, .n_methods = 2, .time = 0.5, .width = 320, .height = 200};
    assert_int_equal(hn_model_picture(&png, &words, model, &request, &ended, &diags), HN_OK);
    assert_int_equal(ended, HN_OK);
    assert_true(png.n > 1000);
    assert_memory_equal(png.text, "\x89PNG\r\n\x1a\n", 8);
    cJSON *doc = parse_and_reset(&words);
    const cJSON *picture = cJSON_GetObjectItem(doc, "picture");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(picture, "poses")), 2);
    assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(picture, "tears")) >= 1);
    cJSON_Delete(doc);
    // a pose that somebody names, such as the one at which a wrong entry shows
    hn_strbuf_clear(&png);
    const hn_state_entry entry_of_crank = {hn_model_scene(model)->coordinates[0].name, 0.4};
    const hn_picture_request pose = {
        .entries = &entry_of_crank, .n_entries = 1, .width = 320, .height = 200};
    assert_int_equal(hn_model_picture(&png, NULL, model, &pose, NULL, &diags), HN_OK);
    assert_memory_equal(png.text, "\x89PNG\r\n\x1a\n", 8);
    const hn_picture_request late = {.methods = methods, .n_methods = 2, .time = -1};
    assert_int_equal(hn_model_picture(&png, NULL, model, &late, NULL, &diags), HN_ERR_INPUT);
    hn_strbuf_reset(&png);
    hn_model_free(model);
}

static void a_parameter_changes_the_mechanism(void **state) {
    (void)state;
    const hn_setting triple = {"l1", 0.9}; // 0.9 + 1.2 > 0.8 + 1.0 with the shortest link 0.8
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_model_source source = {.name = "four-bar", .settings = &triple, .n_settings = 1};
    assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_OK);
    char caption[160];
    hn_model_caption(model, caption, sizeof caption);
    assert_string_equal(
        caption, "triple-rocker, 1 degree of freedom (3 \xe2\x88\x92 2 independent constraints)");
    hn_model_free(model);

    // 5 > 0.8 + 1.2 + 1.0: no loop
    const hn_setting torn = {"l1", 5};
    const hn_model_source open = {
        .name = "four-bar", .settings = &torn, .n_settings = 1, .allow_open = true};
    assert_int_equal(hn_model_load(hn_test_library, &open, &model, &diags), HN_OK);
    hn_model_caption(model, caption, sizeof caption);
    assert_non_null(strstr(caption, "links that cannot close, "));
    hn_model_free(model);
}

/// Whether every point of every fixed shape (`standing` of them solid bars) is told as ground, and
/// no point of a body.
static void assert_ground(const char *scene, int n_standing) {
    hn_model *model = load(&(hn_model_source){.name = scene});
    const hn_system *sys = hn_model_system(model);
    const hn_drawing d = hn_system_drawing(sys);
    char *is_ground = calloc((size_t)d.n_points + 1, 1);
    assert_int_equal(hn_model_ground_points(model, is_ground), HN_OK);
    int standing = 0;
    for (int i = 0; i < d.n_shapes; i++) {
        const hn_shape *shape = &d.shapes[i];
        if (shape->kind == HN_SHAPE_GROUND) {
            assert_true(is_ground[shape->p]);
        } else if (shape->kind == HN_SHAPE_BAR) {
            standing += is_ground[shape->p] && is_ground[shape->q];
            assert_false(shape->body >= 0 && is_ground[shape->p] && is_ground[shape->q]);
        }
    }
    assert_int_equal(standing, n_standing);
    free(is_ground);
    hn_model_free(model);
}

static void what_stands_on_the_ground_is_told_from_what_moves(void **state) {
    (void)state;
    assert_ground("four-bar", 0);
    assert_ground("delta-robot", 3);     // its base; the rods belong to no body and move
    assert_ground("planetary-gear", 36); // its ring
    assert_ground("car-axis", 0);        // formulas: the chassis has no body either
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(captions_follow_grashof_and_count_freedoms),
        cmocka_unit_test(an_unknown_scene_gets_the_nearest_name),
        cmocka_unit_test(every_shipped_scene_loads_and_describes_itself),
        cmocka_unit_test(terms_balance_in_the_coordinates_of_the_scene),
        cmocka_unit_test(reactions_of_joints_and_efforts_of_formulas_are_listed),
        cmocka_unit_test(a_state_with_an_unknown_name_is_refused_with_a_hint),
        cmocka_unit_test(equations_say_which_quaternion_an_orientation_is),
        cmocka_unit_test(equations_keep_the_names_of_parameters),
        cmocka_unit_test(a_picture_is_a_png_and_says_what_it_shows),
        cmocka_unit_test(what_stands_on_the_ground_is_told_from_what_moves),
        cmocka_unit_test(a_parameter_changes_the_mechanism),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
