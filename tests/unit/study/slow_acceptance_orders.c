// SPDX-License-Identifier: GPL-3.0-or-later
// Every fixed-step formulation with every fixed-step integrator converges with the integrator's
// order: slopes fitted over six steps against the reference four-bar at t = 1, known to 18 digits.

#include "support/model.h"
#include "support/near.h"
#include "support/order_runs.h"

#include <math.h>
#include <stdio.h>

enum { STEPS = 6 };

static void every_pair_converges_with_the_order_of_its_integrator(void **state) {
    (void)state;
    static const char *const formulations[] = {
        "index1",  "baumgarte:alpha=5,beta=5", "projection",    "nullspace", "partitioning",
        "reduced", "augmented-lagrangian",     "udwadia-kalaba"};
    static const struct {
        const char *name;
        double order, first; // largest step, where the error has settled into its power of h
    } integrators[] = {{"euler", 1, 1e-3},
                       {"symplectic-euler", 1, 1e-3},
                       {"heun", 2, 4e-3},
                       {"verlet", 2, 2e-3},
                       {"rk4", 4, 1e-2}};
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    const double th1 = 2.72677524435372249, th2 = 0.434120794394454479, th3 = 2.37837623328492433;
    double q[3];
    q[hn_model_user(&m, "th1")] = th1;
    q[hn_model_user(&m, "a2")] = th2 - th1;
    q[hn_model_user(&m, "th3")] = th3;

    for (size_t f = 0; f < sizeof formulations / sizeof *formulations; f++) {
        for (size_t i = 0; i < sizeof integrators / sizeof *integrators; i++) {
            char method[128];
            hn_method_spec spec;
            hn_order_runs runs;
            hn_diag diag = {0};
            (void)snprintf(method, sizeof method, "%s@%s:h=%g", formulations[f],
                           integrators[i].name, integrators[i].first);
            assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
            hn_order_runs_make(m.sys, &spec, m.q, m.v, 1, STEPS, q, 1e-13, &runs);
            if (!(fabs(runs.order - integrators[i].order) <= 0.2)) {
                fail_msg("%s: order %.3f, errors %.2e ... %.2e", method, runs.order, runs.error[0],
                         runs.error[STEPS - 1]);
            }
        }
    }
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_converges_with_the_order_of_its_integrator),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
