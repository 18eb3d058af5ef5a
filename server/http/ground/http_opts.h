// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_HTTP_OPTS_H
#define HN_HTTP_HTTP_OPTS_H
// Options and limits of the HTTP server. The index of the API lists the limits.
//
// Places (connections, streams, comparisons, long requests) are limited in all, and for each client
// to its share of them. A client is an address, or the one that a proxy names
// (http/request/client.h says who asks). For this machine itself only the limits in all hold; its
// programs share the queues out among them.

#include "http/ground/jobs.h"
#include "http/ground/proxies.h"

#include <stdbool.h>

enum { HN_MAX_HOSTS = 16 };

typedef struct hn_http_opts {
    const char *host; ///< address or name to listen on; NULL: 127.0.0.1
    int port;         ///< 0: any free one
    int next_ports;   ///< how many following ports are tried when the port is taken
    const char *const *allow_hosts;
    int n_allow_hosts;
    hn_proxies proxies; ///< whose X-Forwarded-For counts, besides those of this machine

    const char *token;       ///< that every client must show; NULL: none
    bool guests;             ///< who has no token may read
    const char *runs_folder; ///< where finished runs are kept; NULL: in memory alone

    // places
    int max_connections, max_comparisons, max_streams, max_events;
    int max_studies;     ///< at once
    double client_share; ///< of the places, for one client [-]
    int pool, queue;     ///< threads for long requests; how many may wait
    int aside;           ///< requests of a pool that are set aside while others have their turn
    int aside_of_one;    ///< those of one client that make way for its own
    int quick_pool;      ///< threads for requests that read a shipped scene or open a comparison
    int quick_queue;     ///< how many of them may wait: a class that opens the page at once

    // sizes
    long long max_body, max_event_bytes; ///< [byte]; event bytes per comparison
    long long max_unread;                ///< of all answers that wait for their readers [byte]
    long long max_samples;               ///< of one run
    long long max_numbers;               ///< in the tables of one answer

    // times
    double max_duration;     ///< of a comparison, simulated [s]
    double max_run_cpu;      ///< of one stateless run, and of one study [s]
    double frame_cpu;        ///< of one method in one frame [s]
    double idle_pause;       ///< a comparison without a reader pauses after this [s]
    double expiry;           ///< a comparison that nobody touched is deleted [s]
    double orphan_expiry;    ///< one whose readers have all left [s]
    double keep_alive;       ///< between comment lines of a quiet stream [s]
    int connection_timeout;  ///< without any progress [s]
    double unread_patience;  ///< with an answer's reader when too many bytes are unread [s]
    double unread_pause;     ///< between two readers that are closed for that [s]
    double head_deadline;    ///< for a head, in all; a later one counts from its first line [s]
    double request_deadline; ///< for a body, in all, and between two requests [s]
} hn_http_opts;
hn_http_opts hn_http_opts_default(void);

/// Returns the options of a pool of threads for long requests.
hn_jobs_opts hn_http_opts_pool(const hn_http_opts *opts);
/// Returns the part of `places` that one client may take, at least 1.
int hn_http_opts_share(const hn_http_opts *opts, int places);
#endif
