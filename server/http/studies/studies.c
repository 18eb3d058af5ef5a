// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/studies.h"

#include "base/clock.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "http/studies/study_fields.h"
#include "http/studies/study_work.h"
#include "study/run/pace.h"
#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

enum { RETRY_AFTER = 5 };
/// Below this share nothing is said of the time left: too little is known.
static const double TELLING = 0.03;

typedef struct study {
    char id[17];
    int refs; ///< under the lock of all, as is everything down to `work`
    double started, ended, touched;
    int done;
    hn_study_result result;
    hn_study_work work;
    hn_studies *all;
} study;

struct hn_studies {
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< a thread has ended
    const hn_http_opts *opts;
    const hn_library *lib;
    study *list[HN_STUDIES_KEPT];
    int n, n_threads, stopping;
};

// ---- one study ----

static void free_study(study *s) {
    if (s) {
        hn_strbuf_reset(&s->result.document);
        hn_strbuf_reset(&s->result.report);
        hn_study_work_reset(&s->work);
        free(s);
    }
}

static void release(study *s) {
    hn_studies *all = s->all;
    pthread_mutex_lock(&all->lock);
    const int left = --s->refs;
    pthread_mutex_unlock(&all->lock);
    if (left == 0) {
        free_study(s);
    }
}

static void *work(void *arg) {
    study *s = arg;
    hn_studies *all = s->all;
    hn_study_result result = {0};
    hn_strbuf_init(&result.document);
    hn_strbuf_init(&result.report);

    // the computation
    hn_study_work_run(&s->work, all->opts->max_run_cpu, &result);
    if (result.document.failed || result.report.failed) {
        result.state = HN_STUDY_FAILED;
        snprintf(result.reason, sizeof result.reason, "%s", hn_status_text(HN_ERR_MEMORY));
    }
    if (result.state == HN_STUDY_FAILED) {
        hn_strbuf_reset(&result.document);
        hn_strbuf_reset(&result.report);
    }

    // the result, with the lock held
    pthread_mutex_lock(&all->lock);
    s->result = result;
    s->done = 1;
    s->ended = s->touched = hn_clock_wall();
    pthread_mutex_unlock(&all->lock);

    // one thread less
    release(s);
    pthread_mutex_lock(&all->lock);
    all->n_threads--;
    pthread_cond_broadcast(&all->changed);
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

static const char *state_name(const study *s) {
    static const char *const names[] = {[HN_STUDY_RUNNING] = "running",
                                        [HN_STUDY_FINISHED] = "finished",
                                        [HN_STUDY_STOPPED] = "stopped",
                                        [HN_STUDY_FAILED] = "failed"};
    return names[s->done ? s->result.state : HN_STUDY_RUNNING];
}

/// Seconds to go, by what was done so far and never beyond the time limit; NaN when too little is
/// known.
static double time_left(const study *s, double share, double elapsed) {
    if (s->done) {
        return 0;
    }
    const double by_share = share > TELLING ? elapsed * (1 - share) / share : (double)NAN;
    return fmin(by_share, fmax(0, s->work.request.limits.time_limit - elapsed));
}

static void put_progress(hn_strbuf *b, const study *s) {
    const double elapsed = (s->done ? s->ended : hn_clock_wall()) - s->started;
    const double share = s->done && s->result.state == HN_STUDY_FINISHED
                             ? 1
                             : fmin(1, fmax(0, atomic_load(&s->work.share)));
    hn_json_put_number(b, "progress", share);
    hn_json_put_number(b, "elapsed_s", elapsed);
    hn_json_put_number(b, "time_left_s", time_left(s, share, elapsed));
}

/// With the lock held.
static void put_study(hn_strbuf *b, const study *s) {
    const hn_job_request *r = &s->work.request;
    char self[64];
    snprintf(self, sizeof self, "/api/v1/studies/%s", s->id);

    // how it stands
    hn_json_object(b);
    hn_json_put_string(b, "id", s->id);
    hn_json_put_string(b, "kind", s->work.kind->name);
    hn_json_put_string(b, "state", state_name(s));
    hn_json_put_string(b, "reason", s->result.reason);
    hn_json_put_string(b, "hint", s->result.hint);
    put_progress(b, s);
    hn_json_put_number(b, "time_limit_s", r->limits.time_limit);

    // what was asked
    hn_json_put_string(b, "scene", hn_model_scene(s->work.model)->id);
    hn_json_key(b, "parameters");
    hn_scene_request_settings_json(b, &s->work.scene);
    hn_json_key(b, "methods");
    hn_json_strings(b, r->methods, (size_t)r->n_methods);

    // what came of it
    hn_json_key(b, "document");
    hn_json_raw(b, s->result.document.n ? hn_strbuf_text(&s->result.document) : "null");
    hn_json_key(b, "links");
    hn_json_object(b);
    hn_json_put_string(b, "self", self);
    if (s->result.report.n) {
        snprintf(self, sizeof self, "/api/v1/studies/%s/report", s->id);
        hn_json_put_string(b, "report", self);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

// ---- all of them ----

hn_studies *hn_studies_create(const hn_http_opts *opts, const hn_library *lib) {
    hn_studies *all = calloc(1, sizeof *all);
    hn_study_fields_fill(opts->max_run_cpu);
    if (all) {
        pthread_mutex_init(&all->lock, NULL);
        pthread_cond_init(&all->changed, NULL);
        all->opts = opts;
        all->lib = lib;
    }
    return all;
}

/// Takes the i-th out; its reference passes to the caller. With the lock held.
static study *take_out(hn_studies *all, int i) {
    study *s = all->list[i];
    memmove(&all->list[i], &all->list[i + 1], (size_t)(all->n - i - 1) * sizeof *all->list);
    all->n--;
    return s;
}

/// Gives up one reference with the lock held; the study itself goes to `*dead` when it was the
/// last.
static void drop(study *s, study **dead, int *n_dead) {
    atomic_store(&s->work.stop, 1);
    if (--s->refs == 0) {
        dead[(*n_dead)++] = s;
    }
}

/// Lets go of what nobody touched for long. With the lock held.
static void expire(hn_studies *all, study **dead, int *n_dead) {
    const double now = hn_clock_wall();
    for (int i = all->n - 1; i >= 0; i--) {
        if (now - all->list[i]->touched > all->opts->expiry) {
            drop(take_out(all, i), dead, n_dead);
        }
    }
}

/// Room for one more among the kept: the finished one that was longest untouched goes. With the
/// lock held.
static void make_room(hn_studies *all, study **dead, int *n_dead) {
    int oldest = -1;
    for (int i = 0; i < all->n; i++) {
        const study *s = all->list[i];
        if (s->done && (oldest < 0 || s->touched < all->list[oldest]->touched)) {
            oldest = i;
        }
    }
    if (all->n == HN_STUDIES_KEPT && oldest >= 0) {
        drop(take_out(all, oldest), dead, n_dead);
    }
}

static void free_all(study **dead, int n) {
    for (int i = 0; i < n; i++) {
        free_study(dead[i]);
    }
}

void hn_studies_tell_end(hn_studies *all) {
    pthread_mutex_lock(&all->lock);
    all->stopping = 1;
    for (int i = 0; i < all->n; i++) {
        atomic_store(&all->list[i]->work.stop, 1);
    }
    pthread_mutex_unlock(&all->lock);
}

void hn_studies_stop(hn_studies *all) {
    if (!all) {
        return;
    }
    study *dead[HN_STUDIES_KEPT];
    int n_dead = 0;
    pthread_mutex_lock(&all->lock);
    all->stopping = 1;
    while (all->n > 0) {
        drop(take_out(all, all->n - 1), dead, &n_dead);
    }
    while (all->n_threads > 0) {
        pthread_cond_wait(&all->changed, &all->lock);
    }
    pthread_mutex_unlock(&all->lock);
    free_all(dead, n_dead);
}

void hn_studies_free(hn_studies *all) {
    if (all) {
        hn_studies_stop(all);
        pthread_cond_destroy(&all->changed);
        pthread_mutex_destroy(&all->lock);
        free(all);
    }
}

static void name_study(study *s) {
    uint64_t name = 0;
    if (getrandom(&name, sizeof name, 0) != (ssize_t)sizeof name) {
        name = (uint64_t)(hn_clock_wall() * 1e9);
    }
    snprintf(s->id, sizeof s->id, "%016llx", (unsigned long long)name);
}

/// A thread's place; 0 with a problem as reply. A study that was deleted holds its place until its
/// thread has ended.
static bool reserve(hn_studies *all, hn_request *r) {
    pthread_mutex_lock(&all->lock);
    const int stopping = all->stopping, full = all->n_threads >= all->opts->max_studies;
    all->n_threads += !stopping && !full;
    pthread_mutex_unlock(&all->lock);
    if (stopping) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is going down");
    } else if (full) {
        hn_reply_problem(r, HN_PROBLEM_STUDIES_BUSY, "ask again, or stop one that is running",
                         "%d studies are running, and no more at once", all->opts->max_studies);
        hn_reply_header_add(r, "Retry-After", "%d", RETRY_AFTER);
    }
    return !stopping && !full;
}

static void give_back(hn_studies *all) {
    pthread_mutex_lock(&all->lock);
    all->n_threads--;
    pthread_cond_broadcast(&all->changed);
    pthread_mutex_unlock(&all->lock);
}

/// Puts it among the others and starts its thread, which has a reference of its own; the caller
/// keeps one too.
static hn_status start(hn_studies *all, study *s) {
    study *dead[HN_STUDIES_KEPT];
    int n_dead = 0;
    pthread_t thread;
    pthread_mutex_lock(&all->lock);
    expire(all, dead, &n_dead);
    make_room(all, dead, &n_dead);
    hn_status status = all->n < HN_STUDIES_KEPT && !all->stopping ? HN_OK : HN_ERR_LIMIT;
    s->started = s->touched = hn_clock_wall();
    s->refs = 3;
    if (status == HN_OK && pthread_create(&thread, NULL, work, s) != 0) {
        status = HN_ERR_MEMORY;
    }
    if (status == HN_OK) {
        pthread_detach(thread);
        all->list[all->n++] = s;
    }
    pthread_mutex_unlock(&all->lock);
    free_all(dead, n_dead);
    return status;
}

// ---- handlers ----

/// The study of the request's path, with a reference for the caller; NULL with a problem as reply.
static study *find_study(hn_request *r) {
    hn_studies *all = r->context->studies;
    study *found = NULL, *dead[HN_STUDIES_KEPT];
    int n_dead = 0;

    // with the lock held: what is too old goes, the rest is listed
    pthread_mutex_lock(&all->lock);
    expire(all, dead, &n_dead);
    for (int i = 0; i < all->n && !found; i++) {
        if (strcmp(all->list[i]->id, r->parts[0]) == 0) {
            found = all->list[i];
            found->refs++;
            found->touched = hn_clock_wall();
        }
    }
    pthread_mutex_unlock(&all->lock);
    free_all(dead, n_dead);
    if (!found) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "POST /api/v1/studies makes one",
                         "there is no study '%.40s' (any more)", r->parts[0]);
    }
    return found;
}

static void reply_study(hn_request *r, unsigned status, study *s) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&s->all->lock);
    put_study(&b, s);
    pthread_mutex_unlock(&s->all->lock);
    hn_reply_json(r, status, &b);
}

void hn_handle_studies_list(hn_request *r) {
    hn_studies *all = r->context->studies;
    study *dead[HN_STUDIES_KEPT];
    int n_dead = 0;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_key(&b, "studies");
    hn_json_array(&b);

    // with the lock held: what is too old goes, the rest is listed
    pthread_mutex_lock(&all->lock);
    expire(all, dead, &n_dead);
    for (int i = 0; i < all->n; i++) {
        hn_json_object(&b);
        hn_json_put_string(&b, "id", all->list[i]->id);
        hn_json_put_string(&b, "kind", all->list[i]->work.kind->name);
        hn_json_put_string(&b, "state", state_name(all->list[i]));
        hn_json_end_object(&b);
    }
    pthread_mutex_unlock(&all->lock);

    free_all(dead, n_dead);
    hn_json_end_array(&b);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_studies_create(hn_request *r) {
    hn_studies *all = r->context->studies;
    hn_diags diags = {0};
    if (!reserve(all, r)) {
        return;
    }

    // the request, read and checked
    study *s = calloc(1, sizeof *s);
    hn_status status = HN_ERR_MEMORY;
    if (s) {
        s->all = all;
        s->work.lib = all->lib;
        s->work.stopping = &r->context->stopping;
        name_study(s);
        status = hn_study_work_read(&s->work, r->json, all->opts, &diags);
    }
    HN_THEN(status, start(all, s));

    // what cannot be computed gives its place back
    if (status != HN_OK) {
        free_study(s);
        give_back(all);
        hn_reply_diags(r, status, &diags);
        return;
    }
    reply_study(r, MHD_HTTP_ACCEPTED, s);
    hn_reply_header_add(r, "Location", "/api/v1/studies/%s", s->id);
    release(s);
}

void hn_handle_study_get(hn_request *r) {
    study *s = find_study(r);
    if (s) {
        reply_study(r, MHD_HTTP_OK, s);
        release(s);
    }
}

void hn_handle_study_report(hn_request *r) {
    study *s = find_study(r);
    if (!s) {
        return;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&s->all->lock);
    hn_strbuf_add_n(&b, hn_strbuf_text(&s->result.report), s->result.report.n);
    pthread_mutex_unlock(&s->all->lock);
    if (b.n > 0 || b.failed) {
        hn_reply_bytes(r, MHD_HTTP_OK, "text/html", &b);
        hn_reply_header_add(r, "Content-Disposition", "attachment; filename=\"holonom-%s.html\"",
                            s->work.kind->name);
    } else {
        hn_strbuf_reset(&b);
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, NULL, "this study has no report: it is not done");
    }
    release(s);
}

void hn_handle_study_patch(hn_request *r) {
    study *s = find_study(r);
    if (s) {
        atomic_store(&s->work.stop, 1);
        reply_study(r, MHD_HTTP_OK, s);
        release(s);
    }
}

void hn_handle_study_delete(hn_request *r) {
    study *s = find_study(r), *dead[1];
    int n_dead = 0;
    if (!s) {
        return;
    }
    pthread_mutex_lock(&s->all->lock);
    for (int i = s->all->n - 1; i >= 0; i--) {
        if (s->all->list[i] == s) {
            drop(take_out(s->all, i), dead, &n_dead); // never the last: there is the caller's
        }
    }
    pthread_mutex_unlock(&s->all->lock);
    HN_ASSERT(n_dead == 0);
    release(s);
    hn_reply_empty(r, MHD_HTTP_NO_CONTENT);
}
