// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUNS_H
#define HN_HTTP_RUNS_H
// Handlers of /api/v1/runs. The same question has the same address, and is computed once.

#include "http/runs/run_store.h"

/// A function for each row of routes.c, which says method and path; the reply is in `r`.
void hn_handle_runs_create(struct hn_request *r); ///< asynchronous
void hn_handle_runs_list(struct hn_request *r);
void hn_handle_run_get(struct hn_request *r); ///< asynchronous
void hn_handle_run_samples(struct hn_request *r);
void hn_handle_run_delete(struct hn_request *r);

/// Fills in the reply to a request that has waited for this run: its end, or how far it is.
void hn_run_reply(struct hn_request *r, const hn_kept_run *run);

/// Returns a reference to the run that the path names; NULL with a problem as reply.
hn_kept_run *hn_run_find(struct hn_request *r);
const char *hn_run_phase_name(hn_run_phase phase);
/// {"id","state","progress","links", and the documents: the members of the one, or "runs"}.
void hn_run_put_json(hn_strbuf *b, const hn_kept_run *run, hn_run_phase phase, bool with_samples);
#endif
