// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/clock.h"
#include "http/live/session_internal.h"
#include "http/live/stream.h"
#include "session/model/model_json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

/// Frames that come later than this are not caught up: the clock is set anew and the loss is told
/// as `lag`.
static const double LATE = 0.25; // [s]

// ---- bench ----

void hn_subject_reset(hn_subject *bench) {
    hn_comparison_free(bench->comparison);
    hn_model_free(bench->model);
    hn_scene_request_reset(&bench->scene);
    *bench = (hn_subject){0};
}

hn_status hn_subject_compare(const hn_session *session, const hn_model *model,
                             const char *const *methods, int n_methods, hn_comparison **out,
                             hn_diags *diags) {
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.frame_dt = session->asked_frame_dt;
    opts.duration = session->asked_duration;
    opts.cpu_budget = session->opts->frame_cpu;
    return hn_comparison_create(model, methods, n_methods, &opts, out, diags);
}

hn_status hn_subject_create(const hn_session *session, const hn_scene_request *scene,
                            const char *const *methods, int n_methods, hn_subject *bench,
                            hn_diags *diags) {
    *bench = (hn_subject){0};
    hn_status status = hn_scene_request_copy(&bench->scene, scene);
    if (status == HN_OK) {
        status = hn_scene_request_load(scene, session->lib, 0, &bench->model, diags);
    }
    if (status == HN_OK) {
        status = hn_subject_compare(session, bench->model, methods, n_methods, &bench->comparison,
                                    diags);
    }
    if (status != HN_OK) {
        hn_subject_reset(bench);
    }
    return status;
}

// ---- publishing ----

static const char *state_name(hn_session_state state) {
    static const char *const names[] = {"paused", "running", "finished"};
    return names[state];
}

void hn_session_put_state(hn_strbuf *b, const hn_session *session) {
    hn_json_put_string(b, "state", state_name(session->state));
    hn_json_put_number(b, "speed", session->speed);
}

static void put_raw(hn_strbuf *b, const char *key, const hn_strbuf *json) {
    hn_json_key(b, key);
    hn_json_raw(b, json->n ? hn_strbuf_text(json) : "null");
}

void hn_session_put_json(hn_strbuf *b, const hn_session *session) {
    char self[64], events[80];
    snprintf(self, sizeof self, "/api/v1/comparisons/%s", session->id);
    snprintf(events, sizeof events, "%s/events", self);

    // what changes from frame to frame
    hn_json_object(b);
    hn_json_put_string(b, "id", session->id);
    hn_session_put_state(b, session);
    hn_json_put_int(b, "frame", session->frame);
    hn_json_put_number(b, "t", (double)session->frame * session->frame_dt);
    hn_json_put_number(b, "frame_dt", session->frame_dt);
    hn_json_put_number(b, "duration", session->duration);
    hn_json_put_int(b, "generation", session->generation);
    hn_json_put_number(b, "lag", session->lag);
    hn_json_put_int(b, "last_event", (long long)session->history.last_id);

    // texts that were written before
    put_raw(b, "scene", &session->scene_json);
    put_raw(b, "comparison", &session->comparison_json);
    put_raw(b, "parameters", &session->settings_json);
    put_raw(b, "latest", &session->latest);
    hn_json_key(b, "links");
    hn_json_object(b);
    hn_json_put_string(b, "self", self);
    hn_json_put_string(b, "events", events);
    hn_json_end_object(b);
    hn_json_end_object(b);
}

void hn_session_wake_streams(hn_session *session) {
    for (hn_stream *s = session->streams; s; s = hn_stream_next(s)) {
        hn_stream_wake(s);
    }
}

static void swap_text(hn_strbuf *a, hn_strbuf *b) {
    hn_strbuf t = *a;
    *a = *b;
    *b = t;
}

/// Writes the scene and its parameters, unless they stand there already: drawing one costs seconds
/// for a mechanism of many bodies.
static hn_status publish_scene(hn_session *session) {
    if (session->published == session->bench.model) {
        return HN_OK;
    }
    hn_strbuf scene, settings;
    hn_strbuf_init(&scene);
    hn_strbuf_init(&settings);
    hn_model_json(&scene, session->bench.model);
    hn_scene_request_settings_json(&settings, &session->bench.scene);
    const hn_status status = scene.failed || settings.failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK) {
        pthread_mutex_lock(&session->lock);
        swap_text(&session->scene_json, &scene);
        swap_text(&session->settings_json, &settings);
        pthread_mutex_unlock(&session->lock);
        session->published = session->bench.model;
    }
    hn_strbuf_reset(&scene);
    hn_strbuf_reset(&settings);
    return status;
}

hn_status hn_session_publish_setup(hn_session *session) {
    HN_TRY(publish_scene(session));
    hn_strbuf comparison;
    hn_strbuf_init(&comparison);
    hn_comparison_json(&comparison, session->bench.comparison);
    const hn_status status = comparison.failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK) {
        pthread_mutex_lock(&session->lock);
        swap_text(&session->comparison_json, &comparison);
        session->frame_dt = hn_comparison_frame_dt(session->bench.comparison);
        session->duration = hn_comparison_duration(session->bench.comparison);
        pthread_mutex_unlock(&session->lock);
    }
    hn_strbuf_reset(&comparison);
    return status;
}

/// Writes {"generation":G, and the members of `object`, an object that is not empty.
static void put_with_generation(hn_strbuf *b, const hn_session *session, const hn_strbuf *object) {
    hn_strbuf_printf(b, "{\"generation\":%lld,", session->generation);
    hn_strbuf_add(b, hn_strbuf_text(object) + (object->n > 0));
    b->failed |= object->failed;
}

/// Publishes an incident as an event.
static void publish_incident(hn_session *session, int method, const hn_incident *incident) {
    hn_strbuf text, event;
    hn_strbuf_init(&text);
    hn_strbuf_init(&event);
    hn_incident_json(&text, method, incident);
    put_with_generation(&event, session, &text);
    pthread_mutex_lock(&session->lock);
    hn_history_add(&session->history, HN_EVENT_INCIDENT, &event);
    pthread_mutex_unlock(&session->lock);
    hn_strbuf_reset(&text);
}

/// Publishes the incidents that were written or completed since the last frame.
static void publish_incidents(hn_session *session) {
    for (int i = 0; i < hn_comparison_n_methods(session->bench.comparison); i++) {
        const hn_incident *list;
        int n = hn_run_incidents(hn_comparison_run(session->bench.comparison, i), &list);
        unsigned newest = session->bench.published[i];
        for (int k = 0; k < n; k++) {
            if (list[k].revision > session->bench.published[i]) {
                newest = list[k].revision > newest ? list[k].revision : newest;
                publish_incident(session, i, &list[k]);
            }
        }
        session->bench.published[i] = newest;
    }
}

static void publish_end(hn_session *session) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "generation", session->generation);
    hn_json_key(&b, "summary");
    hn_comparison_summary_json(&b, session->bench.comparison);
    hn_json_end_object(&b);
    pthread_mutex_lock(&session->lock);
    hn_history_add(&session->history, HN_EVENT_END, &b);
    session->state = HN_SESSION_FINISHED;
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);
}

void hn_session_publish_frame(hn_session *session) {
    hn_strbuf frame, event, latest;
    hn_strbuf_init(&frame);
    hn_strbuf_init(&event);
    hn_strbuf_init(&latest);
    hn_comparison_frame_json(&frame, session->bench.comparison);
    put_with_generation(&event, session, &frame);
    hn_strbuf_add_n(&latest, hn_strbuf_text(&event), event.n);

    // the frame is there for all at once
    pthread_mutex_lock(&session->lock);
    session->frame = hn_comparison_frame(session->bench.comparison);
    if (!latest.failed) {
        swap_text(&session->latest, &latest);
    }
    hn_history_add(&session->history, HN_EVENT_FRAME, &event);
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);

    // then what happened in it
    publish_incidents(session);
    if (hn_comparison_finished(session->bench.comparison)) {
        publish_end(session);
    }
    hn_strbuf_reset(&frame);
    hn_strbuf_reset(&latest);
}

static int must_yield(void *user) {
    hn_session *session = user;
    const int interrupt = atomic_load(&session->interrupt);
    return interrupt == HN_INTERRUPT_END ||
           (interrupt == HN_INTERRUPT_REQUEST && hn_clock_wall() > session->undisturbed);
}

/// What waits. With the lock held.
static void set_interrupt(hn_session *session) {
    atomic_store(&session->interrupt, session->ending    ? HN_INTERRUPT_END
                                      : session->patches ? HN_INTERRUPT_REQUEST
                                                         : HN_INTERRUPT_NONE);
}

int hn_session_advance(hn_session *session) {
    if (!hn_comparison_work(session->bench.comparison, must_yield, session)) {
        return 0;
    }
    hn_session_publish_frame(session);
    return 1;
}

void hn_session_set_anchor(hn_session *session) {
    session->anchor_time = hn_clock_wall();
    session->anchor_frame = session->frame;
}

void hn_session_set_state(hn_session *session, hn_session_state state, const char *reason) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&session->lock);
    session->state = state;
    hn_session_set_anchor(session);
    hn_json_object(&b);
    hn_session_put_state(&b, session);
    if (reason) {
        hn_json_put_string(&b, "reason", reason);
    }
    hn_json_end_object(&b);
    hn_history_add(&session->history, HN_EVENT_STATE, &b);
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);
}

// ---- the thread ----

/// When the next frame is due. With the lock held.
static double next_due(const hn_session *session) {
    return session->anchor_time + (double)(session->frame + 1 - session->anchor_frame) *
                                      session->frame_dt / session->speed;
}

static void wait_until(hn_session *session, double time) {
    struct timespec ts = {.tv_sec = (time_t)time};
    ts.tv_nsec = (long)((time - (double)ts.tv_sec) * 1e9);
    pthread_cond_timedwait(&session->wake, &session->lock, &ts);
}

static hn_request *take_patch(hn_session *session) {
    hn_request *r = session->patches;
    session->patches = r->next;
    if (!session->patches) {
        session->patches_end = &session->patches;
    }
    set_interrupt(session);
    return r;
}

/// Nobody reads along: 1 when the comparison should pause itself.
static int is_unwatched(const hn_session *session) {
    return session->n_streams == 0 &&
           hn_clock_wall() - session->touched > session->opts->idle_pause;
}

/// A frame that is due; its lateness is kept as lag rather than caught up in a burst.
static void advance_on_time(hn_session *session, double due) {
    pthread_mutex_unlock(&session->lock);
    hn_session_advance(session);
    pthread_mutex_lock(&session->lock);
    double late = hn_clock_wall() - due;
    if (late > LATE) {
        session->lag += late;
        hn_session_set_anchor(session);
    }
}

/// One thing to do, or a wait. With the lock held.
static void do_next(hn_session *session) {
    if (session->patches) {
        hn_request *r = take_patch(session);
        pthread_mutex_unlock(&session->lock);
        hn_session_apply(session, r);
        hn_request_finish(r);
        pthread_mutex_lock(&session->lock);
        return;
    }

    // nothing runs, or nobody reads
    if (session->state != HN_SESSION_RUNNING) {
        pthread_cond_wait(&session->wake, &session->lock);
        return;
    }
    if (is_unwatched(session)) {
        pthread_mutex_unlock(&session->lock);
        hn_session_set_state(session, HN_SESSION_PAUSED, "nobody was reading");
        pthread_mutex_lock(&session->lock);
        return;
    }

    // the next frame, when it is due
    double due = next_due(session);
    if (hn_clock_wall() < due) {
        wait_until(session, due);
    } else {
        advance_on_time(session, due);
    }
}

static void reply_gone(hn_session *session, hn_request *r) {
    if (session->deleted) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, NULL, "the comparison was deleted");
    } else {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is going down");
    }
    hn_request_finish(r);
}

static void *work(void *arg) {
    hn_session *session = arg;
    pthread_mutex_lock(&session->lock);
    while (!session->ending) {
        do_next(session);
    }
    session->thread_ended = 1;
    while (session->patches) {
        reply_gone(session, take_patch(session));
    }
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);
    void (*gone)(void *) = session->gone;
    void *user = session->user;
    hn_session_release(session);
    gone(user);
    return NULL;
}

// ---- life ----

static void free_session(hn_session *session) {
    hn_subject_reset(&session->bench);
    hn_history_reset(&session->history);
    hn_strbuf_reset(&session->scene_json);
    hn_strbuf_reset(&session->comparison_json);
    hn_strbuf_reset(&session->settings_json);
    hn_strbuf_reset(&session->latest);
    pthread_cond_destroy(&session->wake);
    pthread_mutex_destroy(&session->lock);
    free(session);
}

hn_session *hn_session_retain(hn_session *session) {
    pthread_mutex_lock(&session->lock);
    session->refs++;
    pthread_mutex_unlock(&session->lock);
    return session;
}

void hn_session_release(hn_session *session) {
    pthread_mutex_lock(&session->lock);
    int left = --session->refs;
    pthread_mutex_unlock(&session->lock);
    if (left == 0) {
        free_session(session);
    }
}

static hn_session *new_session(const hn_http_opts *opts, const hn_library *lib,
                               const hn_session_request *order) {
    hn_session *session = calloc(1, sizeof *session);
    if (!session) {
        return NULL;
    }
    pthread_condattr_t attr;
    pthread_condattr_init(&attr);
    pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
    pthread_cond_init(&session->wake, &attr);
    pthread_condattr_destroy(&attr);
    pthread_mutex_init(&session->lock, NULL);

    // a name that nobody can guess
    uint64_t name = 0;
    if (getrandom(&name, sizeof name, 0) != (ssize_t)sizeof name) {
        name = (uint64_t)(hn_clock_wall() * 1e9);
    }
    snprintf(session->id, sizeof session->id, "%016llx", (unsigned long long)name);

    // the caller's reference
    session->refs = 1;
    session->opts = opts;
    session->lib = lib;
    session->asked_frame_dt = order->frame_dt;
    session->asked_duration = order->duration;
    session->speed = order->speed;
    session->state = order->running ? HN_SESSION_RUNNING : HN_SESSION_PAUSED;
    session->client = order->client;
    session->touched = hn_clock_wall();
    session->patches_end = &session->patches;
    return session;
}

/// The thread holds a reference of its own.
static hn_status start_thread(hn_session *session) {
    pthread_t thread;
    session->refs++;
    hn_session_set_anchor(session);
    if (pthread_create(&thread, NULL, work, session) != 0) {
        session->refs--;
        return HN_ERR_MEMORY;
    }
    pthread_detach(thread);
    return HN_OK;
}

hn_status hn_session_create(const hn_http_opts *opts, const hn_library *lib,
                            const hn_session_request *order, void (*gone)(void *user), void *user,
                            hn_session **out, hn_diags *diags) {
    hn_session *session = new_session(opts, lib, order);
    if (!session) {
        return HN_ERR_MEMORY;
    }
    session->gone = gone;
    session->user = user;
    hn_status status =
        hn_history_init(&session->history, opts->max_events, (size_t)opts->max_event_bytes);
    if (status == HN_OK) {
        status = hn_subject_create(session, order->scene, order->methods, order->n_methods,
                                   &session->bench, diags);
    }
    if (status == HN_OK && hn_comparison_duration(session->bench.comparison) > opts->max_duration) {
        status = hn_diags_add(
            diags, HN_ERR_LIMIT, "/duration", NULL, "the duration is %g s; at most %g s are run",
            hn_comparison_duration(session->bench.comparison), opts->max_duration);
    }
    if (status == HN_OK) {
        status = hn_session_publish_setup(session);
    }
    if (status == HN_OK) {
        hn_session_publish_frame(session);
        status = start_thread(session);
    }
    if (status != HN_OK) {
        hn_session_release(session);
        return status;
    }
    *out = session;
    return HN_OK;
}

const char *hn_session_id(const hn_session *session) {
    return session->id;
}

void hn_session_json(hn_strbuf *b, hn_session *session) {
    pthread_mutex_lock(&session->lock);
    session->touched = hn_clock_wall();
    hn_session_put_json(b, session);
    pthread_mutex_unlock(&session->lock);
}

void hn_session_patch(hn_session *session, hn_request *r) {
    pthread_mutex_lock(&session->lock);
    session->touched = hn_clock_wall();
    if (session->thread_ended) {
        reply_gone(session, r);
    } else {
        r->next = NULL;
        *session->patches_end = r;
        session->patches_end = &r->next;
        set_interrupt(session);
        pthread_cond_signal(&session->wake);
    }
    pthread_mutex_unlock(&session->lock);
}

void hn_session_end(hn_session *session, int deleted) {
    pthread_mutex_lock(&session->lock);
    session->ending = 1;
    set_interrupt(session);
    session->deleted |= deleted;
    pthread_cond_signal(&session->wake);
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);
}

hn_client hn_session_client(const hn_session *session) {
    return session->client;
}

double hn_session_untouched(hn_session *session) {
    pthread_mutex_lock(&session->lock);
    const int watched = session->n_streams > 0 || session->patches;
    const double seconds = watched ? 0 : hn_clock_wall() - session->touched;
    pthread_mutex_unlock(&session->lock);
    return seconds;
}

int hn_session_tick(hn_session *session) {
    double now = hn_clock_wall();
    pthread_mutex_lock(&session->lock);
    const double patience = session->had_streams
                                ? fmin(session->opts->orphan_expiry, session->opts->expiry)
                                : session->opts->expiry;
    int expired = session->n_streams == 0 && !session->patches && now - session->touched > patience;
    for (hn_stream *s = session->streams; s; s = hn_stream_next(s)) {
        hn_stream_tick(s, now);
    }
    pthread_mutex_unlock(&session->lock);
    return expired;
}
