// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_STREAM_H
#define HN_HTTP_RUN_STREAM_H
// A run as a stream of events (server-sent events): `progress` while it is computed, then, method
// by method and in the order of time, a `sample` for each row and an `incident` for each report,
// and `end` with the summary.
//
// Samples and incidents are numbered from 1, `end` is the last. The same run always has the same
// events, so a reader that was cut off goes on behind its Last-Event-ID without a gap or a repeat,
// after a restart of the server too. mode=live leaves samples out so that some 200 of each method
// remain; their numbers jump, and no incident is left out.

struct hn_request;

/// GET .../events. The stream holds a place of the server's until it is closed.
void hn_handle_run_events(struct hn_request *r);
#endif
