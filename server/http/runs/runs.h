// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUNS_H
#define HN_HTTP_RUNS_H
// Handlers of /api/v1/runs. The same question has the same address, and is computed once.

struct hn_request;
struct hn_kept_run;

/// A function for each row of routes.c, which says method and path; the reply is in `r`.
void hn_handle_runs_create(struct hn_request *r); ///< asynchronous
void hn_handle_runs_list(struct hn_request *r);
void hn_handle_run_get(struct hn_request *r); ///< asynchronous
void hn_handle_run_samples(struct hn_request *r);
void hn_handle_run_delete(struct hn_request *r);

/// Fills in the reply to a request that has waited for this run: its end, or how far it is.
void hn_run_reply(struct hn_request *r, const struct hn_kept_run *run);
#endif
