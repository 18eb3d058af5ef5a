// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_LIST_H
#define HN_HTTP_RUN_LIST_H
// The list of all runs, in memory and in the folder. A file is listed when it is whole; one that
// was found whole is not read again until it changes.

#include "base/interrupt.h"
#include "http/runs/run_store.h"

typedef struct hn_run_list hn_run_list;

/// `folder` may be NULL and must outlive the list. NULL when memory is out.
hn_run_list *hn_run_list_create(const char *folder);
void hn_run_list_free(hn_run_list *list); ///< NULL is legal

/// Writes the members "runs" (ids, each once, sorted), "spoilt" (the number of files with the name
/// of a run that are not whole) and "unchecked" (the number of files that were not read because
/// `interrupt` ended the work). Reads the folder: not for a connection's thread.
void hn_run_list_put(hn_strbuf *b, hn_run_list *list, hn_runs *runs, hn_interrupt interrupt);
#endif
