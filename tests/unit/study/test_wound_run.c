// SPDX-License-Identifier: GPL-3.0-or-later
// Angles that have wound up: a crank many turns ahead is the same mechanism.
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

#define TURNS 8000.0 // of 10,000 s: angles of 5e4 rad have 11 digits behind the point

static void state_at(const hn_model *m, const char *method, const double *q, double t,
                     double *out) {
    hn_run *run = hn_motion_start_at(m, method, q, m->v);
    const hn_sample s = hn_motion_at(run, t);
    memcpy(out, s.q, (size_t)m->info.n_user * sizeof *out);
    hn_run_free(run);
}

static void a_crank_many_turns_ahead_is_the_same_mechanism(void **state) {
    (void)state;
    static const char *const methods[] = {
        "index1@rk4:h=0.005",
        "projection@rk4:h=0.005",
        "projection@dop853:rtol=1e-9",
        "symmetric-projection@midpoint:h=0.005",
        "nullspace@rk4:h=0.005",
        "nullspace-tangent@rk4:h=0.005",
        "partitioning@gauss2:h=0.005",
        "reduced@rk4:h=0.005",
        "ggl@radau5:rtol=1e-9",
        "index3@genalpha:h=0.005",
        "augmented-lagrangian@rk4:h=0.005",
    };
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        double q[3], here[3], wound[3];
        const double way = 2 * M_PI * TURNS, shift[3] = {way, -way, 0};
        state_at(&m, methods[i], m.q, 2, here);
        for (int k = 0; k < 3; k++) {
            q[k] = m.q[k] + shift[k];
        }
        state_at(&m, methods[i], q, 2, wound);
        for (int k = 0; k < 3; k++) {
            // what the last bits of the angles become in two turns; tolerances relative to an angle
            // would be looser by four digits
            const double off = remainder(wound[k] - here[k], 2 * M_PI);
            if (!(fabs(off) < 1e-6)) {
                fail_msg("%s: coordinate %d is %.3g rad off", methods[i], k, off);
            }
        }
    }
    hn_model_close(&m);
}

// The iteration of the symmetric projection alone needs ever more turns on a fast crank; helped by
// Broyden's method it converges. Where the motion runs back on its way its energy error is bounded,
// on a crank that turns one way round it grows: what the method's text says.
static void the_symmetric_projection_keeps_the_energy_of_a_swing(void **state) {
    (void)state;
    static const char method[] = "symmetric-projection@midpoint:h=0.01";
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run_summary s = hn_motion_summary(&m, method, 20);
    assert_int_equal(s.status, HN_OK);
    const double after_20 = s.worst_energy_change;
    s = hn_motion_summary(&m, method, 60);
    assert_true(s.worst_energy_change > 1.2 * after_20);
    hn_model_close(&m);

    hn_model_open_closed(&m, "four-bar", "w1_0=0 th1_0=-1");
    s = hn_motion_summary(&m, method, 5);
    const double after_5 = s.worst_energy_change;
    s = hn_motion_summary(&m, method, 60);
    assert_true(s.worst_energy_change < 1.1 * after_5);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crank_many_turns_ahead_is_the_same_mechanism),
        cmocka_unit_test(the_symmetric_projection_keeps_the_energy_of_a_swing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
