// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_HTTP_OPTS_H
#define HN_HTTP_HTTP_OPTS_H
// Options and limits of the HTTP server. The index of the API lists the limits.

enum { HN_MAX_HOSTS = 16 };

/// Every bound of the server. The index lists them.
typedef struct hn_http_opts {
    const char *host; ///< address or name to listen on; NULL: 127.0.0.1
    int port;         ///< 0: any free one
    int next_ports;   ///< how many following ports are tried when the port is taken
    const char *const *allow_hosts;
    int n_allow_hosts;
    int max_connections, max_comparisons, max_streams, max_events;
    int max_studies;                     ///< at once
    long long max_body, max_event_bytes; ///< bytes; event bytes per comparison
    double max_duration;                 ///< of a comparison, simulated [s]
    long long max_samples;               ///< of one run
    double max_run_cpu;                  ///< of one stateless run, and of one study [s]
    double frame_cpu;                    ///< of one method in one frame [s]
    int pool, queue;                     ///< threads for long requests; how many may wait
    double idle_pause, expiry,
        keep_alive;         ///< without a reader; untouched; between comment lines [s]
    int connection_timeout; ///< without any progress [s]
} hn_http_opts;
hn_http_opts hn_http_opts_default(void);
#endif
