// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_JOBS_H
#define HN_HTTP_JOBS_H
// A pool of threads with a bounded queue: long requests are done here, so that short ones and
// streams never wait. Among those that wait, the client with the fewest jobs at work comes first.

#include "base/status.h"
#include "http/ground/shares.h"

typedef struct hn_jobs hn_jobs;

/// `run` does one job, on a thread of the pool. At most `n_waiting` jobs wait, `per_client` of them
/// of one client. NULL when memory or threads are out.
hn_jobs *hn_jobs_create(int n_threads, int n_waiting, int per_client, void (*run)(void *job));
/// Returns 0 when the queue is full, in all or for this client, or the pool is stopping.
int hn_jobs_push(hn_jobs *jobs, void *job, hn_client client);
/// Returns the seconds after which a job that is pushed now will probably be taken up: 1 to 60.
int hn_jobs_wait(hn_jobs *jobs);
/// Takes on nothing new, works off what is queued, and joins the threads. NULL is legal.
void hn_jobs_stop(hn_jobs *jobs);
void hn_jobs_free(hn_jobs *jobs); ///< stops first; NULL is legal
#endif
