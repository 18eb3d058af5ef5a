// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/http_opts.h"

hn_http_opts hn_http_opts_default(void) {
    return (hn_http_opts){.host = "127.0.0.1",
                          .port = 8080,
                          .next_ports = 20,

                          // places of connections, sessions and studies
                          .max_connections = 1024,
                          .max_comparisons = 96,
                          .max_studies = 2,
                          .max_streams = 512,
                          .client_share = 0.5,

                          // workers and their queues
                          .pool = 3,
                          .queue = 32,
                          .aside = 16,
                          .aside_of_one = 4,
                          .quick_pool = 2,
                          .quick_queue = 256,

                          // sizes of what is kept and sent
                          .max_events = 20000,
                          .max_body = 1 << 20,
                          .max_event_bytes = 32 << 20,
                          .max_unread = 256 << 20,
                          .max_samples = 100000,
                          .max_numbers = 4000000,

                          // computing time
                          .max_duration = 3600,
                          .max_run_cpu = 20,
                          .frame_cpu = 2,

                          // waiting [s]
                          .idle_pause = 60,
                          .expiry = 900,
                          .orphan_expiry = 60,
                          .keep_alive = 10,
                          .connection_timeout = 30,
                          .unread_patience = 20,
                          .unread_pause = 1,
                          .head_deadline = 10,
                          .request_deadline = 60};
}

hn_jobs_opts hn_http_opts_pool(const hn_http_opts *opts) {
    return (hn_jobs_opts){.at_once = opts->pool,
                          .n_waiting = opts->queue,
                          .n_waiting_of_one = hn_http_opts_share(opts, opts->queue),
                          .n_aside = opts->aside,
                          .n_aside_of_one = opts->aside_of_one,
                          .longest = opts->max_run_cpu};
}

int hn_http_opts_share(const hn_http_opts *opts, int places) {
    const int share = (int)(opts->client_share * places);
    return share < 1 ? 1 : share;
}
