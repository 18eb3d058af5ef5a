// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel.h"
#include "study/run/run_internal.h"
#include "formulations/list/formulation_list.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Incidents: how they are told, what is offered to try, and those that the run itself reports.

// --- remedies ---------------------------------------------------------------------------------------------

enum {
    MAX_TOLD = 5
}; // of one kind, so that a condition that comes and goes leaves room for others

// another formulation with its defaults, the integrator as it is where it serves that too
void hn_run_remedy_formulation(const hn_run *run, const char *name, hn_remedy out) {
    hn_method_spec spec = run->spec;
    char text[HN_SPEC_MAX];
    spec.formulation = hn_formulation_find(name);
    HN_ASSERT(spec.formulation);
    if (!hn_method_fits(spec.formulation, spec.stepper)) {
        snprintf(out, sizeof(hn_remedy), "%s@%s:rtol=1e-8", name,
                 spec.formulation->form == HN_FORM_ODE ? "dopri5" : "radau5");
        return;
    }
    for (int i = 0; i < spec.formulation->n_options; i++) {
        spec.formulation_set[i] = spec.formulation->options[i].initial;
    }
    hn_method_format(&spec, text);
    const char *at = strchr(text, '@');
    snprintf(out, sizeof(hn_remedy), "%s%s", name, at);
}

void hn_run_remedy_finer(const hn_run *run, double factor, hn_remedy out) {
    const char *key = run->adaptive ? "rtol" : "h";
    snprintf(out, sizeof(hn_remedy), "%s=%.4g", key,
             hn_method_option(&run->spec, key, 0) * factor);
}

int hn_run_has_formulation(const hn_run *run, const char *name) {
    return strcmp(run->spec.formulation->name, name) == 0;
}

void hn_run_remedy_robust(const hn_run *run, hn_remedy out) {
    const double longest =
        0.01; // [s]: survives the flat poses of the ladder for every h up to twice this
    const double mean =
        run->summary.steps > 0 ? (run->now.t - run->opts.t0) / (double)run->summary.steps : longest;
    const double fixed = hn_method_option(&run->spec, "h", 0);
    const double h = fixed > 0 ? fixed : fmin(fmax(mean, 1e-4), longest);
    const int fits = hn_method_fits(hn_formulation_find("projection"), run->spec.stepper);
    const char *stepper = fixed > 0 && fits ? run->spec.stepper->name : "rk4";
    if (hn_run_has_formulation(run, "projection") && fixed > 0) {
        snprintf(out, sizeof(hn_remedy), "projection@rk4:h=%.4g", 0.7 * h); // lands elsewhere
    } else {
        snprintf(out, sizeof(hn_remedy), "projection@%s:h=%.4g", stepper, h);
    }
}

// --- telling ----------------------------------------------------------------------------------------------

hn_incident *hn_run_tell(hn_run *run, hn_incident_code code, const char *quantity, double value,
                         double limit, const char *format, ...) {
    const unsigned bit = 1u << code;
    if (run->watch.active & bit || run->watch.told[code] == MAX_TOLD ||
        run->n_incidents == HN_RUN_MAX_INCIDENTS) {
        return NULL;
    }
    run->watch.active |= bit;
    run->watch.told[code]++;
    hn_incident *i = &run->incidents[run->n_incidents++];
    *i = (hn_incident){
        .code = code, .t = run->now.t, .quantity = quantity, .value = value, .limit = limit};
    va_list args;
    va_start(args, format);
    vsnprintf(i->message, sizeof i->message, format, args);
    va_end(args);
    i->revision = ++run->revision;
    return i;
}

void hn_run_over(hn_run *run, hn_incident_code code) {
    run->watch.active &= ~(1u << code);
}

// --- what the run itself tells ----------------------------------------------------------------------------

void hn_run_tell_charts(hn_run *run, long long changes) {
    if (changes == 0) {
        return;
    }
    hn_run_over(run, HN_INCIDENT_CHART_CHANGE);
    hn_run_tell(run, HN_INCIDENT_CHART_CHANGE, "chart changes", (double)changes, 0,
                "other coordinates became the independent ones; the motion goes on unchanged");
}

// The faster rate at which the method itself pulls the gap to zero, 0 where it does not: of s^2 + 2 damping s + rate^2 the
// larger root, or its size alone when the pair is complex.
static double pulling_rate(const hn_run *run) {
    double damping = hn_method_option(&run->spec, "alpha", 0);
    double rate = hn_method_option(&run->spec, "beta", 0);
    if (hn_run_has_formulation(run, "penalty") ||
        hn_run_has_formulation(run, "augmented-lagrangian")) {
        rate = hn_method_option(&run->spec, "omega", 0);
        damping = rate * hn_method_option(&run->spec, "xi", 0);
    } else if (!hn_run_has_formulation(run, "baumgarte") ||
               hn_method_option(&run->spec, "rule", 0) != 0) {
        return 0;
    }
    const double square = damping * damping - rate * rate;
    return square > 0 ? damping + sqrt(square) : fabs(rate);
}

void hn_run_tell_step_limit(hn_run *run) {
    const double h = hn_method_option(&run->spec, "h", 0);
    const double limit = run->spec.stepper->real_limit;
    const double rate = pulling_rate(run);
    hn_run_over(run, HN_INCIDENT_STEP_LIMIT);
    if (!(rate * h > limit)) {
        return;
    }
    hn_incident *i =
        hn_run_tell(run, HN_INCIDENT_STEP_LIMIT, "alpha h", rate * h, limit,
                    "the stabilisation is too fast for the step: rate x h = %.3g, %s is stable "
                    "up to %.3g",
                    rate * h, run->spec.stepper->name, limit);
    if (!i) {
        return;
    }
    const double safe = 0.1 / h;
    if (hn_run_has_formulation(run, "baumgarte")) {
        snprintf(i->remedy[0], sizeof i->remedy[0], "baumgarte:alpha=%.4g,beta=%.4g@%s:h=%.4g",
                 safe, safe, run->spec.stepper->name, h);
    } else {
        snprintf(i->remedy[0], sizeof i->remedy[0], "%s:omega=%.4g@%s:h=%.4g",
                 run->spec.formulation->name, safe, run->spec.stepper->name, h);
    }
    snprintf(i->remedy[1], sizeof i->remedy[1], "h=%.3g", 0.1 * limit / rate);
}

// who failed to converge: where the integrator gives the reason it was its own iteration, else the formulation's projection
static hn_incident_code code_of_iteration(const hn_run *run) {
    const hn_stepper *stepper = run->spec.stepper;
    const int is_ode = hn_method_form(run->spec.formulation, stepper) == HN_FORM_ODE;
    const int stepper_says =
        run->main.stepper && is_ode && stepper->why && stepper->why(run->main.stepper);
    return is_ode && !stepper_says ? HN_INCIDENT_PROJECTION_FAILED : HN_INCIDENT_NEWTON_FAILED;
}

static hn_incident_code code_of(const hn_run *run, hn_status status) {
    switch (status) {
    case HN_ERR_CHART:
    case HN_ERR_UNSUPPORTED: // no choice of coordinates serves: at the start, or where another was to take over
        return HN_INCIDENT_CHART_LOST;
    case HN_ERR_NO_CONVERGENCE:
        return code_of_iteration(run);
    case HN_ERR_STEP_UNDERFLOW:
        return HN_INCIDENT_STEP_UNDERFLOW;
    case HN_ERR_BUDGET:
        return HN_INCIDENT_BUDGET;
    case HN_ERR_MASS:
        return HN_INCIDENT_MASS;
    case HN_ERR_SINGULAR:
    case HN_ERR_NOT_SPD:
    case HN_ERR_INCONSISTENT:
        return HN_INCIDENT_RANK_LOSS;
    default:
        return HN_INCIDENT_DIVERGED;
    }
}

// M has no inverse: the formulation next to this one that needs none, or its own with the solver that needs none
static void remedy_of_mass(hn_run *run, hn_remedy out) {
    if (hn_run_has_formulation(run, "ggl")) {
        hn_run_remedy_formulation(run, "index2", out);
    } else if (hn_run_has_formulation(run, "symmetric-projection")) {
        hn_run_remedy_formulation(run, "projection", out);
    } else if (hn_method_option(&run->spec, "solver", HN_SOLVER_AUTO) != HN_SOLVER_AUTO) {
        hn_run_remedy_formulation(run, run->spec.formulation->name, out);
    }
}

static void remedies_of_failure(hn_run *run, hn_status status, hn_incident *i) {
    switch (i->code) {
    case HN_INCIDENT_CHART_LOST:
        if (status == HN_ERR_UNSUPPORTED) { // no step, however short, brings such coordinates
            hn_run_remedy_formulation(run, "projection", i->remedy[0]);
            hn_run_remedy_formulation(run, "nullspace", i->remedy[1]);
            break;
        }
        if (hn_run_is_near_singular(run)) {
            hn_run_remedy_robust(run, i->remedy[0]);
            break;
        }
        hn_run_remedy_formulation(
            run, hn_run_has_formulation(run, "partitioning") ? "projection" : "partitioning",
            i->remedy[0]);
        hn_run_remedy_finer(run, 0.25, i->remedy[1]);
        break;
    case HN_INCIDENT_BUDGET:
        hn_run_remedy_finer(run, 10, i->remedy[0]);
        break;
    case HN_INCIDENT_MASS:
        remedy_of_mass(run, i->remedy[0]);
        break;
    case HN_INCIDENT_RANK_LOSS:
        hn_run_remedy_formulation(
            run, hn_run_has_formulation(run, "projection") ? "index1" : "projection", i->remedy[0]);
        hn_run_remedy_finer(run, 0.5, i->remedy[1]);
        break;
    case HN_INCIDENT_STEP_UNDERFLOW:
        hn_run_remedy_robust(run, i->remedy[0]);
        hn_run_remedy_finer(run, 100, i->remedy[1]);
        break;
    case HN_INCIDENT_NEWTON_FAILED:
    case HN_INCIDENT_PROJECTION_FAILED:
        if (hn_run_is_near_singular(run)) {
            hn_run_remedy_robust(run, i->remedy[0]);
            break;
        }
        hn_run_remedy_finer(run, 0.25, i->remedy[0]);
        break;
    default:
        hn_run_remedy_finer(run, 0.25, i->remedy[0]);
        if (!hn_run_has_formulation(run, "projection")) {
            hn_run_remedy_formulation(run, "projection", i->remedy[1]);
        }
        break;
    }
}

void hn_run_tell_failure(hn_run *run, hn_status status) {
    const hn_incident_code code = code_of(run, status);
    // the end of a run is always told, even when the list is full
    if (run->n_incidents == HN_RUN_MAX_INCIDENTS) {
        run->n_incidents--;
    }
    hn_run_over(run, code);
    run->watch.told[code] = 0;
    hn_incident *i = hn_run_tell(run, code, "t", run->now.t, 0, "%s", run->summary.reason);
    if (i) {
        remedies_of_failure(run, status, i);
    }
}
