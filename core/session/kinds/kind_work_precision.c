// SPDX-License-Identifier: GPL-3.0-or-later
// Work-precision study: error against cost, method by method.
#include "session/kinds/job.h"
#include "session/precision/study.h"
#include "session/precision/study_doc.h"
#include "session/precision/study_html.h"

static const hn_field FIELDS[] = {
    HN_JOB_METHODS_FIELD(HN_WP_METHODS, 12),
    HN_JOB_TIME_FIELD,
    HN_JOB_TIME_LIMIT_FIELD("60 when left out, 0: none"),
    HN_JOB_LEVELS_FIELD,
    HN_JOB_SAMPLES_FIELD,
    {.name = "shard",
     .type = HN_FIELD_TEXT,
     .served_max = -1,
     .argument = "I/N",
     .about = "compute part I of N of the study, for 'holonom merge'"},
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_study(const hn_job_request *request, void **work, hn_diags *diags) {
    return hn_study_open(request, (hn_study **)work, diags);
}

static int resumed(const void *work) {
    return hn_study_resumed(work);
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)request;
    hn_study_run(work);
    if (hn_study_wp(work)->status != HN_OK) {
        return hn_diags_add(diags, hn_study_wp(work)->status, NULL, NULL, "out of memory");
    }
    end->stopped = hn_study_wp(work)->stopped;
    end->out_of_time = hn_study_wp(work)->out_of_time;
    end->lost = hn_study_lost(work);
    return HN_OK;
}

static void set_time_limit(void *work, double time_limit) {
    hn_study_set_time_limit(work, time_limit);
}

static void release(void *work) {
    hn_study_free(work);
}

HN_JOB_FORM(html, hn_study, hn_study_html)
HN_JOB_FORM(json, hn_study, hn_study_json)
HN_JOB_FORM(csv, hn_study, hn_study_csv)

const hn_job_kind hn_kind_work_precision = {
    .name = "work-precision",
    .title = "what accuracy costs",
    .about = "the error of each method against its cost",
    .command = "study",
    .words = HN_JOB_WORDS_SCENE,
    .pieces = "points",
    .chooses = "h rtol",
    .served = true,
    .opens_slowly = true,
    .fields = FIELDS,
    .forms = {{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
    .open = open_study,
    .resumed = resumed,
    .run = run,
    .set_time_limit = set_time_limit,
    .release = release,
};
