// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_HOSTS_H
#define HN_HTTP_HOSTS_H
// The host names that the server answers to.

#include <stdbool.h>

/// Host names this server answers to besides the loopback ones.
typedef struct hn_hosts {
    int n;
    const char *const *names; ///< without port
    bool any_address;         ///< bound to every interface, so any literal address is ours
} hn_hosts;

/// Returns whether `host` (a Host header: name[:port]) is one that is served.
bool hn_host_is_ours(const hn_hosts *hosts, const char *host);
#endif
