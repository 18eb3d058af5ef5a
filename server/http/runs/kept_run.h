// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_KEPT_RUN_H
#define HN_HTTP_KEPT_RUN_H
// One run: its question, its documents once they are computed, and who waits for them.

#include "base/strbuf.h"
#include "http/ground/shares.h"
#include "http/runs/run_document.h"
#include "http/runs/run_question.h"

#include <stdatomic.h>
#include <stdbool.h>

struct hn_request;

typedef enum hn_run_phase {
    HN_RUN_WAITS,
    HN_RUN_COMPUTES,
    HN_RUN_DONE,
    HN_RUN_REFUSED
} hn_run_phase;

/// One run. Members after `phase` belong to the thread that computes until the phase is DONE or
/// REFUSED, and never changes afterwards.
typedef struct hn_kept_run {
    char id[HN_RUN_ID];
    int refs; ///< under the lock of the store, as are the next four
    hn_run_phase phase;
    double touched;             ///< [s, wall clock]
    struct hn_request *waiting; ///< requests that wait for the end
    bool is_known;              ///< somebody was told its id, or asked by it: it goes on unwatched
    _Atomic double share;       ///< done of the whole
    atomic_int stop;
    hn_client client;
    hn_run_question question;
    char *request; ///< the question as the body of a request
    int n;         ///< documents: one for each method
    hn_run_document documents[HN_COMPARISON_MAX_METHODS];
    size_t bytes;
    bool is_cut;       ///< the computing time was used up; asked again it is computed again
    hn_status refused; ///< why there is none
    hn_diags diags;
    struct hn_kept_run *next;
} hn_kept_run;

/// A run that waits, without a question, with one reference; NULL when memory is out.
hn_kept_run *hn_kept_run_create(const char *id, hn_client client);
/// NULL is legal.
void hn_kept_run_free(hn_kept_run *run);
/// Takes the text of a document. Returns false when memory is out or it is no document of a run.
HN_MUST_CHECK bool hn_kept_run_add_document(hn_kept_run *run, hn_strbuf *text);
#endif
