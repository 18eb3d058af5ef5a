// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/dispatch.h"

#include "base/clock.h"
#include "build.h"
#include "http/request/client.h"
#include "http/request/early_answer.h"
#include "http/request/guard.h"
#include "http/request/gzip.h"
#include "http/request/request.h"
#include "http/request/token.h"
#include "http/routes/static_files.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/// An unwanted body of this size is read before the answer. A longer one is answered at once, and
/// read for DRAIN_SECONDS: a client that is cut off while it sends would not see the answer.
enum { MAX_DRAINED = 8 << 20 };
static const double DRAIN_SECONDS = 10;
/// Longer texts are sent as they are: by a pool, and by an event loop.
enum { MOST_ZIPPED = 32 << 20, MOST_ZIPPED_AT_ONCE = 256 << 10 };

// ---- the head ----

/// The verbs that an address takes, to a request by another one.
static void reply_verb(hn_request *r, const char *method, const char *allow) {
    if (strcmp(method, "OPTIONS") == 0) {
        hn_reply_empty(r, MHD_HTTP_NO_CONTENT);
    } else {
        hn_reply_problem(r, HN_PROBLEM_METHOD, NULL, "%.20s is not among: %s", method, allow);
    }
    hn_reply_header_add(r, "Allow", "%s", allow);
}

/// Replies to an address off the API: a redirect to its front door, a file of the page, or nothing.
static void reply_off_routes(hn_request *r, const char *method, const hn_route_match *match) {
    // relative: a proxy may serve them below a prefix
    static const char *const front_doors[][2] = {
        {"/api", "./api/v1/"}, {"/api/", "./v1/"}, {"/api/v1", "./v1/"}};
    for (size_t i = 0; i < sizeof front_doors / sizeof *front_doors; i++) {
        if (strcmp(r->path, front_doors[i][0]) == 0) {
            hn_reply_empty(r, MHD_HTTP_PERMANENT_REDIRECT);
            hn_reply_header_add(r, "Location", "%s", front_doors[i][1]);
            return;
        }
    }

    // a tunnel: its address is a host, and no address here takes it
    if (strcmp(method, "CONNECT") == 0) {
        reply_verb(r, method,
                   match->allow[0] ? match->allow : "GET, HEAD, POST, PATCH, DELETE, OPTIONS");
        return;
    }

    // a file of the page
    if ((strcmp(method, "GET") == 0 || r->is_head) &&
        hn_static_files_reply(r->context->files, r, r->path)) {
        return;
    }

    // an address by a verb that it does not take
    const char *allow = match->allow[0]                                   ? match->allow
                        : hn_static_files_has(r->context->files, r->path) ? "GET, HEAD, OPTIONS"
                                                                          : NULL;
    if (allow) {
        reply_verb(r, method, allow);
        return;
    }

    // nothing here; perhaps a slip
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
    if (r->has_zero) {
        hn_reply_problem(
            r, HN_PROBLEM_BAD_REQUEST, NULL,
            "the address holds a zero byte (%%00 or a raw one); no address of this server does");
        return;
    }

    // an address that can be served, by a request that may ask for it
    hn_route_match match = hn_route_find(&r->context->routes, method, r->path, r->parts);
    r->route = match.route;
    if (!hn_token_check(r, method)) {
        return;
    }
    if (!r->route) {
        reply_off_routes(r, method, &match);
    } else if (atomic_load(&r->context->stopping)) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
    } else if (hn_guard_site(r) && hn_guard_query(r) && hn_guard_accept(r) &&
               hn_guard_body_type(r) && text && sscanf(text, "%lld", &length) == 1 &&
               length > r->context->opts.max_body) {
        hn_reply_problem(r, HN_PROBLEM_TOO_LARGE, NULL,
                         "the body has %lld bytes; at most %lld are read", length,
                         r->context->opts.max_body);
    }
}

static bool is_refused(const hn_request *r) {
    return r->status >= MHD_HTTP_BAD_REQUEST;
}

/// Returns whether the rest of the body is not worth reading: it is long, or it is that of a
/// refused request and comes in chunks, so that nobody knows its end.
static bool is_too_long_to_drain(const hn_request *r) {
    long long length = 0;
    if (is_refused(r) && hn_request_header(r, "Transfer-Encoding")) {
        return true;
    }
    const char *text = hn_request_header(r, "Content-Length");
    return (text && sscanf(text, "%lld", &length) == 1 && length > MAX_DRAINED) ||
           r->body_dropped > MAX_DRAINED;
}

/// Puts a refusal in place of the present reply, a file of the page or a redirect.
static void refuse_body(hn_request *r) {
    if (r->response) {
        MHD_destroy_response(r->response);
        r->response = NULL;
    }
    r->n_headers = 0;
    hn_reply_problem(r, HN_PROBLEM_TOO_LARGE, NULL, "this address takes no body");
}

static void answer_and_drain(hn_dispatch *d, hn_request *r) {
    if (!is_refused(r)) {
        refuse_body(r);
    }
    hn_connection_is_answered(d->connections, r->watch);
    hn_answer_early(r);
    r->drain_until = hn_clock_wall() + DRAIN_SECONDS;
}

// ---- the body ----

/// Keeps a piece of the body; what is beyond the bound, or not wanted, is dropped.
static void take_body(hn_request *r, const char *data, size_t n) {
    if (r->stage != HN_STAGE_BODY || !r->route->fields) {
        r->body_dropped += n;
        if (r->stage == HN_STAGE_BODY && r->body_dropped > MAX_DRAINED) {
            refuse_body(r);
        }
        return;
    }
    if (r->n_body + n > (size_t)r->context->opts.max_body) {
        hn_reply_problem(r, HN_PROBLEM_TOO_LARGE, NULL, "the body is longer than %lld bytes",
                         r->context->opts.max_body);
        r->body_dropped += n;
        return;
    }

    // grown by doubling
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

// ---- the work ----

void hn_dispatch_job(void *job, hn_job_turn *turn) {
    hn_request *r = job;
    r->turn = turn;
    hn_request_add_time(r);
    if (atomic_load(&r->context->stopping)) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
    } else if (hn_request_may_answer(r, 0) && hn_request_read_body(r)) { // it may have waited long
        const bool own = r->route->work == HN_WORK_QUICK_OWN || r->route->work == HN_WORK_HEAVY_OWN;
        r->route->handle(r);
        if (own) {
            return; // the handler has it finished
        }
    }
    hn_reply_compress(r, MOST_ZIPPED);
    hn_request_finish(r);
}

/// Gives the request to a pool, or refuses it with the time after which there will be a place.
static void push(hn_request *r, hn_jobs *jobs) {
    hn_request_suspend(r);
    if (!hn_request_may_answer(r, 0)) {
        hn_request_finish(r);
    } else if (!hn_jobs_push(jobs, r, r->queues_as, 0)) {
        hn_reply_queue_full(r, jobs);
        hn_request_finish(r);
    }
}

/// 1 when the route computes only when it is told to.
static bool may_compute(const hn_route *route) {
    const hn_route_query *q = route->query;
    while (q && q->name && strcmp(q->name, "compute") != 0) {
        q++;
    }
    return q && q->name;
}

static bool is_quick(const hn_request *r) {
    const char *compute = hn_request_query(r, "compute");
    return r->route->work == HN_WORK_QUICK || r->route->work == HN_WORK_QUICK_OWN ||
           (may_compute(r->route) && (!compute || strcmp(compute, "true") != 0));
}

/// Arranges the reply. Returns 1 when it is there, 0 when another thread owns the request.
static bool start_work(hn_dispatch *d, hn_request *r) {
    switch (r->route->work) {
    case HN_WORK_LIGHT:
        r->route->handle(r);
        hn_reply_compress(r, MOST_ZIPPED_AT_ONCE);
        return true;
    case HN_WORK_OWN:
        hn_request_suspend(r);
        r->route->handle(r);
        return false;
    case HN_WORK_QUICK:
    case HN_WORK_QUICK_OWN:
    case HN_WORK_HEAVY:
    case HN_WORK_HEAVY_OWN:
        push(r, is_quick(r) ? d->quick : d->heavy);
        return false;
    }
    return true;
}

// ---- the reply ----

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
    add_header(response, "Holonom-Build", hn_build_name());
    add_header(response, "Content-Security-Policy", hn_static_files_policy(r->context->files));
    add_header(response, "X-Content-Type-Options", "nosniff");
    add_header(response, "Referrer-Policy", "no-referrer");
    add_header(response, "Cross-Origin-Resource-Policy", "same-origin");
    if (!MHD_get_response_header(response, "Cache-Control")) {
        add_header(response, "Cache-Control", "no-store");
    }
}

static enum MHD_Result send_reply(hn_dispatch *d, hn_request *r) {
    struct MHD_Response *response = r->response;
    r->response = NULL;
    if (!r->is_endless) {
        hn_connection_sends(d->connections, r->watch);
    }
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

    // counted until the reader has all of it
    add_headers(r, response);
    enum MHD_Result queued = MHD_queue_response(r->connection, r->status, response);
    MHD_destroy_response(response);
    return queued;
}

// ---- callbacks of the HTTP library ----

/// Refuses an address that is too long, or that has too many parameters.
static void check_address(hn_request *r, const char *uri) {
    size_t n = 0, parameters = 1;
    for (; uri[n]; n++) {
        parameters += uri[n] == '&';
    }
    if (n > HN_MAX_ADDRESS || parameters > HN_MAX_PARAMETERS) {
        hn_reply_problem(r, HN_PROBLEM_ADDRESS, "send what is long in the body of a POST",
                         "the address has %zu bytes and %zu parameters; at most %d and %d are read",
                         n, parameters, HN_MAX_ADDRESS, HN_MAX_PARAMETERS);
        hn_answer_early(r);
        hn_request_drain(r);
    }
}

void *hn_dispatch_address(void *cls, const char *uri, struct MHD_Connection *connection) {
    hn_dispatch *d = cls;
    hn_request *r = calloc(1, sizeof *r);
    if (r) {
        const union MHD_ConnectionInfo *info =
            MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
        r->context = d->context;
        atomic_fetch_add(&d->context->open_requests, 1);
        r->connection = connection;
        r->watch = info ? info->socket_context : NULL;
        r->has_zero = strstr(uri, "%00") != NULL;
        r->address_end = uri + strlen(uri);
        snprintf(r->path, sizeof r->path, "%.*s", (int)strcspn(uri, "?"), uri);
        check_address(r, uri);
        if (r->stage != HN_STAGE_SENT) {
            hn_connection_asks(d->connections, r->watch);
        }
    }
    return r;
}

/// Returns whether something stands between the end of the address, as a text of C, and the
/// version: a zero byte has cut the address. Both lie in the library's buffer of the head, one byte
/// apart; a library that keeps the version elsewhere is believed.
static bool is_cut(const char *address_end, const char *version) {
    const ptrdiff_t apart = address_end && version ? version - address_end : 0;
    return apart > 1 && apart <= HN_HEAD_BYTES;
}

/// Keeps the path of an address; one in absolute form ("http://HOST/PATH", as clients send that
/// take the server for a proxy) must name the host of the header, and is refused otherwise.
static bool take_path(hn_request *r, const char *url) {
    const size_t scheme = strncasecmp(url, "http://", 7) == 0    ? 7
                          : strncasecmp(url, "https://", 8) == 0 ? 8
                                                                 : 0;
    const char *authority = url + scheme, *host = hn_request_header(r, "Host");
    const size_t n = scheme ? strcspn(authority, "/") : 0;
    const char *path = scheme && !authority[n] ? "/" : authority + n;
    snprintf(r->path, sizeof r->path, "%.*s", HN_HEADER_TEXT - 1, path);
    if (scheme && (!host || !hn_guard_is_same_host(authority, n, host, strlen(host)))) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL,
                         "the address names the host '%.*s', the Host header '%.100s'",
                         (int)(n < 100 ? n : 100), authority, host ? host : "");
        return false;
    }
    return true;
}

/// The head is complete. Returns 0 when the connection is to be closed.
static bool begin_request(hn_dispatch *d, hn_request *r, const char *url, const char *method) {
    if (r->stage == HN_STAGE_SENT) {
        return false;
    }
    r->has_begun = true;
    r->head = method;
    const bool is_known = hn_request_identify(r);
    r->is_head = strcmp(method, "HEAD") == 0;
    hn_connection_reads_body(d->connections, r->watch);
    if (is_known && hn_guard_headers(r) && take_path(r, url)) {
        check_head(r, method);
    }
    if (r->stage != HN_STAGE_ANSWERED) {
        return true;
    }

    // a client that waits to be told before it sends its body is told; so is one that sends much
    if (hn_request_header(r, "Expect")) {
        return send_reply(d, r) == MHD_YES;
    }
    if (is_too_long_to_drain(r)) {
        answer_and_drain(d, r);
    }
    return true;
}

enum MHD_Result hn_dispatch_request(void *cls, struct MHD_Connection *connection, const char *url,
                                    const char *method, const char *version, const char *data,
                                    size_t *n_data, void **req_cls) {
    hn_request *r = *req_cls;
    (void)connection;
    if (!r) {
        return MHD_NO; // memory was out
    }
    if (!r->has_begun) {
        r->has_zero = r->has_zero || is_cut(r->address_end, version);
        r->takes_interim = strcmp(version, MHD_HTTP_VERSION_1_1) == 0;
        return begin_request(cls, r, url, method) ? MHD_YES : MHD_NO;
    }

    // a piece of the body
    if (*n_data > 0) {
        hn_connection_goes_on(((hn_dispatch *)cls)->connections, r->watch);
        take_body(r, data, *n_data);
        *n_data = 0;
        if (r->stage == HN_STAGE_ANSWERED && is_too_long_to_drain(r)) {
            answer_and_drain(cls, r);
        }
        return r->stage == HN_STAGE_SENT && hn_clock_wall() > r->drain_until ? MHD_NO : MHD_YES;
    }
    if (r->stage == HN_STAGE_SENT) {
        return MHD_NO; // answered already: the connection closes
    }

    // its end: the library comes again at once
    if (r->stage == HN_STAGE_BODY && !r->is_whole) {
        r->is_whole = true;
        return MHD_YES;
    }

    // a request that was told that it is late is not carried out
    if (r->stage == HN_STAGE_BODY &&
        !hn_connection_is_served(((hn_dispatch *)cls)->connections, r->watch)) {
        return MHD_NO;
    }

    // its work, or the reply of another thread
    if (r->stage == HN_STAGE_BODY && !start_work(cls, r)) {
        return MHD_YES;
    }
    return send_reply(cls, r);
}

void hn_dispatch_completed(void *cls, struct MHD_Connection *connection, void **req_cls,
                           enum MHD_RequestTerminationCode how) {
    hn_dispatch *d = cls;
    hn_request *r = *req_cls;
    (void)connection;
    (void)how;
    if (r) {
        hn_connection_is_idle(d->connections, r->watch);
        atomic_fetch_sub(&d->context->unread, r->n_unread);
        atomic_fetch_sub(&d->context->open_requests, 1);
    }
    hn_request_free(r);
    *req_cls = NULL;
}

enum MHD_Result hn_dispatch_accept(void *cls, const struct sockaddr *address, socklen_t length) {
    hn_dispatch *d = cls;
    (void)length;
    const hn_client client = hn_client_of_connection(&d->context->opts.proxies, address);
    return hn_connections_make_room(d->connections, client) ? MHD_YES : MHD_NO;
}

void hn_dispatch_connection(void *cls, struct MHD_Connection *connection, void **socket_context,
                            enum MHD_ConnectionNotificationCode what) {
    hn_dispatch *d = cls;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info = MHD_get_connection_info(
                                           connection, MHD_CONNECTION_INFO_CONNECTION_FD),
                                       *from = MHD_get_connection_info(
                                           connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
        const hn_client client =
            hn_client_of_connection(&d->context->opts.proxies, from ? from->client_addr : NULL);
        *socket_context =
            info ? hn_connections_add(d->connections, info->connect_fd, client) : NULL;
    } else {
        hn_connections_remove(d->connections, *socket_context);
        *socket_context = NULL;
    }
}
