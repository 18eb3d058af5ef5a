// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/studies.h"

#include "base/clock.h"
#include "http/request/context.h"
#include "http/request/gzip.h"
#include "http/request/request.h"
#include "http/studies/study_cut.h"
#include "http/studies/study_fields.h"
#include "http/studies/study_places.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

/// Less computing time than this is none: a study does not go on for it [s].
static const double LEAST_LEFT = 0.05;
enum { MOST_ZIPPED = 8 << 20 };

// ---- one study ----

static void reset_result(hn_study_result *result) {
    hn_strbuf_reset(&result->document);
    hn_strbuf_reset(&result->report);
}

static void free_study(hn_study *s) {
    if (s) {
        reset_result(&s->result);
        hn_study_work_reset(&s->work);
        free(s);
    }
}

static void release(hn_study *s) {
    hn_studies *all = s->all;
    pthread_mutex_lock(&all->lock);
    const int left = --s->refs;
    pthread_mutex_unlock(&all->lock);
    if (left == 0) {
        free_study(s);
    }
}

static void *work(void *arg) {
    hn_study *s = arg;
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
        reset_result(&result);
    }

    // the result, in place of that of an earlier run, with the lock held
    pthread_mutex_lock(&all->lock);
    reset_result(&s->result);
    s->result = result;
    s->done = 1;
    if (s->is_cut && result.state == HN_STUDY_STOPPED) {
        all->n_cut++;
        all->n_cut_kept += s->work.is_kept;
    }
    s->ended = s->touched = hn_clock_wall();
    hn_shares_give(all->places, s->client); // whoever sees the end finds the place free
    pthread_mutex_unlock(&all->lock);

    // one thread less
    release(s);
    pthread_mutex_lock(&all->lock);
    all->n_threads--;
    pthread_cond_broadcast(&all->changed);
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

static const char *state_name(const hn_study *s) {
    static const char *const names[] = {[HN_STUDY_RUNNING] = "running",
                                        [HN_STUDY_FINISHED] = "finished",
                                        [HN_STUDY_STOPPED] = "stopped",
                                        [HN_STUDY_FAILED] = "failed"};
    return names[s->done ? s->result.state : HN_STUDY_RUNNING];
}

static void put_progress(hn_strbuf *b, const hn_study *s) {
    const double elapsed = (s->done ? s->ended : hn_clock_wall()) - s->started;
    const double share = s->done && s->result.state == HN_STUDY_FINISHED
                             ? 1
                             : fmin(1, fmax(0, atomic_load(&s->work.share)));
    hn_json_put_number(b, "progress", share);
    hn_json_put_number(b, "elapsed_s", s->before + elapsed);
    hn_json_put_number(b, "time_left_s", hn_study_time_left(s, share, elapsed));
}

/// With the lock held.
static void put_study(hn_strbuf *b, const hn_study *s) {
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
        all->places =
            hn_shares_create(opts->max_studies, hn_http_opts_share(opts, opts->max_studies));
    }
    if (all && (!all->places || !hn_study_places_start(all))) {
        hn_studies_free(all);
        return NULL;
    }
    return all;
}

/// Takes the i-th out; its reference passes to the caller. With the lock held.
static hn_study *take_out(hn_studies *all, int i) {
    hn_study *s = all->list[i];
    memmove(&all->list[i], &all->list[i + 1], (size_t)(all->n - i - 1) * sizeof *all->list);
    all->n--;
    return s;
}

/// Gives up one reference with the lock held; the study itself goes to `*dead` when it was the
/// last.
static void drop(hn_study *s, hn_study **dead, int *n_dead) {
    atomic_store(&s->work.stop, 1);
    if (--s->refs == 0) {
        dead[(*n_dead)++] = s;
    }
}

/// Lets go of what nobody touched for long. With the lock held.
static void expire(hn_studies *all, hn_study **dead, int *n_dead) {
    const double now = hn_clock_wall();
    for (int i = all->n - 1; i >= 0; i--) {
        if (now - all->list[i]->touched > all->opts->expiry) {
            drop(take_out(all, i), dead, n_dead);
        }
    }
}

/// Room for one more among the kept: the finished one that was longest untouched goes, of the same
/// client where that has its share of them. With the lock held.
static void make_room(hn_studies *all, hn_client client, hn_study **dead, int *n_dead) {
    int of_client = 0, oldest = -1;
    for (int i = 0; i < all->n; i++) {
        of_client += client && all->list[i]->client == client;
    }
    const bool has_share = of_client >= hn_http_opts_share(all->opts, HN_STUDIES_KEPT);
    for (int i = 0; i < all->n; i++) {
        const hn_study *s = all->list[i];
        if (s->done && (!has_share || s->client == client) &&
            (oldest < 0 || s->touched < all->list[oldest]->touched)) {
            oldest = i;
        }
    }
    if ((all->n == HN_STUDIES_KEPT || has_share) && oldest >= 0) {
        drop(take_out(all, oldest), dead, n_dead);
    }
}

static void free_all(hn_study **dead, int n) {
    for (int i = 0; i < n; i++) {
        free_study(dead[i]);
    }
}

void hn_studies_tell_end(hn_studies *all) {
    pthread_mutex_lock(&all->lock);
    all->stopping = 1;
    for (int i = 0; i < all->n; i++) {
        atomic_store(&all->list[i]->work.stop, 1);
        all->list[i]->is_cut = !all->list[i]->done;
    }
    pthread_mutex_unlock(&all->lock);
}

void hn_studies_stop(hn_studies *all) {
    if (!all) {
        return;
    }
    hn_study *dead[HN_STUDIES_KEPT];
    int n_dead = 0;
    pthread_mutex_lock(&all->lock);
    all->stopping = 1;
    hn_study_refuse_waiting(all);
    pthread_cond_broadcast(&all->changed);
    while (all->n > 0) {
        drop(take_out(all, all->n - 1), dead, &n_dead);
    }
    while (all->n_threads > 0) {
        pthread_cond_wait(&all->changed, &all->lock);
    }
    hn_study_report_cut(all);
    pthread_mutex_unlock(&all->lock);
    free_all(dead, n_dead);
    if (all->has_keeper) {
        pthread_join(all->keeper, NULL);
        all->has_keeper = false;
    }
}

void hn_studies_free(hn_studies *all) {
    if (all) {
        hn_studies_stop(all);
        pthread_cond_destroy(&all->changed);
        pthread_mutex_destroy(&all->lock);
        hn_shares_free(all->places);
        free(all);
    }
}

static void name_study(hn_study *s) {
    uint64_t name = 0;
    if (getrandom(&name, sizeof name, 0) != (ssize_t)sizeof name) {
        name = (uint64_t)(hn_clock_wall() * 1e9);
    }
    snprintf(s->id, sizeof s->id, "%016llx", (unsigned long long)name);
}

/// Starts a thread that works on the study, with a reference of its own. With the lock held.
static hn_status start_thread(hn_study *s) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, work, s) != 0) {
        return HN_ERR_MEMORY;
    }
    pthread_detach(thread);
    s->refs++;
    s->started = s->touched = hn_clock_wall();
    return HN_OK;
}

/// Puts it among the others and starts its thread; the caller keeps a reference too.
static hn_status start(hn_studies *all, hn_study *s) {
    hn_study *dead[HN_STUDIES_KEPT];
    int n_dead = 0;
    pthread_mutex_lock(&all->lock);
    expire(all, dead, &n_dead);
    make_room(all, s->client, dead, &n_dead);
    hn_status status = all->n < HN_STUDIES_KEPT && !all->stopping ? HN_OK : HN_ERR_LIMIT;
    s->refs = 2; // of the list and of the caller
    HN_THEN(status, start_thread(s));
    if (status == HN_OK) {
        all->list[all->n++] = s;
    }
    pthread_mutex_unlock(&all->lock);
    free_all(dead, n_dead);
    return status;
}

// ---- handlers ----

/// The study of the request's path, with a reference for the caller; NULL when there is none.
static hn_study *look_for_study(const hn_request *r) {
    hn_studies *all = r->context->studies;
    hn_study *found = NULL, *dead[HN_STUDIES_KEPT];
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
    return found;
}

/// The same; NULL with a problem as reply.
static hn_study *find_study(hn_request *r) {
    hn_study *found = look_for_study(r);
    if (!found) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "POST /api/v1/studies makes one",
                         "there is no study '%.40s', or it was deleted", r->parts[0]);
    }
    return found;
}

static void reply_study(hn_request *r, unsigned status, hn_study *s) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&s->all->lock);
    put_study(&b, s);
    pthread_mutex_unlock(&s->all->lock);
    hn_reply_json(r, status, &b);
}

void hn_handle_studies_list(hn_request *r) {
    hn_studies *all = r->context->studies;
    hn_study *dead[HN_STUDIES_KEPT];
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
    double wait = HN_PLACE_WAIT;
    if (!hn_request_query_number(r, "wait", 0, HN_PLACE_MAX_WAIT, false, &wait)) {
        hn_request_finish(r);
        return;
    }
    pthread_mutex_lock(&all->lock);
    const hn_study_place place = hn_study_find_place(all, r, wait);
    pthread_mutex_unlock(&all->lock);
    if (place == HN_STUDY_REFUSED) {
        hn_request_finish(r);
    }
    if (place != HN_STUDY_PLACED) {
        return;
    }

    // the request, read and checked
    hn_study *s = calloc(1, sizeof *s);
    hn_status status = HN_ERR_MEMORY;
    if (s) {
        s->all = all;
        s->client = r->client;
        s->work.lib = all->lib;
        s->work.stopping = &r->context->stopping;
        name_study(s);
        s->work.asker = r;
        status = hn_study_work_read(&s->work, r->json, all->opts, &diags);
        s->work.asker = NULL;
    }
    if (status == HN_OK && hn_request_has_been_left(r)) {
        status = HN_ERR_STOPPED; // nobody would know of it
    }
    HN_THEN(status, start(all, s));

    // what cannot be computed gives its place back
    if (status != HN_OK) {
        free_study(s);
        pthread_mutex_lock(&all->lock);
        hn_study_give_back(all, r->client);
        pthread_mutex_unlock(&all->lock);
        hn_reply_diags(r, status, &diags);
    } else {
        reply_study(r, MHD_HTTP_ACCEPTED, s);
        hn_reply_header_add(r, "Location", "/api/v1/studies/%s", s->id);
        release(s);
    }
    hn_reply_compress(r, MOST_ZIPPED);
    hn_request_finish(r);
}

void hn_handle_study_get(hn_request *r) {
    hn_study *s = find_study(r);
    if (s) {
        reply_study(r, MHD_HTTP_OK, s);
        release(s);
    }
}

void hn_handle_study_report(hn_request *r) {
    hn_study *s = find_study(r);
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

/// With the lock held.
static bool is_listed(const hn_study *s) {
    for (int i = 0; i < s->all->n; i++) {
        if (s->all->list[i] == s) {
            return true;
        }
    }
    return false;
}

/// Returns whether a study runs, or is finished: going on changes nothing. With the lock held.
static bool has_no_need(const hn_study *s) {
    return s->done ? s->result.state == HN_STUDY_FINISHED : !atomic_load(&s->work.stop);
}

/// Computing time that all its runs have left [s].
static double left_of(const hn_study *s) {
    return hn_study_work_left(&s->work, s->all->opts->max_run_cpu);
}

/// Why a study cannot go on; NULL: it can. With the lock held.
static const char *hindrance(const hn_study *s) {
    return !s->done                             ? "it is still ending; ask again"
           : s->result.state == HN_STUDY_FAILED ? "it failed and kept nothing"
           : !is_listed(s)                      ? "it was deleted"
           : left_of(s) < LEAST_LEFT            ? "its computing time is used up"
                                                : NULL;
}

/// Lets a stopped study go on, for the time limit of the body or else for all the computing time
/// that its runs have left, and never for longer. The rest of the earlier limit does not count.
/// The document of what is done stays until there is a new one. With the lock held.
static hn_status go_on(hn_study *s, const cJSON *body) {
    const cJSON *limit = cJSON_GetObjectItemCaseSensitive(body, "time_limit");
    const double ran = s->ended - s->started, before = s->before + ran;
    const double left = left_of(s), wanted = limit ? fmin(left, limit->valuedouble) : left;
    hn_study_work_again(&s->work, fmax(LEAST_LEFT, wanted));
    HN_TRY(start_thread(s));
    s->before = before;
    s->done = 0;
    s->result.reason[0] = s->result.hint[0] = 0;
    return HN_OK;
}

/// Starts a study that may go on, in the place that the request has or finds. A place that it has
/// waited for, and that is of no use any more, goes back. With the lock held.
static hn_status start_again(hn_request *r, hn_study *s, double wait, const char **why,
                             hn_study_place *place) {
    const bool is_needed = !has_no_need(s) && (*why = hindrance(s)) == NULL;
    *place = HN_STUDY_PLACED;
    if (is_needed || r->has_place) {
        *place = hn_study_find_place(s->all, r, wait);
    }
    if (*place != HN_STUDY_PLACED || (!is_needed && !r->has_place)) {
        return HN_OK;
    }

    hn_status status = HN_OK;
    if (is_needed) {
        s->client = r->client;
        status = go_on(s, r->json);
    }
    if (!is_needed || status != HN_OK) {
        hn_study_give_back(s->all, r->client);
    }
    return status;
}

/// Answers a request that a study go on. Returns false where the request waits for a place, and is
/// another thread's.
static bool resume(hn_request *r, hn_study *s) {
    const char *why = NULL;
    double wait = HN_PLACE_WAIT;
    hn_study_place place;
    if (!hn_request_query_number(r, "wait", 0, HN_PLACE_MAX_WAIT, false, &wait)) {
        return true;
    }

    // one look, so that of two such requests one starts it
    pthread_mutex_lock(&s->all->lock);
    const hn_status status = start_again(r, s, wait, &why, &place);
    pthread_mutex_unlock(&s->all->lock);

    if (place != HN_STUDY_PLACED) {
        return place == HN_STUDY_REFUSED;
    }
    if (why) {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, NULL, "the study cannot go on: %s", why);
    } else if (status != HN_OK) {
        hn_reply_diags(r, status, &(hn_diags){0});
    } else {
        reply_study(r, MHD_HTTP_OK, s);
    }
    return true;
}

/// Makes the reply. Returns false where the request waits for a place.
static bool change(hn_request *r) {
    hn_studies *all = r->context->studies;
    bool replied = true;
    hn_study *s = find_study(r);
    if (!s && r->has_place) { // it was deleted meanwhile
        hn_shares_give(all->places, r->client);
    } else if (s && strcmp(hn_fields_text(r->json, "state"), "running") == 0) {
        replied = resume(r, s);
    } else if (s) {
        atomic_store(&s->work.stop, 1);
        reply_study(r, MHD_HTTP_OK, s);
    }
    if (s) {
        release(s);
    }
    return replied;
}

void hn_handle_study_patch(hn_request *r) {
    if (change(r)) {
        hn_reply_compress(r, MOST_ZIPPED);
        hn_request_finish(r);
    }
}

void hn_handle_study_delete(hn_request *r) {
    hn_study *s = look_for_study(r), *dead[1];
    int n_dead = 0;
    hn_reply_empty(r, MHD_HTTP_NO_CONTENT); // the same for one that is gone
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
}
