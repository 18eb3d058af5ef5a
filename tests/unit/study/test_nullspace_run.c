// SPDX-License-Identifier: GPL-3.0-or-later
// The null-space forms as whole runs: with the basis by partition, orthonormal and carried along,
// in tangent-space coordinates, and with a basis that nobody tracks.

#include "study/cost/convergence.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_Q = 64 };

static const char *const sound[] = {"nullspace", "nullspace:basis=orthonormal",
                                    "nullspace-tangent"};
enum { SOUND = 3 };

// user coordinates at t
static void state_at(const hn_model *m, const char *method, double t, double *q) {
    hn_run *run = hn_motion_start(m, method);
    const hn_sample s = hn_motion_at(run, t);
    assert_true(m->info.nv <= MAX_Q);
    memcpy(q, s.q, (size_t)m->info.nv * sizeof *q);
    hn_run_free(run);
}

static double error_of(const hn_model *m, const char *formulation, double h, double t,
                       const double *exact) {
    char method[96];
    double q[MAX_Q], error = 0;
    (void)snprintf(method, sizeof method, "%s@rk4:h=%.17g", formulation, h);
    state_at(m, method, t, q);
    for (int i = 0; i < m->info.nv; i++) {
        error = fmax(error, fabs(q[i] - exact[i]));
    }
    return error;
}

// one freedom, two, balls, redundant rows (three too many; one written twice), rows that move in
// time
static void every_form_has_the_order_of_rk4_whatever_the_mechanism(void **state) {
    (void)state;
    static const struct {
        const char *scene;
        double h, t;
    } cases[] = {{"fb0", 1e-2, 1},     {"five-bar", 8e-3, 0.8},    {"rssr", 2e-3, 0.5},
                 {"bennett", 8e-3, 1}, {"fb0-redundant", 1e-2, 1}, {"heavy-top", 2e-3, 0.5}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        hn_model m;
        double exact[MAX_Q], h[3], error[3];
        hn_model_open_closed(&m, cases[c].scene, NULL);
        state_at(&m, "projection@dop853:rtol=1e-13", cases[c].t, exact);
        for (int f = 0; f < SOUND; f++) {
            for (int k = 0; k < 3; k++) {
                h[k] = ldexp(cases[c].h, -k);
                error[k] = error_of(&m, sound[f], h[k], cases[c].t, exact);
            }
            const double order = hn_fit_order(3, h, error);
            // signed errors of two kinds may cancel at one of three steps
            if (!(order > 3.4 && order < 5.1)) {
                fail_msg("%s by %s: order %.2f, errors %.2e %.2e %.2e", cases[c].scene, sound[f],
                         order, error[0], error[1], error[2]);
            }
        }
        hn_model_close(&m);
    }
}

static void gap_and_speed_gap_stay_at_rounding(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "five-bar", NULL);
    for (int f = 0; f < SOUND; f++) {
        char method[96];
        (void)snprintf(method, sizeof method, "%s@rk4:h=5e-3", sound[f]);
        const hn_run_summary s = hn_motion_summary(&m, method, 2);
        // rounding of twelve links one after the other
        assert_true(s.worst_gap < 1e-14);          // metres
        assert_true(s.worst_velocity_gap < 1e-13); // of speeds up to 10 m/s
    }
    hn_model_close(&m);
}

// a light crank and a heavy slider: with the slider's place as the independent coordinate, taken
// almost to its dead points, the error was 1500 times that of projection
static void a_heavy_slider_is_not_kept_to_its_dead_points(void **state) {
    (void)state;
    hn_model m;
    double exact[MAX_Q];
    hn_model_open_closed(&m, "spatial-slider-crank", NULL);
    state_at(&m, "projection@dop853:rtol=1e-13", 2, exact);
    const double measure = error_of(&m, "projection", 1e-3, 2, exact);
    assert_true(measure < 2e-6);
    for (int f = 0; f < SOUND; f++) {
        assert_true(error_of(&m, sound[f], 1e-3, 2, exact) < 3 * measure);
    }
    assert_true(error_of(&m, "partitioning", 1e-3, 2, exact) < 3 * measure);
    hn_model_close(&m);
}

static void a_basis_that_nobody_tracks_turns_the_motion_round_at_every_step_size(void **state) {
    (void)state;
    hn_model m;
    double exact[MAX_Q];
    hn_model_open_closed(&m, "fb0", NULL);
    state_at(&m, "projection@dop853:rtol=1e-13", 2, exact);
    for (double h = 4e-3; h > 5e-4; h /= 2) {
        // radians; an independent program with other factorisations had 4.3
        assert_true(error_of(&m, "nullspace-untracked", h, 2, exact) > 1);
    }
    assert_true(hn_motion_summary(&m, "nullspace-untracked@rk4:h=1e-3", 2).worst_gap < 4e-15);
    // carried along, the same basis serves
    assert_true(error_of(&m, "nullspace:basis=orthonormal", 1e-3, 2, exact) < 1e-10);
    hn_model_close(&m);
}

// samples between steps of an integrator with dense output: the state's meaning ends with the step
static void samples_between_steps_lie_on_the_motion(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "five-bar", NULL);
    for (int f = 0; f < SOUND; f++) {
        char method[96];
        double exact[MAX_Q], q[MAX_Q];
        (void)snprintf(method, sizeof method, "%s@dopri5:rtol=1e-9", sound[f]);
        for (double t = 0.1; t < 0.35; t += 0.1) {
            state_at(&m, "projection@dop853:rtol=1e-13", t, exact);
            state_at(&m, method, t, q);
            assert_all_near(q, exact, (size_t)m.info.nv, 1e-7);
        }
    }
    hn_model_close(&m);
}

static void twelve_links_in_a_ring_keep_their_energy_for_ten_seconds(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "ring", NULL);
    for (int f = 1; f < SOUND; f++) {
        char method[96];
        (void)snprintf(method, sizeof method, "%s@rk4:h=1e-3", sound[f]);
        const hn_run_summary s = hn_motion_summary(&m, method, 10);
        // of some 19 J between highest and lowest; projection: 3e-4 J
        assert_true(fabs(s.worst_energy_change) < 2e-3);
        // rounding of twelve links one after the other
        assert_true(s.worst_gap < 1e-14);
    }
    hn_model_close(&m);
}

// At its dead points the crank of this four-bar turns round within a few steps, while the other
// links all but line up: coordinates that become poor between two steps are left before. Kept until
// they are poor, partitioning gains 8 J in one step and the null-space form ends at a dead point.
static void a_chart_is_left_before_its_end(void **state) {
    (void)state;
    static const char *const methods[] = {"nullspace@rk4:h=0.0025", "partitioning@rk4:h=0.0025",
                                          "nullspace@rk4:h=0.005", "partitioning@rk4:h=0.005"};
    hn_model m;
    hn_model_open_closed(&m, "four-bar", "l2=0.859496 l3=0.625323");
    for (int i = 0; i < 4; i++) {
        const hn_run_summary s = hn_motion_summary(&m, methods[i], 2);
        if (s.status != HN_OK || !(s.worst_energy_change < 1)) { // of 45 J of kinetic energy
            fail_msg("%s: t = %g, %g J, %s", methods[i], s.t, s.worst_energy_change, s.reason);
        }
    }
    hn_model_close(&m);
}

// A four-bar whose links line up: J itself loses rank there, and all choices of coordinates with
// it. A step across goes straight on, as that of projection does.
static void a_step_across_a_singular_configuration_goes_straight_on(void **state) {
    (void)state;
    hn_model m;
    double exact[MAX_Q], q[MAX_Q];
    hn_model_open_closed(&m, "four-bar", "l4=0.1");
    state_at(&m, "projection@rk4:h=0.002", 2, exact);
    state_at(&m, "nullspace@rk4:h=0.01", 2, q);
    for (int i = 0; i < m.info.nv; i++) {
        assert_near(q[i], exact[i],
                    0.01); // the error of this step; the other branch is radians off
    }
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_form_has_the_order_of_rk4_whatever_the_mechanism),
        cmocka_unit_test(gap_and_speed_gap_stay_at_rounding),
        cmocka_unit_test(a_heavy_slider_is_not_kept_to_its_dead_points),
        cmocka_unit_test(a_basis_that_nobody_tracks_turns_the_motion_round_at_every_step_size),
        cmocka_unit_test(samples_between_steps_lie_on_the_motion),
        cmocka_unit_test(a_chart_is_left_before_its_end),
        cmocka_unit_test(a_step_across_a_singular_configuration_goes_straight_on),
        cmocka_unit_test(twelve_links_in_a_ring_keep_their_energy_for_ten_seconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
