// SPDX-License-Identifier: GPL-3.0-or-later
// The full report: studies, error budgets and survival of several scenes in one page.
#include "session/kinds/job.h"
#include "session/report/report.h"
#include "session/report/report_doc.h"
#include "session/report/report_html.h"

static const hn_field FIELDS[] = {
    HN_JOB_METHODS_FIELD(HN_WP_METHODS, 0),
    HN_JOB_TIME_LIMIT_FIELD("240 when left out, 0: none"),
    HN_JOB_LEVELS_FIELD,
    HN_JOB_SAMPLES_FIELD,
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_report(const hn_job_request *request, void **work, hn_diags *diags) {
    return hn_report_open(request, (hn_report **)work, diags);
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)request;
    HN_TRY(hn_report_run(work, diags));
    end->stopped = hn_report_stopped(work);
    return HN_OK;
}

static void release(void *work) {
    hn_report_free(work);
}

HN_JOB_FORM(html, hn_report, hn_report_html)
HN_JOB_FORM(json, hn_report, hn_report_json)

const hn_job_kind hn_kind_report = {
    .name = "report",
    .about = "work-precision, error budgets and survival of several scenes on one page",
    .command = "report",
    .pieces = "points",
    .chooses = "h rtol",
    .opens_slowly = true,
    .fields = FIELDS,
    .forms = {{".html", put_html}, {".json", put_json}},
    .open = open_report,
    .run = run,
    .release = release,
};
