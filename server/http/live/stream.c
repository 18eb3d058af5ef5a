// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // POLLRDHUP
#include "http/live/stream.h"

#include "base/clock.h"
#include "build.h"
#include "http/ground/stream_socket.h"
#include "http/live/session_state.h"
#include "http/request/context.h"
#include "session/compare/comparison_doc.h"

#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { CHUNK = 1 << 16, SCHEMA = 1 };

struct hn_stream {
    hn_reader reader; ///< first: the session lists it
    hn_session *session;
    int fd;            ///< of the connection, to notice that the reader has gone
    int gone;          ///< 1: it has
    hn_shares *places; ///< its own is given back at the end
    hn_client client;
    uint64_t cursor; ///< id of the event that comes next
    int skips;       ///< mode=live: frames may be left out
    unsigned fields; ///< bit i: hn_frame_extra i is wanted
    int said_hello, said_end;
    double last_sent;
    hn_strbuf text; ///< what is being sent, from `at` on; only the connection's thread touches it
    size_t at;
};

/// 1 when the reader has closed the connection. A suspended one is not looked at by the HTTP
/// library.
static bool has_gone(const hn_stream *s) {
    struct pollfd look = {.fd = s->fd, .events = POLLRDHUP};
    return s->reader.waiting && poll(&look, 1, 0) > 0 && look.revents;
}

void hn_stream_end(hn_reader *reader) {
    hn_stream_socket_end(((hn_stream *)reader)->fd);
    hn_reader_wake(reader);
}

void hn_stream_tick(hn_reader *reader, double now) {
    hn_stream *s = (hn_stream *)reader;
    s->gone |= has_gone(s);
    if (s->gone || now - s->last_sent >= s->session->opts->keep_alive) {
        hn_reader_wake(reader);
    }
}

// ---- writing, with the lock held ----

static void put_hello(hn_stream *s) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "schema", SCHEMA);
    hn_json_put_string(&b, "build", hn_build_name());
    hn_json_key(&b, "description");
    hn_session_put_json(&b, s->session);
    hn_json_end_object(&b);
    hn_strbuf_add(&s->text, "retry: 1000\nevent: hello\ndata: ");
    hn_strbuf_add_n(&s->text, hn_strbuf_text(&b), b.n);
    hn_strbuf_add(&s->text, "\n\n");
    s->text.failed |= b.failed;
    hn_strbuf_reset(&b);
    s->said_hello = 1;
}

static void put_gap(hn_stream *s, uint64_t from, uint64_t to) {
    hn_strbuf_printf(&s->text, "event: gap\ndata: {\"from\":%llu,\"to\":%llu}\n\n",
                     (unsigned long long)from, (unsigned long long)to);
}

static void put_event(hn_stream *s, const hn_event *e) {
    if (!e->data) {
        put_gap(s, e->id, e->id);
        return;
    }
    hn_strbuf_printf(&s->text, "id: %llu\nevent: %s\ndata: ", (unsigned long long)e->id,
                     hn_event_name(e->kind));
    if (e->extra[0] == 0) {
        hn_strbuf_add_n(&s->text, e->data, e->n);
    } else {
        hn_strbuf_add_n(&s->text, e->data, e->extra[0]);
        for (int i = 0; i < HN_FRAME_EXTRAS; i++) {
            const size_t wanted = s->fields >> i & 1 ? e->extra[i + 1] - e->extra[i] : 0;
            hn_strbuf_add_n(&s->text, e->data + e->extra[i], wanted);
        }
        hn_strbuf_add(&s->text, "}");
    }
    hn_strbuf_add(&s->text, "\n\n");
}

/// Writes what has come since the last look, up to a chunk's size.
static void put_new_events(hn_stream *s) {
    const hn_history *h = &s->session->history;
    uint64_t first = hn_history_first_id(h);
    if (s->cursor < first) {
        put_gap(s, s->cursor, first - 1);
        s->cursor = first;
    }
    for (; s->cursor <= h->last_id && s->text.n < CHUNK; s->cursor++) {
        const hn_event *e = hn_history_find(h, s->cursor);
        if (!s->skips || e->kind != HN_EVENT_FRAME || e->id == h->last_frame_id) {
            put_event(s, e);
        }
    }
}

/// The last event of a stream: the comparison was deleted, or the server ends. A reader that lags
/// when the server ends is told what it will not get: there is no time for it.
static void put_last_event(hn_stream *s) {
    const uint64_t last = s->session->history.last_id;
    if (s->session->deleted) {
        hn_strbuf_add(&s->text, "event: end\ndata: {\"deleted\":true}\n\n");
    } else {
        if (s->cursor <= last) {
            put_gap(s, s->cursor, last);
            s->cursor = last + 1;
        }
        hn_strbuf_add(&s->text,
                      "event: stopping\ndata: {\"detail\":\"the server is shutting down\"}\n\n");
    }
    s->said_end = 1;
}

/// 1 when the reader has seen all there will be (until somebody resets the comparison).
static bool is_at_end(const hn_stream *s) {
    return s->session->ending ||
           (s->session->state == HN_SESSION_FINISHED && s->cursor > s->session->history.last_id);
}

static void fill(hn_stream *s) {
    hn_strbuf_clear(&s->text);
    s->at = 0;
    if (!s->said_hello) {
        put_hello(s);
    }
    if (!s->said_end) {
        put_new_events(s);
    }
    const bool is_served = s->session->deleted && s->cursor <= s->session->history.last_id;
    if (s->session->ending && !is_served && !s->said_end) {
        put_last_event(s);
    }
    if (s->text.n == 0 && !is_at_end(s) &&
        hn_clock_wall() - s->last_sent >= s->session->opts->keep_alive) {
        hn_strbuf_add(&s->text, ": still here\n\n");
    }
}

// ---- callbacks of the HTTP library ----

static ssize_t read_stream(void *cls, uint64_t pos, char *out, size_t size) {
    hn_stream *s = cls;
    (void)pos;
    if (s->at == s->text.n) {
        hn_session *session = s->session;
        pthread_mutex_lock(&session->lock);
        if (s->gone) {
            pthread_mutex_unlock(&session->lock);
            return MHD_CONTENT_READER_END_WITH_ERROR;
        }
        fill(s);
        int ended = s->text.n == 0 && is_at_end(s);
        if (s->text.n == 0 && !ended) {
            // under the lock: whoever has news wakes a connection that is already suspended
            s->reader.waiting = 1;
            MHD_suspend_connection(s->reader.connection);
        } else {
            s->last_sent = hn_clock_wall();
        }
        pthread_mutex_unlock(&session->lock);
        if (ended) {
            return MHD_CONTENT_READER_END_OF_STREAM;
        }
    }

    // what is left of the text
    if (s->text.failed) {
        return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    size_t n = s->text.n - s->at < size ? s->text.n - s->at : size;
    memcpy(out, hn_strbuf_text(&s->text) + s->at, n);
    s->at += n;
    return (ssize_t)n;
}

static void close_stream(void *cls) {
    hn_stream *s = cls;
    hn_session *session = s->session;
    pthread_mutex_lock(&session->lock);
    hn_reader **place = &session->readers;
    while (*place != &s->reader) {
        place = &(*place)->next;
    }
    *place = s->reader.next;
    session->n_streams--;
    session->touched = hn_clock_wall();
    pthread_mutex_unlock(&session->lock);
    hn_shares_give(s->places, s->client);
    hn_strbuf_reset(&s->text);
    free(s);
    hn_session_release(session);
}

// ---- opening ----

/// Last-Event-ID (a header, or last_event_id in the query); -1 when not given, -2 when it is no
/// number.
static long long read_last_id(const hn_request *r) {
    const char *text = hn_request_header(r, "Last-Event-ID");
    if (!text || !*text) {
        text = hn_request_query(r, "last_event_id");
    }
    if (!text || !*text) {
        return -1;
    }
    size_t n = strlen(text);
    return n <= 18 && strspn(text, "0123456789") == n ? strtoll(text, NULL, 10) : -2;
}

/// Chooses where to begin. With the lock held; 0 when the reply is made here.
static bool choose_cursor(hn_stream *s, hn_request *r, long long last) {
    const hn_history *h = &s->session->history;
    if (last == -2 || (last >= 0 && (uint64_t)last > h->last_id)) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL,
                         "the last event id must be a number up to %llu, the newest event here",
                         (unsigned long long)h->last_id);
        return false;
    }
    s->cursor = last >= 0  ? (uint64_t)last + 1
                : s->skips ? h->last_frame_id
                           : hn_history_first_id(h);
    if (last >= 0 && is_at_end(s)) {
        hn_reply_empty(r, MHD_HTTP_NO_CONTENT);
        return false;
    }
    return true;
}

/// The extras of a frame that the query names; 0 with a problem as reply.
static bool read_fields(hn_request *r, unsigned *fields) {
    const char *at = hn_request_query(r, "fields");
    *fields = 0;
    while (at && *at) {
        const size_t n = strcspn(at, ",");
        int i = 0;
        while (i < HN_FRAME_EXTRAS &&
               (strlen(hn_frame_extra_name((hn_frame_extra)i)) != n ||
                memcmp(hn_frame_extra_name((hn_frame_extra)i), at, n) != 0)) {
            i++;
        }
        if (i == HN_FRAME_EXTRAS) {
            hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, "fields=sigma_min,lambda,condition",
                             "'%.*s' cannot be added to a frame", (int)(n < 40 ? n : 40), at);
            return false;
        }
        *fields |= 1U << i;
        at += n + (at[n] == ',');
    }
    return true;
}

static void reply_stream(hn_stream *s, hn_request *r) {
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, CHUNK, read_stream, s, close_stream);
    if (!response) {
        close_stream(s);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return;
    }
    hn_reply_response(r, MHD_HTTP_OK, response);
    r->is_endless = true;
    hn_stream_socket_begin(s->fd);
    hn_reply_header_add(r, "Content-Type", "text/event-stream");
    hn_reply_header_add(r, "Cache-Control", "no-cache");
    hn_reply_header_add(r, "X-Accel-Buffering", "no");
}

/// Puts the stream on the comparison's list; 0 when the reply is made here.
static int attach(hn_stream *s, hn_request *r) {
    hn_session *session = s->session;
    pthread_mutex_lock(&session->lock);
    session->touched = hn_clock_wall();
    int open = choose_cursor(s, r, read_last_id(r));
    if (open) {
        session->refs++;
        session->n_streams++;
        pthread_cond_signal(&session->wake); // it may wait for a reader
        session->had_streams = 1;
        s->reader.next = session->readers;
        session->readers = &s->reader;
    }
    pthread_mutex_unlock(&session->lock);
    return open;
}

/// Takes a place and makes the stream; NULL with a problem as reply.
static hn_stream *create_stream(hn_session *session, hn_request *r, int skips) {
    hn_shares *places = r->context->streams;
    if (!hn_shares_take(places, r->client)) {
        hn_reply_problem(r, HN_PROBLEM_BUSY, "close a stream",
                         "all streams are in use (%d), or your client has its share of %d",
                         hn_shares_taken(places), session->opts->max_streams);
        hn_reply_header_add(r, "Retry-After", "5");
        return NULL;
    }
    hn_stream *s = calloc(1, sizeof *s);
    if (!s) {
        hn_shares_give(places, r->client);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return NULL;
    }

    // it joins the session's list later
    *s = (hn_stream){.session = session,
                     .reader = {.connection = r->connection},
                     .fd = hn_request_socket(r),
                     .places = places,
                     .client = r->client,
                     .skips = skips,
                     .last_sent = hn_clock_wall()};
    return s;
}

void hn_stream_open(hn_session *session, hn_request *r) {
    // what the query asks for
    const char *mode = hn_request_query(r, "mode");
    if (mode && strcmp(mode, "live") != 0 && strcmp(mode, "complete") != 0) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, "mode=complete or mode=live",
                         "the mode '%.40s' is unknown", mode);
        return;
    }
    unsigned fields;
    if (!read_fields(r, &fields)) {
        return;
    }
    if (r->is_head) {
        hn_reply_empty(r, MHD_HTTP_OK);
        hn_reply_header_add(r, "Content-Type", "text/event-stream");
        return;
    }

    // a stream that is not attached gives its place back
    hn_stream *s = create_stream(session, r, mode && strcmp(mode, "live") == 0);
    if (s) {
        s->fields = fields;
    }
    if (s && attach(s, r)) {
        reply_stream(s, r);
    } else if (s) {
        hn_shares_give(s->places, s->client);
        free(s);
    }
}
