// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_work.h"

#include "base/clock.h"
#include "base/units.h"
#include "http/request/request.h"
#include "http/studies/study_folder.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// ---- what is asked for ----

static int must_stop(void *user) {
    hn_study_work *w = user;
    w->cpu_used_up |= hn_clock_thread() > w->cpu_end;
    return w->cpu_used_up || atomic_load(&w->stop);
}

/// Returns whether equations are no longer wanted: of the scene, and of its methods while the study
/// computes. Members written afterwards need none.
static bool must_end(void *user) {
    hn_study_work *w = user;
    w->out_of_time |= w->computes && hn_clock_wall() > w->wall_end;
    return (w->asker && hn_request_is_unwanted(w->asker)) || atomic_load(w->stopping) ||
           hn_clock_thread() > w->load_end || (w->computes && (must_stop(w) || w->out_of_time));
}

static hn_interrupt interrupt_of(hn_study_work *w) {
    return (hn_interrupt){must_end, w};
}

/// The scene as it was asked for, with these parameters on top.
static hn_status load_with(void *user, const hn_setting *parameters, int n, hn_model **out,
                           hn_diags *diags) {
    hn_study_work *w = user;
    hn_scene_request scene = {0};
    hn_status status = hn_scene_request_copy(&scene, &w->scene);
    for (int i = 0; i < n && status == HN_OK; i++) {
        status = hn_scene_request_set(&scene, &parameters[i], diags);
    }
    HN_THEN(status, hn_scene_request_load(&scene, w->lib, 0, interrupt_of(w), out, diags));
    hn_scene_request_reset(&scene);
    return status;
}

/// The same share by another sum may be less by a rounding error: what is told never falls.
static void keep_share(void *user, const char *part, double share) {
    hn_study_work *w = user;
    (void)part;
    atomic_store(&w->share, fmax(share, atomic_load(&w->share)));
}

/// The members of the body that are fields of the kind, checked and with the bounds of this server.
static hn_status read_fields(hn_study_work *w, const cJSON *body, const hn_http_opts *opts,
                             hn_diags *diags) {
    const char *kind = hn_fields_text(body, "kind");
    w->kind = kind ? hn_job_kind_find(kind) : NULL;
    if (!w->kind) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/kind", "the index of the API lists the kinds",
                            "'kind' is missing, or names no kind of study");
    }

    // the body without what is read elsewhere
    w->body = cJSON_Duplicate(body, 1);
    if (!w->body) {
        return HN_ERR_MEMORY;
    }
    cJSON_DeleteItemFromObjectCaseSensitive(w->body, "scene");
    cJSON_DeleteItemFromObjectCaseSensitive(w->body, "parameters");
    cJSON_DeleteItemFromObjectCaseSensitive(w->body, "kind");

    // the fields of the kind
    HN_TRY(hn_job_check(w->kind, w->body, true, diags));
    HN_TRY(hn_job_request_read(&w->request, w->body, w->kind->fields, diags));

    // the bounds of this server
    double *limit = &w->request.limits.time_limit;
    *limit = isnan(*limit) ? opts->max_run_cpu : *limit;
    if (w->request.time > opts->max_duration) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/time", NULL,
                            "the time is %.*g s; at most %g s are run",
                            hn_digits_apart(w->request.time, opts->max_duration, 6),
                            w->request.time, opts->max_duration);
    }
    return HN_OK;
}

/// Tries every spelling, so that each fault is reported and before the computation.
static hn_status check_methods(const hn_job_request *r, hn_diags *diags) {
    hn_status status = HN_OK;
    for (int i = 0; i < r->n_methods; i++) {
        hn_method_spec spec;
        hn_diag diag = {0};
        char pointer[32];
        snprintf(pointer, sizeof pointer, "/methods/%d", i);
        const hn_status one = hn_method_parse(r->methods[i], &spec, &diag);
        if (one != HN_OK) {
            status = hn_diags_add(diags, one, pointer, diag.hint, "%s", diag.message);
        }
    }
    return status;
}

/// Opens the job. A study that cannot be kept, because the same one runs already or the disk is
/// full, is computed without being kept.
static hn_status open_job(hn_study_work *w, hn_diags *diags) {
    hn_diags kept = *diags;
    hn_status status = hn_job_open(w->kind, &w->request, &w->job, diags);
    if (status == HN_ERR_IO && w->request.limits.folder) {
        *diags = kept;
        w->request.limits.folder = NULL;
        status = hn_job_open(w->kind, &w->request, &w->job, diags);
    }
    return status;
}

hn_status hn_study_work_read(hn_study_work *w, const cJSON *body, const hn_http_opts *opts,
                             hn_diags *diags) {
    w->request = hn_job_request_default(NULL);
    HN_TRY(read_fields(w, body, opts, diags));
    HN_TRY(check_methods(&w->request, diags));

    // the scene, and how long it may last
    HN_TRY(hn_scene_request_read(&w->scene, body, diags));
    w->load_end = hn_clock_thread() + opts->max_run_cpu;
    HN_TRY(hn_scene_request_load(&w->scene, w->lib, 0, interrupt_of(w), &w->model, diags));
    w->load_end = HUGE_VAL;
    const double duration = hn_model_scene(w->model)->duration;
    if (isnan(w->request.time) && !(duration <= opts->max_duration)) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/time", "say until when",
                            "the scene lasts %.*g s; at most %g s are run",
                            hn_digits_apart(duration, opts->max_duration, 6), duration,
                            opts->max_duration);
    }

    // the job; what opens slowly is left to the thread of the study
    w->request.models[0] = w->model;
    w->request.n_models = 1;
    w->request.load = load_with;
    w->request.load_user = w;
    w->request.limits.stop = must_stop;
    w->request.limits.progress = keep_share;
    w->request.limits.user = w;
    w->cpu_end = HUGE_VAL;
    const bool keeps = hn_study_folder_ready(opts->runs_folder, w->folder, sizeof w->folder);
    w->request.limits.folder = keeps ? w->folder : NULL;
    return w->kind->opens_slowly ? HN_OK : open_job(w, diags);
}

void hn_study_work_reset(hn_study_work *w) {
    hn_job_free(w->job);
    hn_model_free(w->model);
    hn_scene_request_reset(&w->scene);
    cJSON_Delete(w->body);
    w->job = NULL;
    w->model = NULL;
    w->body = NULL;
}

// ---- the computation ----

/// Says why a document is no more than a part.
static void report_end(const hn_study_work *w, const hn_job_end *end, hn_study_result *out) {
    if (w->cpu_used_up) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason,
                 "the computing time of one study is used up; the finished part is shown");
    } else if (atomic_load(&w->stop)) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason, "stopped on request; the finished part is shown");
    } else if (end->out_of_time || w->out_of_time) {
        out->state = HN_STUDY_STOPPED;
        snprintf(out->reason, sizeof out->reason,
                 "the time limit of %.4g s was over before all was done",
                 w->request.limits.time_limit);
    } else {
        out->state = HN_STUDY_FINISHED;
    }
}

/// Why there is no document. A study that was only stopped before it had one can still go on.
static void report_failure(const hn_study_work *w, hn_status status, const hn_diags *diags,
                           hn_study_result *out) {
    const bool ended = w->out_of_time || w->cpu_used_up || atomic_load(&w->stop);
    const bool by_limits = status == HN_ERR_STOPPED || status == HN_ERR_LIMIT;
    out->state = ended && by_limits ? HN_STUDY_STOPPED : HN_STUDY_FAILED;
    if (w->out_of_time && !w->cpu_used_up && !atomic_load(&w->stop)) {
        snprintf(out->reason, sizeof out->reason,
                 "the time limit of %.4g s ended before the first result",
                 w->request.limits.time_limit);
        return;
    }
    snprintf(out->reason, sizeof out->reason, "%s",
             w->cpu_used_up ? "the computing time of one study ended before the first result"
             : atomic_load(&w->stop) ? "stopped before the first result"
             : diags->n > 0          ? diags->item[0].message
                                     : hn_status_text(status));
    snprintf(out->hint, sizeof out->hint, "%s", diags->n > 0 ? diags->item[0].hint : "");
}

void hn_study_work_again(hn_study_work *w, double time_limit) {
    // a limit that was over is a share of the longer whole; any other share stays
    const double share = atomic_load(&w->share), spent = w->wall_spent;
    atomic_store(&w->share, w->out_of_time ? fmin(share, spent / (spent + time_limit)) : share);

    w->out_of_time = false;
    atomic_store(&w->stop, 0);
    w->request.limits.time_limit = time_limit;
    if (w->job) {
        hn_job_set_time_limit(w->job, time_limit);
    }
}

double hn_study_work_left(const hn_study_work *w, double cpu_seconds) {
    return fmax(0, cpu_seconds - w->cpu_spent);
}

void hn_study_work_run(hn_study_work *w, double cpu_seconds, hn_study_result *out) {
    hn_diags diags = {0};
    hn_job_end end = {0};
    hn_status status = HN_OK;
    const double wall = hn_clock_wall(), cpu = hn_clock_thread();
    w->cpu_end = cpu + hn_study_work_left(w, cpu_seconds);
    w->wall_end = wall + w->request.limits.time_limit;
    w->computes = true;
    if (!w->job) {
        status = open_job(w, &diags);
    }
    HN_THEN(status, hn_job_run(w->job, &end, &diags));
    w->computes = false;
    w->cpu_spent += hn_clock_thread() - cpu;
    w->wall_spent += hn_clock_wall() - wall;
    w->out_of_time |= end.out_of_time;
    w->is_kept = w->request.limits.folder && !end.lost;
    if (status != HN_OK) {
        report_failure(w, status, &diags, out);
        return;
    }
    report_end(w, &end, out);
    hn_job_write(&out->document, w->job, ".json");
    hn_job_write(&out->report, w->job, ".html");
}
