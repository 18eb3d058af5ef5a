// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/server.h"

#include "http/ground/listen.h"
#include "http/ground/own_addresses.h"
#include "http/ground/shares.h"
#include "http/live/comparisons.h"
#include "http/routes/dispatch.h"
#include "http/routes/routes.h"
#include "http/routes/static_files.h"
#include "http/runs/run_list.h"
#include "http/runs/run_store.h"
#include "http/runs/runs.h"
#include "http/studies/studies.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/// Connections of one event loop; with its own descriptors fewer than the 128 events of one look.
enum { LOOP_CONNECTIONS = 120 };
/// Files of an event loop itself, and of all that is not a connection: files, libraries, guests.
enum { LOOP_DESCRIPTORS = 4, OTHER_DESCRIPTORS = 128 };
/// Texts of this size have pages of their own, which go back to the system with them; the C library
/// otherwise raises the bound as such texts are freed, and keeps later ones [byte].
enum { LARGE_TEXT = 1 << 20 };
enum { DRAIN_LOOKS = 30, DRAIN_NS = 10000000 }; // 0.3 s in all

struct hn_server {
    hn_context context;
    hn_dispatch dispatch;
    const char *host_names[HN_MAX_HOSTS + 1];
    struct MHD_Daemon *daemon;
    int port;
    char addresses[HN_OWN_ADDRESSES][300];
    int n_addresses;
};

static void set_hosts(hn_server *s) {
    const char *host = s->context.opts.host;
    int n = 0;
    for (int i = 0; i < s->context.opts.n_allow_hosts && n < HN_MAX_HOSTS; i++) {
        s->host_names[n++] = s->context.opts.allow_hosts[i];
    }
    s->host_names[n++] = host;
    s->context.hosts =
        (hn_hosts){.n = n,
                   .names = s->host_names,
                   .any_address = strcmp(host, "0.0.0.0") == 0 || strcmp(host, "::") == 0};
}

/// Connections that may be open: those with a place, and those whose place was given to another and
/// that their loop has not closed yet.
static int count_connections(const hn_http_opts *opts) {
    return opts->max_connections + opts->max_connections / 4 + 16;
}

/// Event loops; two at least, for which alone the library starts a pool.
static int count_loops(const hn_http_opts *opts) {
    const int loops = count_connections(opts) / LOOP_CONNECTIONS + 1;
    return loops > 1 ? loops : 2;
}

int hn_server_descriptors(const hn_http_opts *opts) {
    return count_connections(opts) + count_loops(opts) * LOOP_DESCRIPTORS + OTHER_DESCRIPTORS;
}

/// Several event loops of the HTTP library, each with its share of the connections. The library
/// asks for 128 events at a time and, when it gets as many, asks again before it serves them: a
/// loop with fewer sockets than that never waits there.
static hn_status start_daemon(hn_server *s, int fd, hn_diag *diag) {
    const int loops = count_loops(&s->context.opts);
    s->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME, 0,
        hn_dispatch_accept, &s->dispatch, hn_dispatch_request, &s->dispatch,
        MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_URI_LOG_CALLBACK, hn_dispatch_address,
        &s->dispatch, MHD_OPTION_NOTIFY_COMPLETED, hn_dispatch_completed, &s->dispatch,
        MHD_OPTION_NOTIFY_CONNECTION, hn_dispatch_connection, &s->dispatch,
        MHD_OPTION_THREAD_POOL_SIZE, (unsigned)loops, MHD_OPTION_CONNECTION_LIMIT,
        (unsigned)count_connections(&s->context.opts), MHD_OPTION_CONNECTION_MEMORY_LIMIT,
        (size_t)HN_HEAD_BYTES, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)s->context.opts.connection_timeout, MHD_OPTION_END);
    if (!s->daemon) {
        close(fd);
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "the HTTP library could not be started");
    }
    return HN_OK;
}

/// The parts that handlers and event loops work with.
/// Returns the bytes of the stack of a thread.
static long long stack_size(void) {
    pthread_attr_t attributes;
    size_t size = 0;
    if (pthread_attr_init(&attributes) == 0) {
        pthread_attr_getstacksize(&attributes, &size);
        pthread_attr_destroy(&attributes);
    }
    return (long long)size;
}

static hn_status create_parts(hn_server *s, hn_diag *diag) {
    hn_context *c = &s->context;
    const hn_http_opts *o = &c->opts;
    const hn_jobs_opts heavy = hn_http_opts_pool(o);
    const hn_jobs_opts quick = {.at_once = o->quick_pool,
                                .n_waiting = o->quick_queue,
                                .n_waiting_of_one = hn_http_opts_share(o, o->quick_queue),
                                .n_aside = o->aside,
                                .n_aside_of_one = o->aside_of_one};
    HN_TRY(hn_static_files_create(hn_library_web(c->lib), &c->files, diag));
    s->dispatch.context = c;
    s->dispatch.heavy = hn_jobs_create(&heavy, hn_dispatch_job);
    s->dispatch.quick = hn_jobs_create(&quick, hn_dispatch_job);
    c->quick = s->dispatch.quick;
    c->heavy = s->dispatch.heavy;
    s->dispatch.connections = hn_connections_create(o);
    c->connections = s->dispatch.connections;
    c->streams = hn_shares_create(o->max_streams, hn_http_opts_share(o, o->max_streams));
    c->comparisons = hn_comparisons_create(o, c->lib);
    c->studies = hn_studies_create(o, c->lib);
    c->runs = hn_runs_create(o, c->lib, hn_run_reply);
    c->run_list = hn_run_list_create(o->runs_folder);
    if (!s->dispatch.heavy || !s->dispatch.quick || !s->dispatch.connections || !c->streams ||
        !c->comparisons || !c->studies || !c->runs || !c->run_list) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL,
                           "'ulimit -v' and 'ulimit -u' say what this shell allows",
                           "the system refuses memory or a thread to the server, which starts some "
                           "seventy threads, each with a stack of %lld kB",
                           stack_size() / 1024);
    }
    return HN_OK;
}

/// Writes how links name the server: by the address that it listens on, or by those of the machine
/// where that is every one; a machine without a network has its loopback.
static void write_addresses(hn_server *s, const char *host) {
    char own[HN_OWN_ADDRESSES][HN_ADDRESS_TEXT];
    const bool is_six = host[0] == '[';
    const int n = s->context.hosts.any_address ? hn_own_addresses(is_six, own) : 0;
    const char *only = !s->context.hosts.any_address ? host : is_six ? "[::1]" : "127.0.0.1";
    s->n_addresses = n > 0 ? n : 1;
    for (int i = 0; i < s->n_addresses; i++) {
        const char *name = n > 0 ? own[i] : only;
        snprintf(s->addresses[i], sizeof s->addresses[i], "http://%.255s:%d", name, s->port);
    }
}

static hn_status start(hn_server *s, hn_diag *diag) {
    const hn_http_opts *o = &s->context.opts;
    int fd = -1;
    char host[256];
    HN_TRY(hn_microhttpd_load(diag));
    HN_TRY(create_parts(s, diag));
    HN_TRY(hn_listen(o->host, o->port, o->next_ports, &fd, &s->port, host, diag));
    write_addresses(s, host);
    return start_daemon(s, fd, diag);
}

hn_status hn_server_start(const hn_library *lib, const hn_http_opts *opts, hn_server **out,
                          hn_diag *diag) {
    hn_server *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    mallopt(M_MMAP_THRESHOLD, LARGE_TEXT);
    s->context.lib = lib;
    s->context.routes = hn_routes();
    s->context.opts = *opts;
    pthread_mutex_init(&s->context.scenes.lock, NULL);
    pthread_mutex_init(&s->context.openapi.lock, NULL);
    set_hosts(s);

    const hn_status status = start(s, diag);
    if (status != HN_OK) {
        hn_server_stop(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

const char *hn_server_address(const hn_server *server, int i) {
    return i < server->n_addresses ? server->addresses[i] : NULL;
}

int hn_server_port(const hn_server *server) {
    return server->port;
}

void hn_server_stop(hn_server *s) {
    // New connections are still taken, and told that the server ends. MHD_quiesce_daemon would
    // refuse them, but the library (0.9.75) aborts the program there when one of its event loops
    // wakes at that moment: both take the listening socket out of the loop's set.
    hn_context *c = &s->context;
    atomic_store(&c->stopping, 1);

    // all are told before anybody is waited for, so that they end at the same time
    if (c->runs) {
        hn_runs_tell_end(c->runs);
    }
    if (c->studies) {
        hn_studies_tell_end(c->studies);
    }

    // nobody may be left suspended when the daemon goes: workers and pools answer what they hold
    hn_comparisons_stop(c->comparisons);
    hn_studies_stop(c->studies);
    hn_jobs_stop(s->dispatch.quick);
    hn_jobs_stop(s->dispatch.heavy);
    hn_runs_stop(c->runs);

    // answers that are there go out, to whoever reads them
    for (int i = 0; i < DRAIN_LOOKS && atomic_load(&c->open_requests) > 0; i++) {
        nanosleep(&(struct timespec){.tv_nsec = DRAIN_NS}, NULL);
    }
    if (s->daemon) {
        MHD_stop_daemon(s->daemon); // closes the listening socket too
    }

    // streams gave back their places when the daemon ended
    hn_jobs_free(s->dispatch.quick);
    hn_jobs_free(s->dispatch.heavy);
    hn_connections_free(s->dispatch.connections);
    hn_comparisons_free(c->comparisons);
    hn_studies_free(c->studies);
    hn_runs_free(c->runs);
    hn_run_list_free(c->run_list);
    hn_shares_free(c->streams);
    hn_static_files_free(c->files);
    pthread_mutex_destroy(&c->scenes.lock);
    free(c->scenes.text);
    pthread_mutex_destroy(&c->openapi.lock);
    free(c->openapi.text);
    free(s);
}
