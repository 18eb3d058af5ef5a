// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_HOSTS_H
#define HN_HTTP_HOSTS_H
// The host names that the server answers to.

/// Host names this server answers to besides the loopback ones.
typedef struct hn_hosts {
    int n;
    const char *const *names; ///< without port
    int any_address;          ///< 1: bound to every interface, so any literal address is ours
} hn_hosts;

/// 1 when `host` (a Host header: name[:port]) is one that is served.
int hn_host_is_ours(const hn_hosts *hosts, const char *host);
#endif
