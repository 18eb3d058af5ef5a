// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STREAM_H
#define HN_HTTP_STREAM_H
// A reader of a comparison's events (server-sent events). Its connection is suspended while there
// is nothing to say.

#include "http/live/session_state.h"

typedef struct hn_stream hn_stream;

/// Answers GET .../events. The stream holds its own reference of the session, and a place of the
/// server's until it is closed.
void hn_stream_open(hn_session *session, struct hn_request *r);

/// Wakes the stream and makes room for its last events: the session ends. With the session's lock
/// held.
void hn_stream_end(hn_reader *reader);
/// Wakes the stream where a keep-alive line is due or its reader has left. With the session's lock
/// held.
void hn_stream_tick(hn_reader *reader, double now);
#endif
