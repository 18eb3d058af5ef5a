// SPDX-License-Identifier: GPL-3.0-or-later
// Error budget: where the error at the end of a run comes from, and where its energy goes.
#include "base/json_text.h"
#include "session/budgets/budgets.h"
#include "session/budgets/budgets_doc.h"
#include "session/budgets/budgets_html.h"
#include "session/kinds/job.h"

static const hn_field FIELDS[] = {
    HN_JOB_METHODS_FIELD(HN_BUDGETS_METHODS, 12),
    HN_JOB_TIME_FIELD,
    HN_JOB_TIME_LIMIT_FIELD("none when left out"),
    {.name = "coordinate",
     .type = HN_FIELD_TEXT,
     .argument = "NAME",
     .about = "coordinate whose error is split; when left out, for each method the one with the "
              "largest error at the end"},
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_budgets(const hn_job_request *request, void **work, hn_diags *diags) {
    return hn_budgets_open(request, (hn_budgets **)work, diags);
}

static int resumed(const void *work) {
    return hn_budgets_resumed(work);
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)request, (void)diags;
    hn_budgets_run(work);
    end->stopped = hn_budgets_stopped(work);
    end->out_of_time = hn_budgets_out_of_time(work);
    end->lost = hn_budgets_lost(work);
    return HN_OK;
}

static void set_time_limit(void *work, double time_limit) {
    hn_budgets_set_time_limit(work, time_limit);
}

static void release(void *work) {
    hn_budgets_free(work);
}

static void put_part(hn_strbuf *b, const hn_budget_part_words *words) {
    hn_json_object(b);
    hn_json_put_string(b, "name", words->name);
    hn_json_put_string(b, "letter", words->letter);
    hn_json_put_string(b, "word", words->word);
    hn_json_put_string(b, "about", words->about);
    hn_json_end_object(b);
}

static void put_parts(hn_strbuf *b) {
    hn_json_object(b);
    hn_json_key(b, "error");
    hn_json_array(b);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        put_part(b, hn_cause_words((hn_cause)i));
    }
    hn_json_end_array(b);
    hn_json_key(b, "energy");
    hn_json_array(b);
    for (int i = 0; i < HN_ENERGY_COUNT; i++) {
        put_part(b, hn_energy_item_words((hn_energy_item)i));
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

HN_JOB_FORM(html, hn_budgets, hn_budgets_html)
HN_JOB_FORM(json, hn_budgets, hn_budgets_json)
HN_JOB_FORM(csv, hn_budgets, hn_budgets_csv)

const hn_job_kind hn_kind_budget = {
    .name = "budget",
    .title = "where the error comes from",
    .about = "which causes add up to the error at the end and to the change of energy",
    .command = "study",
    .words = HN_JOB_WORDS_SCENE,
    .pieces = "methods",
    .chooses = "",
    .served = true,
    .fields = FIELDS,
    .put_parts = put_parts,
    .forms = {{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
    .open = open_budgets,
    .resumed = resumed,
    .run = run,
    .set_time_limit = set_time_limit,
    .release = release,
};
