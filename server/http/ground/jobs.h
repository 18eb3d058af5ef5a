// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_JOBS_H
#define HN_HTTP_JOBS_H
// A pool of threads with a bounded queue: long requests are done here, so that short ones and
// streams never wait. Among those that wait, the client with the fewest jobs at work comes first.
//
// A job that works for long makes way: it asks now and then whether others wait, and is then set
// aside, on its thread, until its turn comes again. So a job of 20 ms waits for a slice of time of
// those before it, not for their ends.

#include "base/status.h"
#include "http/ground/shares.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct hn_jobs hn_jobs;
typedef struct hn_job_turn hn_job_turn; ///< a thread of the pool while it does a job

typedef struct hn_jobs_opts {
    int at_once;          ///< jobs at work
    int n_waiting;        ///< jobs that wait, at most
    int n_waiting_of_one; ///< of them of one client
    int n_aside;          ///< jobs that are set aside, at most; 0: a job works to its end
    int n_aside_of_one;   ///< jobs of one client that make way for another job of that client
    double longest;       ///< computing time of one job, at most [s]; 0: short
    bool reports;         ///< jobs say how much of them is done, as soon as they know
} hn_jobs_opts;

/// `run` does one job, on a thread of the pool. NULL when memory or threads are out.
hn_jobs *hn_jobs_create(const hn_jobs_opts *opts, void (*run)(void *job, hn_job_turn *turn));
/// Returns 0 when the queue is full, in all or for this client, or the pool is stopping. `key`
/// stands for what the job is to do, as in hn_jobs_wait(); 0: unknown.
int hn_jobs_push(hn_jobs *jobs, void *job, hn_client client, uint64_t key);
/// Returns the seconds after which the queue will probably have a place for a client that was
/// refused, 1 to 3600: jobs that are begun end or make way, and one that waits leaves its place.
/// Those that were refused before, and have not come back, have theirs first.
int hn_jobs_wait(hn_jobs *jobs, hn_client client, uint64_t key);
/// Takes on nothing new, works off what is queued, and joins the threads. NULL is legal.
void hn_jobs_stop(hn_jobs *jobs);
void hn_jobs_free(hn_jobs *jobs); ///< stops first; NULL is legal

/// Lets other jobs work first. A job calls it often; it returns at once, unless others wait and the
/// job has worked for a slice of time. NULL is legal. The caller holds no lock that jobs need.
void hn_job_make_way(hn_job_turn *turn);
/// Says that a share (0 to 1) of the job is done: hn_jobs_wait() reckons with it. Costs a store;
/// `longest` holds for what comes after the first report.
/// NULL is legal.
void hn_job_report(hn_job_turn *turn, double share);
#endif
