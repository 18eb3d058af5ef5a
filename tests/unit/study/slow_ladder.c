// SPDX-License-Identifier: GPL-3.0-or-later
// The ladder of N four-bars: what a step costs as N grows, and who comes through its flat poses.

#include "formulations/list/formulation_list.h"
#include "support/ladder.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>

static void a_step_costs_the_same_for_each_loop_however_many_there_are(void **state) {
    (void)state;
    static const char *const methods[] = {
        "index1@rk4:h=1e-3",    "baumgarte@rk4:h=1e-3",           "projection@rk4:h=1e-3",
        "nullspace@rk4:h=1e-3", "partitioning@rk4:h=1e-3",        "reduced@rk4:h=1e-3",
        "penalty@rk4:h=1e-3",   "augmented-lagrangian@rk4:h=1e-3"};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        hn_ladder_check_cost(methods[k], 0.025, 100);
    }
}

static void the_exact_motion_is_the_published_one(void **state) {
    (void)state;
    static hn_ladder_motion motion;
    // one turn of N = 1 takes 1.92371181733896585 s (elliptic functions)
    hn_ladder_motion_fill(&motion, 1, 1.92371181733896585);
    assert_near(motion.b[HN_LADDER_GRID], 6.28318530717958648, 1e-11);
    assert_near(motion.rate[HN_LADDER_GRID], 1, 1e-11);
    // N = 2 after 10 s: x of the first tip, published for the double four-bar, to the digits it has
    // at h = 1.25e-4
    hn_ladder_motion_fill(&motion, 2, 10);
    assert_near(sin(hn_ladder_motion_angle(&motion, 10)), 0.32845738, 1e-6);
}

static void projection_survives_every_step_size(void **state) {
    (void)state;
    static hn_ladder_motion motion;
    static const int sizes[] = {1, 2, 10}, steps[] = {60, 40, 12};
    for (int i = 0; i < 3; i++) {
        char setting[16];
        hn_model m;
        snprintf(setting, sizeof setting, "N=%d", sizes[i]);
        hn_model_open_closed(&m, "n-four-bar", setting);
        hn_ladder_motion_fill(&motion, sizes[i], 10);
        for (int k = 0; k < steps[i]; k++) {
            char method[64];
            double worst = 0;
            snprintf(method, sizeof method, "projection@rk4:h=%.17g", hn_ladder_step(k, steps[i]));
            if (hn_ladder_run(&m, &motion, method, &worst) != HN_SURVIVAL_SURVIVED) {
                fail_msg("N = %d, %s: %g m from the exact motion", sizes[i], method, worst);
            }
        }
        hn_model_close(&m);
    }
}

static void nobody_is_silent_on_the_other_branch(void **state) {
    (void)state;
    static hn_ladder_motion motion;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    hn_ladder_motion_fill(&motion, 1, 10);
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        if (f->form != HN_FORM_ODE) {
            continue;
        }
        for (int k = 0; k < 25; k++) {
            char method[64];
            snprintf(method, sizeof method, "%s@rk4:h=%.17g", f->name, hn_ladder_step(k, 25));
            if (hn_ladder_run(&m, &motion, method, NULL) == HN_SURVIVAL_SILENT) {
                fail_msg("%s left the branch and did not say so", method);
            }
        }
    }
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_costs_the_same_for_each_loop_however_many_there_are),
        cmocka_unit_test(the_exact_motion_is_the_published_one),
        cmocka_unit_test(projection_survives_every_step_size),
        cmocka_unit_test(nobody_is_silent_on_the_other_branch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
