// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/branch.h"

#include "linalg/dense.h"
#include "study/incidents/heading.h"
#include "study/incidents/motion.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <math.h>

/// Share of the largest sigma_min so far: a singular configuration has been passed.
static const double RANGE = 0.35;

// ---- the assembly mode ----

/// The loop whose mode changed its sign by most since the last check, -1: none changed it by more
/// than is reported.
static int find_flipped_loop(const hn_watch *w) {
    double most = HN_RUN_WARN_MODE;
    int loop = -1;
    for (int k = 0; k < hn_mode_watch_count(w->mode); k++) {
        const double jump = fabs(w->modes[k] - w->last_modes[k]);
        if (w->modes[k] * w->last_modes[k] < 0 && jump > most) {
            most = jump;
            loop = k;
        }
    }
    return loop;
}

// A change of sign in smooth motion means that a dead point was passed; with a jump it means the
// other branch. A long step of a method of high order looks like a jump, and a pilot run with short
// steps arrives at its end.
static void check_mode(hn_watch *w) {
    const hn_system *sys = w->run->sys;
    hn_mode_watch_values(w->mode, w->run->now.t, w->run->now.q, w->modes);
    const int loop = find_flipped_loop(w);
    const bool named = !hn_system_scene(sys)->is_lagrangian; // formulas share their loops
    if (loop >= 0 && hn_motion_unexplained(w, 0) > HN_RUN_WARN_JUMP &&
        !hn_motion_is_followed(w, &w->run->before, &w->run->now)) {
        hn_incident_report(w, &hn_incident_branch_flip, "assembly mode", w->modes[loop],
                           HN_RUN_WARN_MODE,
                           "the loop%s%s jumped to its other assembly mode in one step (the number "
                           "whose sign tells the modes apart went from %.2g to %.2g)",
                           named ? " " : "", named ? hn_system_loop_name(sys, loop) : "",
                           w->last_modes[loop], w->modes[loop]);
    } else {
        hn_incident_over(&w->log, HN_INCIDENT_BRANCH_FLIP);
    }
    double *const seen = w->last_modes;
    w->last_modes = w->modes;
    w->modes = seen;
}

// ---- velocities that turn round ----

// A motion turns back where its velocities are small, and there its accelerations explain it.
static void check_turn(hn_watch *w) {
    const hn_stepping *s = w->run;
    const int n = s->info.nv;
    double back = 0;
    if (!s->has_step || w->accel_status != HN_OK || s->info.nc == 0) {
        return;
    }

    // along each other: |v + u| is above |v| and |u|, whatever the accelerations are
    if (hn_dot(n, s->now.v, s->before.v) >= 0) {
        return;
    }
    for (int i = 0; i < n; i++) {
        back = hypot(back, s->now.v[i] + s->before.v[i]);
    }
    const double speed = fmin(hn_norm2(n, s->now.v), hn_norm2(n, s->before.v));
    const double change = (s->now.t - s->before.t) * hn_norm2(n, w->a);
    if (back < HN_RUN_WARN_BACK * speed && change < HN_RUN_WARN_BACK * 2 * speed &&
        !hn_motion_is_followed(w, &s->before, &s->now)) {
        hn_incident_report(
            w, &hn_incident_branch_flip, "change of speed", 2 * speed, change,
            "the velocities turned round within one step of %.3g s: the accelerations account for "
            "a change of %.2g times the velocities, a turn takes twice the velocities",
            s->now.t - s->before.t, change / speed);
    }
}

// ---- the direction of motion ----

/// Completes the report on the configuration that has been passed. `angle` HUGE_VAL: the headings
/// cannot be compared.
static void finish_passing(hn_watch *w, double angle) {
    const int passing = w->singular.passing;
    w->singular.passing = 0;
    if (passing == 0 || passing > w->log.n) {
        return;
    }
    hn_incident *i = &w->log.list[passing - 1];
    if (angle == HUGE_VAL) {
        hn_incident_append(
            &w->log, i,
            "; the steps are too long, or the loops too far open, to say on which branch "
            "the run continued");
    } else if (angle > HN_RUN_WARN_TURN) {
        hn_incident_append(&w->log, i,
                           w->heading.explained
                               ? "; the motion turns there by %.2g rad"
                               : "; the run left the smooth path there, by %.2g rad",
                           angle);
    } else {
        hn_incident_append(&w->log, i, "; the run stayed on the smooth path");
    }
}

static void check_direction(hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    const bool passed = s->passing || s->info.sigma_min < RANGE * s->largest;
    const double angle = hn_heading_check(w);
    if (angle < 0) {
        return;
    }
    if (angle < HUGE_VAL && angle > HN_RUN_WARN_TURN && !w->heading.explained) {
        hn_incident_report(
            w, &hn_incident_branch_flip, "turn", angle, HN_RUN_WARN_TURN,
            passed
                ? "the run came out of a singular configuration on another branch: its "
                  "direction turned by %.2g rad from the smooth continuation"
                : "the last step jumped to another branch: its direction turned by %.2g rad from "
                  "the smooth continuation, and the step is longer than its velocities allow",
            angle);
    } else {
        hn_incident_over(&w->log, HN_INCIDENT_BRANCH_FLIP);
    }
    finish_passing(w, angle);
}

static void check_stay(hn_watch *w) {
    double way = 0;
    if (hn_heading_stays_singular(w, &way)) {
        hn_incident_report(w, &hn_incident_branch_flip, "way", way, w->length,
                           "the run left the motion at a singular configuration and continued with "
                           "some links folded onto each other: the constraints stay dependent (the "
                           "smallest singular value of J is %.2g, its largest so far %.2g)",
                           w->singular.info.sigma_min, w->singular.largest);
    }
}

static void check(hn_watch *w) {
    check_mode(w);
    check_turn(w);
    if (w->run->info.nc > 0) {
        check_direction(w);
        check_stay(w);
    }
}

const hn_incident_kind hn_incident_branch_flip = {
    .code = HN_INCIDENT_BRANCH_FLIP,
    .is_wrong = true,
    .spelling = "branch-flip",
    .name = "jumped to another branch",
    .rule = "The same lengths close in more than one way. A step that is too long can land on "
            "another of these branches.",
    .check = check,
    .remedies = {{hn_remedy_right_model, 0}, {hn_remedy_robust, 0}, {hn_remedy_finer, 0.25}},
};
