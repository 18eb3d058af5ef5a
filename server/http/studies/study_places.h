// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_PLACES_H
#define HN_HTTP_STUDY_PLACES_H
// The studies of a server, and the places of those that run: so many in all and so many for one
// client.

#include "http/ground/shares.h"
#include "http/request/place_queue.h"
#include "http/studies/studies.h"
#include "http/studies/study_work.h"

#include <pthread.h>

typedef struct hn_study {
    char id[17];
    int refs;       ///< under the lock of all, as is everything down to `work`
    double started; ///< the present run, or the last one [s, wall clock]
    double ended, touched;
    double before; ///< wall time of earlier runs [s]
    int done;
    bool is_cut; ///< it ran when the server began to end
    hn_study_result result;
    hn_client client; ///< who holds its place while it runs, and who started it last
    hn_study_work work;
    hn_studies *all;
} hn_study;

struct hn_studies {
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< a thread has ended
    const hn_http_opts *opts;
    const hn_library *lib;
    hn_study *list[HN_STUDIES_KEPT];
    int n, stopping;
    hn_shares *places;    ///< of studies that are being read or computed
    hn_place_queue queue; ///< requests that wait for a place
    pthread_t keeper;     ///< looks after them
    bool has_keeper;
    int n_threads;         ///< that are at work, or on their way out
    int n_cut, n_cut_kept; ///< the end of the server stopped them; what they did is in the folder
};

/// Returns the seconds to go, by what was done in `elapsed` seconds and never beyond the time
/// limit; all that the limit leaves when too little is known.
double hn_study_time_left(const hn_study *s, double share, double elapsed);
/// Outcome of a request for a place.
typedef enum hn_study_place {
    HN_STUDY_PLACED, ///< the place of one more thread is the request's
    HN_STUDY_WAITS,  ///< it is another thread's now, and comes again with its place, or is refused
    HN_STUDY_REFUSED ///< the reply is there, and has the seconds until there will be a place
} hn_study_place;

/// Gives a request its place for one more thread, after those who wait have theirs; lets it wait
/// for one where there is none, at most so many seconds, or refuses it with the number of requests
/// that wait before it. With the lock held. A study that was deleted holds its place until its
/// thread has ended.
hn_study_place hn_study_find_place(hn_studies *all, hn_request *r, double wait);
/// Starts the thread that looks after those who wait. Returns false when threads are out.
bool hn_study_places_start(hn_studies *all);
/// Refuses those who wait; with the lock held, and `stopping` set.
void hn_study_refuse_waiting(hn_studies *all);
/// Gives back a place whose thread was never started, with the lock held.
void hn_study_give_back(hn_studies *all, hn_client client);
#endif
