// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/budgets/budgets_internal.h"
#include "session/budgets/budgets_store.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// rows ----

const char *hn_budget_state(const hn_budget_row *row) {
    return row->status == HN_ERR_STOPPED        ? "left out"
           : row->status != HN_OK               ? "refused"
           : row->budget.state == HN_RUN_FAILED ? "failed"
                                                : "done";
}

const hn_coordinate *hn_budget_coordinate(const hn_model *model, const hn_budget_row *row) {
    const int i = row->budget.coordinate;
    return row->status != HN_OK || i < 0
               ? NULL
               : &hn_model_scene(model)
                      ->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
}

double hn_budget_part(const hn_budget_row *row, int energy, int i) {
    const hn_budget *a = &row->budget;
    const int of_formulation =
        i == (energy ? (int)HN_ENERGY_FORMULATION : (int)HN_CAUSE_FORMULATION);
    return of_formulation && !a->has_equations ? (double)NAN
           : energy                            ? a->energy_parts[i]
                                               : a->part[i];
}

// smaller errors [rad or m] are rounding: their parts have no meaning
static const double ROUNDING = 1e-11;

double hn_budget_mismatch(const hn_budget_row *row) {
    const double sum = row->budget.sum, error = row->budget.error;
    const double larger = fmax(fabs(sum), fabs(error));
    return row->status != HN_OK || row->budget.coordinate < 0 ? (double)NAN
           : larger > 0                                       ? fabs(sum - error) / larger
                                                              : 0;
}

bool hn_budget_holds(const hn_budget_row *row) {
    const double larger = fmax(fabs(row->budget.sum), fabs(row->budget.error));
    return larger < ROUNDING || !(hn_budget_mismatch(row) > HN_BUDGET_HOLDS);
}

void hn_budget_note(const hn_model *model, const hn_budget_row *row, char out[HN_BUDGET_NOTE]) {
    const hn_coordinate *c = hn_budget_coordinate(model, row);
    const char *unit = c ? hn_coordinate_unit(c, "") : "";
    out[0] = 0;
    if (!c || hn_budget_holds(row)) {
        return;
    }
    const int n = snprintf(
        out, HN_BUDGET_NOTE,
        "the error is too large to be split: the parts add up to %.3g %s, the error is %.3g %s",
        row->budget.sum, unit, row->budget.error, unit);
    if (isfinite(row->holds_until) && n > 0 && n < HN_BUDGET_NOTE) {
        snprintf(out + n, (size_t)(HN_BUDGET_NOTE - n),
                 "; at t = %.3g s the parts still added up to the error, within %.0f %%",
                 row->holds_until, 100 * HN_BUDGET_HOLDS);
    }
}

// ---- life ----

/// The coordinate that the request names, among those that the system has.
static hn_status find_coordinate(hn_budgets *a, hn_diags *diags) {
    const hn_system *sys = hn_model_system(a->model);
    const hn_scene *scene = hn_model_scene(a->model);
    const char *name = hn_job_text(&a->request, "coordinate");
    const int n = hn_system_get_info(sys).n_user;
    char names[HN_DIAG_HINT] = "one of ";
    for (int i = 0; name && i < n; i++) {
        const char *own = scene->coordinates[hn_system_user_coordinate(sys, i)].name;
        if (strcmp(own, name) == 0) {
            a->coordinate = i + 1;
            return HN_OK;
        }
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", own);
    }
    return name ? hn_diags_add(diags, HN_ERR_INPUT, "/coordinate", names,
                               "the scene has no coordinate '%.60s'", name)
                : HN_OK;
}

static hn_status set_up(hn_budgets *a, hn_diags *diags) {
    hn_job_request *r = &a->request;
    if (r->n_methods == 0) {
        int n;
        const char *const *methods = hn_model_methods(a->model, &n);
        HN_TRY(hn_job_request_set_methods(r, methods, n, diags));
    }
    HN_TRY(hn_job_complete(r, 0, HN_BUDGETS_METHODS, a->specs, diags));
    HN_TRY(find_coordinate(a, diags));
    a->n = r->n_methods;
    for (int i = 0; i < a->n; i++) {
        hn_budget_row *row = &a->rows[i];
        hn_method_format(&a->specs[i], row->spelling);
        row->status = HN_ERR_STOPPED;
        row->holds_until = (double)NAN;
        snprintf(row->reason, sizeof row->reason, "not begun");
    }
    return r->limits.folder ? hn_budgets_open_journal(a, diags) : HN_OK;
}

hn_status hn_budgets_open(const hn_job_request *request, hn_budgets **out, hn_diags *diags) {
    hn_budgets *a = calloc(1, sizeof *a);
    if (!a) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    a->model = request->models[0];
    a->request = *request;
    const hn_status status = set_up(a, diags);
    if (status != HN_OK) {
        hn_budgets_free(a);
        return status;
    }
    *out = a;
    return HN_OK;
}

void hn_budgets_free(hn_budgets *a) {
    if (a) {
        hn_journal_end(&a->journal, 0);
        free(a);
    }
}

// making ----

static int ask_stop(void *user) {
    hn_budgets *a = user;
    a->stopped |= hn_job_must_stop(&a->request.limits);
    a->out_of_time |= hn_clock_wall() > a->deadline;
    return a->stopped || a->out_of_time;
}

static void report_progress(void *user, double part) {
    const hn_budgets *a = user;
    hn_job_progress(&a->request.limits, "", (a->at + part) / a->n);
}

/// Finds the time until which the parts add up to the error, by halving the end time until they do.
/// Together these budgets take no longer than the first.
static void find_horizon(hn_budgets *a, hn_budget_row *row) {
    enum { MOST_HALVINGS = 5 };
    const hn_budget_opts opts = {.coordinate = a->coordinate, .stop = ask_stop, .user = a};
    hn_budget_row shorter = *row;
    double T = row->budget.t;
    for (int k = 0; k < MOST_HALVINGS && !hn_budget_holds(&shorter); k++) {
        hn_diag diag = {0};
        T /= 2;
        shorter.status =
            hn_budget_make(hn_model_system(a->model), &a->specs[a->at], hn_model_q(a->model),
                           hn_model_v(a->model), T, &opts, &shorter.budget, &diag);
        if (shorter.status != HN_OK || shorter.budget.coordinate < 0) {
            return;
        }
    }
    row->holds_until = hn_budget_holds(&shorter) ? T : (double)NAN;
}

/// Computes the budget of one method. Returns 0 when it was stopped.
static bool make_row(hn_budgets *a, hn_budget_row *row) {
    const hn_budget_opts opts = {
        .coordinate = a->coordinate, .stop = ask_stop, .progress = report_progress, .user = a};
    hn_diag diag = {0};
    row->status = hn_budget_make(hn_model_system(a->model), &a->specs[a->at], hn_model_q(a->model),
                                 hn_model_v(a->model), a->request.time, &opts, &row->budget, &diag);
    snprintf(row->reason, sizeof row->reason, "%s",
             row->status == HN_OK ? row->budget.reason : diag.message);
    if (row->status == HN_OK && row->budget.coordinate >= 0) {
        find_horizon(a, row);
    }
    a->stopped |= hn_system_was_stopped(hn_model_system(a->model));
    return row->status != HN_ERR_STOPPED && !a->stopped && !a->out_of_time;
}

bool hn_budgets_run(hn_budgets *a) {
    const double limit = a->request.limits.time_limit;
    bool going = true;
    a->deadline = limit > 0 ? hn_clock_wall() + limit : HUGE_VAL;
    a->stopped = a->out_of_time = 0;
    for (a->at = 0; a->at < a->n && going; a->at++) {
        if (a->whole[a->at]) {
            continue;
        }
        going = a->whole[a->at] = make_row(a, &a->rows[a->at]);
        if (going) {
            hn_budgets_keep(a, a->at);
        }
    }
    hn_journal_end(&a->journal, going);
    return going;
}

void hn_budgets_set_time_limit(hn_budgets *a, double time_limit) {
    a->request.limits.time_limit = time_limit;
}

// reading ----

bool hn_budgets_lost(const hn_budgets *a) {
    return a->journal.failed;
}

int hn_budgets_resumed(const hn_budgets *a) {
    return a->resumed;
}

bool hn_budgets_stopped(const hn_budgets *a) {
    return a->stopped;
}

bool hn_budgets_out_of_time(const hn_budgets *a) {
    return a->out_of_time;
}

int hn_budgets_n(const hn_budgets *a) {
    return a->n;
}

const hn_budget_row *hn_budgets_at(const hn_budgets *a, int i) {
    return &a->rows[i];
}

const hn_model *hn_budgets_model(const hn_budgets *a) {
    return a->model;
}

double hn_budgets_time(const hn_budgets *a) {
    return a->request.time;
}
