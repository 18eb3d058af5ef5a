// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PLACE_QUEUE_H
#define HN_HTTP_PLACE_QUEUE_H
// Requests that wait for a place: of a comparison, or of a study. The oldest that may have one gets
// it. Every call is made with the lock held that guards the places.

#include "http/request/request.h"

#include <stdbool.h>

/// A request waits so long for a place unless it says otherwise, and at most [s].
#define HN_PLACE_WAIT 25.0
#define HN_PLACE_MAX_WAIT 60.0

typedef struct hn_place_queue {
    hn_request *first; ///< oldest first
    int n;
} hn_place_queue;

/// Rules by which places are given.
typedef struct hn_place_rules {
    bool (*take)(void *user, hn_client client); ///< whether there was a place, which is then taken
    void (*give)(void *user, hn_client client); ///< a place was taken for nothing
    /// Makes the problem that is the reply, where so many requests waited before this one.
    void (*refuse)(void *user, hn_request *r, int n_before);
    void *user;
    hn_jobs *jobs; ///< where a request that has its place goes on
} hn_place_rules;

/// Lets a request wait. Returns false when its time is 0, or when `longest` wait already, or for
/// one client its share of them.
bool hn_place_queue_add(hn_place_queue *queue, hn_request *r, double seconds, int longest);
/// Gives places to those who wait; refuses those who have waited long enough or whose client has
/// gone, and all where the server ends.
void hn_place_queue_serve(hn_place_queue *queue, const hn_place_rules *rules, bool is_stopping);
#endif
