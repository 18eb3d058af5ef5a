// SPDX-License-Identifier: GPL-3.0-or-later
// The trial of shorter steps says which step would do, or only what was tried. The step is
// denied to be the cause where the error does not fall with it, and nowhere else.
#include "tui/step_trial.h"

#include "support/near.h"

#include <poll.h>
#include <string.h>

static hn_library *lib;

/// The report of a whole trial.
static hn_step_report try_steps(const char *scene, const char *spelling, double wrong_at,
                                double limit) {
    const hn_model_source source = {.name = scene};
    const hn_step_trial_request request = {spelling, wrong_at, limit};
    hn_step_trial *trial;
    hn_step_report report;
    hn_diags diags = {0};
    assert_int_equal(hn_step_trial_start(lib, &source, &request, &trial, &diags), HN_OK);
    hn_step_trial_judge(trial, &report);
    while (report.finding == HN_STEP_RUNNING) {
        poll(NULL, 0, 1);
        hn_step_trial_judge(trial, &report);
    }
    hn_step_trial_free(trial);
    return report;
}

static void the_longest_step_that_is_right_is_the_remedy(void **state) {
    (void)state;
    const hn_step_report r = try_steps("four-bar", "baumgarte@rk4:h=0.02", 1, 0);
    assert_int_equal(r.finding, HN_STEP_LONG);
    assert_string_equal(r.remedy, "h=0.005");
    assert_non_null(strstr(r.cause, "the step h = 0.02 s is too long"));
    assert_non_null(strstr(r.tried, "until t = 10 s: right to"));
}

static void a_step_is_not_denied_while_the_error_falls_with_it(void **state) {
    (void)state;
    static const struct {
        const char *scene, *method, *tried;
    } cases[] = {{"pendulum", "index1@euler:h=0.02", "h = 0.00125 s was tried until t = 10 s: "},
                 {"four-bar", "reduced@euler:h=0.002", "h = 0.000125 s was tried until t = 10 s: "},
                 {"double-pendulum", "index1@rk4:h=0.05", "h = 0.003125 s was tried until"},
                 {"double-pendulum", "index1@dopri5:rtol=0.01", "rtol = 1e-06 was tried until"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const hn_step_report r = try_steps(cases[i].scene, cases[i].method, 1, 0);
        assert_int_equal(r.finding, HN_STEP_NO_HELP);
        assert_string_equal(r.remedy, "");
        assert_ptr_equal(strstr(r.cause, cases[i].tried), r.cause);
        assert_non_null(strstr(r.cause, "The error falls with"));
        assert_null(strstr(r.cause, "not the cause"));
    }
}

static void a_step_is_denied_where_the_error_stays(void **state) {
    (void)state;
    // a weak penalty without iterations: the motion is another one at any step
    const hn_step_report r =
        try_steps("four-bar", "augmented-lagrangian:a=1,iterations=1@rk4:h=8e-3", 1, 0);
    assert_int_equal(r.finding, HN_STEP_NO_HELP);
    assert_non_null(strstr(r.cause, "From h = 0.001 s on the error does not fall with h: h alone "
                                    "is not the cause."));
}

static void a_trial_ends_with_its_computing_time_and_says_how_far_it_came(void **state) {
    (void)state;
    // a limit that is over before the first frame, on any machine
    const hn_step_report r = try_steps("four-bar", "baumgarte@rk4:h=0.02", 1, 1e-9);
    assert_int_equal(r.finding, HN_STEP_NO_HELP);
    assert_non_null(strstr(r.cause, "Whether h is the cause is not known: h = 0.01 s reached t = 0 "
                                    "s of 10 s, in 1e-09 s of computing"));
    assert_non_null(strstr(r.cause, "known to be wrong at 1 s. Nothing smaller was tried."));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_longest_step_that_is_right_is_the_remedy),
        cmocka_unit_test(a_step_is_not_denied_while_the_error_falls_with_it),
        cmocka_unit_test(a_step_is_denied_where_the_error_stays),
        cmocka_unit_test(a_trial_ends_with_its_computing_time_and_says_how_far_it_came),
    };
    if (hn_library_open(".", &lib, NULL) != HN_OK) {
        return 1;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    hn_library_free(lib);
    return failed;
}
