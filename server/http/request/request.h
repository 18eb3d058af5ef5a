// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_REQUEST_H
#define HN_HTTP_REQUEST_H
// One HTTP request from its first header to its last byte. The server creates it, a handler (a
// function of the table of routes) fills in the reply, and the callback that libmicrohttpd makes at
// the end frees it; nothing else may. A handler reads and writes this struct only.

#include "base/diag.h"
#include "base/interrupt.h"
#include "base/strbuf.h"
#include "http/ground/jobs.h"
#include "http/ground/microhttpd.h"
#include "http/ground/problem_document.h"
#include "http/ground/shares.h"
#include "http/request/route.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum { HN_MAX_REPLY_HEADERS = 10 };
/// Bytes of an address, and parameters of its query: as many as a scene may have, and some more.
enum { HN_MAX_ADDRESS = 8000, HN_MAX_PARAMETERS = 256 };
/// For a head, and what the library makes of it: 72 bytes and more for each parameter and header.
enum { HN_HEAD_BYTES = 64 << 10 };

struct hn_context;
struct hn_kept_text;

typedef struct hn_reply_header {
    const char *name; ///< static text
    char value[HN_HEADER_TEXT];
} hn_reply_header;

typedef enum hn_request_stage {
    HN_STAGE_BODY,     ///< the body is coming in
    HN_STAGE_WAITING,  ///< suspended until a worker has the reply
    HN_STAGE_ANSWERED, ///< the reply is there
    HN_STAGE_SENT      ///< the reply has been sent while the body, or the address, still came in
} hn_request_stage;

typedef struct hn_request {
    struct hn_context *context;
    struct MHD_Connection *connection;
    hn_request_stage stage;
    hn_client client;                  ///< who asks, for places
    hn_client queues_as;               ///< who asks, for queues; see client.h
    struct hn_connection_watch *watch; ///< deadlines of the connection; may be NULL
    const hn_route *route;
    bool is_head;
    char path[HN_HEADER_TEXT];                ///< as asked, cut when longer (for messages)
    char parts[HN_MAX_PARTS][HN_HEADER_TEXT]; ///< what stood for {id} ... in the path
    char *body;
    size_t n_body, body_cap, body_dropped;
    bool has_begun;          ///< the head is complete
    bool has_zero;           ///< the address holds a zero byte
    const char *address_end; ///< in the library's buffer, until the head is complete
    const char *head;        ///< its first byte in the library's buffer
    double drain_until; ///< stage SENT: the rest of the body is read until then [s, wall clock]
    cJSON *json;        ///< the parsed body, when the route takes fields
    struct hn_request *next; ///< in a queue
    double wait_until;       ///< in a queue of those who wait for a run [s, wall clock]
    int is_new;              ///< it has begun what it asks for
    double cpu_end;          ///< of the thread that works on it [s]
    hn_job_turn *turn;       ///< of that thread; NULL where it is no pool's
    /// The library was asked to come again at the end of the request. A connection that is
    /// suspended at the first call is read when it is resumed, before its answer is sent: one whose
    /// client has closed its own side would be closed then, without its answer.
    bool is_whole;
    bool interrupted;   ///< the work was ended early
    bool takes_interim; ///< HTTP/1.1: an answer 100 may come before the answer
    bool was_probed;    ///< it was sent one, to see whether its client is still there
    bool is_left;       ///< its client has gone; of the thread that works on it
    double next_look;   ///< that thread looks for the client then [s, wall clock]
    bool has_place;     ///< it has waited for a place, and has it

    // the reply
    long long n_unread; ///< bytes of the answer that count as unread, until it is completed
    unsigned status;
    const char *media_type; ///< static text
    hn_strbuf text;
    struct MHD_Response *response; ///< instead of `text`: a stream, a file
    bool is_endless;               ///< `response` is a stream
    int n_headers;
    hn_reply_header headers[HN_MAX_REPLY_HEADERS];
} hn_request;

/// The query argument, or NULL. Light routes and heavy ones alike.
const char *hn_request_query(const hn_request *r, const char *name);
/// Reads a number of the query from `low` to `high`, whole if asked; *out stays where it is not
/// given. Returns false with a problem as reply.
bool hn_request_query_number(hn_request *r, const char *name, double low, double high, bool whole,
                             double *out);
int hn_request_socket(const hn_request *r); ///< descriptor of the connection, -1 if unknown
const char *hn_request_header(const hn_request *r, const char *name);
/// Calls `see` for each argument `name=value` of the query in turn; stops when it returns not
/// HN_OK, and returns that.
HN_MUST_CHECK hn_status hn_request_each_query(const hn_request *r, const char *name,
                                              hn_status (*see)(void *user, const char *value),
                                              void *user);

/// Returns whether the client of a suspended request has closed its connection. The HTTP library
/// does not check the connection of a suspended request. A client that has closed its own side only
/// still waits: it is sent a "100 Continue", which a connection that is closed refuses, so that the
/// next look tells them apart. One that speaks HTTP/1.0 cannot be asked: it counts as there, unless
/// its system has refused something.
bool hn_request_is_left(hn_request *r);
/// The same, and waits for the answer of a client's system where that is needed: 50 ms at most. Not
/// for a thread that serves others, nor under a lock. A reply to ended work then says that the
/// client has gone.
bool hn_request_has_been_left(hn_request *r);

/// Adds a header to the reply; the value is printed as by printf().
void hn_reply_header_add(hn_request *r, const char *name, const char *format, ...) HN_PRINTF(3, 4);
/// Takes the buffer's text (the buffer is empty afterwards). A buffer whose memory ran out becomes
/// a problem.
void hn_reply_json(hn_request *r, unsigned status, hn_strbuf *text);
void hn_reply_bytes(hn_request *r, unsigned status, const char *media_type, hn_strbuf *bytes);
/// Replies with a JSON document that never changes. The first such request makes it by `put`.
void hn_reply_kept(hn_request *r, struct hn_kept_text *kept,
                   void (*put)(hn_strbuf *b, const struct hn_context *c));
void hn_reply_empty(hn_request *r, unsigned status);
/// Takes the response.
void hn_reply_response(hn_request *r, unsigned status, struct MHD_Response *response);
void hn_reply_problem(hn_request *r, hn_http_problem kind, const char *hint, const char *format,
                      ...) HN_PRINTF(4, 5);
/// Counts an answer of about n bytes as unread before it is made. Returns false where it would be
/// one too many of those that wait for their readers: the reply is then a problem, and the slowest
/// reader is given up. An answer that waits for nobody else is never too large.
HN_MUST_CHECK bool hn_request_may_answer(hn_request *r, size_t n);
/// Counts the bytes of the answer that is there, in place of what was counted for it before.
void hn_request_count_answer(hn_request *r);
/// A pool has not taken the request: its queue is full, in all or for this client.
void hn_reply_queue_full(hn_request *r, hn_jobs *jobs);
/// HN_ERR_INPUT and its like become 422 with errors[], a fault of the program 500.
void hn_reply_diags(hn_request *r, hn_status status, const hn_diags *diags);

/// Extends the computing time of the thread that works on the request by `run_cpu_s`.
void hn_request_add_time(hn_request *r);
/// The question of the work on this request: whether the computing time is used up, the server
/// ends, or the client has gone. The reply to what was ended early is then a problem that says
/// which.
hn_interrupt hn_request_interrupt(hn_request *r);
/// The question of work that has a time of its own: whether the server ends, or the client has
/// gone. `request` is a hn_request. It makes way for others too, as the question above does.
int hn_request_is_unwanted(void *request);

/// Parses the body and checks it against the fields of the route. Returns 0 with a problem as
/// reply. Cost: the length of the body; not for the connection's thread. A body that was read is
/// not read again.
int hn_request_read_body(hn_request *r);
/// Suspends the connection: from here on another thread owns the request, until
/// hn_request_finish().
void hn_request_suspend(hn_request *r);
/// Hands an answered request back to the connection's thread, which sends the reply.
void hn_request_finish(hn_request *r);
/// Frees the request and everything that it holds.
void hn_request_free(hn_request *r);
#endif
