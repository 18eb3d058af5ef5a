// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_quantity.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_measure.h"
#include "session/extreme/extreme_model.h"
#include "session/extreme/extreme_solve.h"
#include "session/extreme/extreme_verdict.h"
#include "session/extreme/extreme_walk.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int n_user(const hn_extreme_check *look) {
    return hn_system_get_info(hn_model_system(look->model)).n_user;
}

/// Returns the index of a user coordinate, by its name or the name of its rate; -1: none.
static int find_coordinate(const hn_extreme_check *look, const char *name) {
    const hn_system *sys = hn_model_system(look->model);
    const hn_scene *scene = hn_model_scene(look->model);
    for (int i = 0; i < n_user(look); i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(sys, i)];
        if (strcmp(c->name, name) == 0 || strcmp(c->rate, name) == 0) {
            return i;
        }
    }
    return -1;
}

static double largest_difference(const double *x, const double *y, int n) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        worst = fmax(worst, fabs(x[i] - y[i]));
    }
    return worst;
}

// errors ----

/// Returns the largest error of the coordinates that the truth names, or of all.
static double error_q(const hn_extreme_check *look) {
    const hn_extreme_trial *t = look->point->trial;
    double worst = 0;
    if (t->truth_method) {
        return largest_difference(look->end.q, look->truth, n_user(look));
    }
    for (int i = 0; i < t->n_truth; i++) {
        const int k = find_coordinate(look, t->truth[i].name);
        double exact = 0;
        hn_diags diags = {0};
        if (k < 0 || hn_extreme_value(&t->truth[i].number, t->sweep, look->point->value, &exact,
                                      &diags) != HN_OK) {
            return (double)NAN;
        }
        worst = fmax(worst, fabs(look->end.q[k] - exact));
    }
    return worst;
}

static double error_v(const hn_extreme_check *look) {
    return look->truth_v ? largest_difference(look->end.v, look->truth_v, n_user(look))
                         : (double)NAN;
}

static int n_rows(const hn_extreme_check *look) {
    return hn_system_get_info(hn_model_system(look->model)).nc;
}

static double error_lambda(const hn_extreme_check *look) {
    return look->truth_lambda
               ? largest_difference(look->end.lambda, look->truth_lambda, n_rows(look))
               : (double)NAN;
}

static double error_raw(const hn_extreme_check *look) {
    return look->truth_lambda && look->end.raw_lambda
               ? largest_difference(look->end.raw_lambda, look->truth_lambda, n_rows(look))
               : (double)NAN;
}

static double raw_lambda(const hn_extreme_check *look) {
    return look->end.raw_lambda ? hn_norm2(n_rows(look), look->end.raw_lambda) : (double)NAN;
}

static double lambda(const hn_extreme_check *look) {
    return hn_norm2(n_rows(look), look->end.lambda);
}

// gaps and energies ----

static double gap(const hn_extreme_check *look) {
    return look->end.gap;
}
static double speed_gap(const hn_extreme_check *look) {
    return look->end.velocity_gap;
}
static double worst_gap(const hn_extreme_check *look) {
    return look->summary.worst_gap;
}
static double worst_speed_gap(const hn_extreme_check *look) {
    return look->summary.worst_velocity_gap;
}
static double energy_change(const hn_extreme_check *look) {
    return look->end.energy - look->start_energy;
}
static double energy_error(const hn_extreme_check *look) {
    return fabs(energy_change(look));
}
static double worst_energy_error(const hn_extreme_check *look) {
    return fabs(look->summary.worst_energy_change);
}
static double energy_removed(const hn_extreme_check *look) {
    return look->summary.cost.energy_removed;
}
static double energy_share(const hn_extreme_check *look) {
    return energy_change(look) / look->start_energy;
}
static double energy_growth(const hn_extreme_check *look) {
    return log(look->end.energy / look->start_energy);
}

// steps ----

static double steps(const hn_extreme_check *look) {
    return (double)look->summary.steps;
}
static double rejected(const hn_extreme_check *look) {
    return (double)look->summary.rejected;
}
static double rejected_share(const hn_extreme_check *look) {
    return rejected(look) / (rejected(look) + steps(look));
}
static double evaluations(const hn_extreme_check *look) {
    return (double)look->summary.cost.evals;
}
static double chart_changes(const hn_extreme_check *look) {
    return (double)look->summary.cost.chart_changes;
}
static double time_reached(const hn_extreme_check *look) {
    return look->summary.t;
}
static double least_step(const hn_extreme_check *look) {
    return look->least_step;
}
static double ringing(const hn_extreme_check *look) {
    return look->last / look->first;
}
static double per_step_ringing(const hn_extreme_check *look) {
    // between the middles of the first and the last tenth
    return exp(log(ringing(look)) / (0.9 * steps(look)));
}

// states and incidents ----

/// Returns the coordinate or rate of that name at the last good state.
static double coordinate(const hn_extreme_check *look) {
    const int k = find_coordinate(look, look->point->trial->coordinate);
    const hn_scene *scene = hn_model_scene(look->model);
    hn_sample s = look->end;
    if (k < 0 ||
        (look->status != HN_OK && hn_run_sample(look->run, hn_run_time(look->run), &s) != HN_OK)) {
        return (double)NAN;
    }
    const int c = hn_system_user_coordinate(hn_model_system(look->model), k);
    const int is_rate = strcmp(scene->coordinates[c].rate, look->point->trial->coordinate) == 0;
    return is_rate ? s.v[k] : s.q[k];
}

static const hn_incident *find_incident(const hn_extreme_check *look) {
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(look->run, &list);
    for (int i = 0; i < n; i++) {
        if (strcmp(hn_incident_spelling(list[i].code), look->point->trial->incident) == 0) {
            return &list[i];
        }
    }
    return NULL;
}
static double incident_told(const hn_extreme_check *look) {
    return find_incident(look) != NULL;
}
static double incident_time(const hn_extreme_check *look) {
    const hn_incident *found = find_incident(look);
    return found ? found->t : (double)NAN;
}
static double incident_count(const hn_extreme_check *look) {
    const hn_incident *list = NULL;
    return hn_run_incidents(look->run, &list);
}

// models ----

static double assembly_gap(const hn_extreme_check *look) {
    return hn_model_assembly(look->model)->gap;
}
static double rank(const hn_extreme_check *look) {
    return hn_model_assembly(look->model)->rank;
}
static double freedoms(const hn_extreme_check *look) {
    return hn_model_assembly(look->model)->freedoms;
}
static double sigma_min(const hn_extreme_check *look) {
    return hn_model_assembly(look->model)->sigma_min;
}

// answers ----

static double solve_error(const hn_extreme_answer *a) {
    return a->error;
}
static double solve_force_error(const hn_extreme_answer *a) {
    return a->force_error;
}
static double solve_norm_share(const hn_extreme_answer *a) {
    return a->lambda_norm / a->exact_lambda_norm;
}

#define EARLY HN_EXTREME_FAILED_TOO
#define WATCHED HN_EXTREME_WATCHED
const hn_extreme_quantity hn_extreme_quantities[] = {
    {"error", "", "largest error of a coordinate at the end", HN_EXTREME_TRUTH, error_q, NULL},
    {"error-v", "", "of a rate", HN_EXTREME_TRUTH, error_v, NULL},
    {"error-lambda", "", "of a multiplier, recomputed at the state", HN_EXTREME_TRUTH, error_lambda,
     NULL},
    {"error-raw-lambda", "", "of a multiplier as the scheme found it",
     HN_EXTREME_TRUTH | HN_EXTREME_RAW, error_raw, NULL},
    {"lambda", "", "length of the multipliers at the end", 0, lambda, NULL},
    {"raw-lambda", "", "length of the scheme's own multipliers at the end", HN_EXTREME_RAW,
     raw_lambda, NULL},
    {"gap", "", "length of the constraints at the end", 0, gap, NULL},
    {"speed-gap", "", "length of their rates at the end", 0, speed_gap, NULL},
    {"worst-gap", "", "largest gap during the run", EARLY | WATCHED, worst_gap, NULL},
    {"worst-speed-gap", "", "largest rate of the gap during the run", EARLY | WATCHED,
     worst_speed_gap, NULL},
    {"energy-change", "J", "energy at the end less that at the start", 0, energy_change, NULL},
    {"energy-error", "J", "its size", 0, energy_error, NULL},
    {"worst-energy-error", "J", "its largest size during the run", EARLY | WATCHED,
     worst_energy_error, NULL},
    {"energy-removed", "J", "energy that projections remove, as the method counts it", 0,
     energy_removed, NULL},
    {"energy-share", "", "energy change over the energy at the start", 0, energy_share, NULL},
    {"energy-growth", "", "logarithm of the energy over that at the start", 0, energy_growth, NULL},
    {"steps", "", "steps taken", EARLY, steps, NULL},
    {"rejected", "", "steps rejected", EARLY, rejected, NULL},
    {"rejected-share", "", "share of rejected steps among all steps tried", EARLY, rejected_share,
     NULL},
    {"evaluations", "", "evaluations of the right-hand side", EARLY, evaluations, NULL},
    {"chart-changes", "", "how often other independent coordinates were chosen", EARLY,
     chart_changes, NULL},
    {"time-reached", "s", "time at which the run ended", EARLY, time_reached, NULL},
    {"least-step", "s", "smallest step", HN_EXTREME_EACH_STEP, least_step, NULL},
    {"ringing", "", "largest rate of the last tenth over that of the first", HN_EXTREME_EACH_STEP,
     ringing, NULL},
    {"ringing-per-step", "", "its factor for each step", HN_EXTREME_EACH_STEP, per_step_ringing,
     NULL},
    {"coordinate", "", "a coordinate or rate at the last good state", EARLY | HN_EXTREME_COORDINATE,
     coordinate, NULL},
    {"incident-told", "", "1 when the run reported it", EARLY | WATCHED | HN_EXTREME_INCIDENT,
     incident_told, NULL},
    {"incident-time", "s", "when it was reported", EARLY | WATCHED | HN_EXTREME_INCIDENT,
     incident_time, NULL},
    {"incidents", "", "how many were reported, of any kind", EARLY | WATCHED, incident_count, NULL},
    {"assembly-gap", "", "gap that assembly leaves", HN_EXTREME_MODEL, assembly_gap, NULL},
    {"rank", "", "rank of J at the start", HN_EXTREME_MODEL, rank, NULL},
    {"dof", "", "at the start", HN_EXTREME_MODEL, freedoms, NULL},
    {"sigma-min", "", "smallest singular value of J D at the start", HN_EXTREME_MODEL, sigma_min,
     NULL},
    {"solve-error", "", "of the accelerations, relative", HN_EXTREME_SOLVE, NULL, solve_error},
    {"solve-force-error", "", "of J' lambda, relative", HN_EXTREME_SOLVE, NULL, solve_force_error},
    {"solve-lambda-share", "", "length of lambda over that of one exact solution", HN_EXTREME_SOLVE,
     NULL, solve_norm_share},
};
const int hn_extreme_n_quantities = sizeof hn_extreme_quantities / sizeof *hn_extreme_quantities;

static double of_answer(hn_extreme_bench *bench, const hn_extreme_point *point, char reason[200],
                        hn_status *status) {
    hn_extreme_answer answer;
    hn_extreme_solve(bench, point, &answer);
    *status = answer.status;
    if (answer.status != HN_OK) {
        snprintf(reason, 200, "%s", answer.reason);
        return (double)NAN;
    }
    return point->trial->of->of_answer(&answer);
}

double hn_extreme_quantity_of(hn_extreme_bench *bench, const hn_extreme_point *point,
                              char reason[200], hn_status *status) {
    const hn_extreme_quantity *of = point->trial->of;
    double value = (double)NAN;
    hn_extreme_check look;
    reason[0] = 0;

    // a solver's answer needs no run
    if (of->needs & HN_EXTREME_SOLVE) {
        return of_answer(bench, point, reason, status);
    }

    // make the run; some quantities exist for a run that ended early
    hn_extreme_check_begin(bench, point, of->needs, &look);
    *status = look.status;
    const int early =
        (of->needs & HN_EXTREME_FAILED_TOO) && look.run && !hn_extreme_is_stopped(bench);
    if (look.status == HN_OK || early) {
        value = of->of_run(&look) / point->trial->scale;
    }

    // without a number, give the outcome as the reason
    if (isnan(value)) {
        snprintf(reason, 200, "%s%s%.150s", hn_extreme_outcome(look.status),
                 look.reason[0] ? ": " : "", look.reason);
    }
    hn_extreme_check_end(&look);
    return value;
}
