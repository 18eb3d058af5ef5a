// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // POLLRDHUP
#include "http/request/request.h"

#include "base/clock.h"
#include "base/json_text.h"
#include "http/ground/connections.h"
#include "http/ground/plain_number.h"
#include "http/request/context.h"
#include "session/job/field.h"

#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

enum { MAX_JSON_DEPTH = 64 };
/// Work looks so often whether its client is still there [s].
static const double LOOK_EVERY = 0.25;
/// A system that is asked whether a connection is still open answers within this time.
enum { PROBE_MS = 50 };

const char *hn_request_query(const hn_request *r, const char *name) {
    return MHD_lookup_connection_value(r->connection, MHD_GET_ARGUMENT_KIND, name);
}

bool hn_request_query_number(hn_request *r, const char *name, double low, double high, bool whole,
                             double *out) {
    const char *text = hn_request_query(r, name);
    double value = 0;
    if (!text) {
        return true;
    }
    if (!hn_plain_number(text, whole, &value) || !(value >= low && value <= high)) {
        char pointer[32];
        hn_diags diags = {0};
        snprintf(pointer, sizeof pointer, "/%s", name);
        hn_diags_add(&diags, HN_ERR_INPUT, pointer, NULL,
                     "'%s' is '%.40s'; %s from %g to %g is allowed", name, text,
                     whole ? "a whole number, in digits," : "a number", low, high);
        hn_reply_diags(r, HN_ERR_INPUT, &diags);
        return false;
    }
    *out = value;
    return true;
}

bool hn_request_is_left(hn_request *r) {
    static const char interim[] = "HTTP/1.1 100 Continue\r\n\r\n";
    struct pollfd look = {.fd = hn_request_socket(r), .events = POLLRDHUP};
    if (look.fd < 0 || poll(&look, 1, 0) <= 0) {
        return false;
    }
    if (look.revents & ~POLLRDHUP) {
        return true;
    }

    // it sends no more; whether it still reads, the answer of its system tells
    if (r->takes_interim && !r->was_probed) {
        r->was_probed = true;
        return send(look.fd, interim, sizeof interim - 1, MSG_DONTWAIT | MSG_NOSIGNAL) < 0;
    }
    return false;
}

bool hn_request_has_been_left(hn_request *r) {
    if (!hn_request_is_left(r) && r->was_probed) {
        struct pollfd answer = {.fd = hn_request_socket(r)};
        poll(&answer, 1, PROBE_MS);
    }
    r->is_left = hn_request_is_left(r);
    return r->is_left;
}

int hn_request_socket(const hn_request *r) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(r->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info ? info->connect_fd : -1;
}

const char *hn_request_header(const hn_request *r, const char *name) {
    return MHD_lookup_connection_value(r->connection, MHD_HEADER_KIND, name);
}

typedef struct query_walk {
    const char *name;
    hn_status (*see)(void *user, const char *value);
    void *user;
    hn_status status;
} query_walk;

static enum MHD_Result see_query(void *cls, enum MHD_ValueKind kind, const char *key,
                                 const char *value) {
    query_walk *walk = cls;
    (void)kind;
    if (strcmp(key, walk->name) == 0) {
        walk->status = walk->see(walk->user, value ? value : "");
    }
    return walk->status == HN_OK ? MHD_YES : MHD_NO;
}

hn_status hn_request_each_query(const hn_request *r, const char *name,
                                hn_status (*see)(void *user, const char *value), void *user) {
    query_walk walk = {.name = name, .see = see, .user = user, .status = HN_OK};
    MHD_get_connection_values(r->connection, MHD_GET_ARGUMENT_KIND, see_query, &walk);
    return walk.status;
}

void hn_reply_header_add(hn_request *r, const char *name, const char *format, ...) {
    HN_ASSERT(r->n_headers < HN_MAX_REPLY_HEADERS);
    hn_reply_header *h = &r->headers[r->n_headers++];
    h->name = name;
    va_list args;
    va_start(args, format);
    vsnprintf(h->value, sizeof h->value, format, args);
    va_end(args);
}

/// The reply to what was ended early.
static void reply_interrupted(hn_request *r) {
    if (atomic_load(&r->context->stopping)) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
    } else if (r->is_left) {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, NULL, "the client has closed its connection");
    } else {
        hn_reply_problem(r, HN_PROBLEM_INPUT, "take fewer bodies, shorter chains or longer steps",
                         "the equations and runs of this request take more than %g s of computing",
                         r->context->opts.max_run_cpu);
    }
}

void hn_reply_bytes(hn_request *r, unsigned status, const char *media_type, hn_strbuf *bytes) {
    if (bytes->failed && r->interrupted) {
        hn_strbuf_reset(bytes);
        reply_interrupted(r);
        return;
    }
    if (bytes->failed) {
        hn_strbuf_reset(bytes);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return;
    }
    hn_strbuf_reset(&r->text);
    r->text = *bytes;
    hn_strbuf_init(bytes);
    r->status = status;
    r->media_type = media_type;
    r->stage = HN_STAGE_ANSWERED;
    hn_request_count_answer(r);
}

void hn_reply_json(hn_request *r, unsigned status, hn_strbuf *text) {
    hn_reply_bytes(r, status, "application/json", text);
}

void hn_reply_kept(hn_request *r, hn_kept_text *kept,
                   void (*put)(hn_strbuf *b, const hn_context *c)) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&kept->lock);
    if (!kept->text) {
        put(&b, r->context);
        kept->text = hn_strbuf_take(&b);
    }
    if (kept->text) {
        hn_strbuf_add(&b, kept->text);
    } else {
        b.failed = 1;
    }
    pthread_mutex_unlock(&kept->lock);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_reply_empty(hn_request *r, unsigned status) {
    hn_strbuf_reset(&r->text);
    hn_request_count_answer(r);
    r->status = status;
    r->media_type = NULL;
    r->stage = HN_STAGE_ANSWERED;
}

void hn_reply_response(hn_request *r, unsigned status, struct MHD_Response *response) {
    r->response = response;
    r->status = status;
    r->stage = HN_STAGE_ANSWERED;
}

/// Writes the document; when even that has no memory, the status stands alone.
static void reply_document(hn_request *r, hn_http_problem kind, const char *detail,
                           const char *hint, long long offset, const hn_diags *diags) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_http_problem_json(&b, kind, detail, hint, r->path, offset, diags);
    unsigned status = hn_http_problem_get_info(kind)->status;
    if (b.failed) {
        hn_strbuf_reset(&b);
        hn_reply_empty(r, status);
        return;
    }
    hn_reply_bytes(r, status, "application/problem+json", &b);
}

void hn_reply_problem(hn_request *r, hn_http_problem kind, const char *hint, const char *format,
                      ...) {
    char detail[HN_DIAG_MESSAGE];
    va_list args;
    va_start(args, format);
    vsnprintf(detail, sizeof detail, format, args);
    va_end(args);
    reply_document(r, kind, detail, hint, -1, NULL);
}

/// Counts n bytes for the answer; returns how many are unread in all without it.
static long long count_unread(hn_request *r, long long n) {
    const long long before = atomic_fetch_add(&r->context->unread, n - r->n_unread) - r->n_unread;
    r->n_unread = n;
    return before;
}

void hn_request_count_answer(hn_request *r) {
    count_unread(r, (long long)r->text.n);
}

bool hn_request_may_answer(hn_request *r, size_t n) {
    const hn_http_opts *opts = &r->context->opts;
    const long long others = count_unread(r, (long long)n);
    if (others <= 0 || others + (long long)n <= opts->max_unread) {
        return true;
    }
    hn_connections_end_slowest(r->context->connections, opts->unread_patience);
    hn_reply_problem(r, HN_PROBLEM_BUSY, "read the answers that were asked for, then ask again",
                     "%lld bytes of answers have not been read by their clients, and this one has "
                     "%zu; at most %lld may wait (unread_bytes of the index)",
                     others, n, opts->max_unread);
    hn_reply_header_add(r, "Retry-After", "5");
    return false;
}

void hn_reply_queue_full(hn_request *r, hn_jobs *jobs) {
    const hn_http_opts *opts = &r->context->opts;
    hn_reply_problem(
        r, HN_PROBLEM_BUSY, NULL,
        "%d requests of this kind are waiting already, or your client has its share of them; "
        "Retry-After estimates when there is a place for this one",
        jobs == r->context->quick ? opts->quick_queue : opts->queue);
    hn_reply_header_add(r, "Retry-After", "%d", hn_jobs_wait(jobs, r->queues_as, 0));
}

static void reply_bad_json(hn_request *r, size_t offset, const char *what, const char *hint) {
    reply_document(r, HN_PROBLEM_BAD_JSON, what, hint, (long long)offset, NULL);
}

void hn_reply_diags(hn_request *r, hn_status status, const hn_diags *diags) {
    if (r->interrupted || (status == HN_ERR_STOPPED && diags->n == 0)) {
        reply_interrupted(r);
        return;
    }
    int ours = status == HN_ERR_MEMORY || status == HN_ERR_INTERNAL || status == HN_ERR_IO;
    hn_http_problem kind = ours ? HN_PROBLEM_INTERNAL : HN_PROBLEM_INPUT;
    const char *detail = diags->n > 0 ? diags->item[0].message : hn_status_text(status);
    reply_document(r, kind, detail, diags->n > 0 ? diags->item[0].hint : NULL, -1, diags);
}

void hn_request_add_time(hn_request *r) {
    r->cpu_end = fmax(r->cpu_end, hn_clock_thread()) + r->context->opts.max_run_cpu;
}

int hn_request_is_unwanted(void *request) {
    hn_request *r = request;
    hn_job_make_way(r->turn);
    const double now = hn_clock_wall();
    if (!r->is_left && now >= r->next_look) {
        r->is_left = r->next_look > 0 && hn_request_is_left(r); // not before it has worked for long
        r->next_look = now + LOOK_EVERY;
    }
    const bool is_unwanted = r->is_left || atomic_load(&r->context->stopping);
    r->interrupted |= is_unwanted; // whatever its work then says, the request is not at fault
    return is_unwanted;
}

static bool must_end(void *user) {
    hn_request *r = user;
    r->interrupted |= hn_request_is_unwanted(r) || hn_clock_thread() > r->cpu_end;
    return r->interrupted;
}

hn_interrupt hn_request_interrupt(hn_request *r) {
    return (hn_interrupt){must_end, r};
}

/// Adds to the faults of a body that it names a scene which is not there.
static void check_scene_name(const hn_request *r, hn_diags *diags) {
    const hn_field *field = hn_fields_find(r->route->fields, "scene");
    const char *name = hn_fields_text(r->json, "scene");
    if (field && field->type == HN_FIELD_SCENE && name) {
        hn_library_check_scene(r->context->lib, name, "/scene", diags);
    }
}

int hn_request_read_body(hn_request *r) {
    if (!r->route->fields || r->json) {
        return 1;
    }
    hn_diag fault = {0};
    size_t offset = 0;
    if (hn_json_text_locate(r->body, r->n_body, MAX_JSON_DEPTH, &offset, &fault) != HN_OK) {
        reply_bad_json(r, offset, fault.message, fault.hint);
        return 0;
    }

    // a text that is JSON, so that only memory can fail
    r->json = cJSON_ParseWithLength(r->body, r->n_body);
    if (!r->json) {
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return 0;
    }

    // then its members
    hn_diags diags = {0};
    hn_status status = HN_OK;
    if (!cJSON_IsObject(r->json)) {
        status = hn_diags_add(&diags, HN_ERR_INPUT, "", NULL, "the body must be a JSON object");
    } else {
        status = hn_fields_check(r->json, r->route->fields, "", true, &diags);
        if (status != HN_OK) { // otherwise its reader says so
            check_scene_name(r, &diags);
        }
    }
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
    }
    return status == HN_OK;
}

void hn_request_suspend(hn_request *r) {
    r->stage = HN_STAGE_WAITING;
    MHD_suspend_connection(r->connection);
}

void hn_request_finish(hn_request *r) {
    HN_ASSERT(r->stage == HN_STAGE_ANSWERED);
    MHD_resume_connection(r->connection);
}

void hn_request_free(hn_request *r) {
    if (r) {
        cJSON_Delete(r->json);
        hn_strbuf_reset(&r->text);
        if (r->response) {
            MHD_destroy_response(r->response);
        }
        free(r->body);
        free(r);
    }
}
