// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_JOBS_H
#define HN_HTTP_JOBS_H
// A pool of threads with a bounded queue: long requests are worked off here, so that short ones and
// streams never wait.

#include "base/status.h"

typedef struct hn_jobs hn_jobs;

/// `run` does one job, on a thread of the pool. NULL when memory or threads are out.
hn_jobs *hn_jobs_create(int n_threads, int n_waiting, void (*run)(void *job));
/// 0 when the queue is full or the pool is stopping.
int hn_jobs_push(hn_jobs *jobs, void *job);
/// Takes on nothing new, works off what is queued, and joins the threads.
void hn_jobs_stop(hn_jobs *jobs);
void hn_jobs_free(hn_jobs *jobs); ///< stops first; NULL is legal
#endif
