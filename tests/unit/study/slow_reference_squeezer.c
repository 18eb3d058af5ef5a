// SPDX-License-Identifier: GPL-3.0-or-later
// Two problems of the test set for initial value problems: Andrews' seven-body squeezer, as bodies
// and joints and as a Lagrangian, and the car axis, whose road moves. Hairer & Wanner 1996, VII.7;
// Mazzia & Magherini 2008.

#include "support/near.h"
#include "support/reference.h"

#include <math.h>

static void the_squeezer_meets_its_reference_at_all_times(void **state) {
    (void)state;
    hn_reference_check("andrews");
}

static void the_car_axis_meets_its_reference_at_all_times(void **state) {
    (void)state;
    hn_reference_check("caraxis");
}

/// By each component's own size, which is harder than by the largest it takes: gamma is 0.04 there,
/// beta 16.
static void must_have_twelve_digits(const double *found, const double *exact, int n) {
    for (int i = 0; i < n; i++) {
        assert_rel(found[i], exact[i], 1e-12);
    }
}

static void the_squeezer_ends_with_twelve_digits_in_every_coordinate(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@dopri5:rtol=1e-14", "partitioning@rk4:h=1e-6",
                                          "nullspace@rk4:h=1e-6"};
    static const double q[7] = {15.8107711951537,  -15.7563710584118, 0.0408222401196458,
                                -0.53473011634208, 0.524409965879954, 0.53473011634208,
                                1.04808074104194};
    hn_reference *r = hn_reference_open("andrews");
    hn_reference_state exact = hn_reference_trusted(r, 0.03);
    must_have_twelve_digits(exact.x[HN_REFERENCE_Q], q, 7);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        hn_reference_state end =
            hn_reference_run_to(r, hn_reference_scene(r, (int)i % 2), methods[i], 0.03);
        must_have_twelve_digits(end.x[HN_REFERENCE_Q], exact.x[HN_REFERENCE_Q], 7);
        assert_rel(end.x[HN_REFERENCE_V][0], 1139.92030225910607, 1e-12);
    }
    hn_reference_close(r);
}

static void
the_squeezer_starts_with_the_accelerations_and_multipliers_of_the_test_set(void **state) {
    (void)state;
    static const double a[7] = {14222.4439199541, -10666.8329399656};
    static const double lambda[6] = {98.5668703962411, -6.12268834425567};
    hn_reference *r = hn_reference_open("andrews");
    for (int i = 0; i < hn_reference_scenes(r); i++) {
        hn_model m;
        hn_model_open_closed(&m, hn_reference_scene(r, i), NULL);
        hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-6");
        hn_sample s = hn_motion_at(run, 0);
        static const char *const names[7] = {"beta",  "Theta", "gamma",  "Phi",
                                             "delta", "Omega", "epsilon"};
        for (int k = 0; k < 7; k++) {
            assert_near(s.a[hn_model_user(&m, names[k])], a[k], 1e-12 * a[0]);
        }
        for (int k = 0; k < 6; k++) {
            assert_near(-s.lambda[k], lambda[k], 1e-12 * lambda[0]); // theirs has the other sign
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
    hn_reference_close(r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_squeezer_meets_its_reference_at_all_times),
        cmocka_unit_test(the_squeezer_ends_with_twelve_digits_in_every_coordinate),
        cmocka_unit_test(
            the_squeezer_starts_with_the_accelerations_and_multipliers_of_the_test_set),
        cmocka_unit_test(the_car_axis_meets_its_reference_at_all_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
