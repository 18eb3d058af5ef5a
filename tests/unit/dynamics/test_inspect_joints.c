// SPDX-License-Identifier: GPL-3.0-or-later
// Reports on joints with several degrees of freedom, on limits and on motors.
#include "support/near.h"

#include "dynamics/analyse/inspect.h"
#include "dynamics/compile/compile.h"
#include "support/model.h"

#include <string.h>

static const char SCENE[] =
    "{\"holonom\":1,\"name\":\"arm\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"a\",\"mass\":"
    "1,"
    "\"com\":[0.2,0,0],\"inertia\":{\"xx\":1,\"yy\":1,\"zz\":1}},{\"name\":\"b\",\"mass\":1,"
    "\"com\":"
    "[0,0.1,0],\"inertia\":{\"xx\":1,\"yy\":1,\"zz\":1}}],\"joints\":[{\"name\":\"U\",\"type\":"
    "\"universal\",\"axis\":[1,0,0],\"axis2\":[0,1,0],\"parent\":{\"body\":\"ground\"},\"child\":"
    "{\"body\":\"a\"},\"actuated\":[\"U_1\"],\"limits\":{\"U_2\":[-1,null]}},{\"name\":\"S\","
    "\"type\":\"spherical\",\"parent\":{\"body\":\"a\",\"at\":[1,0,0]},\"child\":{\"body\":\"b\"}}]"
    "}";

static void joints_are_told_as_what_they_are_with_limits_and_motors(void **state) {
    hn_model m;
    hn_strbuf b;
    (void)state;
    hn_model_open_text(&m, SCENE, NULL);
    assert_int_equal(m.status, HN_OK);
    hn_strbuf_init(&b);
    hn_json_object(&b);
    assert_int_equal(hn_system_inspect_put(&b, m.sys), HN_OK);
    hn_system_actuation_put(&b, m.sys, m.assembly.freedoms);
    hn_json_end_object(&b);
    const char *text = hn_strbuf_text(&b);
    // the cross of the universal joint is no body: depth 1 and 2 only
    assert_non_null(strstr(text, "[\"ground\",\"  a by universal U\",\"    b by spherical S\"]"));
    assert_non_null(strstr(text, "{\"name\":\"U_2\",\"min\":-1}"));
    assert_non_null(strstr(text, "\"actuated\":1,\"dof\":5,\"reading\":\"under-actuated"));
    assert_non_null(strstr(text, "unit quaternion"));
    hn_strbuf_reset(&b);
    hn_model_close(&m);
}

static void one_entry_of_an_orientation_cannot_be_pinned_alone(void **state) {
    hn_model m;
    char text[1200];
    (void)state;
    strcpy(text, SCENE);
    strcpy(text + strlen(text) - 1, ",\"start\":{\"positions\":{\"S_ry\":0.5}}}");
    hn_model_open_text(&m, text, NULL);
    assert_int_equal(m.status, HN_ERR_INPUT);
    assert_non_null(strstr(m.diags.item[0].message, "S_ry alone cannot have"));
    hn_model_close(&m);
}

/// Loads and compiles SCENE with a load on it and gives what it is refused for, or NULL.
static const char *refusal(const char *load, hn_diags *diags) {
    char text[1600];
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    strcpy(text, SCENE);
    strcpy(text + strlen(text) - 1, ",\"loads\":[");
    strcat(text, load);
    strcat(text, "]}");
    if (hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, diags) != HN_OK) {
        return diags->item[0].message;
    }
    hn_status status = hn_system_compile(scene, NULL, &sys, diags);
    hn_system_free(sys);
    hn_scene_free(scene);
    return status == HN_OK ? NULL : diags->item[0].message;
}

static void formulas_may_use_the_rates_of_an_orientation_and_not_its_entries(void **state) {
    hn_diags diags = {0};
    (void)state;
    assert_null(refusal(
        "{\"name\":\"L\",\"torque\":{\"coordinate\":\"S_rx\",\"value\":\"-2*d_S_ry\"}}", &diags));
    const char *why = refusal(
        "{\"name\":\"L\",\"torque\":{\"coordinate\":\"S_rx\",\"value\":\"-2*S_ry\"}}", &diags);
    assert_non_null(why);
    assert_non_null(strstr(why, "'S_ry' is an entry of"));
}

static void a_free_joint_closes_nothing(void **state) {
    static const char text[] =
        "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"a\",\"mass\":1,\"inertia\":{\"zz\":"
        "1}"
        "}],\"joints\":[{\"name\":\"R\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},"
        "\"child\":{\"body\":\"a\"}},{\"name\":\"F\",\"type\":\"free\",\"parent\":{\"body\":"
        "\"ground\"},\"child\":{\"body\":\"a\"}}]}";
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    hn_diags diags = {0};
    (void)state;
    assert_int_equal(hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, &diags), HN_OK);
    assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_ERR_INPUT);
    assert_non_null(
        strstr(diags.item[0].message, "has no effect: other joints already carry both its bodies"));
    hn_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_are_told_as_what_they_are_with_limits_and_motors),
        cmocka_unit_test(one_entry_of_an_orientation_cannot_be_pinned_alone),
        cmocka_unit_test(formulas_may_use_the_rates_of_an_orientation_and_not_its_entries),
        cmocka_unit_test(a_free_joint_closes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
