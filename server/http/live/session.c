#include "base/clock.h"
#include "http/live/session_internal.h"
#include "http/live/stream.h"

#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

/// Frames that come later than this are not caught up: the clock is set anew and the loss is told as `lag`.
static const double LATE = 0.25; // [s]

// ---- bench ------------------------------------------------------------------------------------------------------

void hn_subject_reset(hn_subject *bench) {
    hn_comparison_free(bench->comparison);
    hn_model_free(bench->model);
    hn_scene_request_reset(&bench->scene);
    *bench = (hn_subject){0};
}

hn_status hn_subject_create(const hn_session *live, const hn_scene_request *scene,
                            const char *const *methods, int n_methods, hn_subject *bench,
                            hn_diags *diags) {
    *bench = (hn_subject){0};
    hn_status status = hn_scene_request_copy(&bench->scene, scene);
    if (status == HN_OK) {
        status = hn_scene_request_load(scene, live->lib, 0, &bench->model, diags);
    }
    if (status == HN_OK) {
        hn_comparison_opts opts = hn_comparison_opts_default();
        opts.frame_dt = live->asked_frame_dt;
        opts.duration = live->asked_duration;
        opts.cpu_budget = live->opts->frame_cpu;
        status = hn_comparison_create(bench->model, methods, n_methods, &opts, &bench->comparison,
                                      diags);
    }
    if (status != HN_OK) {
        hn_subject_reset(bench);
    }
    return status;
}

// ---- publishing -------------------------------------------------------------------------------------------------

static const char *state_name(hn_session_state state) {
    static const char *const names[] = {"paused", "running", "finished"};
    return names[state];
}

void hn_session_put_state(hn_strbuf *b, const hn_session *live) {
    hn_json_put_string(b, "state", state_name(live->state));
    hn_json_put_number(b, "speed", live->speed);
}

static void put_raw(hn_strbuf *b, const char *key, const hn_strbuf *json) {
    hn_json_key(b, key);
    hn_json_raw(b, json->n ? hn_strbuf_text(json) : "null");
}

void hn_session_put_json(hn_strbuf *b, const hn_session *live) {
    char self[64], events[80];
    snprintf(self, sizeof self, "/api/v1/comparisons/%s", live->id);
    snprintf(events, sizeof events, "%s/events", self);
    hn_json_object(b);
    hn_json_put_string(b, "id", live->id);
    hn_session_put_state(b, live);
    hn_json_put_int(b, "frame", live->frame);
    hn_json_put_number(b, "t", (double)live->frame * live->frame_dt);
    hn_json_put_number(b, "frame_dt", live->frame_dt);
    hn_json_put_number(b, "duration", live->duration);
    hn_json_put_int(b, "generation", live->generation);
    hn_json_put_number(b, "lag", live->lag);
    hn_json_put_int(b, "last_event", (long long)live->history.last_id);
    put_raw(b, "scene", &live->scene_json);
    put_raw(b, "comparison", &live->comparison_json);
    put_raw(b, "settings", &live->settings_json);
    put_raw(b, "latest", &live->latest);
    hn_json_key(b, "links");
    hn_json_object(b);
    hn_json_put_string(b, "self", self);
    hn_json_put_string(b, "events", events);
    hn_json_end_object(b);
    hn_json_end_object(b);
}

void hn_session_wake_streams(hn_session *live) {
    for (hn_stream *s = live->streams; s; s = hn_stream_next(s)) {
        hn_stream_wake(s);
    }
}

static void swap_text(hn_strbuf *a, hn_strbuf *b) {
    hn_strbuf t = *a;
    *a = *b;
    *b = t;
}

hn_status hn_session_publish_setup(hn_session *live) {
    hn_strbuf scene, comparison, settings;
    hn_strbuf_init(&scene);
    hn_strbuf_init(&comparison);
    hn_strbuf_init(&settings);
    hn_model_json(&scene, live->bench.model);
    hn_comparison_json(&comparison, live->bench.comparison);
    hn_scene_request_settings_json(&settings, &live->bench.scene);
    hn_status status = scene.failed || comparison.failed || settings.failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK) {
        pthread_mutex_lock(&live->lock);
        swap_text(&live->scene_json, &scene);
        swap_text(&live->comparison_json, &comparison);
        swap_text(&live->settings_json, &settings);
        live->frame_dt = hn_comparison_frame_dt(live->bench.comparison);
        live->duration = hn_comparison_duration(live->bench.comparison);
        pthread_mutex_unlock(&live->lock);
    }
    hn_strbuf_reset(&scene);
    hn_strbuf_reset(&comparison);
    hn_strbuf_reset(&settings);
    return status;
}

/// Writes {"generation":G, and the members of `object`, an object that is not empty.
static void put_with_generation(hn_strbuf *b, const hn_session *live, const hn_strbuf *object) {
    hn_strbuf_printf(b, "{\"generation\":%lld,", live->generation);
    hn_strbuf_add(b, hn_strbuf_text(object) + (object->n > 0));
    b->failed |= object->failed;
}

/// Publishes an incident as an event.
static void publish_incident(hn_session *live, int method, const hn_incident *incident) {
    hn_strbuf text, event;
    hn_strbuf_init(&text);
    hn_strbuf_init(&event);
    hn_incident_json(&text, method, incident);
    put_with_generation(&event, live, &text);
    pthread_mutex_lock(&live->lock);
    hn_history_add(&live->history, HN_EVENT_INCIDENT, &event);
    pthread_mutex_unlock(&live->lock);
    hn_strbuf_reset(&text);
}

/// Publishes the incidents that were written or completed since the last frame.
static void publish_incidents(hn_session *live) {
    for (int i = 0; i < hn_comparison_n_methods(live->bench.comparison); i++) {
        const hn_incident *list;
        int n = hn_run_incidents(hn_comparison_run(live->bench.comparison, i), &list);
        unsigned newest = live->bench.published[i];
        for (int k = 0; k < n; k++) {
            if (list[k].revision > live->bench.published[i]) {
                newest = list[k].revision > newest ? list[k].revision : newest;
                publish_incident(live, i, &list[k]);
            }
        }
        live->bench.published[i] = newest;
    }
}

static void publish_end(hn_session *live) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "generation", live->generation);
    hn_json_key(&b, "summary");
    hn_comparison_summary_json(&b, live->bench.comparison);
    hn_json_end_object(&b);
    pthread_mutex_lock(&live->lock);
    hn_history_add(&live->history, HN_EVENT_END, &b);
    live->state = HN_SESSION_FINISHED;
    hn_session_wake_streams(live);
    pthread_mutex_unlock(&live->lock);
}

void hn_session_publish_frame(hn_session *live) {
    hn_strbuf frame, event, latest;
    hn_strbuf_init(&frame);
    hn_strbuf_init(&event);
    hn_strbuf_init(&latest);
    hn_comparison_frame_json(&frame, live->bench.comparison);
    put_with_generation(&event, live, &frame);
    hn_strbuf_add_n(&latest, hn_strbuf_text(&event), event.n);
    pthread_mutex_lock(&live->lock);
    live->frame = hn_comparison_frame(live->bench.comparison);
    if (!latest.failed) {
        swap_text(&live->latest, &latest);
    }
    hn_history_add(&live->history, HN_EVENT_FRAME, &event);
    hn_session_wake_streams(live);
    pthread_mutex_unlock(&live->lock);
    publish_incidents(live);
    if (hn_comparison_finished(live->bench.comparison)) {
        publish_end(live);
    }
    hn_strbuf_reset(&frame);
    hn_strbuf_reset(&latest);
}

void hn_session_advance(hn_session *live) {
    hn_comparison_next(live->bench.comparison);
    hn_session_publish_frame(live);
}

void hn_session_set_anchor(hn_session *live) {
    live->anchor_time = hn_clock_wall();
    live->anchor_frame = live->frame;
}

void hn_session_set_state(hn_session *live, hn_session_state state, const char *reason) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&live->lock);
    live->state = state;
    hn_session_set_anchor(live);
    hn_json_object(&b);
    hn_session_put_state(&b, live);
    if (reason) {
        hn_json_put_string(&b, "reason", reason);
    }
    hn_json_end_object(&b);
    hn_history_add(&live->history, HN_EVENT_STATE, &b);
    hn_session_wake_streams(live);
    pthread_mutex_unlock(&live->lock);
}

// ---- the thread -------------------------------------------------------------------------------------------------

/// When the next frame is due. With the lock held.
static double next_due(const hn_session *live) {
    return live->anchor_time +
           (double)(live->frame + 1 - live->anchor_frame) * live->frame_dt / live->speed;
}

static void wait_until(hn_session *live, double time) {
    struct timespec ts = {.tv_sec = (time_t)time};
    ts.tv_nsec = (long)((time - (double)ts.tv_sec) * 1e9);
    pthread_cond_timedwait(&live->wake, &live->lock, &ts);
}

static hn_request *take_patch(hn_session *live) {
    hn_request *r = live->patches;
    live->patches = r->next;
    if (!live->patches) {
        live->patches_end = &live->patches;
    }
    return r;
}

/// Nobody reads along: 1 when the comparison should pause itself.
static int is_unwatched(const hn_session *live) {
    return live->n_streams == 0 && hn_clock_wall() - live->touched > live->opts->idle_pause;
}

/// A frame that is due; its lateness is kept as lag rather than caught up in a burst.
static void advance_on_time(hn_session *live, double due) {
    pthread_mutex_unlock(&live->lock);
    hn_session_advance(live);
    pthread_mutex_lock(&live->lock);
    double late = hn_clock_wall() - due;
    if (late > LATE) {
        live->lag += late;
        hn_session_set_anchor(live);
    }
}

/// One thing to do, or a wait. With the lock held.
static void do_next(hn_session *live) {
    if (live->patches) {
        hn_request *r = take_patch(live);
        pthread_mutex_unlock(&live->lock);
        hn_session_apply(live, r);
        hn_request_finish(r);
        pthread_mutex_lock(&live->lock);
        return;
    }
    if (live->state != HN_SESSION_RUNNING) {
        pthread_cond_wait(&live->wake, &live->lock);
        return;
    }
    if (is_unwatched(live)) {
        pthread_mutex_unlock(&live->lock);
        hn_session_set_state(live, HN_SESSION_PAUSED, "nobody was reading");
        pthread_mutex_lock(&live->lock);
        return;
    }
    double due = next_due(live);
    if (hn_clock_wall() < due) {
        wait_until(live, due);
    } else {
        advance_on_time(live, due);
    }
}

static void reply_gone(hn_session *live, hn_request *r) {
    if (live->deleted) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, NULL, "the comparison was deleted");
    } else {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is going down");
    }
    hn_request_finish(r);
}

static void *work(void *arg) {
    hn_session *live = arg;
    pthread_mutex_lock(&live->lock);
    while (!live->ending) {
        do_next(live);
    }
    live->thread_ended = 1;
    while (live->patches) {
        reply_gone(live, take_patch(live));
    }
    hn_session_wake_streams(live);
    pthread_mutex_unlock(&live->lock);
    void (*gone)(void *) = live->gone;
    void *user = live->user;
    hn_session_release(live);
    gone(user);
    return NULL;
}

// ---- life -------------------------------------------------------------------------------------------------------

static void free_live(hn_session *live) {
    hn_subject_reset(&live->bench);
    hn_history_reset(&live->history);
    hn_strbuf_reset(&live->scene_json);
    hn_strbuf_reset(&live->comparison_json);
    hn_strbuf_reset(&live->settings_json);
    hn_strbuf_reset(&live->latest);
    pthread_cond_destroy(&live->wake);
    pthread_mutex_destroy(&live->lock);
    free(live);
}

hn_session *hn_session_retain(hn_session *live) {
    pthread_mutex_lock(&live->lock);
    live->refs++;
    pthread_mutex_unlock(&live->lock);
    return live;
}

void hn_session_release(hn_session *live) {
    pthread_mutex_lock(&live->lock);
    int left = --live->refs;
    pthread_mutex_unlock(&live->lock);
    if (left == 0) {
        free_live(live);
    }
}

static hn_session *new_live(const hn_http_opts *opts, const hn_library *lib,
                            const hn_session_request *order) {
    hn_session *live = calloc(1, sizeof *live);
    if (!live) {
        return NULL;
    }
    pthread_condattr_t attr;
    pthread_condattr_init(&attr);
    pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
    pthread_cond_init(&live->wake, &attr);
    pthread_condattr_destroy(&attr);
    pthread_mutex_init(&live->lock, NULL);
    uint64_t name = 0;
    if (getrandom(&name, sizeof name, 0) != (ssize_t)sizeof name) {
        name = (uint64_t)(hn_clock_wall() * 1e9);
    }
    snprintf(live->id, sizeof live->id, "%016llx", (unsigned long long)name);
    live->refs = 1;
    live->opts = opts;
    live->lib = lib;
    live->asked_frame_dt = order->frame_dt;
    live->asked_duration = order->duration;
    live->speed = order->speed;
    live->state = order->running ? HN_SESSION_RUNNING : HN_SESSION_PAUSED;
    live->touched = hn_clock_wall();
    live->patches_end = &live->patches;
    return live;
}

/// The thread holds a reference of its own.
static hn_status start_thread(hn_session *live) {
    pthread_t thread;
    live->refs++;
    hn_session_set_anchor(live);
    if (pthread_create(&thread, NULL, work, live) != 0) {
        live->refs--;
        return HN_ERR_MEMORY;
    }
    pthread_detach(thread);
    return HN_OK;
}

hn_status hn_session_create(const hn_http_opts *opts, const hn_library *lib,
                            const hn_session_request *order, void (*gone)(void *user), void *user,
                            hn_session **out, hn_diags *diags) {
    hn_session *live = new_live(opts, lib, order);
    if (!live) {
        return HN_ERR_MEMORY;
    }
    live->gone = gone;
    live->user = user;
    hn_status status =
        hn_history_init(&live->history, opts->max_events, (size_t)opts->max_event_bytes);
    if (status == HN_OK) {
        status = hn_subject_create(live, order->scene, order->methods, order->n_methods,
                                   &live->bench, diags);
    }
    if (status == HN_OK && hn_comparison_duration(live->bench.comparison) > opts->max_duration) {
        status = hn_diags_add(diags, HN_ERR_LIMIT, "/duration", NULL,
                              "the duration is %g s; at most %g s are run",
                              hn_comparison_duration(live->bench.comparison), opts->max_duration);
    }
    if (status == HN_OK) {
        status = hn_session_publish_setup(live);
    }
    if (status == HN_OK) {
        hn_session_publish_frame(live);
        status = start_thread(live);
    }
    if (status != HN_OK) {
        hn_session_release(live);
        return status;
    }
    *out = live;
    return HN_OK;
}

const char *hn_session_id(const hn_session *live) {
    return live->id;
}

void hn_session_json(hn_strbuf *b, hn_session *live) {
    pthread_mutex_lock(&live->lock);
    live->touched = hn_clock_wall();
    hn_session_put_json(b, live);
    pthread_mutex_unlock(&live->lock);
}

void hn_session_patch(hn_session *live, hn_request *r) {
    pthread_mutex_lock(&live->lock);
    live->touched = hn_clock_wall();
    if (live->thread_ended) {
        reply_gone(live, r);
    } else {
        r->next = NULL;
        *live->patches_end = r;
        live->patches_end = &r->next;
        pthread_cond_signal(&live->wake);
    }
    pthread_mutex_unlock(&live->lock);
}

void hn_session_end(hn_session *live, int deleted) {
    pthread_mutex_lock(&live->lock);
    live->ending = 1;
    live->deleted |= deleted;
    pthread_cond_signal(&live->wake);
    hn_session_wake_streams(live);
    pthread_mutex_unlock(&live->lock);
}

int hn_session_tick(hn_session *live) {
    double now = hn_clock_wall();
    pthread_mutex_lock(&live->lock);
    int expired =
        live->n_streams == 0 && !live->patches && now - live->touched > live->opts->expiry;
    for (hn_stream *s = live->streams; s; s = hn_stream_next(s)) {
        hn_stream_tick(s, now);
    }
    pthread_mutex_unlock(&live->lock);
    return expired;
}
