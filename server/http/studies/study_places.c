// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_places.h"

#include "base/clock.h"
#include "http/request/context.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <time.h>

enum { LONGEST_RETRY = 60, LOOK_MS = 100 }; // [s], [ms]
/// Below this share the time left is not estimated: too little is known.
static const double TELLING = 0.03;

double hn_study_time_left(const hn_study *s, double share, double elapsed) {
    if (s->done) {
        return 0;
    }
    const double by_share =
        share > TELLING ? (s->before + elapsed) * (1 - share) / share : HUGE_VAL;
    return fmin(by_share, fmax(0, s->work.request.limits.time_limit - elapsed));
}

void hn_study_give_back(hn_studies *all, hn_client client) {
    hn_shares_give(all->places, client);
    all->n_threads--;
    pthread_cond_broadcast(&all->changed);
}

/// Seconds until a study ends whose place this client could have: by its progress, at most its time
/// limit. Those that are not listed are being read or ending, which takes no time. With the lock
/// held.
static double time_to_place(const hn_studies *all, hn_client client) {
    const bool has_share = hn_shares_has_share(all->places, client);
    double shortest = LONGEST_RETRY;
    int listed = 0;
    for (int i = 0; i < all->n; i++) {
        const hn_study *s = all->list[i];
        if (!s->done && (!has_share || s->client == client)) {
            const double elapsed = hn_clock_wall() - s->started;
            const double left = hn_study_time_left(s, atomic_load(&s->work.share), elapsed);
            shortest = fmin(shortest, atomic_load(&s->work.stop) ? 0 : left);
            listed++;
        }
    }
    return listed > 0 ? shortest : 1;
}

/// The place of each of those that wait before is free again after a study of full length.
static double time_to_turn(const hn_studies *all, hn_client client, int n_before) {
    const double each = all->opts->max_run_cpu / all->opts->max_studies;
    return fmin(LONGEST_RETRY, time_to_place(all, client) + n_before * each);
}

/// Makes the reply to a request that found no place. With the lock held.
static void refuse_place(hn_studies *all, hn_request *r, int n_before, const char *tail) {
    if (all->stopping) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
        return;
    }
    const int share = hn_http_opts_share(all->opts, all->opts->max_studies);
    const double seconds = time_to_turn(all, r->client, n_before);
    if (hn_shares_has_share(all->places, r->client)) {
        hn_reply_problem(r, HN_PROBLEM_STUDIES_BUSY, "wait, or stop one that is running",
                         "your client runs %d of %d studies, which is its share%s; Retry-After "
                         "estimates when the first of yours ends",
                         share, all->opts->max_studies, tail);
    } else {
        hn_reply_problem(r, HN_PROBLEM_STUDIES_BUSY, "wait, or stop one that is running",
                         "all %d places for studies are taken%s; Retry-After estimates when this "
                         "request would have one",
                         all->opts->max_studies, tail);
    }
    hn_reply_header_add(r, "Retry-After", "%d", (int)fmin(LONGEST_RETRY, 1 + floor(seconds)));
}

// ---- those who wait ----

static bool take(void *user, hn_client client) {
    hn_studies *all = user;
    return !all->stopping && hn_shares_take(all->places, client);
}

static void give(void *user, hn_client client) {
    hn_studies *all = user;
    hn_shares_give(all->places, client);
}

static void refuse(void *user, hn_request *r, int n_before) {
    char tail[64];
    snprintf(tail, sizeof tail, "; %d requests wait before this one", n_before);
    refuse_place(user, r, n_before, tail);
}

/// With the lock held.
static void serve_waiting(hn_studies *all) {
    if (all->queue.first) {
        const hn_place_rules rules = {.take = take,
                                      .give = give,
                                      .refuse = refuse,
                                      .user = all,
                                      .jobs = all->queue.first->context->heavy};
        hn_place_queue_serve(&all->queue, &rules, all->stopping);
    }
}

/// Takes a place that no waiting request could have. With the lock held.
static bool take_after_waiting(hn_studies *all, hn_client client) {
    serve_waiting(all);
    return take(all, client);
}

void hn_study_refuse_waiting(hn_studies *all) {
    serve_waiting(all);
}

static void *keep(void *arg) {
    hn_studies *all = arg;
    pthread_mutex_lock(&all->lock);
    while (!all->stopping) {
        if (all->queue.n == 0) {
            pthread_cond_wait(&all->changed, &all->lock);
        } else {
            pthread_mutex_unlock(&all->lock);
            nanosleep(&(struct timespec){.tv_nsec = LOOK_MS * 1000000L}, NULL);
            pthread_mutex_lock(&all->lock);
        }
        serve_waiting(all);
    }
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

bool hn_study_places_start(hn_studies *all) {
    all->has_keeper = pthread_create(&all->keeper, NULL, keep, all) == 0;
    return all->has_keeper;
}

hn_study_place hn_study_find_place(hn_studies *all, hn_request *r, double wait) {
    if (!all->stopping && (r->has_place || take_after_waiting(all, r->client))) {
        all->n_threads++;
        return HN_STUDY_PLACED;
    }
    if (!all->stopping && hn_place_queue_add(&all->queue, r, wait, all->opts->queue)) {
        pthread_cond_broadcast(&all->changed);
        return HN_STUDY_WAITS;
    }
    refuse(all, r, all->queue.n);
    return HN_STUDY_REFUSED;
}
