// SPDX-License-Identifier: GPL-3.0-or-later
// Explicit methods with a step control on a stiff part: they arrive, with steps that stability
// holds, and say so.

#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// 1 kg on a damper of 1e6 N s/m, pushed as sin t: a motion of metres in seconds, and a rate of 1e6
// 1/s that dies away
static const char *const damped =
    "{\"holonom\":1,\"name\":\"damped-slider\",\"bodies\":[{\"name\":\"mass\",\"mass\":1}],"
    "\"joints\":[{\"name\":\"S\",\"type\":\"prismatic\",\"axis\":[1,0,0],"
    "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"mass\"},\"coordinate\":\"x\","
    "\"rate\":\"vx\"}],\"loads\":[{\"name\":\"damper\",\"joint_spring\":{\"joint\":\"S\","
    "\"damping\":1e6}},{\"name\":\"push\",\"force\":{\"at\":{\"body\":\"mass\",\"at\":[0,0,0]},"
    "\"value\":[\"1e6*sin(t)\",0,0]}}],\"start\":{\"positions\":{\"x\":0}},\"duration\":1,"
    "\"step\":1e-6}";
static const double T = 0.01, RATE = 1e6;

static const hn_incident *find_stiff(const hn_run *run) {
    const hn_incident *incidents;
    const int n = hn_run_incidents(run, &incidents);
    for (int i = 0; i < n; i++) {
        if (incidents[i].code == HN_INCIDENT_STIFF) {
            return &incidents[i];
        }
    }
    return NULL;
}

static void steps_held_by_a_strong_damper_are_told_with_an_implicit_remedy(void **state) {
    (void)state;
    static const struct {
        const char *method;
        double limit; // on the real axis, of the stability polynomial
    } cases[] = {{"index1@dopri5:rtol=1e-6", 3.3066}, {"index1@dop853:rtol=1e-6", 6.3937}};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_text(&m, damped, NULL);
        hn_run *run = hn_motion_start(&m, cases[k].method);
        assert_int_equal(hn_run_advance(run, T), HN_OK);
        const hn_incident *stiff = find_stiff(run);
        assert_non_null(stiff);
        assert_true(stiff->t < T / 10);
        assert_rel(stiff->value, cases[k].limit, 0.1); // the control swings about it
        assert_non_null(strstr(stiff->message, "1e+06 1/s"));
        assert_string_equal(stiff->remedy[0], "ggl@radau5:rtol=1e-06");
        assert_string_equal(stiff->remedy[1], "index1@radau5:rtol=1e-06");
        const hn_run_summary s = hn_run_get_summary(run);
        assert_rel((double)s.steps, T * RATE / cases[k].limit, 0.05);
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void the_remedy_takes_few_steps_and_arrives_at_the_same_place(void **state) {
    (void)state;
    static const char *const methods[] = {"ggl@radau5:rtol=1e-6", "index1@radau5:rtol=1e-6"};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_text(&m, damped, NULL);
        hn_run *run = hn_motion_start(&m, methods[k]);
        const hn_sample s = hn_motion_at(run, T);
        // v follows sin t with a delay of 1e-6 s
        assert_near(s.v[0], sin(T), 2e-6);
        assert_near(s.q[0], 1 - cos(T), 1e-7);
        assert_true(hn_run_get_summary(run).steps < 40);
        assert_null(find_stiff(run));
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void motions_that_ask_for_their_steps_are_not_called_stiff(void **state) {
    (void)state;
    static const struct {
        const char *scene;
        double T;
    } scenes[] = {{"fb0", 2}, {"andrews", 0.03}, {"car-axis", 1}};
    static const char *const formulations[] = {"index1", "projection"};
    static const char *const integrators[] = {"dopri5:rtol=1e-4", "dopri5:rtol=1e-6",
                                              "dopri5:rtol=1e-8", "dop853:rtol=1e-6",
                                              "dop853:rtol=1e-10"};
    for (int k = 0; k < 3; k++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[k].scene, NULL);
        for (int i = 0; i < 10; i++) {
            char method[64];
            snprintf(method, sizeof method, "%s@%s", formulations[i / 5], integrators[i % 5]);
            hn_run *run = hn_motion_start(&m, method);
            assert_int_equal(hn_run_advance(run, scenes[k].T), HN_OK);
            if (find_stiff(run)) {
                fail_msg("%s by %s: %s", scenes[k].scene, method, find_stiff(run)->message);
            }
            hn_run_free(run);
        }
        hn_model_close(&m);
    }
}

// steps of 1e-4 s end at 9.999999999999999e-05 where a hundredth of 0.01 s is asked for
static void a_sample_a_rounding_after_the_last_step_is_that_step(void **state) {
    (void)state;
    hn_model m;
    hn_sample s;
    hn_model_open_text(&m, damped, NULL);
    hn_run *run = hn_motion_start(&m, "index1@radau5:rtol=1e-6");
    assert_int_equal(hn_run_step(run), HN_OK);
    const double t = hn_run_time(run);
    assert_int_equal(hn_run_sample(run, t * (1 + 5e-15), &s), HN_OK);
    assert_near(s.t, t, 1e-14 * t);
    assert_int_equal(hn_run_sample(run, t * (1 + 1e-6), &s), HN_ERR_INPUT); // has yet to be reached
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_held_by_a_strong_damper_are_told_with_an_implicit_remedy),
        cmocka_unit_test(the_remedy_takes_few_steps_and_arrives_at_the_same_place),
        cmocka_unit_test(a_sample_a_rounding_after_the_last_step_is_that_step),
        cmocka_unit_test(motions_that_ask_for_their_steps_are_not_called_stiff),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
