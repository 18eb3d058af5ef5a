// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_STORE_H
#define HN_HTTP_RUN_STORE_H
// Runs as resources: found by the id of their question, computed once, by a pool of threads. Kept
// in memory as long as there is room, and in a folder where the server was given one.

#include "http/ground/http_opts.h"
#include "http/runs/kept_run.h"

#include <stdbool.h>

struct hn_request;

typedef struct hn_runs hn_runs;

/// A stream that reads a run; the first member of it.
typedef struct hn_run_reader {
    struct MHD_Connection *connection;
    hn_kept_run *run;
    int fd;       ///< of the connection
    bool waiting; ///< the connection is suspended; under the lock, as are the next two
    double due;   ///< it is then woken [s, wall clock]
    struct hn_run_reader *next;
} hn_run_reader;

/// Fills in the reply to a request that has waited for this run. On any thread, with no lock held.
typedef void (*hn_run_answer)(struct hn_request *r, const hn_kept_run *run);

/// NULL when memory or threads are out. `opts` and `lib` must outlive it.
hn_runs *hn_runs_create(const hn_http_opts *opts, const hn_library *lib, hn_run_answer answer);
/// Tells what computes to end, and waits for nothing.
void hn_runs_tell_end(hn_runs *all);
bool hn_runs_is_ending(hn_runs *all); ///< it was told to
/// Stops what computes, answers who waits, and joins the threads. NULL is legal.
void hn_runs_stop(hn_runs *all);
void hn_runs_free(hn_runs *all);

/// Finds a run by its id, in memory or in the folder. Returns a reference, or NULL. From here on
/// its id is known: it is computed to its end.
hn_kept_run *hn_runs_find(hn_runs *all, const char *id);
/// Finds the run of a question or begins it; takes what the question holds. Returns a reference in
/// *out; `begun` says whether it is new. Fails: HN_ERR_LIMIT (the queue is full), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_runs_begin(hn_runs *all, hn_run_question *question, hn_client client,
                                      hn_kept_run **out, int *begun);
/// Gives up a reference. A run whose askers have all gone before one was told its id ends.
void hn_runs_release(hn_runs *all, hn_kept_run *run);
/// Stops it if it computes, and forgets it, in the folder too. An id that no run has is legal.
void hn_runs_delete(hn_runs *all, const char *id);
/// Returns the phase.
hn_run_phase hn_runs_phase(hn_runs *all, const hn_kept_run *run);
/// Answers a suspended request when the run has ended, `seconds` are over, or its client has gone;
/// at once if the run has ended.
void hn_runs_await(hn_runs *all, hn_kept_run *run, struct hn_request *r, double seconds);
/// The store wakes a reader that it lists when its run ends, when it is due, and when the server
/// ends.
void hn_runs_add_reader(hn_runs *all, hn_run_reader *reader);
void hn_runs_remove_reader(hn_runs *all, hn_run_reader *reader);
/// Suspends a reader's connection for at most so many seconds. Returns false where the run, or the
/// server, has ended.
bool hn_runs_suspend_reader(hn_runs *all, hn_run_reader *reader, double seconds);
/// Returns the seconds after which a client's question that was refused may be asked again.
int hn_runs_wait(hn_runs *all, hn_client client, const char *id);
/// Calls `see` with the id of each run in memory, which somebody then knows: it goes on unwatched.
/// With the lock of the store held.
void hn_runs_list(hn_runs *all, void (*see)(void *user, const char *id), void *user);
#endif
