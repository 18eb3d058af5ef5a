// What each kind of study does: the same documents as the command line's.
#include "http/studies_internal.h"

#include "http/live_internal.h"
#include "session/account_doc.h"
#include "session/study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

double hn_thread_cpu(void) {
    struct timespec ts;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

static int must_stop(void *user) {
    hn_study_work *w = user;
    w->cpu_used_up |= hn_thread_cpu() > w->cpu_end;
    return w->cpu_used_up || atomic_load(&w->stop);
}

/// For a kind that does not share out its budget itself.
static int must_stop_in_time(void *user) {
    hn_study_work *w = user;
    w->out_of_time |= hn_now() > w->wall_end;
    return w->out_of_time || must_stop(w);
}

static void tell_share(void *user, double share) {
    hn_study_work *w = user;
    atomic_store(&w->share, share);
}

/// Why a document is no more than a part; `out_of_time` of what the study itself says.
static void tell_end(const hn_study_work *w, int out_of_time, hn_study_result *out) {
    if (w->cpu_used_up) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason,
                 "the computing time of one study is used up; what was done is shown");
    } else if (atomic_load(&w->stop)) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason, "stopped on request; what was done is shown");
    } else if (out_of_time) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason, "the budget of %g s left something out",
                 w->order.budget);
    } else {
        out->state = HN_STUDY_FINISHED;
    }
}

static void tell_failure(const hn_study_work *w, hn_status status, const hn_diags *diags,
                         hn_study_result *out) {
    hn_study_result ended = {0};
    tell_end(w, 0, &ended);
    out->state = HN_STUDY_FAILED;
    snprintf(out->reason, sizeof out->reason, "%s",
             ended.state == HN_STUDY_STOPPED ? "stopped before there was anything to show"
             : diags->n > 0                  ? diags->item[0].message
                                             : hn_status_text(status));
    if (w->cpu_used_up) {
        snprintf(out->reason, sizeof out->reason,
                 "the computing time of one study is used up before there was anything to show");
    }
    snprintf(out->hint, sizeof out->hint, "%s", diags->n > 0 ? diags->item[0].hint : "");
}

// ---- work-precision ---------------------------------------------------------------------------------------------

static void run_work_precision(hn_study_work *w, hn_study_result *out) {
    hn_study_request request = hn_study_request_default();
    request.methods = (const char *const *)w->order.methods;
    request.n_methods = w->order.n_methods;
    request.time = w->order.time;
    request.budget = w->order.budget;
    request.levels = w->order.levels;
    request.samples = w->order.samples;
    request.hooks = (hn_wp_hooks){.user = w, .stop = must_stop, .progress = tell_share};
    hn_study *study = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_study_open(w->model, &request, &study, &diags);
    if (status != HN_OK) {
        tell_failure(w, status, &diags, out);
        return;
    }
    hn_study_run(study);
    tell_end(w, hn_study_wp(study)->out_of_time, out);
    hn_study_json(&out->document, study);
    hn_study_free(study);
}

// ---- budget -----------------------------------------------------------------------------------------------------

static void run_budget(hn_study_work *w, hn_study_result *out) {
    const hn_accounts_request request = {.methods = (const char *const *)w->order.methods,
                                         .n_methods = w->order.n_methods,
                                         .time = w->order.time,
                                         .stop = must_stop_in_time,
                                         .progress = tell_share,
                                         .user = w};
    hn_diags diags = {0};
    const hn_status status = hn_accounts_json(&out->document, w->model, &request, &diags);
    if (status == HN_OK || status == HN_ERR_BUDGET) {
        tell_end(w, w->out_of_time, out);
    } else {
        tell_failure(w, status, &diags, out);
    }
}

// ---- the table --------------------------------------------------------------------------------------------------

static const hn_study_kind_row KINDS[] = {
    {.name = "work-precision",
     .most_methods = HN_STUDIES_METHODS,
     .options = "levels samples",
     .run = run_work_precision},
    {.name = "budget", .most_methods = HN_STUDIES_METHODS, .options = "", .run = run_budget},
};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

const char *const hn_studies_kind_names[] = {"work-precision", "budget", NULL};

const hn_study_kind_row *hn_study_kind_find(const char *name) {
    for (int i = 0; i < N_KINDS; i++) {
        if (strcmp(KINDS[i].name, name) == 0) {
            return &KINDS[i];
        }
    }
    return NULL;
}
