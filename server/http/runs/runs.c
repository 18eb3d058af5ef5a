// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/runs.h"

#include "http/request/context.h"
#include "http/request/guard.h"
#include "http/request/request.h"
#include "http/runs/json_scan.h"
#include "http/runs/run_list.h"
#include "http/runs/run_samples.h"
#include "http/runs/run_store.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double POST_WAIT = 25; // a client that waits longer asks again [s]
static const double MAX_WAIT = 60;  // [s]
enum { MAX_ROWS = 100000 };

// ---- documents ----

const char *hn_run_phase_name(hn_run_phase phase) {
    static const char *const names[] = {"waiting", "running", "finished", "refused"};
    return names[phase];
}

/// The document of one method from its byte `from` on, with or without its samples.
static void put_document(hn_strbuf *b, const hn_run_document *d, int from, int with_samples) {
    if (with_samples || !d->samples) {
        hn_strbuf_add_n(b, d->text + from, d->n - (size_t)from);
        return;
    }
    // the comma behind the samples goes with them
    const char *key = d->samples - strlen("\"samples\":"), *end = d->samples_end;
    hn_strbuf_add_n(b, d->text + from, (size_t)(key - d->text - from));
    hn_strbuf_add(b, end + (*end == ','));
}

/// The addresses of a run.
static void put_links(hn_strbuf *b, const hn_kept_run *run) {
    static const char *const parts[] = {"self", "samples", "events", "export"};
    hn_json_key(b, "links");
    hn_json_object(b);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char address[64];
        snprintf(address, sizeof address, "/api/v1/runs/%s%s%s", run->id, i ? "/" : "",
                 i ? parts[i] : "");
        hn_json_put_string(b, parts[i], address);
    }
    hn_json_end_object(b);
}

void hn_run_put_json(hn_strbuf *b, const hn_kept_run *run, hn_run_phase phase, bool with_samples) {
    hn_json_object(b);
    hn_json_put_string(b, "id", run->id);
    hn_json_put_string(b, "state", hn_run_phase_name(phase));
    hn_json_put_number(b, "progress", phase == HN_RUN_DONE ? 1 : atomic_load(&run->share));
    put_links(b, run);

    if (phase == HN_RUN_DONE && run->n == 1) {
        hn_strbuf_add(b, ",");
        put_document(b, &run->documents[0], 1, with_samples); // its closing brace ends the object
        return;
    }
    if (phase == HN_RUN_DONE) {
        hn_json_key(b, "runs");
        hn_json_array(b);
        for (int i = 0; i < run->n; i++) {
            hn_strbuf_add(b, i ? "," : "");
            put_document(b, &run->documents[i], 0, with_samples);
        }
        hn_json_end_array(b);
    }
    hn_json_end_object(b);
}

// ---- replies ----

/// 1 when the client has this version: the reply is made.
static bool is_unchanged(hn_request *r, const char *etag) {
    const char *known = hn_request_header(r, "If-None-Match");
    if (!known || (strcmp(known, "*") != 0 && !strstr(known, etag))) {
        return false;
    }
    hn_reply_empty(r, MHD_HTTP_NOT_MODIFIED);
    hn_reply_header_add(r, "ETag", "%s", etag);
    hn_reply_header_add(r, "Cache-Control", "no-cache");
    return true;
}

static void reply_refused(hn_request *r, const hn_kept_run *run) {
    if (atomic_load(&r->context->stopping)) {
        hn_reply_problem(r, HN_PROBLEM_STOPPING, NULL, "the server is shutting down");
    } else if (run->refused == HN_ERR_STOPPED || run->refused == HN_OK) {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, NULL, "the run was deleted while it was computed");
    } else {
        hn_reply_diags(r, run->refused, &run->diags);
    }
}

void hn_run_reply(hn_request *r, const hn_kept_run *run) {
    const hn_run_phase phase = hn_runs_phase(r->context->runs, run);
    const int post = strcmp(r->route->method, "POST") == 0;
    char etag[HN_RUN_ID + 4];
    snprintf(etag, sizeof etag, "\"%s\"", run->id);
    if (phase == HN_RUN_REFUSED) {
        reply_refused(r, run);
        return;
    }
    if (!post && phase == HN_RUN_DONE && is_unchanged(r, etag)) {
        return;
    }

    // the whole for who asked the question, the summary for who asks again
    if (post && phase == HN_RUN_DONE && !hn_request_may_answer(r, run->bytes)) {
        return;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_run_put_json(&b, run, phase, post);
    const int done = phase == HN_RUN_DONE;
    hn_reply_json(r,
                  !post       ? MHD_HTTP_OK
                  : !done     ? MHD_HTTP_ACCEPTED
                  : r->is_new ? MHD_HTTP_CREATED
                              : MHD_HTTP_OK,
                  &b);
    if (post) {
        hn_reply_header_add(r, "Location", "/api/v1/runs/%s", run->id);
    }
    if (done) {
        hn_reply_header_add(r, "ETag", "%s", etag);
        hn_reply_header_add(r, "Cache-Control", "no-cache");
    } else {
        hn_reply_header_add(r, "Retry-After", "1");
    }
}

static void reply_unknown(hn_request *r) {
    hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "POST /api/v1/runs asks the question again",
                     "there is no run '%.40s', or it was deleted", r->parts[0]);
}

hn_kept_run *hn_run_find(hn_request *r) {
    hn_kept_run *run = hn_runs_find(r->context->runs, r->parts[0]);
    if (!run) {
        reply_unknown(r);
    }
    return run;
}

// ---- handlers ----

void hn_handle_runs_create(hn_request *r) {
    hn_runs *all = r->context->runs;
    hn_run_question question = {0};
    hn_kept_run *run = NULL;
    hn_diags diags = {0};
    double wait = POST_WAIT;
    if (!hn_request_query_number(r, "wait", 0, MAX_WAIT, 0, &wait)) {
        hn_request_finish(r);
        return;
    }
    hn_status status = hn_run_question_read(&question, r->json, r->context->lib, &diags);
    HN_THEN(status, hn_runs_begin(all, &question, r->queues_as, &run, &r->is_new));
    char id[HN_RUN_ID];
    snprintf(id, sizeof id, "%s", question.id);
    hn_run_question_reset(&question);

    // answered when the run has ended, or after the wait
    if (status == HN_OK) {
        hn_runs_await(all, run, r, wait);
        hn_runs_release(all, run);
        return;
    }
    if (status == HN_ERR_LIMIT && diags.n == 0) {
        hn_reply_problem(r, HN_PROBLEM_BUSY, NULL,
                         "%d runs are waiting already, or your client has its share of them; "
                         "Retry-After estimates when there is a place for this one",
                         r->context->opts.queue);
        hn_reply_header_add(r, "Retry-After", "%d", hn_runs_wait(all, r->queues_as, id));
    } else {
        hn_reply_diags(r, status, &diags);
    }
    hn_request_finish(r);
}

void hn_handle_runs_list(hn_request *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_run_list_put(&b, r->context->run_list, r->context->runs, hn_request_interrupt(r));
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_run_get(hn_request *r) {
    hn_runs *all = r->context->runs;
    double wait = 0;
    hn_kept_run *run = NULL;
    if (hn_request_query_number(r, "wait", 0, MAX_WAIT, 0, &wait)) {
        run = hn_runs_find(all, r->parts[0]);
        if (!run) {
            reply_unknown(r);
        }
    }
    if (run) {
        hn_runs_await(all, run, r, wait);
        hn_runs_release(all, run);
    } else {
        hn_request_finish(r);
    }
}

void hn_handle_run_delete(hn_request *r) {
    hn_runs_delete(r->context->runs, r->parts[0]);
    hn_reply_empty(r, MHD_HTTP_NO_CONTENT); // the same for one that is gone
}

/// The document that `method` names by its index; 0 with a problem as reply.
static bool choose_document(hn_request *r, const hn_kept_run *run,
                            const hn_run_document **document) {
    double method = 0;
    if (!hn_request_query_number(r, "method", 0, run->n - 1, 1, &method)) {
        return false;
    }
    *document = &run->documents[(int)method];
    return true;
}

static bool read_samples_request(hn_request *r, hn_samples_request *q) {
    static const char *const types[] = {"application/json", "application/x-ndjson", "text/csv"};
    const char *accept = hn_request_header(r, "Accept");
    double stride = 1, cursor = 0, limit = MAX_ROWS;
    *q = (hn_samples_request){
        .fields = hn_request_query(r, "fields"), .from = -HUGE_VAL, .to = HUGE_VAL};
    if (!hn_request_query_number(r, "stride", 1, 1e9, 1, &stride) ||
        !hn_request_query_number(r, "cursor", 0, 1e15, 1, &cursor) ||
        !hn_request_query_number(r, "limit", 1, MAX_ROWS, 1, &limit) ||
        !hn_request_query_number(r, "from", 0, 1e12, 0, &q->from) ||
        !hn_request_query_number(r, "to", 0, 1e12, 0, &q->to)) {
        return false;
    }
    if (q->from > q->to) {
        hn_diags diags = {0};
        hn_diags_add(&diags, HN_ERR_INPUT, "/from", NULL,
                     "'from' is %.17g and 'to' is %.17g: no time is between them", q->from, q->to);
        hn_reply_diags(r, HN_ERR_INPUT, &diags);
        return false;
    }
    q->stride = (long long)stride;
    q->cursor = (long long)cursor;
    q->limit = (long long)limit;
    for (int form = q->form; form <= HN_SAMPLES_CSV; form++) {
        if (hn_accept_weight(accept, types[form]) > hn_accept_weight(accept, types[q->form])) {
            q->form = form;
        }
    }
    return true;
}

/// The page that follows: this address with another cursor.
static void add_next(hn_request *r, const hn_samples_request *q, long long next) {
    char address[HN_HEADER_TEXT];
    int n = snprintf(address, sizeof address, "%s?cursor=%lld&stride=%lld&limit=%lld", r->path,
                     next, q->stride, q->limit);
    double method = 0;
    if (hn_request_query(r, "method") && n < (int)sizeof address &&
        hn_request_query_number(r, "method", 0, 1e9, 1, &method)) {
        n += snprintf(address + n, sizeof address - (size_t)n, "&method=%d", (int)method);
    }
    if (q->fields && n < (int)sizeof address) {
        n += snprintf(address + n, sizeof address - (size_t)n, "&fields=%s", q->fields);
    }
    if (isfinite(q->to) && n < (int)sizeof address) {
        n += snprintf(address + n, sizeof address - (size_t)n, "&to=%.17g", q->to);
    }
    if (n < (int)sizeof address - 20) {
        hn_reply_header_add(r, "Link", "<%s>; rel=\"next\"", address);
    }
}

static void reply_samples(hn_request *r, const hn_kept_run *run) {
    static const char *const types[] = {"application/json", "application/x-ndjson",
                                        "text/csv; charset=utf-8"};
    hn_samples_request q;
    const hn_run_document *document;
    long long next = -1;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (!choose_document(r, run, &document) || !read_samples_request(r, &q)) {
        return;
    }
    char etag[HN_RUN_ID + 8];
    snprintf(etag, sizeof etag, "\"%s.%d\"", run->id, q.form);
    if (is_unchanged(r, etag)) {
        hn_reply_header_add(r, "Vary", "Accept");
        return;
    }

    // one page
    const hn_status status = hn_run_samples_write(&b, document, &q, &next, &diags);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        hn_reply_diags(r, status, &diags);
        return;
    }
    hn_reply_bytes(r, MHD_HTTP_OK, types[q.form], &b);
    hn_reply_header_add(r, "ETag", "%s", etag);
    hn_reply_header_add(r, "Cache-Control", "no-cache");
    hn_reply_header_add(r, "Vary", "Accept");
    if (next >= 0) {
        add_next(r, &q, next);
    }
}

void hn_handle_run_samples(hn_request *r) {
    hn_runs *all = r->context->runs;
    hn_kept_run *run = hn_runs_find(all, r->parts[0]);
    if (!run) {
        reply_unknown(r);
        return;
    }
    if (hn_runs_phase(all, run) == HN_RUN_DONE) {
        reply_samples(r, run);
    } else {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, "GET /api/v1/runs/{id}?wait=10 waits for the end",
                         "the run has not ended yet");
        hn_reply_header_add(r, "Retry-After", "1");
    }
    hn_runs_release(all, run);
}
