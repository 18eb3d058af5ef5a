// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/session_state.h"

#include "base/clock.h"
#include "http/live/pulls.h"
#include "session/compare/comparison_doc.h"
#include "session/compare/incident_json.h"
#include "session/model/model_json.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Frames that come later than this are not caught up: the clock is set anew and the loss is told
/// as `lag`.
static const double LATE = 0.25; // [s]

// ---- what is compared ----

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
    opts.cpu_limit = session->opts->frame_cpu;
    return hn_comparison_create(model, methods, n_methods, &opts, out, diags);
}

void hn_session_limit_equations(hn_session *session, bool limited) {
    session->load_end = limited ? hn_clock_thread() + session->opts->max_run_cpu : (double)HUGE_VAL;
    session->interrupted = false;
}

/// Returns whether equations are no longer wanted, or take too long.
static bool must_end(void *user) {
    hn_session *session = user;
    session->interrupted |= (session->maker && hn_request_is_unwanted(session->maker)) ||
                            atomic_load(&session->interrupt) == HN_INTERRUPT_END ||
                            atomic_load(session->stopping) || hn_clock_thread() > session->load_end;
    return session->interrupted;
}

hn_status hn_subject_create(hn_session *session, const hn_scene_request *scene,
                            const char *const *methods, int n_methods, hn_subject *bench,
                            hn_diags *diags) {
    *bench = (hn_subject){0};
    hn_status status = hn_scene_request_copy(&bench->scene, scene);
    HN_THEN(status, hn_scene_request_load(scene, session->lib, 0, (hn_interrupt){must_end, session},
                                          &bench->model, diags));
    HN_THEN(status, hn_subject_compare(session, bench->model, methods, n_methods,
                                       &bench->comparison, diags));
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
    hn_json_put_number(b, "lag", session->lag + hn_session_lateness(session));
    hn_json_put_int(b, "last_event", (long long)session->history.last_id);
    hn_json_put_int(b, "pulls", session->n_pulls);

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

void hn_reader_wake(hn_reader *r) {
    if (r->waiting) {
        r->waiting = 0;
        MHD_resume_connection(r->connection);
    }
}

void hn_session_wake_streams(hn_session *session) {
    for (hn_reader *r = session->readers; r; r = r->next) {
        hn_reader_wake(r);
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

void hn_session_publish_pulls(hn_session *session) {
    const hn_pull_event *events;
    const int n = hn_comparison_pulls(session->bench.comparison, &events);
    pthread_mutex_lock(&session->lock);
    if (n <= session->n_pulls) { // those that were not done yet were forgotten
        hn_strbuf_clear(&session->pulls_json);
        session->n_pulls = 0;
    }
    hn_pulls_json(&session->pulls_json, session->bench.comparison, session->n_pulls);
    session->n_pulls = n;
    pthread_mutex_unlock(&session->lock);
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

/// Writes a frame, an object, with what only some readers want.
static void add_extras(hn_strbuf *event, const hn_strbuf *plain, const hn_comparison *c,
                       size_t extra[HN_EVENT_MAX_EXTRAS + 1]) {
    _Static_assert((int)HN_FRAME_EXTRAS <= (int)HN_EVENT_MAX_EXTRAS, "every extra has its place");
    event->failed = plain->failed || plain->n == 0;
    hn_strbuf_add_n(event, hn_strbuf_text(plain), plain->n - (plain->n > 0)); // without its brace
    extra[0] = event->n;
    for (int i = 0; i < HN_FRAME_EXTRAS; i++) {
        hn_strbuf value;
        hn_strbuf_init(&value);
        hn_comparison_extra_json(&value, c, (hn_frame_extra)i);
        hn_strbuf_printf(event, ",\"%s\":", hn_frame_extra_name((hn_frame_extra)i));
        hn_strbuf_add_n(event, hn_strbuf_text(&value), value.n);
        event->failed |= value.failed;
        hn_strbuf_reset(&value);
        extra[i + 1] = event->n;
    }
    hn_strbuf_add(event, "}");
}

void hn_session_publish_frame(hn_session *session) {
    size_t extra[HN_EVENT_MAX_EXTRAS + 1] = {0};
    hn_strbuf frame, event, latest;
    hn_strbuf_init(&frame);
    hn_strbuf_init(&event);
    hn_strbuf_init(&latest);
    hn_comparison_frame_json(&frame, session->bench.comparison);
    put_with_generation(&latest, session, &frame);
    add_extras(&event, &latest, session->bench.comparison, extra);

    // the frame is there for all at once
    pthread_mutex_lock(&session->lock);
    session->frame = hn_comparison_frame(session->bench.comparison);
    if (!latest.failed) {
        swap_text(&session->latest, &latest);
    }
    hn_history_add_parts(&session->history, HN_EVENT_FRAME, &event, extra);
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

/// Publishes how slow the frame in progress is, where that is due.
static void publish_slowness(hn_session *session) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "generation", session->generation);
    const bool is_due =
        hn_slow_frame_report(&session->slow, session->bench.comparison, session->speed, &b);
    hn_json_end_object(&b);
    if (is_due) {
        pthread_mutex_lock(&session->lock);
        hn_history_add(&session->history, HN_EVENT_SLOW, &b);
        hn_session_wake_streams(session);
        pthread_mutex_unlock(&session->lock);
    }
    hn_strbuf_reset(&b);
}

static int must_yield(void *user) {
    hn_session *session = user;
    publish_slowness(session);
    const int interrupt = atomic_load(&session->interrupt);
    return interrupt == HN_INTERRUPT_END ||
           (interrupt == HN_INTERRUPT_REQUEST && hn_clock_wall() > session->undisturbed);
}

void hn_session_set_interrupt(hn_session *session) {
    atomic_store(&session->interrupt, session->ending    ? HN_INTERRUPT_END
                                      : session->patches ? HN_INTERRUPT_REQUEST
                                                         : HN_INTERRUPT_NONE);
}

int hn_session_advance(hn_session *session) {
    hn_slow_frame_begin(&session->slow);
    const bool is_whole = hn_comparison_work(session->bench.comparison, must_yield, session);
    hn_slow_frame_end(&session->slow, is_whole);
    if (!is_whole) {
        return 0;
    }
    hn_session_publish_frame(session);
    return 1;
}

double hn_session_lateness(const hn_session *session) {
    const double late = session->due > 0 ? hn_clock_wall() - session->due : 0;
    return late > LATE ? late : 0;
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

// ---- references ----

static void free_session(hn_session *session) {
    hn_subject_reset(&session->bench);
    hn_history_reset(&session->history);
    hn_strbuf_reset(&session->scene_json);
    hn_strbuf_reset(&session->comparison_json);
    hn_strbuf_reset(&session->settings_json);
    hn_strbuf_reset(&session->latest);
    hn_strbuf_reset(&session->pulls_json);
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

const char *hn_session_id(const hn_session *session) {
    return session->id;
}

void hn_session_json(hn_strbuf *b, hn_session *session) {
    pthread_mutex_lock(&session->lock);
    session->touched = hn_clock_wall();
    pthread_cond_signal(&session->wake);
    hn_session_put_json(b, session);
    pthread_mutex_unlock(&session->lock);
}

void hn_session_pulls_json(hn_strbuf *b, hn_session *session) {
    pthread_mutex_lock(&session->lock);
    session->touched = hn_clock_wall();
    hn_strbuf_printf(b, "{\"generation\":%lld,\"frame_dt\":%.17g,\"pulls\":[%s]}",
                     session->generation, session->frame_dt, hn_strbuf_text(&session->pulls_json));
    b->failed |= session->pulls_json.failed;
    pthread_mutex_unlock(&session->lock);
}

hn_client hn_session_client(const hn_session *session) {
    return session->client;
}
