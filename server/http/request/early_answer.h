// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_EARLY_ANSWER_H
#define HN_HTTP_EARLY_ANSWER_H
// An answer that leaves before its request is complete. The HTTP library takes one only between
// the head and the body, and then closes the connection while the client still sends: the system
// drops the answer with what was not read (RFC 9112, section 9.6). Here the answer is written to
// the socket itself, and the rest is read for a while.

#include "http/request/request.h"

/// Sends the reply, a text, with Connection: close; the stage is SENT afterwards, and the
/// connection has to be closed at the end. On the connection's thread, when nothing was sent for
/// this request.
void hn_answer_early(hn_request *r);
/// Reads and drops what has come already, and ends the connection in both directions.
void hn_request_drain(const hn_request *r);
/// Writes a whole answer to a socket that sends nothing afterwards, and ends the connection in both
/// directions.
void hn_answer_last(int fd, const char *bytes, size_t n);
#endif
