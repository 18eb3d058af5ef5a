// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_GZIP_H
#define HN_HTTP_GZIP_H
// Compressed answers, for clients that take them (RFC 1952, RFC 9110 section 8.4).

#include "http/request/request.h"

#include <stdbool.h>

/// Returns 1 when the client takes gzip.
int hn_gzip_accepted(const hn_request *r);
/// Returns whether a text of this media type gets smaller by it.
bool hn_gzip_is_worth(const char *media_type, size_t n);
/// Appends the compressed bytes. Returns 0 when memory is out.
int hn_gzip(hn_strbuf *out, const char *bytes, size_t n);
/// Compresses the text of a reply where that is worth it; `most`: texts longer than that stay as
/// they are (the time it takes is the thread's that calls).
void hn_reply_compress(hn_request *r, size_t most);
#endif
