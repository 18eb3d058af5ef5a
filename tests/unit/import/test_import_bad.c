// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are no mechanism: each is refused with a line and what is wrong, quickly and in
// bounded memory.
#include "support/near.h"

#include "support/imported.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORLD(inside) "<mujoco><worldbody>" inside "</worldbody></mujoco>"
#define BODY(inside) WORLD("<body name='b'>" inside "</body>")
#define ROBOT(inside) "<robot name='r'>\n" inside "</robot>"

static const struct {
    const char *text, *says;
} BAD[] = {
    {"", "line 1"},
    {"hello", "line 1, column 1"},
    {"<mujoco>\n  <worldbody>\n</mujoco>", "line 3, column"},
    {"<html/>", "<html> is not the root"},
    {"<mujoco/>", "no body"},
    {"<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco model='&b;'/>", "document type"},
    {BODY("<joint/><geom size='nan'/>"), "'nan' is not a number"},
    {BODY("<joint/><geom size='0x1p3'/>"), "'0x1p3' is not a number"},
    {BODY("<joint/><geom size='1e999'/>"), "'1e999' is not a number"},
    {BODY("<joint/><geom size='-1'/>"), "not positive"},
    {BODY("<joint/><geom type='box' size='1 1'/>"), "needs 3 sizes"},
    {BODY("<joint axis='0 0 0'/><geom size='1'/>"), "length 0"},
    {BODY("<joint axis='0 1'/><geom size='1'/>"), "2 numbers, expected 3"},
    {BODY("<joint type='hinges'/><geom size='1'/>"), "unknown joint type 'hinges'"},
    {BODY("<joint/><inertial pos='0 0 0' mass='-1'/>"), "not negative"},
    {BODY("<joint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 5'/>"), "no body has"},
    {BODY("<joint/><geom size='1' quat='1 0 0 0' euler='1 2 3'/>"), "given twice"},
    {BODY("<joint/><geom size='1' class='nobody'/>"), "no default class 'nobody'"},
    {BODY("<joint name='j'/><joint name='j'/><geom size='1'/>"), "two joints"},
    {WORLD("<body name='b'><geom size='1'/><body><freejoint/><geom size='1'/></body></body>"),
     "only on children of worldbody"},
    {WORLD("<joint/>"), "the world has no 'joint'"},
    {"<mujoco><default><default class='a'><default class='a'/></default></default></mujoco>",
     "default class 'a' is defined in line 1 already"},
    {"<mujoco><include file='x.xml'/><worldbody><body><joint/><geom "
     "size='1'/></body></worldbody></mujoco>",
     "the folder of 'x.xml' is not known"},
    {"<mujoco><worldbody><body name='b'><joint/><geom size='1'/></body></worldbody><equality>"
     "<connect body1='b' body2='c' anchor='0 0 0'/></equality></mujoco>",
     "no body named 'c'"},
    {"<mujoco><worldbody><body name='b'><joint/><geom size='1'/></body></worldbody><keyframe><key "
     "qpos='1 2'/></keyframe></mujoco>",
     "2 numbers, expected 1"},
    {ROBOT(""), "no link"},
    {ROBOT("<link name='a'/><link name='b'/>"), "one root"},
    {ROBOT("<link name='a'/><link name='a'/>"), "two links"},
    {ROBOT("<link name='a'/><joint name='j' type='fixed'><parent link='a'/><child "
           "link='b'/></joint>"),
     "no link named 'b'"},
    {ROBOT("<link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/><child "
           "link='b'/></joint><joint name='k' type='fixed'><parent link='b'/><child "
           "link='a'/></joint>"),
     "circle"},
    {ROBOT(
         "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child "
         "link='b'/></joint>"),
     "needs its 'limit'"},
    {ROBOT("<link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/>"
           "<child link='b'/></joint><joint name='k' type='continuous'><parent link='a'/><child "
           "link='b'/></joint>"),
     "two parents"},
    {ROBOT(
         "<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1'/></inertial></link>"),
     "'izz' is missing"},
};

static void each_is_refused_with_its_line_and_reason(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        hn_status status;
        const char *message = imported_fault(BAD[i].text, NULL, &status);
        if (status != HN_ERR_INPUT || !strstr(message, BAD[i].says) || !strstr(message, "line ")) {
            fail_msg("%zu: %s: '%s' does not say '%s'", i, hn_status_name(status), message,
                     BAD[i].says);
        }
    }
}

static void loop_files_are_checked_too(void **state) {
    (void)state;
    static const char robot[] = ROBOT("<link name='a'/>");
    static const struct {
        const char *text, *says;
    } bad[] = {{"", "loop file"},
               {"[]", "expected an object"},
               {"{\"holonom_loops\": 2}", "version"},
               {"{\"holonom_loops\": 1, \"joins\": []}", "unknown field"},
               {"{\"holonom_loops\": 1, \"joints\": {}}", "expected a list"},
               {"{\"holonom_loops\": 1, \"joints\": [{\"name\": \"B\", \"type\": \"revolute\", "
                "\"parent\": {\"body\": \"a\"}, \"child\": {\"body\": \"nobody\"}}]}",
                "loop file: there is no body named 'nobody'"},
               {"{\"holonom_loops\": 1, \"gravity\": [1, 2]}", "three numbers"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        hn_status status;
        const char *message = imported_fault(robot, bad[i].text, &status);
        assert_int_equal(status, HN_ERR_INPUT);
        if (!strstr(message, bad[i].says)) {
            fail_msg("%zu: '%s' does not say '%s'", i, message, bad[i].says);
        }
    }
}

static void nesting_and_size_are_bounded(void **state) {
    (void)state;
    enum { DEEP = 200, MANY = HN_SCENE_MAX_BODIES + 1, ROOM = 1 << 19 };
    static const char body[] = "<body><joint/><geom size='1' contype='0' conaffinity='0'/>";
    char *text = malloc(ROOM);
    hn_status status;
    assert_non_null(text);
    int n = snprintf(text, ROOM, "<mujoco><worldbody>");
    for (int i = 0; i < DEEP; i++) {
        n += snprintf(text + n, (size_t)(ROOM - n), "<body>");
    }
    for (int i = 0; i < DEEP; i++) {
        n += snprintf(text + n, (size_t)(ROOM - n), "</body>");
    }
    (void)snprintf(text + n, (size_t)(ROOM - n), "</worldbody></mujoco>");
    const char *message = imported_fault(text, NULL, &status);
    assert_int_equal(status, HN_ERR_LIMIT);
    assert_non_null(strstr(message, "nested"));

    n = snprintf(text, ROOM, "<mujoco><worldbody>");
    for (int i = 0; i < MANY; i++) {
        n += snprintf(text + n, (size_t)(ROOM - n), "%s</body>", body);
    }
    (void)snprintf(text + n, (size_t)(ROOM - n), "</worldbody></mujoco>");
    message = imported_fault(text, NULL, &status);
    assert_int_equal(status, HN_ERR_INPUT);
    assert_non_null(strstr(message, "more than 4000 bodies"));
    free(text);
}

/// A file cut off anywhere is refused, never half read.
static void a_file_cut_off_anywhere_is_refused(void **state) {
    (void)state;
    char *text = imported_text("stewart.xml");
    for (size_t n = strlen(text) - 3; n > 40; n -= 37) {
        hn_status status;
        text[n] = '\0';
        const char *message = imported_fault(text, NULL, &status);
        assert_int_equal(status, HN_ERR_INPUT);
        assert_non_null(strstr(message, "line "));
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_is_refused_with_its_line_and_reason),
        cmocka_unit_test(loop_files_are_checked_too),
        cmocka_unit_test(nesting_and_size_are_bounded),
        cmocka_unit_test(a_file_cut_off_anywhere_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
