// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// SUNDIALS IDA on the reference four-bar to t = 1 s: dense matrix, difference quotients, the
// library's own first step, and atol = rtol / 10, with which the printed counts come out to the
// step.

#define LIBRARY ",h0=-1,jacobian=differences,safety=1"
#define UNTESTED ",suppress=multipliers,loosen=1" LIBRARY
#define TESTED ",suppress=none,loosen=1" LIBRARY
#define LOOSE ",suppress=multipliers,loosen=1e6" LIBRARY
#define SPEEDS ",suppress=speeds,loosen=1" LIBRARY

typedef enum asked { STEPS, TURNED_DOWN, ERROR, END, FLAG } asked;
static const char *const asked_names[] = {"steps", "steps turned down by the error test",
                                          "largest error of an angle [rad]", "ends at [s]",
                                          "ends at once with flag"};

typedef struct ida_row {
    const char *form, *settings;
    double rtol;
    asked what;
    const char *printed, *instead;
    double units;
    const char *note;
} ida_row;

static const char decides[] =
    "each step is turned down some six times out of seven, and rounding decides";
static const char weight[] = "the kinematics were weighted with the identity; with the mass "
                             "matrix, as here, it is 99 and 296";
static const char creeps[] = "with the identity for weight it gave up at the start (flags -3, -4); "
                             "here it creeps, and is ended once it needs more steps than it has";
static const char shrinks[] = "it ran out of steps there; here a run is ended once it needs more "
                              "steps than it has";

static const ida_row rows[] = {
    {"index1", TESTED, 1e-8, STEPS, "629", NULL, 0, NULL},
    {"index1", UNTESTED, 1e-8, STEPS, "198", NULL, 0, NULL},
    {"index1", UNTESTED, 1e-8, ERROR, "1.9e-7", NULL, 0, NULL},
    {"baumgarte:alpha=20,beta=20", UNTESTED, 1e-8, STEPS, "200", NULL, 0, NULL},
    {"baumgarte:alpha=20,beta=20", UNTESTED, 1e-8, ERROR, "3.5e-8", NULL, 0, NULL},
    {"index2", TESTED, 1e-4, STEPS, "3345", NULL, 50, decides},
    {"index2", TESTED, 1e-4, TURNED_DOWN, "2878", NULL, 50, decides},
    {"index2", TESTED, 1e-6, END, "0.06", "<0.08", 0, shrinks},
    {"index2", UNTESTED, 1e-6, STEPS, "99", NULL, 0, NULL},
    {"ggl", UNTESTED, 1e-6, STEPS, "96", "99", 0, weight},
    {"index2", UNTESTED, 1e-8, FLAG, "-4", NULL, 0, NULL},
    {"ggl", UNTESTED, 1e-8, FLAG, "-4", NULL, 0, NULL},
    {"index2", LOOSE, 1e-8, STEPS, "340", NULL, 0, NULL},
    {"ggl", LOOSE, 1e-8, STEPS, "275", "296", 1, weight},
    {"ggl", LOOSE, 1e-10, STEPS, "795", "-4", 0,
     "flag -4 in the library's own first step of 1e-12 s, which divides the rounding of q by "
     "itself; 795 with the identity for weight"},
    {"ggl", "", 1e-10, ERROR, "<1e-7", NULL, 0,
     "with our own first step and exact derivatives it runs"},
    {"ggl", TESTED, 1e-6, END, "0", "<0.08", 0, creeps},
    {"index3", UNTESTED, 1e-4, TURNED_DOWN, "2503", NULL, 60, decides},
    {"index3", SPEEDS, 1e-6, STEPS, "79", NULL, 0, NULL},
    {"index3", SPEEDS, 1e-6, ERROR, "2e-3", NULL, 0, NULL},
};

static const double at_one[3] = {2.72677524435375, 0.43412079439446, 2.37837623328494};

/// The library's flag in the reason of a run that ended.
static double flag_of(const hn_run_summary *s) {
    const char *const flag = strstr(s->reason, "flag ");
    return flag ? atof(flag + 5) : nan("");
}

static double answer(const hn_model *m, const char *method, asked what) {
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_run_opts opts = hn_run_opts_default();
    double found = 0;
    opts.max_steps = 200000; // taken and turned down
    assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
    assert_int_equal(hn_run_create(m->sys, &spec, m->q, m->v, &opts, &run, &diag), HN_OK);
    const hn_status status = hn_run_advance(run, 1);
    const hn_run_summary s = hn_run_get_summary(run);
    hn_sample at = {0};
    switch (what) {
    case STEPS:
        found = status == HN_OK ? (double)s.steps : flag_of(&s);
        break;
    case TURNED_DOWN:
        found = (double)s.rejected;
        break;
    case END:
        found = s.t;
        break;
    case FLAG:
        found = s.t < 1e-7 ? flag_of(&s) : nan("");
        break;
    case ERROR:
        if (status != HN_OK || hn_run_sample(run, 1, &at) != HN_OK) {
            found = nan("");
        }
        for (int i = 0; isfinite(found) && i < 3; i++) {
            found = fmax(found, fabs(at.q[i] - at_one[i]));
        }
        break;
    }
    hn_run_free(run);
    return found;
}

void hn_figures_ida(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const ida_row *r = &rows[i];
        char method[HN_SPEC_MAX], how[HN_SPEC_MAX + 16];
        (void)snprintf(method, sizeof method, "%s@ida:rtol=%g,atol=%g%s", r->form, r->rtol,
                       r->rtol / 10, r->settings);
        (void)snprintf(how, sizeof how, "fb0, %s", method);
        const hn_figure row = {.what = asked_names[r->what],
                               .how = how,
                               .printed = r->printed,
                               .instead = r->instead,
                               .units = r->units,
                               .note = r->note};
        hn_figure_add(f, &row, answer(&m, method, r->what));
    }
    hn_model_close(&m);
}
