// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/http_opts.h"

hn_http_opts hn_http_opts_default(void) {
    return (hn_http_opts){.host = "127.0.0.1",
                          .port = 8080,
                          .next_ports = 20,
                          .max_connections = 256,
                          .max_comparisons = 32,
                          .max_studies = 2,
                          .max_streams = 64,
                          .max_events = 20000,
                          .max_body = 1 << 20,
                          .max_event_bytes = 32 << 20,
                          .max_duration = 3600,
                          .max_samples = 100000,
                          .max_run_cpu = 20,
                          .frame_cpu = 2,
                          .pool = 3,
                          .queue = 32,
                          .idle_pause = 60,
                          .expiry = 900,
                          .keep_alive = 10,
                          .connection_timeout = 30};
}
