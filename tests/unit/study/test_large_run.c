// SPDX-License-Identifier: GPL-3.0-or-later
// Methods that choose coordinates, on a ladder of more than a hundred velocities, where they choose
// them sparsely: the bars stay beside its exact motion, and no dense solve answers.

#include "study/run/run.h"
#include "support/ladder.h"
#include "support/motion.h"
#include "support/near.h"

enum { LOOPS = 60 };
static const double DURATION = 0.1; // [s]

static void every_method_follows_the_exact_motion_of_a_large_ladder(void **state) {
    (void)state;
    static hn_ladder_motion motion;
    static const char *const methods[] = {"partitioning@rk4:h=1e-3", "reduced@rk4:h=1e-3",
                                          "nullspace@rk4:h=1e-3", "projection@rk4:h=1e-3",
                                          "index1@rk4:h=1e-3"};
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=60");
    hn_ladder_motion_fill(&motion, LOOPS, DURATION);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        double worst = 999;
        assert_int_equal(hn_ladder_run(&m, &motion, methods[k], &worst), HN_SURVIVAL_SURVIVED);
        assert_true(worst < 1e-7); // the interpolation of the exact motion is good to that
        hn_run *run = hn_motion_start(&m, methods[k]);
        assert_int_equal(hn_run_advance(run, DURATION), HN_OK);
        assert_int_equal(hn_run_get_summary(run).cost.fallbacks, 0);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_method_follows_the_exact_motion_of_a_large_ladder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
