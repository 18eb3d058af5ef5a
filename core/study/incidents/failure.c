// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/failure.h"

#include "integrators/method/guest.h"
#include "study/incidents/rank.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

/// Returns whose iteration did not converge: where the integrator gives the reason it was its own,
/// else the formulation's projection.
static const hn_incident_kind *kind_of_iteration(const hn_watch *w) {
    const hn_method_spec *spec = &w->run->spec;
    const bool is_ode = hn_method_form(spec->formulation, spec->stepper) == HN_FORM_ODE;
    return is_ode && !hn_engine_stepper_says_why(&w->run->engine) ? &hn_incident_projection_failed
                                                                  : &hn_incident_newton_failed;
}

/// Returns whether the method is a program of its own and that failed, not the motion.
static bool is_of_program(const hn_watch *w, hn_status status) {
    return hn_guest_is_named(w->run->spec.formulation->name) &&
           (status == HN_ERR_IO || status == HN_ERR_INPUT || status == HN_ERR_LIMIT);
}

static const hn_incident_kind *kind_of(const hn_watch *w, hn_status status) {
    if (is_of_program(w, status)) {
        return &hn_incident_program;
    }
    switch (status) {
    // charts and iterations of the method
    case HN_ERR_CHART:
    // no chart is regular here: at the start, or when the chart was to change
    case HN_ERR_UNSUPPORTED:
        return &hn_incident_chart_lost;
    case HN_ERR_NO_CONVERGENCE:
        return kind_of_iteration(w);

    // limits of the run
    case HN_ERR_STEP_UNDERFLOW:
        return &hn_incident_step_underflow;
    case HN_ERR_STOPPED:
        return &hn_incident_stopped;

    // singular matrices of the mechanism
    case HN_ERR_MASS:
        return &hn_incident_mass;
    case HN_ERR_SINGULAR:
    case HN_ERR_NOT_SPD:
    case HN_ERR_INCONSISTENT:
        return &hn_incident_rank_loss;

    default:
        return &hn_incident_diverged;
    }
}

void hn_failure_report(hn_watch *w, hn_status status, const char *reason) {
    const hn_incident_kind *kind = kind_of(w, status);
    hn_incident_make_room(&w->log, kind->code);
    w->failure = status;
    const double lost = HN_RUN_LOST_GAP * w->length;
    if (status == HN_ERR_DIVERGED && w->measure.gap > lost) {
        hn_incident_report(w, kind, "gap", w->measure.gap, lost, "%s", reason);
    } else {
        hn_incident_report(w, kind, "t", w->run->now.t, 0, "%s", reason);
    }
}

const hn_incident_kind hn_incident_chart_lost = {
    .code = HN_INCIDENT_CHART_LOST,
    .is_wrong = true,
    .spelling = "chart-lost",
    .name = "a dead point of the independent coordinates",
    .rule = "A set of independent coordinates is valid for a part of the motion. At a dead "
            "point of one of them, where it turns back, the dependent coordinates cannot be solved "
            "for.",
    .remedies = {{hn_remedy_robust_near, 0}, {hn_remedy_other_chart, 0}, {hn_remedy_finer, 0.25}},
};

const hn_incident_kind hn_incident_projection_failed = {
    .code = HN_INCIDENT_PROJECTION_FAILED,
    .is_wrong = true,
    .spelling = "projection-failed",
    .name = "the projection did not close the loop",
    .rule = "Projection searches for the nearest closed configuration. From too far away, or where "
            "none exists, the iteration does not converge.",
    .remedies = {{hn_remedy_robust_near, 0}, {hn_remedy_finer, 0.25}},
};

const hn_incident_kind hn_incident_newton_failed = {
    .code = HN_INCIDENT_NEWTON_FAILED,
    .is_wrong = true,
    .spelling = "newton-failed",
    .name = "Newton's method did not converge",
    .rule = "An implicit step is found by iteration. The iteration does not converge from a step "
            "that is too long, or near a configuration where J loses rank.",
    .remedies = {{hn_remedy_robust_near, 0}, {hn_remedy_finer, 0.25}},
};

const hn_incident_kind hn_incident_step_underflow = {
    .code = HN_INCIDENT_STEP_UNDERFLOW,
    .is_wrong = true,
    .spelling = "step-underflow",
    .name = "the step became too small",
    .rule = "The tolerance cannot be met with any step that the arithmetic can resolve.",
    .remedies = {{hn_remedy_robust, 0}, {hn_remedy_finer, 100}},
};

const hn_incident_kind hn_incident_diverged = {
    .code = HN_INCIDENT_DIVERGED,
    .is_wrong = true,
    .spelling = "diverged",
    .name = "diverged",
    .rule = "An explicit step beyond its stability limit multiplies the error at every step.",
    .remedies = {{hn_remedy_finer, 0.25}, {hn_remedy_stiff_closed, 0}, {hn_remedy_close, 0}},
};

const hn_incident_kind hn_incident_mass = {
    .code = HN_INCIDENT_MASS,
    .is_wrong = true,
    .spelling = "mass-singular",
    .name = "the mass matrix has no inverse",
    .rule = "A link without mass makes M singular. The constraints may still determine the motion, "
            "but only for methods that never form the inverse of M.",
    .remedies = {{hn_remedy_singular_mass, 0}},
};

const hn_incident_kind hn_incident_program = {
    .code = HN_INCIDENT_PROGRAM,
    .is_wrong = true,
    .spelling = "program-failed",
    .name = "the program gave no answer that can be used",
    .rule = "The method is a program outside holonom. It ended, took too long, or gave an answer "
            "of another form than was asked for.",
};

const hn_incident_kind hn_incident_stopped = {
    .code = HN_INCIDENT_STOPPED,
    .spelling = "stopped",
    .name = "the limit of steps or time was reached",
    .rule = "Each method has a limited number of steps and a limited computing time, so that the "
            "other methods need not wait for it.",
    .remedies = {{hn_remedy_finer, 10}},
};
