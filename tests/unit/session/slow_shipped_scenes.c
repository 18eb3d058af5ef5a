// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene of the library at many random states near its start; its energy changes by the work
// of its drives, dampers and loads, and else by the order only.

#include "session/model/model.h"
#include "study/run/run.h"
#include "support/near.h"
#include "support/shipped.h"
#include "support/shipped_library.h"

#include <math.h>
#include <stdio.h>

static void every_shipped_scene_obeys_mechanics_at_twenty_states(void **state) {
    (void)state;
    for (int scene = 0; scene < hn_library_n_scenes(hn_test_library); scene++) {
        shipped_obeys_mechanics(hn_test_library, scene, 20);
    }
}

/// The largest change of energy, less the work done, over 0.4 s, or as long as a quicker scene
/// suggests.
static double energy_change(const hn_model *model, const char *id, double h) {
    hn_method_spec spec = {0};
    hn_diag diag = {0};
    hn_run *run = NULL;
    char method[64];
    snprintf(method, sizeof method, "projection@rk4:h=%.17g", h);
    assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
    assert_int_equal(hn_run_create(hn_model_system(model), &spec, hn_model_q(model),
                                   hn_model_v(model), NULL, &run, &diag),
                     HN_OK);
    hn_run_watch(run, 1);
    if (hn_run_advance(run, fmin(0.4, hn_model_scene(model)->duration)) != HN_OK) {
        fail_msg("%s by %s: %s", id, method, hn_run_get_summary(run).reason);
    }
    const double change = hn_run_get_summary(run).worst_energy_change;
    hn_run_free(run);
    return change;
}

// Order four: half the step, a sixteenth of the change, but for terms of the next order and where
// rounding is all there is. On a free rotation the leading term keeps the energy: a thirty-second.
static void energy_is_kept_to_the_order_of_the_method(void **state) {
    (void)state;
    int seen = 0;
    for (int scene = 0; scene < hn_library_n_scenes(hn_test_library); scene++) {
        hn_model *model = NULL;
        hn_diags diags = {0};
        const hn_model_source source = {.name = hn_library_scene_id(hn_test_library, scene)};
        assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_OK);
        const hn_scene *s = hn_model_scene(model);
        const double coarse = energy_change(model, source.name, 4 * s->step);
        const double fine = energy_change(model, source.name, 2 * s->step);
        if (fine > 1e-11 && !(coarse / fine > 13 && coarse / fine < 40)) {
            fail_msg("%s: %.3g J, with half the step %.3g J: ratio %.3g", source.name, coarse, fine,
                     coarse / fine);
        }
        seen += fine > 1e-11;
        hn_model_free(model);
    }
    assert_true(seen >= 25);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shipped_scene_obeys_mechanics_at_twenty_states),
        cmocka_unit_test(energy_is_kept_to_the_order_of_the_method),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
