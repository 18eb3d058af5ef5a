// SPDX-License-Identifier: GPL-3.0-or-later
// The ladder of N four-bars by integrators with Newton matrices: what a step costs for each loop as
// N grows.

#include "support/ladder.h"
#include "support/near.h"

// A dense factorisation costs 400 times as much a loop when there are 20 times as many; 1.5 leaves
// room for an iteration more.
static void a_newton_step_costs_the_same_for_each_loop_however_many_there_are(void **state) {
    (void)state;
    static const char *const methods[] = {
        "ggl@radau5:h=1e-3",        "index2@radau5:h=1e-3",
        "index3@radau5:h=1e-3",     "index2@midpoint:h=1e-3",
        "index3@genalpha:h=1e-3",   "ggl@genalpha:h=1e-3",
        "index3@rattle:h=1e-3",     "index2@hem3:h=1e-3",
        "index2@hem4:h=1e-3",       "index1@radau5:h=1e-3",
        "projection@gauss2:h=1e-3", "baumgarte@midpoint:h=1e-3",
        "penalty@radau3:h=1e-3",    "augmented-lagrangian@implicit-euler:h=1e-3",
        "ali3p@trapezoidal:h=1e-3", "index1@ida:rtol=1e-6",
        "index2@ida:rtol=1e-6",     "ggl@ida:rtol=1e-6",
        "baumgarte@ida:rtol=1e-6"};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        hn_ladder_check_cost(methods[k], 0.01, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_newton_step_costs_the_same_for_each_loop_however_many_there_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
