// SPDX-License-Identifier: GPL-3.0-or-later
// What each kind of study does: the same documents as the command line's.
#include "base/clock.h"
#include "http/studies/studies_internal.h"
#include "session/accounts/accounts.h"
#include "session/precision/study.h"
#include "session/stability/stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int must_stop(void *user) {
    hn_study_work *w = user;
    w->cpu_used_up |= hn_clock_thread() > w->cpu_end;
    return w->cpu_used_up || atomic_load(&w->stop);
}

/// For a kind that does not share out its budget itself.
static int must_stop_in_time(void *user) {
    hn_study_work *w = user;
    w->out_of_time |= hn_clock_wall() > w->wall_end;
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
    hn_study_html(&out->report, study);
    hn_study_free(study);
}

// ---- budget -----------------------------------------------------------------------------------------------------

static void run_budget(hn_study_work *w, hn_study_result *out) {
    hn_accounts_request request = hn_accounts_request_default();
    request.methods = (const char *const *)w->order.methods;
    request.n_methods = w->order.n_methods;
    request.time = w->order.time;
    request.stop = must_stop_in_time;
    request.progress = tell_share;
    request.user = w;
    hn_accounts *accounts = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_accounts_open(w->model, &request, &accounts, &diags);
    if (status != HN_OK) {
        tell_failure(w, status, &diags, out);
        return;
    }
    hn_accounts_run(accounts);
    tell_end(w, w->out_of_time, out);
    hn_accounts_json(&out->document, accounts);
    hn_accounts_html(&out->report, accounts);
    hn_accounts_free(accounts);
}

// ---- stability --------------------------------------------------------------------------------------------------

/// The scene as it was asked for, with these parameters on top.
static hn_status load_with(void *user, const hn_setting *settings, int n, hn_model **out,
                           hn_diags *diags) {
    const hn_study_work *w = user;
    hn_scene_request order = {0};
    hn_status status = hn_scene_request_copy(&order, &w->order.scene);
    for (int i = 0; i < n && status == HN_OK; i++) {
        status = hn_scene_request_add(&order, settings[i].name, strlen(settings[i].name),
                                      settings[i].value, diags);
    }
    if (status == HN_OK) {
        status = hn_scene_request_load(&order, w->lib, 0, out, diags);
    }
    hn_scene_request_reset(&order);
    return status;
}

static hn_status prepare_stability(hn_study_work *w, hn_diags *diags) {
    const hn_study_order *o = &w->order;
    hn_map_request request = hn_map_request_default();
    if (o->preset && o->over) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", "take one of them",
                            "a map is over what 'preset' names or over what 'over' says");
    }
    request.over = o->over;
    request.preset = o->preset || o->over ? o->preset : "limits";
    request.columns = o->columns;
    request.rows = o->rows;
    request.methods = (const char *const *)o->methods;
    request.n_methods = o->n_methods;
    request.time = o->time;
    request.budget = o->budget;
    request.load = load_with;
    request.load_user = w;
    request.stop = must_stop;
    request.progress = tell_share;
    request.user = w;
    hn_map *map = NULL;
    w->cpu_end = HUGE_VAL; // the thread of the study sets it to its own clock
    const hn_status status = hn_map_open(w->model, &request, &map, diags);
    w->prepared = map;
    return status;
}

static void run_stability(hn_study_work *w, hn_study_result *out) {
    hn_map *map = w->prepared;
    hn_map_run(map);
    tell_end(w, hn_map_out_of_time(map), out);
    hn_map_json(&out->document, map);
    hn_map_html(&out->report, map);
}

static void release_map(hn_study_work *w) {
    hn_map_free(w->prepared);
    w->prepared = NULL;
}

// ---- the table --------------------------------------------------------------------------------------------------

static const hn_study_kind_row KINDS[] = {
    {.name = "work-precision",
     .most_methods = HN_STUDIES_METHODS,
     .options = "levels samples",
     .run = run_work_precision},
    {.name = "stability",
     .most_methods = HN_STUDIES_MAPS,
     .options = "preset over columns rows",
     .prepare = prepare_stability,
     .run = run_stability,
     .release = release_map},
    {.name = "budget", .most_methods = HN_STUDIES_METHODS, .options = "", .run = run_budget},
};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

const char *const hn_studies_kind_names[] = {"work-precision", "stability", "budget", NULL};

const hn_study_kind_row *hn_study_kind_find(const char *name) {
    for (int i = 0; i < N_KINDS; i++) {
        if (strcmp(KINDS[i].name, name) == 0) {
            return &KINDS[i];
        }
    }
    return NULL;
}
