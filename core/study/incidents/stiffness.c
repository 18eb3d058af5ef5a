// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/stiffness.h"

#include "base/units.h"
#include "study/incidents/failure.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <math.h>

// An explicit method that chooses its own steps does not fail on a stiff problem. It stays
// accurate, with steps held at |h lambda| on the edge of its stability region, however smooth the
// motion is: T c / (3.3 m) steps of dopri5 for a damper c on a mass m. Its own right-hand sides
// show that (hn_stepper.stiffness).
// Source: Hairer & Wanner 1996, IV.2, with the counts of the programs DOPRI5 and DOP853.
enum { STEPS_HELD = 15, STEPS_FREE = 6 };
#define AT_LIMIT 0.95 // of the limit on the real axis; the control swings about it

// A multistep integrator whose state is changed after each step (a projection, a ball's unit
// quaternion) stays at order 1.
enum { RESTARTS_REPORTED = 20 };

static void report_stiff(hn_watch *w, double size, double h) {
    const hn_stepper *stepper = w->run->spec.stepper;
    hn_incident *i = hn_incident_report(
        w, &hn_incident_stiff, "|h lambda|", size, stepper->real_limit,
        "stability, not accuracy, limits the steps to %.2g s: the fastest part of the motion, "
        "damped or vibrating, has a rate of %.3g 1/s, and %s is stable up to |h lambda| = %.3g; "
        "an implicit method may take longer steps",
        h, size / h, stepper->name, stepper->real_limit);
    if (i) {
        i->t = w->run->before.t; // the start of the step that showed it
    }
}

static void check_stiff(hn_watch *w) {
    const hn_stepper *stepper = w->run->spec.stepper;
    if (!stepper->stiffness || !w->run->engine.stepper || !w->run->adaptive) {
        return;
    }
    const double size = stepper->stiffness(w->run->engine.stepper);
    if (size > AT_LIMIT * stepper->real_limit) {
        w->released = 0;
        if (++w->held >= STEPS_HELD) {
            report_stiff(w, size, w->run->h);
        }
    } else if (w->held > 0 && ++w->released == STEPS_FREE) {
        w->held = w->released = 0;
        hn_incident_over(&w->log, HN_INCIDENT_STIFF);
    }
}

static void check_restarts(hn_watch *w) {
    const long long restarts = ++w->restarts, steps = w->run->steps;
    const hn_stepper *stepper = w->run->spec.stepper;
    if (!stepper->multistep || restarts < RESTARTS_REPORTED || 2 * restarts < steps) {
        return;
    }
    hn_incident_report(w, &hn_incident_restarts, "restarts", (double)restarts, RESTARTS_REPORTED,
                       "the state was corrected after %lld of %lld steps, and each time %s starts "
                       "again at order 1: its steps stay near %.2g s",
                       restarts, steps, stepper->name, w->run->h);
}

// steps that shrink without advancing the motion, whatever holds them
static void check_headway(hn_watch *w) {
    const hn_headway *p = &w->run->headway;
    if (!(p->needed > HN_HEADWAY_MANY)) {
        return;
    }
    char cause[160];
    hn_headway_describe(w->run, cause, sizeof cause);
    if (!isfinite(p->needed)) {
        hn_incident_report(
            w, &hn_incident_step_underflow, "steps needed", p->needed, (double)w->run->max_steps,
            "the steps collapse: %lld trial steps did not advance the motion; %s", p->tried, cause);
        return;
    }
    hn_incident_report(w, &hn_incident_step_underflow, "steps needed", p->needed,
                       (double)w->run->max_steps,
                       "the steps collapse: %lld trial steps advanced the motion by %.2g s, and "
                       "%.2g more are needed to t = %.6g s; %s",
                       p->tried, p->advance, p->needed, w->run->t_asked, cause);
}

void hn_stiffness_check_step(hn_watch *w) {
    check_headway(w);
    check_stiff(w);
    if (w->run->corrected) {
        check_restarts(w);
    }
}

void hn_step_limit_check(hn_watch *w) {
    const hn_stepper *stepper = w->run->spec.stepper;
    const double h = hn_method_option(&w->run->spec, "h", 0);
    const double rate = hn_pulling_rate(&w->run->spec), limit = stepper->real_limit;
    hn_incident_over(&w->log, HN_INCIDENT_STEP_LIMIT);
    if (rate * h > limit) {
        const int digits = hn_digits_apart(rate * h, limit, 3);
        hn_incident_report(w, &hn_incident_step_limit, "alpha h", rate * h, limit,
                           "the stabilisation is too fast for this step: its rate times h is %.*g, "
                           "and %s is stable up to %.*g",
                           digits, rate * h, stepper->name, digits, limit);
    }
}

void hn_step_long_check(hn_watch *w) {
    const double h = hn_method_option(&w->run->spec, "h", 0), whole = w->t_end - w->run->t0;
    if (!w->run->adaptive && w->t_end > 0 && h > whole * (1 + HN_STEPPING_LANDING)) {
        const int digits = hn_digits_apart(h, whole, 4);
        hn_incident_report(w, &hn_incident_step_long, "h", h, whole,
                           "the step h = %.*g s is longer than the run of %.*g s, so one shorter "
                           "step was taken; choose h below %.*g s",
                           digits, h, digits, whole, digits, whole);
    }
}

const hn_incident_kind hn_incident_stiff = {
    .code = HN_INCIDENT_STIFF,
    .spelling = "stiff",
    .name = "a stiff part limits the step",
    .rule =
        "Some part of the motion is much faster than the rest and too small to see. An explicit "
        "method must take steps short enough to follow it; an implicit method need not.",
    .remedies = {{hn_remedy_stiff_closed, 0},
                 {hn_remedy_stiff_same, 0},
                 {hn_remedy_stiff_multistep, 0}},
};

const hn_incident_kind hn_incident_restarts = {
    .code = HN_INCIDENT_RESTARTS,
    .spelling = "order-lost",
    .name = "restarts at order 1 after every step",
    .rule =
        "A multistep method gets its order from previous steps. If the state is corrected after "
        "each step, the previous steps cannot be used: the order stays 1 and the steps stay short.",
    .remedies = {{hn_remedy_one_step, 0}, {hn_remedy_uncorrected, 0}},
};

const hn_incident_kind hn_incident_step_limit = {
    .code = HN_INCIDENT_STEP_LIMIT,
    .spelling = "step-limit",
    .name = "the step is at its stability limit",
    .rule = "The step times the fastest rate must stay within the stability region of the "
            "integrator.",
    .remedies = {{hn_remedy_slower_feedback, 0.1}, {hn_remedy_step_for_feedback, 0.1}},
};

const hn_incident_kind hn_incident_step_long = {
    .code = HN_INCIDENT_STEP_LONG,
    .spelling = "step-long",
    .name = "the step is longer than the run",
    .rule = "The error of a method is known for steps that are short against the motion. One step "
            "across a whole run says nothing about the motion.",
    .remedies = {{hn_remedy_step_of_run, 0.01}},
};
