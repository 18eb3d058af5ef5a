// SPDX-License-Identifier: GPL-3.0-or-later
// The tables that say what a type of joint is made of agree: its degrees of freedom, its chain of
// links, and the steps by which it is written as MJCF and URDF.
#include "support/near.h"

#include "dynamics/compile/tree.h"
#include "scene/joint_freedoms.h"
#include "session/export/start_poses.h"

static int freedoms_of_links(hn_joint_type type) {
    const hn_primitive *chain;
    int freedoms = 0;
    const int n = hn_joint_primitives(type, &chain);
    for (int i = 0; i < n; i++) {
        freedoms += chain[i].type == HN_JOINT_SPHERICAL ? 3 : chain[i].type != HN_JOINT_FIXED;
    }
    return freedoms;
}

static int freedoms_of_steps(hn_joint_type type) {
    int n, freedoms = 0;
    const hn_joint_step *step = hn_joint_steps(type, &n);
    for (int i = 0; i < n; i++) {
        freedoms += step[i].kind == HN_POSE_BALL ? 3 : 1;
    }
    return freedoms;
}

static void every_type_has_as_many_freedoms_in_each_table(void **state) {
    (void)state;
    for (int type = 0; type < HN_JOINT_TYPE_COUNT; type++) {
        int n;
        const hn_freedom *freedoms = hn_joint_freedoms((hn_joint_type)type, &n);
        assert_int_equal(freedoms_of_links((hn_joint_type)type), n);
        assert_int_equal(freedoms_of_steps((hn_joint_type)type), n);
        for (int i = 0; i < n; i++) {
            assert_non_null(freedoms[i].suffix);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_has_as_many_freedoms_in_each_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
