// SPDX-License-Identifier: GPL-3.0-or-later
// Index 2 with rows that depend on each other: Bennett's loop, five rows of rank two, keeps closed
// and keeps its energy.

#include "support/model.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>

typedef struct trial {
    const char *method;
    double
        // error allowed after 2 s [J], of some 10 J of kinetic energy: ten times what the order
        // leaves
        energy;
} trial;

static void dependent_rows_are_closed_after_each_step(void **state) {
    (void)state;
    static const trial trials[] = {{"index2@midpoint:h=1e-3", 1e-4},
                                   {"index2@radau3:h=1e-3", 1e-6},
                                   {"index2@radau5:h=1e-3", 1e-8},
                                   {"index2@hem3:h=1e-3", 3e-6},
                                   {"index2@hem4:h=1e-3", 1e-8}};
    hn_model m;
    hn_model_open_closed(&m, "bennett", NULL);
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        hn_run *run = hn_motion_start(&m, trials[i].method);
        const double start = hn_motion_at(run, 0).energy;
        const hn_sample end = hn_motion_at(run, 2);
        assert_true(end.gap < 1e-13);
        assert_near(end.energy, start, trials[i].energy);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// on the four-bar no row depends on another: without `close` the gap opens, with it the gap is that
// of the last steps alone
static void positions_are_projected_every_so_many_steps_on_request(void **state) {
    (void)state;
    static const char *const methods[] = {"index2@hem3:h=1e-2", "index2:close=1@hem3:h=1e-2",
                                          "index2@midpoint:h=1e-2",
                                          "index2:close=1@midpoint:h=1e-2"};
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (int i = 0; i < 4; i++) {
        hn_run *run = hn_motion_start(&m, methods[i]);
        const double gap = hn_motion_at(run, 1).gap;
        assert_true(i % 2 == 0 ? gap > 1e-7 : gap < 1e-14);
        hn_run_free(run);
    }
    hn_run *third = hn_motion_start(&m, "index2:close=4@hem3:h=1e-2");
    assert_true(hn_motion_at(third, 0.99).gap > 1e-10);
    assert_true(hn_motion_at(third, 1).gap < 1e-14);
    hn_run_free(third);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dependent_rows_are_closed_after_each_step),
        cmocka_unit_test(positions_are_projected_every_so_many_steps_on_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
