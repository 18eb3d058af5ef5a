#ifndef HN_HTTP_GUARD_H
#define HN_HTTP_GUARD_H
// What is checked before a handler sees a request: who asks, for whom, and in which media types.

#include "http/request.h"

/// Host names this server answers to besides the loopback ones.
typedef struct hn_hosts {
    int n;
    const char *const *names; ///< without port
    int any_address;          ///< 1: bound to every interface, so any literal address is ours
} hn_hosts;

/// 1 when `host` (a Host header: name[:port]) is one that is served.
int hn_host_is_ours(const hn_hosts *hosts, const char *host);
/// 1 when an Accept header (NULL: none) lets `media_type` through.
int hn_accepts(const char *accept, const char *media_type);
/// 1 for application/json, with or without parameters.
int hn_is_json_type(const char *content_type);

/// Each returns 1 when all is well; otherwise the reply is a problem.
int hn_guard_host(hn_request *r, const hn_hosts *hosts);
int hn_guard_accept(hn_request *r);
int hn_guard_body_type(hn_request *r);
#endif
