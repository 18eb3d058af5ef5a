// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/accounts/accounts_internal.h"
#include "session/accounts/accounts_store.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

// rows ----

const char *hn_account_state(const hn_account_row *row) {
    return row->status == HN_ERR_BUDGET          ? "left out"
           : row->status != HN_OK                ? "refused"
           : row->account.state == HN_RUN_FAILED ? "failed"
                                                 : "done";
}

const hn_coordinate *hn_account_coordinate(const hn_model *model, const hn_account_row *row) {
    const int i = row->account.coordinate;
    return row->status != HN_OK || i < 0
               ? NULL
               : &hn_model_scene(model)
                      ->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
}

double hn_account_part(const hn_account_row *row, int energy, int i) {
    const hn_account *a = &row->account;
    const int of_formulation = i == (energy ? (int)HN_BILL_FORMULATION : (int)HN_CAUSE_FORMULATION);
    return of_formulation && !a->has_equations ? (double)NAN : energy ? a->bill[i] : a->part[i];
}

// smaller errors [rad or m] are rounding: their parts have no meaning
static const double ROUNDING = 1e-11;

double hn_account_mismatch(const hn_account_row *row) {
    const double sum = row->account.sum, error = row->account.error;
    const double larger = fmax(fabs(sum), fabs(error));
    return row->status != HN_OK || row->account.coordinate < 0 ? (double)NAN
           : larger > 0                                        ? fabs(sum - error) / larger
                                                               : 0;
}

bool hn_account_holds(const hn_account_row *row) {
    const double larger = fmax(fabs(row->account.sum), fabs(row->account.error));
    return larger < ROUNDING || !(hn_account_mismatch(row) > HN_ACCOUNT_HOLDS);
}

void hn_account_note(const hn_model *model, const hn_account_row *row, char out[HN_ACCOUNT_NOTE]) {
    const hn_coordinate *c = hn_account_coordinate(model, row);
    const char *unit = c && c->kind == HN_LENGTH ? "m" : "rad";
    out[0] = 0;
    if (!c || hn_account_holds(row)) {
        return;
    }
    const int n =
        snprintf(out, HN_ACCOUNT_NOTE,
                 "first order has ended: the parts add up to %.3g %s, the error is %.3g %s",
                 row->account.sum, unit, row->account.error, unit);
    if (isfinite(row->holds_until) && n > 0 && n < HN_ACCOUNT_NOTE) {
        snprintf(out + n, (size_t)(HN_ACCOUNT_NOTE - n), "; they agree until t = %.3g s",
                 row->holds_until);
    }
}

// ---- life ----

static hn_status set_up(hn_accounts *a, hn_diags *diags) {
    hn_job_request *r = &a->request;
    if (r->n_methods == 0) {
        int n;
        const char *const *methods = hn_model_methods(a->model, &n);
        HN_TRY(hn_job_request_set_methods(r, methods, n, diags));
    }
    HN_TRY(hn_job_complete(r, 0, HN_ACCOUNTS_METHODS, a->specs, diags));
    a->n = r->n_methods;
    for (int i = 0; i < a->n; i++) {
        hn_account_row *row = &a->rows[i];
        hn_method_format(&a->specs[i], row->spelling);
        row->status = HN_ERR_BUDGET;
        row->holds_until = (double)NAN;
        snprintf(row->reason, sizeof row->reason, "not begun");
    }
    return r->limits.folder ? hn_accounts_open_journal(a, diags) : HN_OK;
}

hn_status hn_accounts_open(const hn_job_request *request, hn_accounts **out, hn_diags *diags) {
    hn_accounts *a = calloc(1, sizeof *a);
    if (!a) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    a->model = request->models[0];
    a->request = *request;
    const hn_status status = set_up(a, diags);
    if (status != HN_OK) {
        hn_accounts_free(a);
        return status;
    }
    *out = a;
    return HN_OK;
}

void hn_accounts_free(hn_accounts *a) {
    if (a) {
        hn_journal_end(&a->journal, 0);
        free(a);
    }
}

// making ----

static int ask_stop(void *user) {
    hn_accounts *a = user;
    a->stopped |= hn_job_must_stop(&a->request.limits);
    a->out_of_time |= hn_clock_wall() > a->deadline;
    return a->stopped || a->out_of_time;
}

static void report_progress(void *user, double part) {
    const hn_accounts *a = user;
    hn_job_progress(&a->request.limits, "", (a->at + part) / a->n);
}

/// Finds the time until which the parts add up to the error, by halving the end time until they do.
/// Together these budgets take no longer than the first.
static void find_horizon(hn_accounts *a, hn_account_row *row) {
    enum { MOST_HALVINGS = 5 };
    const hn_account_opts opts = {.stop = ask_stop, .user = a};
    hn_account_row shorter = *row;
    double T = row->account.t;
    for (int k = 0; k < MOST_HALVINGS && !hn_account_holds(&shorter); k++) {
        hn_diag diag = {0};
        T /= 2;
        shorter.status =
            hn_account_make(hn_model_system(a->model), &a->specs[a->at], hn_model_q(a->model),
                            hn_model_v(a->model), T, &opts, &shorter.account, &diag);
        if (shorter.status != HN_OK || shorter.account.coordinate < 0) {
            return;
        }
    }
    row->holds_until = hn_account_holds(&shorter) ? T : (double)NAN;
}

/// Computes the budget of one method. Returns 0 when it was stopped.
static bool make_row(hn_accounts *a, hn_account_row *row) {
    const hn_account_opts opts = {.stop = ask_stop, .progress = report_progress, .user = a};
    hn_diag diag = {0};
    row->status =
        hn_account_make(hn_model_system(a->model), &a->specs[a->at], hn_model_q(a->model),
                        hn_model_v(a->model), a->request.time, &opts, &row->account, &diag);
    snprintf(row->reason, sizeof row->reason, "%s",
             row->status == HN_OK ? row->account.reason : diag.message);
    if (row->status == HN_OK && row->account.coordinate >= 0) {
        find_horizon(a, row);
    }
    return row->status != HN_ERR_BUDGET && !a->stopped && !a->out_of_time;
}

bool hn_accounts_run(hn_accounts *a) {
    const double limit = a->request.limits.time_limit;
    int going = 1;
    a->deadline = limit > 0 ? hn_clock_wall() + limit : HUGE_VAL;
    for (a->at = 0; a->at < a->n && going; a->at++) {
        hn_account_row *row = &a->rows[a->at];
        if (row->status == HN_ERR_BUDGET && (going = make_row(a, row)) != 0) {
            hn_accounts_keep(a, a->at);
        }
    }
    hn_journal_end(&a->journal, going);
    return going;
}

// reading ----

bool hn_accounts_lost(const hn_accounts *a) {
    return a->journal.failed;
}

int hn_accounts_resumed(const hn_accounts *a) {
    return a->resumed;
}

bool hn_accounts_stopped(const hn_accounts *a) {
    return a->stopped;
}

bool hn_accounts_out_of_time(const hn_accounts *a) {
    return a->out_of_time;
}

int hn_accounts_n(const hn_accounts *a) {
    return a->n;
}

const hn_account_row *hn_accounts_at(const hn_accounts *a, int i) {
    return &a->rows[i];
}

const hn_model *hn_accounts_model(const hn_accounts *a) {
    return a->model;
}

double hn_accounts_time(const hn_accounts *a) {
    return a->request.time;
}
