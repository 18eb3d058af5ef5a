// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/conditioning.h"

#include "linalg/dense.h"
#include "study/incidents/report.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

/// sigma_min / sigma_max above which multipliers are those of a regular configuration.
static const double FAR = 0.1;

static void check_multipliers(hn_watch *w) {
    hn_singular_record *s = &w->singular;
    if (w->run->info.nc == 0) {
        return;
    }
    const double size = w->accel_status == HN_OK ? hn_norm_max(w->run->info.nc, w->lambda) : 0;
    const double kinetic = w->measure.kinetic;
    if (s->info.ratio > FAR || s->multiplier == 0) {
        s->multiplier = fmax(s->multiplier, size);
        s->kinetic = fmax(s->kinetic, kinetic);
        hn_incident_over(&w->log, HN_INCIDENT_MULTIPLIERS);
        return;
    }

    // loads of inertia grow as the kinetic energy: a run that blows up has large multipliers
    // anywhere, and dependent rows are not their cause
    const double faster = s->kinetic > 0 ? fmax(1, kinetic / s->kinetic) : 1;
    const double limit = HN_RUN_WARN_MULTIPLIERS * s->multiplier * faster;
    if (size > limit) {
        hn_incident_report(
            w, &hn_incident_multipliers, "|lambda|", size, limit,
            "the multipliers grew to %.3g (N, or N m for an equation of angles), %.2g times their "
            "size away from singular configurations",
            size, size / s->multiplier);
    }
}

// the condition of K grows as the square of what sigma loses; it is estimated only where it can
// matter
static void check_condition(hn_watch *w) {
    const hn_stepping *run = w->run;
    const double ratio = w->singular.info.ratio;
    double kappa = 0;
    if (run->info.nc == 0 || ratio * ratio * HN_RUN_WARN_CONDITION > 1) {
        hn_incident_over(&w->log, HN_INCIDENT_ILL_CONDITIONED);
        return;
    }
    if (hn_incident_holds(&w->log, HN_INCIDENT_ILL_CONDITIONED) ||
        hn_accel_condition(run->accel, run->now.t, run->now.q, run->now.v, &kappa) != HN_OK ||
        !(kappa > HN_RUN_WARN_CONDITION)) {
        return;
    }
    const double digits = fmax(0, -log10(DBL_EPSILON) - log10(kappa));
    char left[40] = "no digit";
    if (kappa <= HN_CONDITION_LOST) {
        snprintf(left, sizeof left, "about %.0f of 16 digits", digits);
    }
    hn_incident_report(w, &hn_incident_ill_conditioned, "condition", kappa, HN_RUN_WARN_CONDITION,
                       "%s of the multipliers can be trusted: the condition number of K is %.2g",
                       left, kappa);
}

static void check_solver(hn_watch *w) {
    hn_singular_record *s = &w->singular;
    const long long now = w->cost->fallbacks, more = now - s->fallbacks;
    s->fallbacks = now;
    // constraints that always depend on others have been reported as such
    if (more == 0 || w->start_rank < w->run->info.nc || w->run->info.nc == 0) {
        hn_incident_over(&w->log, HN_INCIDENT_SOLVER);
        return;
    }
    hn_incident_report(w, &hn_incident_solver, "dense solves", (double)more, 0,
                       "the sparse LDL' factorisation met a pivot near zero, and the dense "
                       "least-norm solver took its place %lld times so far",
                       now);
}

const hn_incident_kind hn_incident_multipliers = {
    .code = HN_INCIDENT_MULTIPLIERS,
    .spelling = "multipliers-grow",
    .name = "the multipliers grow",
    .rule = "Where the rows of J become dependent, larger and larger multipliers balance the same "
            "loads. Their forces cancel each other; the joints do not carry forces of that size.",
    .check = check_multipliers,
};

const hn_incident_kind hn_incident_ill_conditioned = {
    .code = HN_INCIDENT_ILL_CONDITIONED,
    .spelling = "ill-conditioned",
    .name = "few digits of the multipliers are left",
    .rule =
        "Accelerations and multipliers lose as many of their sixteen digits as the condition "
        "number of K has. Near a singular configuration the condition number grows without bound.",
    .check = check_condition,
};

const hn_incident_kind hn_incident_solver = {
    .code = HN_INCIDENT_SOLVER,
    .spelling = "solver-fallback",
    .name = "the dense solver took over",
    .rule = "The sparse solver has a fixed order of pivots. Where one of them vanishes, a dense "
            "least-norm solver gives the answer: it is slower and as accurate.",
    .check = check_solver,
};
