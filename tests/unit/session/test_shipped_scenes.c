// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene of the library, at random states near its start and in motion: facts that hold for
// any mechanism.

#include "session/model/model.h"
#include "study/run/run.h"
#include "support/near.h"
#include "support/shipped.h"
#include "support/shipped_library.h"

#include <math.h>
#include <stdio.h>

static void every_shipped_scene_obeys_mechanics_near_its_start(void **state) {
    (void)state;
    for (int scene = 0; scene < hn_library_n_scenes(hn_test_library); scene++) {
        shipped_obeys_mechanics(hn_test_library, scene, 4);
    }
}

/// Two seconds with steps of 2 ms, or as long and as finely as a quicker scene suggests.
static void every_shipped_scene_runs_two_seconds_by_two_methods(void **state) {
    (void)state;
    static const char *const methods[] = {"index1@rk4:h=%.3g", "projection@rk4:h=%.3g"};
    for (int scene = 0; scene < hn_library_n_scenes(hn_test_library); scene++) {
        for (int k = 0; k < 2; k++) {
            hn_model *model = NULL;
            hn_diags diags = {0};
            const hn_model_source source = {.name = hn_library_scene_id(hn_test_library, scene)};
            assert_int_equal(hn_model_load(hn_test_library, &source, &model, &diags), HN_OK);
            hn_method_spec spec = {0};
            hn_diag diag = {0};
            hn_run *run = NULL;
            const hn_scene *s = hn_model_scene(model);
            char method[64];
            snprintf(method, sizeof method, methods[k], fmin(2e-3, s->step));
            assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
            assert_int_equal(hn_run_create(hn_model_system(model), &spec, hn_model_q(model),
                                           hn_model_v(model), NULL, &run, &diag),
                             HN_OK);
            if (hn_run_advance(run, fmin(2, s->duration)) != HN_OK) {
                fail_msg("%s by %s: %s", source.name, method, hn_run_get_summary(run).reason);
            }
            // a change point, met head-on, is the one place where loops stay open by what phi can
            // tell there
            assert_true(k == 0 || hn_run_get_summary(run).worst_gap < 1e-6);
            hn_run_free(run);
            hn_model_free(model);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shipped_scene_obeys_mechanics_near_its_start),
        cmocka_unit_test(every_shipped_scene_runs_two_seconds_by_two_methods),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
