// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CLOSING_HEAD_H
#define HN_HTTP_CLOSING_HEAD_H
// The head of an answer that is written to the socket past the HTTP library, and ends its
// connection.

#include "base/strbuf.h"

#include <stdbool.h>

/// Writes the status line and the headers that every such answer has. The caller adds its own
/// headers, each with CR LF, then an empty line and n_body bytes.
void hn_closing_head_put(hn_strbuf *b, unsigned status, const char *media_type, size_t n_body);
/// Returns whether that head has a header of this name already.
bool hn_closing_head_has(const char *name);
#endif
