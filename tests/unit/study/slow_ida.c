// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// SUNDIALS IDA on the reference four-bar to t = 1 s, as an independent program found it (SUNDIALS
// 6.4.1, dense matrix, difference quotients, the library's own first step, atol = rtol / 10):
// steps, error-test failures, flags, errors. What the library can and cannot do with each form of
// the constraints is one row each. With the same settings the counts come out the same to a step
// where the residual is the same, entry by entry; the differences:
//   index2, nothing suppressed at 1e-4: 3335 steps for 3345. Every step is turned down some six
//   times out of seven, and rounding decides. the same at 1e-6 creeps: t = 0.06 there when its
//   steps are used up; here the run ends when a thousand trials make no progress to speak of.
//   ggl: 99 and 296 steps for 96 and 275. There the kinematics had the identity for weight, here
//   the mass matrix. With nothing suppressed ggl creeps as index2 does; with the identity it gave
//   up at the start (flags -3, -4). ggl at 1e-10: flag -4 at the start for 795 steps. The library's
//   first step of 1e-12 s divides the rounding of q by itself, and with this weight that is more
//   than the Newton test lets mu have. Our own first step mends it (last row but one).

typedef struct row {
    const char *form;     // formulation
    const char *settings; // of ida, beside rtol and atol
    double rtol;
    hn_status status;
    const char *reason; // part of it, NULL: finished
    double t_least, t_most;
    int steps, steps_tol;   // 0: any
    double err, err_factor; // largest difference of an angle; within this factor; 0: any
} row;

#define LIBRARY ",h0=-1,jacobian=differences,safety=1"
#define UNTESTED ",suppress=multipliers,loosen=1" LIBRARY
#define TESTED ",suppress=none,loosen=1" LIBRARY
#define LOOSE ",suppress=multipliers,loosen=1e6" LIBRARY

static const row rows[] = {
    {"index1", TESTED, 1e-8, HN_OK, NULL, 1, 2, 629, 0, 0, 0},
    {"index1", UNTESTED, 1e-8, HN_OK, NULL, 1, 2, 198, 0, 1.9e-7, 1.05},
    {"baumgarte:alpha=20,beta=20", UNTESTED, 1e-8, HN_OK, NULL, 1, 2, 200, 0, 3.5e-8, 1.05},
    {"index2", TESTED, 1e-4, HN_OK, NULL, 1, 2, 3345, 50, 0, 0},
    {"index2", TESTED, 1e-6, HN_ERR_STEP_UNDERFLOW, "the steps collapsed", 0, 0.08, 0, 0, 0, 0},
    {"index2", UNTESTED, 1e-6, HN_OK, NULL, 1, 2, 99, 0, 0, 0},
    {"ggl", UNTESTED, 1e-6, HN_OK, NULL, 1, 2, 99, 3, 0, 0},
    {"index2", UNTESTED, 1e-8, HN_ERR_NO_CONVERGENCE, "flag -4", 0, 1e-9, 0, 0, 0, 0},
    {"ggl", UNTESTED, 1e-8, HN_ERR_NO_CONVERGENCE, "flag -4", 0, 1e-7, 0, 0, 0, 0},
    {"index2", LOOSE, 1e-8, HN_OK, NULL, 1, 2, 340, 0, 0, 0},
    {"ggl", LOOSE, 1e-8, HN_OK, NULL, 1, 2, 296, 3, 0, 0},
    {"ggl", TESTED, 1e-6, HN_ERR_STEP_UNDERFLOW, "the steps collapsed", 0, 0.08, 0, 0, 0, 0},
    {"index3", UNTESTED, 1e-4, HN_OK, NULL, 1, 2, 2640, 60, 0, 0},
    {"index3", ",suppress=speeds,loosen=1" LIBRARY, 1e-6, HN_OK, NULL, 1, 2, 79, 0, 2e-3, 1.1},
    // not in the matrix: the first step from the slopes and exact derivatives
    {"ggl", "", 1e-10, HN_OK, NULL, 1, 2, 0, 0, 1e-9, 100},
    {"index2", "", 1e-12, HN_OK, NULL, 1, 2, 0, 0, 1e-11, 100},
};

static const double reference[3] = {2.72677524435375, 0.43412079439446, 2.37837623328494};

static double error_at_one(hn_run *run) {
    const hn_sample s = hn_motion_at(run, 1);
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        worst = fmax(worst, fabs(s.q[i] - reference[i]));
    }
    return worst;
}

static void check_row(const hn_model *m, const row *r) {
    char text[HN_SPEC_MAX];
    snprintf(text, sizeof text, "%s@ida:rtol=%g,atol=%g%s", r->form, r->rtol, r->rtol / 10,
             r->settings);
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_run_opts opts = hn_run_opts_default();
    opts.max_steps = 200000; // taken and turned down; about 100,000 are taken
    assert_int_equal(hn_method_parse(text, &spec, &diag), HN_OK);
    assert_int_equal(hn_run_create(m->sys, &spec, m->q, m->v, &opts, &run, &diag), HN_OK);
    const hn_status status = hn_run_advance(run, 1);
    const hn_run_summary s = hn_run_get_summary(run);
    const double err = status == HN_OK ? error_at_one(run) : nan("");
    print_message("%-84s %6lld steps %6lld turned down, t %.3g, error %.2g %s\n", text, s.steps,
                  s.rejected, s.t, err, s.reason);
    if (status != r->status || (r->reason && !strstr(s.reason, r->reason)) || s.t < r->t_least ||
        s.t > r->t_most || (r->steps && llabs(s.steps - r->steps) > r->steps_tol) ||
        (r->err > 0 && !(err < r->err * r->err_factor))) {
        fail_msg("%s: %lld steps to t = %g, error %g: %s", text, s.steps, s.t, err, s.reason);
    }
    hn_run_free(run);
}

static void the_library_does_with_each_form_what_was_measured(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        check_row(&m, &rows[i]);
    }
    hn_model_close(&m);
}

static void an_untested_error_of_index_two_is_turned_down_again_and_again(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    const hn_run_summary s = hn_motion_summary(&m, "index2@ida:rtol=1e-4,atol=1e-5" TESTED, 1);
    assert_near((double)s.rejected, 2878, 50); // rounding decides each, see above
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_library_does_with_each_form_what_was_measured),
        cmocka_unit_test(an_untested_error_of_index_two_is_turned_down_again_and_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
