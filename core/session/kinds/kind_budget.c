// SPDX-License-Identifier: GPL-3.0-or-later
// Error budget: where the error at the end of a run comes from, and where its energy goes.
#include "session/accounts/accounts.h"
#include "session/kinds/job.h"
#include "session/accounts/accounts_doc.h"
#include "session/accounts/accounts_html.h"

static const hn_field FIELDS[] = {
    HN_JOB_METHODS_FIELD(HN_ACCOUNTS_METHODS, 12),
    HN_JOB_TIME_FIELD,
    HN_JOB_TIME_LIMIT_FIELD("none when left out"),
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_accounts(const hn_job_request *request, void **work, hn_diags *diags) {
    return hn_accounts_open(request, (hn_accounts **)work, diags);
}

static int resumed(const void *work) {
    return hn_accounts_resumed(work);
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)request, (void)diags;
    hn_accounts_run(work);
    end->stopped = hn_accounts_stopped(work);
    end->out_of_time = hn_accounts_out_of_time(work);
    end->lost = hn_accounts_lost(work);
    return HN_OK;
}

static void release(void *work) {
    hn_accounts_free(work);
}

HN_JOB_FORM(html, hn_accounts, hn_accounts_html)
HN_JOB_FORM(json, hn_accounts, hn_accounts_json)
HN_JOB_FORM(csv, hn_accounts, hn_accounts_csv)

const hn_job_kind hn_kind_budget = {
    .name = "budget",
    .about = "where the error at the end and the energy come from",
    .command = "study",
    .words = HN_JOB_WORDS_SCENE,
    .pieces = "methods",
    .chooses = "",
    .served = true,
    .fields = FIELDS,
    .forms = {{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
    .open = open_accounts,
    .resumed = resumed,
    .run = run,
    .release = release,
};
