// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CONTEXT_H
#define HN_HTTP_CONTEXT_H
// The parts of the server that handlers use. The server owns them; each part locks itself.

#include "http/ground/hosts.h"
#include "http/ground/http_opts.h"
#include "http/request/route.h"
#include "session/model/library.h"

#include <pthread.h>
#include <stdatomic.h>

/// A document that is costly to make and never changes: made on the first question.
typedef struct hn_kept_text {
    pthread_mutex_t lock;
    char *text;
} hn_kept_text;

typedef struct hn_context {
    const hn_library *lib;
    hn_http_opts opts;
    hn_hosts hosts;
    hn_route_table routes;
    struct hn_static_files *files;
    struct hn_comparisons *comparisons;
    struct hn_studies *studies;
    struct hn_runs *runs;
    struct hn_run_list *run_list;
    hn_kept_text scenes;                ///< the list of shipped scenes, as JSON
    hn_kept_text openapi;               ///< the description of the API
    struct hn_shares *streams;          ///< places of open streams
    struct hn_jobs *quick;              ///< threads of requests that take no time
    struct hn_jobs *heavy;              ///< threads of long requests
    atomic_int open_requests;           ///< begun and not completed
    _Atomic long long unread;           ///< bytes of answers that are made and not yet read
    struct hn_connections *connections; ///< with those that read too slowly
    atomic_int stopping;                ///< 1: the server ends; nothing new is started
} hn_context;
#endif
