// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/session.h"

#include "base/clock.h"
#include "http/live/patch.h"
#include "http/live/pulls.h"
#include "http/live/session_state.h"
#include "http/live/stream.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

/// A running comparison whose readers have left goes on for so long, until one is back [s].
static const double LEFT_ALONE = 2;

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

/// Returns whether the readers have all left: the comparison then waits for one, and computes for
/// nobody.
static bool is_left(const hn_session *session) {
    return session->had_streams && session->n_streams == 0 &&
           hn_clock_wall() - session->touched > LEFT_ALONE;
}

static hn_request *take_patch(hn_session *session) {
    hn_request *r = session->patches;
    session->patches = r->next;
    if (!session->patches) {
        session->patches_end = &session->patches;
    }
    hn_session_set_interrupt(session);
    return r;
}

/// Nobody reads along: 1 when the comparison should pause itself.
static bool is_unwatched(const hn_session *session) {
    return session->n_streams == 0 &&
           hn_clock_wall() - session->touched > session->opts->idle_pause;
}

/// A frame that is due; its lateness is kept as lag rather than caught up in a burst.
static void advance_on_time(hn_session *session, double due) {
    session->due = due;
    pthread_mutex_unlock(&session->lock);
    hn_session_advance(session);
    pthread_mutex_lock(&session->lock);
    const double late = hn_session_lateness(session);
    session->due = 0;
    if (late > 0) {
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

    if (is_left(session)) {
        wait_until(session, session->touched + session->opts->idle_pause);
        hn_session_set_anchor(session);
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
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
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
    session->stopping = order->stopping;
    session->maker = order->maker;
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
    hn_session_limit_equations(session, true);
    hn_status status =
        hn_history_init(&session->history, opts->max_events, (size_t)opts->max_event_bytes);
    HN_THEN(status, hn_subject_create(session, order->scene, order->methods, order->n_methods,
                                      &session->bench, diags));
    if (status == HN_OK && hn_comparison_duration(session->bench.comparison) > opts->max_duration) {
        status = hn_diags_add(
            diags, HN_ERR_LIMIT, "/duration", NULL, "the duration is %g s; at most %g s are run",
            hn_comparison_duration(session->bench.comparison), opts->max_duration);
    }
    hn_pull_list pulls = {(hn_pull_event *)order->pulls, order->n_pulls};
    HN_THEN(status, hn_pull_list_give(&pulls, session->bench.comparison, diags));
    HN_THEN(status, hn_session_publish_setup(session));
    if (session->interrupted) {
        diags->n = 0;
        status = HN_ERR_STOPPED;
    }
    if (status == HN_OK) {
        hn_session_publish_pulls(session);
        hn_session_publish_frame(session);
        hn_session_limit_equations(session, false);
        session->maker = NULL;
        status = start_thread(session);
    }
    if (status != HN_OK) {
        hn_session_release(session);
        return status;
    }
    *out = session;
    return HN_OK;
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
        hn_session_set_interrupt(session);
        pthread_cond_signal(&session->wake);
    }
    pthread_mutex_unlock(&session->lock);
}

void hn_session_end(hn_session *session, int deleted) {
    pthread_mutex_lock(&session->lock);
    session->ending = 1;
    hn_session_set_interrupt(session);
    session->deleted |= deleted;
    pthread_cond_signal(&session->wake);
    for (hn_reader *r = session->readers; r; r = r->next) {
        hn_stream_end(r);
    }
    pthread_mutex_unlock(&session->lock);
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
    for (hn_reader *r = session->readers; r; r = r->next) {
        hn_stream_tick(r, now);
    }
    pthread_mutex_unlock(&session->lock);
    return expired;
}
