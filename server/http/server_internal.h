#ifndef HN_HTTP_SERVER_INTERNAL_H
#define HN_HTTP_SERVER_INTERNAL_H
// What handlers know of the server.

#include "http/comparisons.h"
#include "http/guard.h"
#include "http/jobs.h"
#include "http/server.h"
#include "http/static_files.h"
#include "http/studies.h"

#include <pthread.h>
#include <stdatomic.h>

/// A document that is costly to make and never changes: made on the first question.
typedef struct hn_kept_text {
    pthread_mutex_t lock;
    char *text;
} hn_kept_text;

struct hn_server {
    const hn_library *lib;
    hn_http_opts opts;
    hn_hosts hosts;
    const char *host_names[HN_MAX_HOSTS + 1];
    struct MHD_Daemon *daemon;
    hn_jobs *jobs;
    hn_static_files *files;
    hn_comparisons *comparisons;
    hn_studies *studies;
    hn_kept_text scenes;
    atomic_int stopping;
    int port;
    char address[300];
};

/// Called by whoever did the work of a suspended request: the connection's thread sends the reply.
void hn_request_finish(hn_request *r);
/// Suspends the connection; from here on somebody else owns the request until hn_request_finish().
void hn_request_suspend(hn_request *r);
#endif
