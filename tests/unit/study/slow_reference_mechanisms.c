// SPDX-License-Identifier: GPL-3.0-or-later
// Example mechanisms of other programs, with their published figures and with states that were
// found by two independent
// computations: Drake, the Modelica Standard Library, Exudyn.

#include "support/near.h"
#include "support/reference.h"

static void the_four_bar_of_drake_swings_like_its_reference(void **state) {
    (void)state;
    hn_reference_check("drake-four-bar");
}

static void the_engine_of_modelica_turns_like_its_reference(void **state) {
    (void)state;
    hn_reference_check("engine1a");
}

static void the_point_masses_move_like_their_reference_from_rates_that_could_not_be(void **state) {
    (void)state;
    hn_reference_check("fourbar-point-masses");
}

static void the_slider_crank_passes_all_its_dead_centres(void **state) {
    (void)state;
    hn_reference_check("planar-slider-crank");
}

static void the_four_bar_of_drake_rests_at_its_published_angles(void **state) {
    (void)state;
    static const double degrees[3] = {75.52, 104.48, 104.48}; // relative angle of the coupler
    static const char *const names[3] = {"qA", "qB", "qC"};
    hn_model m;
    hn_model_open_closed(&m, "drake-four-bar", "w0=0");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    for (int k = 0; k <= 1; k++) {
        hn_sample s = hn_motion_at(run, k);
        for (int i = 0; i < 3; i++) {
            int at = hn_model_user(&m, names[i]);
            assert_near(s.q[at] * 180 / 3.14159265358979323846, degrees[i], 0.005);
            assert_near(s.v[at], 0, 1e-13);
            assert_near(s.a[at], 0, 1e-13); // g / L is 2.5
        }
    }
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_four_bar_of_drake_swings_like_its_reference),
        cmocka_unit_test(the_four_bar_of_drake_rests_at_its_published_angles),
        cmocka_unit_test(the_engine_of_modelica_turns_like_its_reference),
        cmocka_unit_test(the_point_masses_move_like_their_reference_from_rates_that_could_not_be),
        cmocka_unit_test(the_slider_crank_passes_all_its_dead_centres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
