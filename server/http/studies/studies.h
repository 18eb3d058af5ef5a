// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDIES_H
#define HN_HTTP_STUDIES_H
// Studies as resources: what takes seconds is done on a thread of its own, asked for progress while
// it lasts and for its document afterwards. Bounded in number and in computing time; finished ones
// go when nobody touched them for long, or to make room.

#include "http/ground/http_opts.h"
#include "session/model/library.h"

enum { HN_STUDIES_KEPT = 16 }; ///< running and finished ones

typedef struct hn_studies hn_studies;
struct hn_request;

/// `opts` and `lib` must outlive it. NULL when memory is out.
hn_studies *hn_studies_create(const hn_http_opts *opts, const hn_library *lib);
/// Asks every study to stop, and waits for nothing.
void hn_studies_tell_end(hn_studies *all);
/// Asks every study to stop and waits for their threads. Reports on standard error how many were
/// told to stop as they ran, and whether what they did is kept. NULL is legal.
void hn_studies_stop(hn_studies *all);
void hn_studies_free(hn_studies *all); ///< stops first; NULL is legal

// handlers
void hn_handle_studies_list(struct hn_request *r);
void hn_handle_studies_create(struct hn_request *r);
void hn_handle_study_get(struct hn_request *r);
void hn_handle_study_report(struct hn_request *r);
void hn_handle_study_patch(struct hn_request *r);
void hn_handle_study_delete(struct hn_request *r);
#endif
