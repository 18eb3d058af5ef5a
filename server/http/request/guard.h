// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_GUARD_H
#define HN_HTTP_GUARD_H
// Checks a request before its handler gets it: its host, the site of the page that sends it, its
// query and its media types.

#include "http/ground/hosts.h"
#include "http/request/request.h"

#include <stdbool.h>

/// Returns how welcome `media_type` is to an Accept header, in thousandths: 0 where it is refused,
/// the same for all types where there is no header (NULL). The closest range decides.
int hn_accept_weight(const char *accept, const char *media_type);
/// 1 when an Accept header (NULL: none) lets `media_type` through.
int hn_accepts(const char *accept, const char *media_type);
/// 1 for application/json in UTF-8, with or without parameters.
bool hn_is_json_type(const char *content_type);

/// Checks the form of the head, and takes blanks off the ends of its values; before any other look
/// at a header. Returns false with a problem as reply.
bool hn_guard_headers(hn_request *r);

/// Returns whether two authorities, of n_a and n_b bytes, are one host and port: a port that a
/// scheme implies (80, 443) may be left out.
bool hn_guard_is_same_host(const char *a, size_t n_a, const char *b, size_t n_b);
/// Each returns 1 when all is well; otherwise the reply is a problem.
int hn_guard_host(hn_request *r, const hn_hosts *hosts);
int hn_guard_site(hn_request *r);  ///< pages of other sites get no computing
int hn_guard_query(hn_request *r); ///< parameters that the route does not take are refused
int hn_guard_accept(hn_request *r);
int hn_guard_body_type(hn_request *r);
#endif
