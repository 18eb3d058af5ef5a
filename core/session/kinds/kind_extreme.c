// SPDX-License-Identifier: GPL-3.0-or-later
// The extreme matrix: cases in which methods break, predicted and observed.
#include "session/extreme/extreme.h"
#include "session/extreme/extreme_doc.h"
#include "session/extreme/extreme_files.h"
#include "session/extreme/extreme_html.h"
#include "session/extreme/extreme_store.h"
#include "session/kinds/job.h"

static const hn_field FIELDS[] = {
    HN_JOB_TIME_LIMIT_FIELD("none when left out"),
    {.name = "long",
     .type = HN_FIELD_BOOL,
     .argument = "",
     .about = "include trials that run for minutes"},
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_cases(const hn_job_request *r, void **work, hn_diags *diags) {
    hn_extreme *x = NULL;
    hn_status status = hn_extreme_load(r->lib, r->ids, r->n_ids, &x, diags);
    if (status == HN_OK && r->limits.folder) {
        status = hn_extreme_resume(x, r->limits.folder, diags);
    }
    if (status != HN_OK) {
        hn_extreme_free(x);
        return status;
    }
    *work = x;
    return HN_OK;
}

static int resumed(const void *work) {
    return ((const hn_extreme *)work)->resumed;
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)diags;
    hn_extreme *x = work;
    hn_extreme_run(x, &request->limits, hn_job_number(request, "long", 0) > 0);
    end->stopped = x->stopped;
    end->out_of_time = x->out_of_time;
    end->lost = x->journal.failed;
    end->differs = hn_extreme_count(x, HN_EXTREME_FAIL) > 0;
    return HN_OK;
}

static void release(void *work) {
    hn_extreme_free(work);
}

HN_JOB_FORM(html, hn_extreme, hn_extreme_html)
HN_JOB_FORM(json, hn_extreme, hn_extreme_json)
HN_JOB_FORM(csv, hn_extreme, hn_extreme_csv)

const hn_job_kind hn_kind_extreme = {
    .name = "extreme",
    .about = "cases in which methods break, predicted and observed",
    .command = "extreme",
    .words = HN_JOB_WORDS_IDS,
    .pieces = "trials",
    .chooses = "",
    .fields = FIELDS,
    .forms = {{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
    .open = open_cases,
    .resumed = resumed,
    .run = run,
    .release = release,
};
