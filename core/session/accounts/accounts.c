#include "session/accounts/accounts_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

hn_accounts_request hn_accounts_request_default(void) {
    return (hn_accounts_request){.time = (double)NAN};
}

// rows -----------------------------------------------------------------------------------------------------------------

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

// life -----------------------------------------------------------------------------------------------------------------

static hn_status set_methods(hn_accounts *a, hn_diags *diags) {
    const hn_scene *scene = hn_model_scene(a->model);
    const hn_accounts_request *r = &a->request;
    const char *const *methods = r->n_methods > 0 ? r->methods : scene->methods;
    a->n = r->n_methods > 0 ? r->n_methods : scene->n_methods;
    if (a->n > HN_ACCOUNTS_METHODS) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/methods", NULL,
                            "%d methods were given; %d are the most", a->n, HN_ACCOUNTS_METHODS);
    }
    for (int i = 0; i < a->n; i++) {
        hn_diag diag = {0};
        hn_account_row *row = &a->rows[i];
        const hn_status status = hn_method_parse(methods[i], &a->specs[i], &diag);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, "/methods", diag.hint, "%s", diag.message);
        }
        hn_method_format(&a->specs[i], row->spelling);
        row->status = HN_ERR_BUDGET;
        snprintf(row->reason, sizeof row->reason, "not begun");
    }
    return HN_OK;
}

static hn_status set_up(hn_accounts *a, hn_diags *diags) {
    const hn_status status = set_methods(a, diags);
    if (status == HN_OK && !(a->request.time > 0)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the end time is %g s; it must be above 0", a->request.time);
    }
    return status == HN_OK && a->request.folder ? hn_accounts_open_journal(a, diags) : status;
}

hn_status hn_accounts_open(const hn_model *model, const hn_accounts_request *request,
                           hn_accounts **out, hn_diags *diags) {
    hn_accounts *a = calloc(1, sizeof *a);
    if (!a) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    a->model = model;
    a->request = *request;
    a->request.time = isnan(request->time) ? hn_model_scene(model)->duration : request->time;
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

// making ---------------------------------------------------------------------------------------------------------------

static int ask_stop(void *user) {
    const hn_accounts *a = user;
    return a->request.stop && a->request.stop(a->request.user);
}

static void tell_progress(void *user, double part) {
    const hn_accounts *a = user;
    if (a->request.progress) {
        a->request.progress(a->request.user, (a->at + part) / a->n);
    }
}

/// 0 when it was stopped.
static int make_row(hn_accounts *a, hn_account_row *row) {
    const hn_account_opts opts = {.stop = ask_stop, .progress = tell_progress, .user = a};
    hn_diag diag = {0};
    row->status =
        hn_account_make(hn_model_system(a->model), &a->specs[a->at], hn_model_q(a->model),
                        hn_model_v(a->model), a->request.time, &opts, &row->account, &diag);
    snprintf(row->reason, sizeof row->reason, "%s",
             row->status == HN_OK ? row->account.reason : diag.message);
    return row->status != HN_ERR_BUDGET;
}

int hn_accounts_run(hn_accounts *a) {
    int going = 1;
    for (a->at = 0; a->at < a->n && going; a->at++) {
        hn_account_row *row = &a->rows[a->at];
        if (row->status == HN_ERR_BUDGET && (going = make_row(a, row)) != 0) {
            hn_accounts_keep(a, a->at);
        }
    }
    hn_journal_end(&a->journal, going);
    return going;
}

// reading --------------------------------------------------------------------------------------------------------------

int hn_accounts_resumed(const hn_accounts *a) {
    return a->resumed;
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
