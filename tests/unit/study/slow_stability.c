// SPDX-License-Identifier: GPL-3.0-or-later
// Dormand-Prince 5 on an undamped vibration: a step at 1.05 of the limit grows by 3e-5 only, so
// that it takes 100,000 steps to see on which side of the limit one is.
#include "study/stability/stability.h"

#include "support/model.h"
#include "support/near.h"

#include <stdio.h>

static void dopri5_is_stable_at_95_percent_of_the_predicted_limit_and_not_at_105(void **state) {
    (void)state;
    // slow and small, so that the spectrum stays what it is at the start: 1e-6 would count here
    static const char *const scenes[][2] = {{"stiff-four-bar", "w=1e-3"},
                                            {"stiff-slider-crank", "w=1e-3"}};
    const hn_walk_limits limits = {300, NULL, NULL};
    const double steps = 1e5;
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_stability_path *path;
        hn_method_spec spec;
        hn_diag diag = {0};
        hn_eigenvalue fastest;
        hn_spectrum *spectrum;
        const hn_eigenvalue *values;
        int n;
        hn_model_open_closed(&m, scenes[k][0], scenes[k][1]);
        assert_int_equal(hn_spectrum_create(m.sys, m.arena, &spectrum), HN_OK);
        assert_int_equal(hn_spectrum_calc(spectrum, 0, m.q, m.v, &values, &n), HN_OK);
        fastest = values[0];
        hn_spectrum_free(spectrum);
        const double T = steps * 0.997189 / fastest.im;
        assert_int_equal(hn_stability_path_create(m.sys, m.q, m.v, T, &limits, &path, &diag),
                         HN_OK);
        assert_int_equal(hn_method_parse("projection@dopri5:h=1e-3", &spec, &diag), HN_OK);
        const hn_stability_forecast f = hn_stability_predict(path, &spec, (long long)steps);
        assert_rel(f.limit, 0.997189 / fastest.im, 1e-2);
        for (int side = 0; side < 2; side++) {
            char text[HN_SPEC_MAX];
            hn_stability_trial t;
            snprintf(text, sizeof text, "projection@dopri5:h=%.17g",
                     (side ? 1.05 : 0.95) * f.limit);
            assert_int_equal(hn_method_parse(text, &spec, &diag), HN_OK);
            assert_int_equal(hn_stability_try(path, &spec, &limits, &t), 1);
            if (hn_stability_is_stable(t.kind) == side) {
                fail_msg("%s %s: %s, %s", scenes[k][0], text, hn_stability_class_name(t.kind),
                         t.reason);
            }
        }
        hn_stability_path_free(path);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dopri5_is_stable_at_95_percent_of_the_predicted_limit_and_not_at_105),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
