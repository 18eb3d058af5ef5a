// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness: an explicit method that chooses its own steps never fails where it is the wrong one. It stays accurate, with steps
// pinned at |h lambda| on the edge of its stability region, however smooth the motion is: T c / (3.3 m) steps of dopri5
// for a damper c on a mass m. Its own right-hand sides tell (hn_stepper.stiffness).
// Source: Hairer & Wanner 1996, IV.2, with the counts of the programs DOPRI5 and DOP853.
#include "study/run/run_internal.h"

#include <stdio.h>

enum { STEPS_HELD = 15, STEPS_FREE = 6 };
#define AT_LIMIT 0.95 // of the limit on the real axis; the control swings about it

static void tell(hn_run *run, double size, double h) {
    const hn_stepper *stepper = run->spec.stepper;
    const double rtol = hn_method_option(&run->spec, "rtol", 1e-6);
    hn_incident *i = hn_run_tell(
        run, HN_INCIDENT_STIFF, "|h lambda|", size, stepper->real_limit,
        "stability, not accuracy, holds the steps at %.2g s: something dies away at %.3g 1/s, and "
        "%s is stable up "
        "to |h lambda| = %.3g; an implicit method takes the steps that the motion needs",
        h, size / h, stepper->name, stepper->real_limit);
    if (!i) {
        return;
    }
    snprintf(i->remedy[0], sizeof i->remedy[0], "ggl@radau5:rtol=%.3g", rtol);
    if (run->spec.formulation->form == HN_FORM_ODE) {
        snprintf(i->remedy[1], sizeof i->remedy[1], "%s@radau5:rtol=%.3g",
                 run->spec.formulation->name, rtol);
    }
    snprintf(i->remedy[2], sizeof i->remedy[2], "index1@ida:rtol=%.3g", rtol);
}

void hn_run_look_at_stiffness(hn_run *run, double h) {
    const hn_stepper *stepper = run->spec.stepper;
    if (!stepper->stiffness || !run->main.stepper) {
        return;
    }
    const double size = stepper->stiffness(run->main.stepper);
    if (size > AT_LIMIT * stepper->real_limit) {
        run->free = 0;
        if (++run->held >= STEPS_HELD) {
            tell(run, size, h);
        }
    } else if (run->held > 0 && ++run->free == STEPS_FREE) {
        run->held = run->free = 0;
        hn_run_over(run, HN_INCIDENT_STIFF);
    }
}

// A multistep integrator whose state is changed after each step (a projection, a ball's unit quaternion) never leaves order 1.
enum { RESTARTS_TOLD = 20 };

void hn_run_tell_restart(hn_run *run) {
    const long long restarts = ++run->watch.restarts;
    if (!run->spec.stepper->multistep || restarts < RESTARTS_TOLD ||
        2 * restarts < run->summary.steps) {
        return;
    }
    const char *stepper = run->spec.stepper->name;
    hn_incident *i =
        hn_run_tell(run, HN_INCIDENT_RESTARTS, "restarts", (double)restarts, RESTARTS_TOLD,
                    "the state was corrected after %lld of %lld steps, and each time %s starts "
                    "again at order 1: its steps stay near %.2g s",
                    restarts, run->summary.steps, stepper, run->h);
    if (!i) {
        return;
    }
    const double rtol = hn_method_option(&run->spec, "rtol", 1e-6);
    snprintf(i->remedy[0], sizeof i->remedy[0], "%s@dop853:rtol=%.3g", run->spec.formulation->name,
             rtol);
    if (run->info.nq == run->info.nv) { // no quaternion that is brought back to length 1
        snprintf(i->remedy[1], sizeof i->remedy[1], "baumgarte@%s:rtol=%.3g", stepper, rtol);
    }
}
