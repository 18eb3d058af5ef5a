// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/server.h"

#include "base/json_text.h"
#include "http/ground/jobs.h"
#include "http/ground/listen.h"
#include "http/live/comparisons.h"
#include "http/request/context.h"
#include "http/request/guard.h"
#include "http/request/request.h"
#include "http/routes/routes.h"
#include "http/routes/static_files.h"
#include "http/studies/studies.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/// Beyond this much of an unwanted body the connection is closed rather than drained.
enum { MAX_DRAINED = 8 << 20, MAX_JSON_DEPTH = 64 };

struct hn_server {
    hn_context context;
    const char *host_names[HN_MAX_HOSTS + 1];
    struct MHD_Daemon *daemon;
    hn_jobs *jobs;
    int port;
    char address[300];
};

// ---- one request ----

/// Where an address lies off the API: a redirect to its front door, a file of the page, or nothing.
static void reply_off_routes(hn_request *r, const char *method, const hn_route_match *match) {
    static const char *const front_doors[] = {"/api", "/api/", "/api/v1"};
    for (size_t i = 0; i < sizeof front_doors / sizeof *front_doors; i++) {
        if (strcmp(r->path, front_doors[i]) == 0) {
            hn_reply_empty(r, MHD_HTTP_PERMANENT_REDIRECT);
            hn_reply_header_add(r, "Location", "/api/v1/");
            return;
        }
    }
    if (match->allow[0]) {
        int options = strcmp(method, "OPTIONS") == 0;
        if (options) {
            hn_reply_empty(r, MHD_HTTP_NO_CONTENT);
        } else {
            hn_reply_problem(r, HN_PROBLEM_METHOD, NULL, "%.20s is not among: %s", method,
                             match->allow);
        }
        hn_reply_header_add(r, "Allow", "%s", match->allow);
        return;
    }
    if ((strcmp(method, "GET") == 0 || r->is_head) &&
        hn_static_files_reply(r->context->files, r, r->path)) {
        return;
    }
    const char *near = hn_route_nearest(&r->context->routes, r->path);
    if (!near) {
        near = hn_static_files_nearest(r->context->files, r->path);
    }
    char hint[HN_DIAG_HINT] = "GET /api/v1/ lists the addresses";
    if (near) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", near);
    }
    hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, hint, "there is nothing at '%.200s'", r->path);
}

/// The checks that need no body; a reply that is there afterwards ends the matter.
static void check_head(hn_request *r, const char *method) {
    long long length = 0;
    const char *text = hn_request_header(r, "Content-Length");
    if (!hn_guard_host(r, &r->context->hosts)) {
        return;
    }
    hn_route_match match = hn_route_find(&r->context->routes, method, r->path, r->parts);
    r->route = match.route;
    if (!r->route) {
        reply_off_routes(r, method, &match);
    } else if (atomic_load(&r->context->stopping)) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is going down");
    } else if (hn_guard_accept(r) && hn_guard_body_type(r) && text &&
               sscanf(text, "%lld", &length) == 1 && length > r->context->opts.max_body) {
        hn_reply_problem(r, HN_PROBLEM_TOO_LARGE, NULL,
                         "the body has %lld bytes; at most %lld are read", length,
                         r->context->opts.max_body);
    }
}

/// 1 when the rest of the body is not worth reading, or the client waits to be told before it sends
/// it.
static int must_answer_early(const hn_request *r) {
    long long length = 0;
    const char *text = hn_request_header(r, "Content-Length");
    return hn_request_header(r, "Expect") ||
           (text && sscanf(text, "%lld", &length) == 1 && length > MAX_DRAINED);
}

/// Keeps a piece of the body; what is beyond the bound, or not wanted, is dropped.
static void take_body(hn_request *r, const char *data, size_t n) {
    if (r->stage == HN_STAGE_ANSWERED || !r->route->fields) {
        r->body_dropped += n;
        return;
    }
    if (r->n_body + n > (size_t)r->context->opts.max_body) {
        hn_reply_problem(r, HN_PROBLEM_TOO_LARGE, NULL, "the body is longer than %lld bytes",
                         r->context->opts.max_body);
        r->body_dropped += n;
        return;
    }
    if (r->n_body + n > r->body_cap) {
        size_t cap = r->n_body + n > 2 * r->body_cap ? r->n_body + n : 2 * r->body_cap;
        char *larger = realloc(r->body, cap);
        if (!larger) {
            hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
            return;
        }
        r->body = larger;
        r->body_cap = cap;
    }
    memcpy(r->body + r->n_body, data, n);
    r->n_body += n;
}

/// Parses and checks the body; 0 when the reply is a problem.
static int read_json(hn_request *r) {
    hn_diag fault = {0};
    size_t offset = 0;
    if (hn_json_text_locate(r->body, r->n_body, MAX_JSON_DEPTH, &offset, &fault) != HN_OK) {
        hn_reply_bad_json(r, offset, fault.message, fault.hint);
        return 0;
    }
    r->json = cJSON_ParseWithLength(r->body, r->n_body);
    if (!r->json) {
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return 0;
    }
    hn_diags diags = {0};
    hn_status status = HN_OK;
    if (!cJSON_IsObject(r->json)) {
        status = hn_diags_add(&diags, HN_ERR_INPUT, "", NULL, "the body must be a JSON object");
    } else {
        status = hn_body_check(r->json, r->route->fields, "", &diags);
    }
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
    }
    return status == HN_OK;
}

/// Does a heavy request, on a thread of the pool.
static void run_job(void *job) {
    hn_request *r = job;
    if (!r->route->fields || read_json(r)) {
        r->route->handle(r);
    }
    hn_request_finish(r);
}

/// Sees to it that a reply comes. 1: it is there; 0: the request belongs to somebody else until it
/// is finished.
static int start_work(hn_server *server, hn_request *r) {
    switch (r->route->work) {
    case HN_WORK_LIGHT:
        if (!r->route->fields || read_json(r)) {
            r->route->handle(r);
        }
        return 1;
    case HN_WORK_HEAVY:
        hn_request_suspend(r);
        if (!hn_jobs_push(server->jobs, r)) {
            hn_reply_problem(r, HN_PROBLEM_BUSY, NULL,
                             "%d long requests are waiting already; no more are taken on",
                             server->context.opts.queue);
            hn_reply_header_add(r, "Retry-After", "1");
            hn_request_finish(r);
        }
        return 0;
    case HN_WORK_OWN:
        if (r->route->fields && !read_json(r)) {
            return 1;
        }
        hn_request_suspend(r);
        r->route->handle(r);
        return 0;
    }
    return 1;
}

static void add_header(struct MHD_Response *response, const char *name, const char *value) {
    MHD_add_response_header(response, name, value);
}

static void add_headers(hn_request *r, struct MHD_Response *response) {
    if (r->media_type) {
        add_header(response, "Content-Type", r->media_type);
    }
    for (int i = 0; i < r->n_headers; i++) {
        add_header(response, r->headers[i].name, r->headers[i].value);
    }
    add_header(response, "Content-Security-Policy", hn_static_files_policy(r->context->files));
    add_header(response, "X-Content-Type-Options", "nosniff");
    add_header(response, "Referrer-Policy", "no-referrer");
    add_header(response, "Cross-Origin-Resource-Policy", "same-origin");
    if (!MHD_get_response_header(response, "Cache-Control")) {
        add_header(response, "Cache-Control", "no-store");
    }
}

static enum MHD_Result send_reply(hn_request *r) {
    struct MHD_Response *response = r->response;
    r->response = NULL;
    if (!response) {
        size_t n = r->text.n;
        char *text = n ? hn_strbuf_take(&r->text) : NULL;
        response = MHD_create_response_from_buffer(
            n, text ? text : "", text ? MHD_RESPMEM_MUST_FREE : MHD_RESPMEM_PERSISTENT);
        if (!response) {
            free(text);
            return MHD_NO;
        }
    }
    add_headers(r, response);
    enum MHD_Result queued = MHD_queue_response(r->connection, r->status, response);
    MHD_destroy_response(response);
    return queued;
}

static hn_request *begin_request(hn_server *server, struct MHD_Connection *connection,
                                 const char *url, const char *method) {
    hn_request *r = calloc(1, sizeof *r);
    if (r) {
        r->context = &server->context;
        r->connection = connection;
        r->is_head = strcmp(method, "HEAD") == 0;
        snprintf(r->path, sizeof r->path, "%.*s", HN_HEADER_TEXT - 1, url);
        check_head(r, method);
    }
    return r;
}

static enum MHD_Result on_request(void *cls, struct MHD_Connection *connection, const char *url,
                                  const char *method, const char *version, const char *data,
                                  size_t *n_data, void **req_cls) {
    hn_request *r = *req_cls;
    (void)version;
    if (!r) {
        *req_cls = r = begin_request(cls, connection, url, method);
        if (!r) {
            return MHD_NO;
        }
        return r->stage == HN_STAGE_ANSWERED && must_answer_early(r) ? send_reply(r) : MHD_YES;
    }
    if (*n_data > 0) {
        take_body(r, data, *n_data);
        *n_data = 0;
        return r->body_dropped > MAX_DRAINED ? MHD_NO : MHD_YES;
    }
    if (r->stage == HN_STAGE_BODY && !start_work(cls, r)) {
        return MHD_YES;
    }
    return send_reply(r);
}

static void on_completed(void *cls, struct MHD_Connection *connection, void **req_cls,
                         enum MHD_RequestTerminationCode how) {
    (void)cls;
    (void)connection;
    (void)how;
    hn_request_free(*req_cls);
    *req_cls = NULL;
}

// ---- the server ----

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

static hn_status start_daemon(hn_server *s, int fd, hn_diag *diag) {
    s->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL,
        on_request, s, MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_NOTIFY_COMPLETED, on_completed,
        NULL, MHD_OPTION_CONNECTION_LIMIT, (unsigned)s->context.opts.max_connections,
        MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)s->context.opts.connection_timeout,
        MHD_OPTION_END);
    if (!s->daemon) {
        close(fd);
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "the HTTP library could not be started");
    }
    return HN_OK;
}

hn_status hn_server_start(const hn_library *lib, const hn_http_opts *opts, hn_server **out,
                          hn_diag *diag) {
    hn_server *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    s->context.lib = lib;
    s->context.routes = hn_routes();
    s->context.opts = *opts;
    pthread_mutex_init(&s->context.scenes.lock, NULL);
    set_hosts(s);
    int fd = -1;
    char host[256];
    hn_status status = hn_static_files_create(hn_library_web(lib), &s->context.files, diag);
    if (status == HN_OK) {
        s->jobs = hn_jobs_create(opts->pool, opts->queue, run_job);
        s->context.comparisons = hn_comparisons_create(&s->context.opts, lib);
        s->context.studies = hn_studies_create(&s->context.opts, lib);
        status =
            s->jobs && s->context.comparisons && s->context.studies
                ? hn_listen(opts->host, opts->port, opts->next_ports, &fd, &s->port, host, diag)
                : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory or threads");
    }
    if (status == HN_OK) {
        snprintf(s->address, sizeof s->address, "http://%s:%d", host, s->port);
        status = start_daemon(s, fd, diag);
    }
    if (status != HN_OK) {
        hn_server_stop(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

const char *hn_server_address(const hn_server *server) {
    return server->address;
}

int hn_server_port(const hn_server *server) {
    return server->port;
}

void hn_server_stop(hn_server *s) {
    atomic_store(&s->context.stopping, 1);
    int fd = s->daemon ? MHD_quiesce_daemon(s->daemon) : -1;
    // nobody may be left suspended when the daemon goes: workers and pool answer what they hold
    hn_comparisons_stop(s->context.comparisons);
    hn_studies_stop(s->context.studies);
    if (s->jobs) {
        hn_jobs_stop(s->jobs);
    }
    if (s->daemon) {
        MHD_stop_daemon(s->daemon);
    }
    if (fd >= 0) {
        close(fd);
    }
    hn_comparisons_free(s->context.comparisons);
    hn_studies_free(s->context.studies);
    hn_jobs_free(s->jobs);
    hn_static_files_free(s->context.files);
    pthread_mutex_destroy(&s->context.scenes.lock);
    free(s->context.scenes.text);
    free(s);
}
