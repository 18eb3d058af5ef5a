// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_stream.h"

#include "base/clock.h"
#include "build.h"
#include "http/ground/stream_socket.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "http/runs/json_scan.h"
#include "http/runs/run_samples.h"
#include "http/runs/run_store.h"
#include "http/runs/runs.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1 << 16, SCHEMA = 1, LIVE_SAMPLES = 201 };
/// Bytes of a document that are read before something is sent, at least a comment, and the event
/// loop serves its other connections: some half a millisecond.
enum { MOST_WALKED = 1 << 18 };
static const double PROGRESS = 0.5; // between two events `progress` [s]

typedef struct run_stream {
    hn_run_reader reader; ///< first: the store lists it
    hn_runs *runs;
    hn_shares *places;
    hn_client client;
    char *fields; ///< columns of the samples; NULL: all
    bool live;

    // the events of the document that is being read
    int method;
    hn_sample_rows *rows; ///< NULL: the method has not begun
    bool has_row;
    double t; ///< of that row [s]
    long long row, stride;
    const char *incidents, *incident; ///< place behind the next one, and the next one or NULL
    unsigned long long id, seen;      ///< of the last event; the last that the reader has

    // what is being sent
    bool said_hello, ended;
    double last_progress;
    hn_strbuf text; ///< from `at` on
    size_t at;
    size_t walked; ///< bytes of documents that were read for this text
} run_stream;

// ---- events ----

static void put_hello(run_stream *s) {
    hn_strbuf_printf(&s->text,
                     "retry: 1000\nevent: hello\ndata: {\"schema\":%d,\"build\":\"%s\","
                     "\"id\":\"%s\"}\n\n",
                     SCHEMA, hn_build_name(), s->reader.run->id);
    s->said_hello = true;
}

/// Counts an event. Returns whether it is sent: the reader has not seen it.
static bool count_event(run_stream *s, const char *name) {
    s->id++;
    if (s->id > s->seen) {
        hn_strbuf_printf(&s->text, "id: %llu\nevent: %s\ndata: ", s->id, name);
    }
    return s->id > s->seen;
}

static void step_row(run_stream *s) {
    const size_t before = hn_sample_rows_walked(s->rows);
    s->has_row = hn_sample_rows_step(s->rows, &s->t);
    s->walked += hn_sample_rows_walked(s->rows) - before;
    s->row++;
}

/// Begins the next document. A column that it does not have ends the stream.
static void begin_method(run_stream *s) {
    const hn_run_document *document = &s->reader.run->documents[s->method];
    hn_diags diags = {0};
    if (hn_sample_rows_open(document, s->fields, &s->rows, &diags) != HN_OK) {
        hn_strbuf_add(&s->text, "event: problem\ndata: {\"detail\":");
        hn_json_string(&s->text, diags.n ? diags.item[0].message : "out of memory");
        hn_strbuf_add(&s->text, "}\n\n");
        s->ended = true;
        return;
    }
    s->row = -1;
    s->stride = s->live ? (document->n_rows + LIVE_SAMPLES - 1) / LIVE_SAMPLES : 1;
    s->incidents = document->incidents;
    s->incident = s->incidents ? hn_json_next(&s->incidents) : NULL;
    step_row(s);
}

static void put_sample(run_stream *s) {
    if (s->row % s->stride != 0) {
        s->id++;
    } else if (count_event(s, "sample")) {
        hn_strbuf_printf(&s->text, "{\"method\":%d,", s->method);
        hn_sample_rows_put(s->rows, &s->text);
        hn_strbuf_add(&s->text, "}\n\n");
    }
    step_row(s);
}

static void put_incident(run_stream *s) {
    if (count_event(s, "incident")) {
        const char *end = hn_json_skip(s->incident);
        hn_strbuf_printf(&s->text, "{\"method\":%d,", s->method);
        hn_strbuf_add_n(&s->text, s->incident + 1, (size_t)(end - s->incident - 1));
        hn_strbuf_add(&s->text, "\n\n");
    }
    s->incident = hn_json_next(&s->incidents);
}

static void put_end(run_stream *s) {
    if (count_event(s, "end")) {
        hn_run_put_json(&s->text, s->reader.run, HN_RUN_DONE, false);
        hn_strbuf_add(&s->text, "\n\n");
    }
    s->ended = true;
}

/// The next event of a run that has ended.
static void put_next(run_stream *s) {
    const hn_kept_run *run = s->reader.run;
    if (s->method == run->n) {
        put_end(s);
        return;
    }
    if (!s->rows) {
        begin_method(s);
        return;
    }
    const char *when = s->incident ? hn_json_member(s->incident, "t") : NULL;
    if (s->incident && (!s->has_row || !when || strtod(when, NULL) <= s->t)) {
        put_incident(s);
    } else if (s->has_row) {
        put_sample(s);
    } else {
        hn_sample_rows_free(s->rows);
        s->rows = NULL;
        s->method++;
    }
}

static void put_progress(run_stream *s, hn_run_phase phase) {
    const double now = hn_clock_wall();
    if (now - s->last_progress >= PROGRESS) {
        hn_strbuf_printf(&s->text,
                         "event: progress\ndata: {\"state\":\"%s\",\"progress\":%.3g}\n\n",
                         hn_run_phase_name(phase), atomic_load(&s->reader.run->share));
        s->last_progress = now;
    }
}

static void fill(run_stream *s) {
    const hn_run_phase phase = hn_runs_phase(s->runs, s->reader.run);
    hn_strbuf_clear(&s->text);
    s->at = 0;
    if (!s->said_hello) {
        put_hello(s);
    }
    if (phase < HN_RUN_DONE) {
        put_progress(s, phase);
    }
    if (!s->ended && hn_runs_is_ending(s->runs)) {
        hn_strbuf_add(&s->text,
                      "event: stopping\ndata: {\"detail\":\"the server is shutting down\"}\n\n");
        s->ended = true;
    } else if (!s->ended && (phase == HN_RUN_REFUSED || atomic_load(&s->reader.run->stop))) {
        const bool stopped = atomic_load(&s->reader.run->stop);
        hn_strbuf_printf(&s->text, "event: end\ndata: {\"state\":\"%s\"}\n\n",
                         stopped ? "stopped" : hn_run_phase_name(phase));
        s->ended = true;
    }
    for (s->walked = 0;
         phase == HN_RUN_DONE && !s->ended && s->text.n < CHUNK && s->walked < MOST_WALKED;) {
        put_next(s);
    }
    if (s->text.n == 0 && s->walked > 0) {
        hn_strbuf_add(&s->text, ":\n\n");
    }
}

// ---- callbacks of the HTTP library ----

static ssize_t read_stream(void *cls, uint64_t pos, char *out, size_t size) {
    run_stream *s = cls;
    (void)pos;
    while (s->at == s->text.n) {
        if (s->ended) {
            return MHD_CONTENT_READER_END_OF_STREAM;
        }
        fill(s);
        if (s->text.n == 0 && hn_runs_suspend_reader(s->runs, &s->reader, PROGRESS)) {
            return 0;
        }
        if (s->text.n == 0 && atomic_load(&s->reader.run->stop) && !hn_runs_is_ending(s->runs)) {
            return MHD_CONTENT_READER_END_OF_STREAM;
        }
    }
    if (s->text.failed) {
        return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    const size_t n = s->text.n - s->at < size ? s->text.n - s->at : size;
    memcpy(out, hn_strbuf_text(&s->text) + s->at, n);
    s->at += n;
    return (ssize_t)n;
}

/// Frees a stream that the store does not list.
static void free_stream(run_stream *s) {
    hn_shares_give(s->places, s->client);
    hn_runs_release(s->runs, s->reader.run);
    hn_sample_rows_free(s->rows);
    hn_strbuf_reset(&s->text);
    free(s->fields);
    free(s);
}

static void close_stream(void *cls) {
    run_stream *s = cls;
    hn_runs_remove_reader(s->runs, &s->reader);
    free_stream(s);
}

// ---- opening ----

/// Finds what the query and the header ask for; false with a problem as reply.
static bool read_request(hn_request *r, bool *live, double *last) {
    const char *mode = hn_request_query(r, "mode"), *text = hn_request_header(r, "Last-Event-ID");
    if (mode && strcmp(mode, "live") != 0 && strcmp(mode, "complete") != 0) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, "mode=complete or mode=live",
                         "the mode '%.40s' is unknown", mode);
        return false;
    }
    *live = mode && strcmp(mode, "live") == 0;
    if (text && *text) {
        *last = strtod(text, NULL);
        if (strlen(text) > 15 || text[strspn(text, "0123456789")]) {
            hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL,
                             "the last event id '%.40s' is no number of an event", text);
            return false;
        }
        return true;
    }
    return hn_request_query_number(r, "last_event_id", 0, 1e15, true, last);
}

/// Takes a place and makes the stream, which takes the reference of the run; NULL with a problem as
/// reply.
static run_stream *create_stream(hn_request *r, hn_kept_run *run) {
    hn_context *c = r->context;
    if (!hn_shares_take(c->streams, r->client)) {
        hn_reply_problem(r, HN_PROBLEM_BUSY, "close a stream",
                         "%d streams are open already, or yours have their share of %d",
                         hn_shares_taken(c->streams), c->opts.max_streams);
        hn_reply_header_add(r, "Retry-After", "5");
        return NULL;
    }
    const char *fields = hn_request_query(r, "fields");
    run_stream *s = calloc(1, sizeof *s);
    char *copy = s && fields ? strdup(fields) : NULL;
    if (!s || (fields && !copy)) {
        free(s);
        hn_shares_give(c->streams, r->client);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return NULL;
    }
    *s = (run_stream){
        .reader = {.connection = r->connection, .fd = hn_request_socket(r), .run = run},
        .runs = c->runs,
        .places = c->streams,
        .client = r->client,
        .fields = copy};
    return s;
}

static void reply_stream(hn_request *r, run_stream *s) {
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, CHUNK, read_stream, s, close_stream);
    if (!response) {
        free_stream(s);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return;
    }
    hn_runs_add_reader(s->runs, &s->reader);
    hn_reply_response(r, MHD_HTTP_OK, response);
    r->is_endless = true;
    hn_stream_socket_begin(s->reader.fd);
    hn_reply_header_add(r, "Content-Type", "text/event-stream");
    hn_reply_header_add(r, "Cache-Control", "no-cache");
    hn_reply_header_add(r, "X-Accel-Buffering", "no");
}

/// Passes over what the reader has. Returns false where it has all there is.
static bool skip_seen(run_stream *s) {
    if (s->seen > 0 && hn_runs_phase(s->runs, s->reader.run) == HN_RUN_DONE) {
        while (!s->ended && s->id < s->seen) {
            put_next(s);
        }
        return !s->ended || s->text.n > 0;
    }
    return true;
}

void hn_handle_run_events(hn_request *r) {
    bool live;
    double last = 0;
    hn_kept_run *run = read_request(r, &live, &last) ? hn_run_find(r) : NULL;
    if (!run) {
        return;
    }
    if (r->is_head) {
        hn_runs_release(r->context->runs, run);
        hn_reply_empty(r, MHD_HTTP_OK);
        hn_reply_header_add(r, "Content-Type", "text/event-stream");
        return;
    }
    run_stream *s = create_stream(r, run);
    if (!s) {
        hn_runs_release(r->context->runs, run);
        return;
    }
    s->live = live;
    s->seen = (unsigned long long)last;
    if (skip_seen(s)) {
        reply_stream(r, s);
    } else {
        free_stream(s);
        hn_reply_empty(r, MHD_HTTP_NO_CONTENT);
    }
}
