// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_COMPARISONS_H
#define HN_HTTP_COMPARISONS_H
// All comparisons of the server: found by id, bounded in number, deleted after a time without a
// request (the option --expiry).

#include "http/ground/http_opts.h"
#include "session/model/library.h"

typedef struct hn_comparisons hn_comparisons;
struct hn_request;

/// `opts` and `lib` must outlive it. NULL when memory or threads are out.
hn_comparisons *hn_comparisons_create(const hn_http_opts *opts, const hn_library *lib);
/// Ends every comparison and waits for their threads. A stream that is still open keeps the data
/// that it reads. NULL is legal.
void hn_comparisons_stop(hn_comparisons *all);
void hn_comparisons_free(hn_comparisons *all);

// handlers
void hn_handle_comparisons_list(struct hn_request *r);
void hn_handle_comparisons_create(struct hn_request *r);
void hn_handle_comparison_get(struct hn_request *r);
void hn_handle_comparison_pulls(struct hn_request *r);
void hn_handle_comparison_patch(struct hn_request *r);
void hn_handle_comparison_delete(struct hn_request *r);
void hn_handle_comparison_events(struct hn_request *r);
#endif
