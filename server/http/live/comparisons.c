// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/comparisons.h"

#include "base/clock.h"
#include "http/ground/jobs.h"
#include "http/live/pulls.h"
#include "http/live/session.h"
#include "http/live/stream.h"
#include "http/request/context.h"
#include "http/request/gzip.h"
#include "http/request/place_queue.h"
#include "http/request/request.h"
#include "session/job/field.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { MAX_LINGERING = 8, MOST_ZIPPED = 8 << 20 };
/// A comparison that nobody has read or asked for so long makes room for another [s].
static const double FORSAKEN = 5;

struct hn_comparisons {
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< the keeper should end, or a comparison's thread has ended
    const hn_http_opts *opts;
    const hn_library *lib;
    hn_session **sessions; ///< one reference each
    int n, n_reserved;     ///< there, and being made
    int n_threads, stopping;
    int n_threads_before; ///< at the keeper's last look
    hn_place_queue queue; ///< requests that wait for a place
    hn_shares *places;
    pthread_t keeper;
    int has_keeper;
};

// ---- the table ----

/// Takes the i-th out; its reference passes to the caller. With the lock held.
static hn_session *take_out(hn_comparisons *all, int i) {
    hn_session *session = all->sessions[i];
    all->sessions[i] = all->sessions[--all->n];
    return session;
}

/// Ends a comparison that was taken out of the table. With the lock held.
static void let_go(hn_comparisons *all, hn_session *session, int deleted) {
    hn_shares_give(all->places, hn_session_client(session));
    hn_session_end(session, deleted);
    hn_session_release(session);
}

/// Ends what nobody touched for long; wakes streams for their comment lines.
static void tick(hn_comparisons *all) {
    for (int i = all->n - 1; i >= 0; i--) {
        if (hn_session_tick(all->sessions[i])) {
            hn_session *session = take_out(all, i);
            let_go(all, session, 1);
        }
    }
}

/// Makes room for a client by ending the comparison that was left alone for longest, if any was:
/// one of its own where the client has its share, else anybody's. With the lock held. Returns true
/// when there is room.
static bool end_forsaken(hn_comparisons *all, hn_client client) {
    const bool full = hn_shares_taken(all->places) >= all->opts->max_comparisons;
    double longest = FORSAKEN;
    int oldest = -1;
    for (int i = 0; i < all->n; i++) {
        const double seconds = hn_session_untouched(all->sessions[i]);
        if (seconds > longest && (full || hn_session_client(all->sessions[i]) == client)) {
            longest = seconds;
            oldest = i;
        }
    }
    if (oldest >= 0) {
        let_go(all, take_out(all, oldest), 1);
    }
    return oldest >= 0;
}

/// Takes a place for a client. One that was deleted may still be busy with its last step: only so
/// many may linger. With the lock held.
static bool take_place(hn_comparisons *all, hn_client client) {
    const int lingering = all->n_threads - all->n - all->n_reserved;
    return !all->stopping && lingering < MAX_LINGERING &&
           (hn_shares_take(all->places, client) ||
            (end_forsaken(all, client) && hn_shares_take(all->places, client)));
}

// ---- those who wait for a place ----

static void refuse(void *user, hn_request *r, int n_before) {
    hn_comparisons *all = user;
    if (all->stopping) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
        return;
    }
    hn_reply_problem(r, HN_PROBLEM_BUSY, "DELETE one that is no longer needed, or wait",
                     "%d of %d comparisons are open; while other clients wait, one client may have "
                     "%d of them; %d requests wait before this one",
                     hn_shares_taken(all->places), all->opts->max_comparisons,
                     hn_http_opts_share(all->opts, all->opts->max_comparisons), n_before);
    hn_reply_header_add(r, "Retry-After", "%d", (int)FORSAKEN);
}

static bool take_for(void *user, hn_client client) {
    return take_place(user, client);
}

static void give_back(void *user, hn_client client) {
    hn_shares_give(((hn_comparisons *)user)->places, client);
}

/// Gives places to those who wait. With the lock held.
static void serve_waiting(hn_comparisons *all) {
    if (all->queue.first) {
        const hn_place_rules rules = {.take = take_for,
                                      .give = give_back,
                                      .refuse = refuse,
                                      .user = all,
                                      .jobs = all->queue.first->context->quick};
        hn_place_queue_serve(&all->queue, &rules, all->stopping);
    }
}

/// Lets a request wait for a place. With the lock held. Returns false when too many wait already.
static bool wait_for_place(hn_comparisons *all, hn_request *r, double seconds) {
    const bool waits =
        !all->stopping && hn_place_queue_add(&all->queue, r, seconds, all->opts->quick_queue);
    if (waits) {
        pthread_cond_broadcast(&all->changed);
    }
    return waits;
}

/// Gives the memory of comparisons that have ended back to the system. Their threads have heaps of
/// their own, which the C library keeps otherwise: 300 MB after a class has gone. With the lock
/// held, which is given up meanwhile.
static void give_back_memory(hn_comparisons *all) {
    if (all->n_threads >= all->n_threads_before) {
        all->n_threads_before = all->n_threads;
        return;
    }
    all->n_threads_before = all->n_threads;
    pthread_mutex_unlock(&all->lock);
    malloc_trim(0);
    pthread_mutex_lock(&all->lock);
}

static void *keep(void *arg) {
    hn_comparisons *all = arg;
    // a look per second, oftener when the bounds are tighter than that or somebody waits
    const bool tight = all->opts->keep_alive < 2 || all->opts->expiry < 2;
    pthread_mutex_lock(&all->lock);
    while (!all->stopping) {
        const double every = tight || all->queue.n > 0 ? 0.1 : 1;
        struct timespec ts;
        clock_gettime(CLOCK_MONOTONIC, &ts);
        long ns = ts.tv_nsec + (long)(every * 1e9);
        ts.tv_sec += ns / 1000000000;
        ts.tv_nsec = ns % 1000000000;
        pthread_cond_timedwait(&all->changed, &all->lock, &ts);
        tick(all);
        serve_waiting(all);
        give_back_memory(all);
    }
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

hn_comparisons *hn_comparisons_create(const hn_http_opts *opts, const hn_library *lib) {
    hn_comparisons *all = calloc(1, sizeof *all);
    if (!all) {
        return NULL;
    }
    pthread_condattr_t attr;
    pthread_condattr_init(&attr);
    pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
    pthread_cond_init(&all->changed, &attr);
    pthread_condattr_destroy(&attr);
    pthread_mutex_init(&all->lock, NULL);

    // the keeper looks after those that nobody touches
    all->opts = opts;
    all->lib = lib;
    all->sessions = calloc((size_t)opts->max_comparisons, sizeof(hn_session *));
    all->places =
        hn_shares_create(opts->max_comparisons, hn_http_opts_share(opts, opts->max_comparisons));
    all->has_keeper =
        all->sessions && all->places && pthread_create(&all->keeper, NULL, keep, all) == 0;
    if (!all->has_keeper) {
        hn_comparisons_free(all);
        return NULL;
    }
    return all;
}

void hn_comparisons_stop(hn_comparisons *all) {
    if (!all) {
        return;
    }
    pthread_mutex_lock(&all->lock);
    all->stopping = 1;
    while (all->n > 0) {
        let_go(all, take_out(all, all->n - 1), 0);
    }
    serve_waiting(all);
    pthread_cond_broadcast(&all->changed);
    while (all->n_threads > 0) {
        pthread_cond_wait(&all->changed, &all->lock);
    }
    pthread_mutex_unlock(&all->lock);
    if (all->has_keeper) {
        pthread_join(all->keeper, NULL);
        all->has_keeper = 0;
    }
}

void hn_comparisons_free(hn_comparisons *all) {
    if (all) {
        hn_comparisons_stop(all);
        pthread_cond_destroy(&all->changed);
        pthread_mutex_destroy(&all->lock);
        hn_shares_free(all->places);
        free(all->sessions);
        free(all);
    }
}

static void thread_gone(void *user) {
    hn_comparisons *all = user;
    pthread_mutex_lock(&all->lock);
    all->n_threads--;
    pthread_cond_broadcast(&all->changed);
    pthread_mutex_unlock(&all->lock);
}

/// The comparison of the request's path, retained; NULL when there is none.
static hn_session *look_for_session(const hn_request *r) {
    hn_comparisons *all = r->context->comparisons;
    hn_session *found = NULL;
    pthread_mutex_lock(&all->lock);
    for (int i = 0; i < all->n && !found; i++) {
        if (strcmp(hn_session_id(all->sessions[i]), r->parts[0]) == 0) {
            found = hn_session_retain(all->sessions[i]);
        }
    }
    pthread_mutex_unlock(&all->lock);
    return found;
}

/// The same; NULL with a problem as reply.
static hn_session *find_session(hn_request *r) {
    hn_session *found = look_for_session(r);
    if (!found) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "POST /api/v1/comparisons makes one",
                         "there is no comparison '%.40s', or it was deleted", r->parts[0]);
    }
    return found;
}

/// A place for one more. Returns false where the request waits for one, or is refused.
static bool reserve(hn_comparisons *all, hn_request *r, double wait) {
    pthread_mutex_lock(&all->lock);
    if (!r->has_place) {
        serve_waiting(all); // then no waiting request could have what is left
    }
    const bool placed = r->has_place || take_place(all, r->client);
    const bool waits = !placed && wait_for_place(all, r, wait);
    if (placed) {
        all->n_reserved++;
        all->n_threads++; // the thread it will have
    } else if (!waits) {
        refuse(all, r, all->queue.n);
    }
    pthread_mutex_unlock(&all->lock);
    if (!placed && !waits) {
        hn_request_finish(r);
    }
    return placed;
}

/// Fills the reserved place, or gives it back when `session` is NULL. A server that stops in
/// between keeps nothing, nor is anything kept for a client that has gone.
static void settle(hn_comparisons *all, hn_request *r, hn_session *session) {
    const bool is_left = hn_request_has_been_left(r);
    pthread_mutex_lock(&all->lock);
    const bool is_kept = session && !all->stopping && !is_left;
    all->n_reserved--;
    if (is_kept) {
        all->sessions[all->n++] = hn_session_retain(session);
    } else {
        hn_shares_give(all->places, r->client);
    }
    if (!session) {
        all->n_threads--;
        pthread_cond_broadcast(&all->changed);
    } else if (!is_kept) {
        hn_session_end(session, 0);
    }
    pthread_mutex_unlock(&all->lock);
}

// ---- handlers ----

void hn_handle_comparisons_list(hn_request *r) {
    hn_comparisons *all = r->context->comparisons;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_key(&b, "comparisons");
    hn_json_array(&b);
    pthread_mutex_lock(&all->lock);
    for (int i = 0; i < all->n; i++) {
        hn_json_string(&b, hn_session_id(all->sessions[i]));
    }
    pthread_mutex_unlock(&all->lock);
    hn_json_end_array(&b);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

/// The spellings of "methods", at most HN_COMPARISON_MAX_METHODS (the field table bounds them).
static int read_methods(const cJSON *body, const char **methods) {
    int n = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(body, "methods")) {
        methods[n++] = item->valuestring;
    }
    return n;
}

static hn_status create(hn_comparisons *all, hn_request *r, hn_session **session, hn_diags *diags) {
    const cJSON *body = r->json;
    const char *methods[HN_COMPARISON_MAX_METHODS];
    hn_scene_request scene = {0};
    hn_session_request order = {
        .scene = &scene,
        .methods = methods,
        .n_methods = read_methods(body, methods),
        .frame_dt = hn_fields_number(body, "frame_dt", 0),
        .duration = hn_fields_number(body, "duration", 0),
        .speed = hn_fields_number(body, "speed", 1),
        .client = r->client,
        .maker = r,
        .stopping = &r->context->stopping,
        .running = cJSON_IsFalse(cJSON_GetObjectItemCaseSensitive(body, "paused")),
    };
    hn_pull_list pulls = {0};
    hn_status status = hn_scene_request_read(&scene, body, diags);
    HN_THEN(status,
            hn_pull_list_read(cJSON_GetObjectItemCaseSensitive(body, "pulls"), &pulls, diags));
    HN_THEN(status, hn_pull_list_name_points(&pulls, &scene, diags));
    order.pulls = pulls.at;
    order.n_pulls = pulls.n;
    HN_THEN(status,
            hn_session_create(all->opts, all->lib, &order, thread_gone, all, session, diags));
    hn_pull_list_reset(&pulls);
    hn_scene_request_reset(&scene);
    return status;
}

void hn_handle_comparisons_create(hn_request *r) {
    hn_comparisons *all = r->context->comparisons;
    hn_session *session = NULL;
    hn_diags diags = {0};
    double wait = HN_PLACE_WAIT;
    if (!hn_request_query_number(r, "wait", 0, HN_PLACE_MAX_WAIT, false, &wait)) {
        hn_request_finish(r);
        return;
    }
    if (!reserve(all, r, wait)) {
        return;
    }

    // made in its place
    hn_status status = create(all, r, &session, &diags);
    settle(all, r, session);
    if (status == HN_OK) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_session_json(&b, session);
        hn_reply_json(r, MHD_HTTP_CREATED, &b);
        hn_reply_header_add(r, "Location", "/api/v1/comparisons/%s", hn_session_id(session));
        hn_session_release(session);
    } else {
        hn_reply_diags(r, status, &diags);
    }
    hn_reply_compress(r, MOST_ZIPPED);
    hn_request_finish(r);
}

void hn_handle_comparison_get(hn_request *r) {
    hn_session *session = find_session(r);
    if (session) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_session_json(&b, session);
        hn_reply_json(r, MHD_HTTP_OK, &b);
        hn_session_release(session);
    }
}

void hn_handle_comparison_pulls(hn_request *r) {
    hn_session *session = find_session(r);
    if (session) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_session_pulls_json(&b, session);
        hn_reply_json(r, MHD_HTTP_OK, &b);
        hn_session_release(session);
    }
}

void hn_handle_comparison_patch(hn_request *r) {
    hn_session *session = find_session(r);
    if (!session) {
        hn_request_finish(r);
        return;
    }
    hn_session_patch(session, r);
    hn_session_release(session);
}

void hn_handle_comparison_delete(hn_request *r) {
    hn_comparisons *all = r->context->comparisons;
    hn_session *session = look_for_session(r);
    hn_reply_empty(r, MHD_HTTP_NO_CONTENT); // the same for one that is gone
    if (!session) {
        return;
    }
    pthread_mutex_lock(&all->lock);
    for (int i = 0; i < all->n; i++) {
        if (all->sessions[i] == session) {
            let_go(all, take_out(all, i), 1);
        }
    }
    pthread_cond_broadcast(&all->changed);
    pthread_mutex_unlock(&all->lock);
    hn_session_release(session);
}

void hn_handle_comparison_events(hn_request *r) {
    hn_session *session = find_session(r);
    if (session) {
        hn_stream_open(session, r);
        hn_session_release(session);
    }
}
