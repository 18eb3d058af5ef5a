// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/own_steps.h"

#include "base/clock.h"
#include "export/spelling.h"
#include "integrators/step/stepper.h"
#include "study/run/run.h"
#include "study/run/walk.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_STEPS = 2000 }; // some seconds of Python
/// Difference of two gaps, relative to the gap. Both are the same steps, rounded in another order;
/// NUDGES times what a start moved by NUDGE makes of the gap is allowed where that is more, and
/// ROUNDING of the mechanism's length where the gap is no more than that.
static const double ALLOWED = 1e-6, ROUNDING = 1e-12, NUDGE = 1e-13, NUDGES = 100;
/// Beyond this, relative to the gap, agreement would say nothing; a gap below CLOSED lengths is as
/// good as none.
static const double SENSITIVE = 1e-2, CLOSED = 1e-9;

/// Why the program has no steps of this kind, "" where it can have them.
static void find_reason(const hn_exporter *e, const hn_method_spec *spec, char why[160]) {
    const bool has_one = e->language->has_steps && e->solver == e->language->solvers;
    if (e->skeleton) {
        snprintf(why, 160, "a skeleton has one integrator, which is its own");
    } else if (!has_one) {
        snprintf(why, 160, "it has one integrator, which is its own");
    } else if (!spec->stepper->tableau || hn_method_is_adaptive(spec)) {
        snprintf(why, 160,
                 "it can take the steps of euler, heun and rk4 with h = ..., and those of its own "
                 "integrator");
    } else if (e->info.nq != e->info.nv) {
        snprintf(why, 160, "its own integrator alone takes orientations");
    } else if (hn_model_assembly(e->model)->rank < e->info.nc) {
        // once they are open, dependent constraints contradict each other
        snprintf(why, 160, "its constraints depend on each other, and it may keep others of them");
    } else if (hn_model_scene(e->model)->duration < hn_method_option(spec, "h", 0)) {
        snprintf(why, 160, "one step is longer than the scene lasts");
    }
}

/// The largest gap of the method's steps until e->steps.t from a start moved by `nudge`; a failure
/// is written to `why`.
static hn_status run_steps(hn_exporter *e, const hn_method_spec *spec, double nudge, double *gap,
                           char why[160]) {
    hn_run_opts opts = hn_run_opts_default();
    hn_run *run = NULL;
    hn_diag diag = {0};
    double *q = hn_arena_doubles(e->arena, (size_t)e->info.nq + 1);
    if (!q) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < e->info.nq; i++) {
        q[i] = hn_model_q(e->model)[i] + (i % 2 ? -nudge : nudge);
    }
    hn_status status =
        hn_run_create(hn_model_system(e->model), spec, q, hn_model_v(e->model), &opts, &run, &diag);
    if (status != HN_OK) {
        snprintf(why, 160, "the run cannot begin: %.100s", diag.message);
        return status == HN_ERR_MEMORY ? status : HN_OK;
    }

    hn_walk_limits left = e->limits;
    if (left.seconds > 0) {
        left.seconds = fmax(left.seconds - (hn_clock_thread() - e->started), 1e-9);
    }
    const hn_walk_end state = hn_walk(run, e->steps.t, 1, &left, NULL, NULL);
    const hn_run_summary sum = hn_run_get_summary(run);
    *gap = sum.worst_gap;
    if (state == HN_WALK_FAILED) {
        snprintf(why, 160, "the run ends early, at t = %.4g s", sum.t);
    }
    hn_run_free(run);
    return state == HN_WALK_DONE || state == HN_WALK_FAILED ? HN_OK : HN_ERR_STOPPED;
}

hn_status hn_export_own_steps_find(hn_exporter *e, const hn_method_spec *spec, hn_diags *diags) {
    hn_export_steps *steps = &e->steps;
    *steps = (hn_export_steps){.asked = true};
    hn_method_format(spec, steps->method);
    find_reason(e, spec, steps->why);
    if (steps->why[0]) {
        return HN_OK;
    }
    steps->tableau = spec->stepper->tableau;
    steps->h = hn_method_option(spec, "h", 0);
    const double n = floor(hn_model_scene(e->model)->duration / steps->h + 0.5);
    steps->n = (int)fmin(MOST_STEPS, fmax(n, 1));
    steps->t = steps->n * steps->h;

    // the gap, and what rounding may make of it
    double nudged = 0;
    hn_status status = run_steps(e, spec, 0, &steps->gap, steps->why);
    if (status == HN_OK && !steps->why[0]) {
        status = run_steps(e, spec, NUDGE, &nudged, steps->why);
    }
    steps->allowed = fmax(ALLOWED * steps->gap, NUDGES * fabs(nudged - steps->gap));
    const double length = hn_system_length(hn_model_system(e->model)), rounding = CLOSED * length;
    steps->allowed = fmax(steps->allowed, ROUNDING * length);
    if (!steps->why[0] && steps->allowed > fmax(SENSITIVE * steps->gap, rounding)) {
        snprintf(steps->why, sizeof steps->why,
                 "rounding changes its motion too much, a start moved by %.0e the gap by %.1g m",
                 NUDGE, fabs(nudged - steps->gap));
    }
    return status == HN_ERR_STOPPED
               ? hn_diags_add(diags, status, NULL, NULL,
                              "computing the steps of %s for the self-check took longer than "
                              "allowed",
                              steps->method)
               : status;
}

static void put_list(hn_strbuf *b, const hn_exporter *e, const double *x, int n) {
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, i ? ", " : "");
        hn_code_given(b, e->language, x[i]);
    }
}

void hn_export_own_steps_put(hn_strbuf *b, const hn_exporter *e, const char *place) {
    const hn_export_steps *steps = &e->steps;
    const hn_tableau *tableau = steps->tableau;
    if (strcmp(place, "METHOD") == 0) {
        hn_code_words(b, e->language, steps->method);
    } else if (strcmp(place, "METHOD_WHY") == 0) {
        hn_code_words(b, e->language, steps->why);
    } else if (strcmp(place, "METHOD_STAGES") == 0) {
        hn_strbuf_printf(b, "%d", tableau->stages);
    } else if (strcmp(place, "METHOD_STEPS") == 0) {
        hn_strbuf_printf(b, "%d", steps->n);
    } else if (strcmp(place, "METHOD_A") == 0) {
        put_list(b, e, tableau->A, tableau->stages * tableau->stages);
    } else if (strcmp(place, "METHOD_B") == 0) {
        put_list(b, e, tableau->b, tableau->stages);
    } else if (strcmp(place, "METHOD_C") == 0) {
        put_list(b, e, tableau->c, tableau->stages);
    } else {
        const double number = strcmp(place, "METHOD_H") == 0     ? steps->h
                              : strcmp(place, "METHOD_GAP") == 0 ? steps->gap
                                                                 : steps->allowed;
        put_list(b, e, &number, 1);
    }
}
