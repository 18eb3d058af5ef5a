// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STREAM_H
#define HN_HTTP_STREAM_H
// A reader of a comparison's events (server-sent events). Its connection is suspended while there
// is nothing to say.

#include "http/live/session.h"

typedef struct hn_stream hn_stream;

/// Answers GET .../events. The stream holds its own reference of the session, and a place of the
/// server's until it is closed.
void hn_stream_open(hn_session *session, struct hn_request *r);

// for the comparison, with its lock held
hn_stream *hn_stream_next(const hn_stream *s);
void hn_stream_wake(hn_stream *s);
void hn_stream_tick(hn_stream *s,
                    double now); ///< wakes it when its reader should hear a comment line
#endif
