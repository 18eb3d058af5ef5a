// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_places.h"

#include "base/clock.h"
#include "http/request/context.h"

#include <math.h>
#include <stdbool.h>

enum { LONGEST_RETRY = 60 }; // [s]
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

hn_study_place hn_study_take_place(hn_studies *all, hn_client client) {
    const hn_study_place p = all->stopping                         ? HN_STUDY_PLACES_CLOSED
                             : hn_shares_take(all->places, client) ? HN_STUDY_PLACE_TAKEN
                                                                   : HN_STUDY_PLACES_FULL;
    all->n_threads += p == HN_STUDY_PLACE_TAKEN;
    return p;
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

void hn_study_reply_no_place(hn_request *r, hn_study_place p) {
    hn_studies *all = r->context->studies;
    if (p == HN_STUDY_PLACES_CLOSED) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
        return;
    }
    const int share = hn_http_opts_share(all->opts, all->opts->max_studies);
    pthread_mutex_lock(&all->lock);
    const double seconds = time_to_place(all, r->client);
    const bool is_own = hn_shares_has_share(all->places, r->client);
    pthread_mutex_unlock(&all->lock);
    hn_reply_problem(r, HN_PROBLEM_STUDIES_BUSY, "ask again, or stop one that is running",
                     is_own ? "your client runs %d of %d studies, which is its share"
                            : "all places for studies are taken; one client may have %d of %d",
                     share, all->opts->max_studies);
    hn_reply_header_add(r, "Retry-After", "%d", (int)fmin(LONGEST_RETRY, 1 + floor(seconds)));
}
