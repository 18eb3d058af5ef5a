// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms that are moved from outside: where every freedom is prescribed nothing but the drive
// says how large a step may be.

#include "support/model.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>

// a double pendulum of which both angles are prescribed: a = 3 t + sin(5 t) / 5, b = sin^2 a + t /
// 10
static const char PUPPET[] =
    "{\"holonom\": 1, \"name\": \"puppet\", \"gravity\": [0, -9.81, 0], \"bodies\": ["
    "{\"name\": \"upper\", \"mass\": 1, \"com\": [0.5, 0], \"inertia\": {\"zz\": 0.0833}},"
    "{\"name\": \"lower\", \"mass\": 1, \"com\": [0.5, 0], \"inertia\": {\"zz\": 0.0833}}], "
    "\"joints\": ["
    "{\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\"},"
    " \"child\": {\"body\": \"upper\"}, \"coordinate\": \"a\"},"
    "{\"name\": \"B\", \"type\": \"revolute\", \"parent\": {\"body\": \"upper\", \"at\": [1, 0]},"
    " \"child\": {\"body\": \"lower\"}, \"coordinate\": \"b\"}], \"constraints\": ["
    "{\"motion\": {\"joint\": \"A\", \"value\": \"3*t + 0.2*sin(5*t)\"}},"
    "{\"formula\": \"b - sin(a)^2 - 0.1*t\"}]}";

static double error_at(const hn_model *m, const char *method, double t) {
    const double a = 3 * t + 0.2 * sin(5 * t), b = sin(a) * sin(a) + 0.1 * t;
    hn_run *run = hn_motion_start(m, method);
    const hn_sample s = hn_motion_at(run, t);
    const double error = fmax(fabs(s.q[0] - a), fabs(s.q[1] - b));
    hn_run_free(run);
    return error;
}

// between the ends of steps too: a tolerance bounds what interpolation leaves there, the tolerance
// over its weight (hn_collocation_estimate_weight) times ten for the times that are not the one
// looked at
static void steps_follow_the_drive_where_nothing_else_moves(void **state) {
    (void)state;
    static const struct {
        const char *method;
        double error;
    } trials[] = {{"ggl@radau5:rtol=1e-4", 2e-3},    {"ggl@radau5:rtol=1e-8", 5e-6},
                  {"index2@radau5:rtol=1e-4", 2e-3}, {"index2@radau5:rtol=1e-8", 5e-6},
                  {"index3@radau5:rtol=1e-4", 2e-3}, {"index3@radau5:rtol=1e-8", 5e-6}};
    hn_model m;
    hn_model_open_text(&m, PUPPET, NULL);
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        for (int k = 1; k <= 5; k++) {
            const double error = error_at(&m, trials[i].method, 0.37 * k);
            if (!(error < trials[i].error)) {
                fail_msg("%s at t = %g s: %.3g", trials[i].method, 0.37 * k, error);
            }
        }
    }
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_follow_the_drive_where_nothing_else_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
