// SPDX-License-Identifier: GPL-3.0-or-later
#define HN_MICROHTTPD_OWN_NAMES // of the library itself, not of the loaded functions
#include "fuzz/stand_in.h"

#include "fuzz/fuzz.h"
#include "http/request/request.h"

#include <ctype.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { MOST_PAIRS = 400, MOST_HEADERS = 32 };
enum { PIECE = 4096, MOST_PIECES = 64 }; ///< of a stream

typedef struct pair {
    enum MHD_ValueKind kind;
    const char *key, *value;
} pair;

struct MHD_Response {
    int refs;
    char *bytes; ///< of a text; freed with it
    size_t n;
    bool is_ours;
    int fd; ///< of a file; -1: none
    MHD_ContentReaderCallback read;
    MHD_ContentReaderFreeCallback free;
    void *user;
    int n_headers;
    pair header[MOST_HEADERS]; ///< of copies
};

struct MHD_Connection {
    char *buffer, *cookies;
    size_t n, header_size;
    const char *method, *url, *version;
    int n_pairs;
    pair pair[MOST_PAIRS];
    const struct sockaddr *from;
    union MHD_ConnectionInfo info;
    bool is_suspended; ///< under the lock
    unsigned status;
    struct MHD_Response *response;
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t resumed = PTHREAD_COND_INITIALIZER;

// ---- what the server calls: answers ----

static struct MHD_Response *new_response(void) {
    struct MHD_Response *response = calloc(1, sizeof *response);
    if (!response) {
        hn_fuzz_fail("no memory");
    }
    response->refs = 1;
    response->fd = -1;
    return response;
}

static struct MHD_Response *from_buffer(size_t n, void *bytes, enum MHD_ResponseMemoryMode mode) {
    struct MHD_Response *response = new_response();
    response->bytes = bytes;
    response->n = n;
    response->is_ours = mode == MHD_RESPMEM_MUST_FREE;
    return response;
}

static struct MHD_Response *from_callback(uint64_t size, size_t block,
                                          MHD_ContentReaderCallback read, void *user,
                                          MHD_ContentReaderFreeCallback end) {
    struct MHD_Response *response = new_response();
    (void)size;
    (void)block;
    response->read = read;
    response->free = end;
    response->user = user;
    return response;
}

static struct MHD_Response *from_fd(size_t size, int fd) {
    struct MHD_Response *response = new_response();
    response->n = size;
    response->fd = fd;
    return response;
}

static void destroy(struct MHD_Response *response) {
    if (--response->refs > 0) {
        return;
    }
    if (response->free) {
        response->free(response->user);
    }
    if (response->is_ours) {
        free(response->bytes);
    }
    if (response->fd >= 0) {
        close(response->fd);
    }
    for (int i = 0; i < response->n_headers; i++) {
        free((char *)response->header[i].key);
        free((char *)response->header[i].value);
    }
    free(response);
}

/// A value with a control character would end the head, or begin another header; one that is empty
/// the library does not send.
static enum MHD_Result add_header(struct MHD_Response *response, const char *name,
                                  const char *value) {
    for (const char *at = value; *at; at++) {
        if (iscntrl((unsigned char)*at) && *at != '\t') {
            hn_fuzz_fail("the header %s has the byte %d", name, *at);
        }
    }
    if (!*value || response->n_headers == MOST_HEADERS) {
        hn_fuzz_fail("the header %s is empty, or one of too many", name);
    }
    response->header[response->n_headers++] = (pair){.key = strdup(name), .value = strdup(value)};
    return MHD_YES;
}

static const char *get_response_header(struct MHD_Response *response, const char *key) {
    for (int i = 0; i < response->n_headers; i++) {
        if (strcasecmp(response->header[i].key, key) == 0) {
            return response->header[i].value;
        }
    }
    return NULL;
}

static enum MHD_Result queue_response(struct MHD_Connection *c, unsigned status,
                                      struct MHD_Response *response) {
    if (c->response || status < 200 || status > 599) {
        hn_fuzz_fail("a second answer, or the status %u", status);
    }
    c->status = status;
    c->response = response;
    response->refs++;
    return MHD_YES;
}

// ---- what the server calls: requests ----

static const union MHD_ConnectionInfo *get_info(struct MHD_Connection *c,
                                                enum MHD_ConnectionInfoType type, ...) {
    switch (type) {
    case MHD_CONNECTION_INFO_CONNECTION_FD:
        c->info.connect_fd = -1;
        return &c->info;
    case MHD_CONNECTION_INFO_CLIENT_ADDRESS:
        c->info.client_addr = (struct sockaddr *)(uintptr_t)c->from;
        return &c->info;
    case MHD_CONNECTION_INFO_REQUEST_HEADER_SIZE:
        c->info.header_size = c->header_size;
        return &c->info;
    default:
        return NULL;
    }
}

static int get_values(struct MHD_Connection *c, enum MHD_ValueKind kind, MHD_KeyValueIterator see,
                      void *user) {
    int n = 0;
    for (int i = 0; i < c->n_pairs; i++) {
        if (c->pair[i].kind == kind) {
            n++;
            if (see && see(user, kind, c->pair[i].key, c->pair[i].value) == MHD_NO) {
                break;
            }
        }
    }
    return n;
}

static const char *lookup(struct MHD_Connection *c, enum MHD_ValueKind kind, const char *key) {
    for (int i = 0; i < c->n_pairs; i++) {
        if (c->pair[i].kind == kind && strcasecmp(c->pair[i].key, key) == 0) {
            return c->pair[i].value;
        }
    }
    return NULL;
}

static void suspend(struct MHD_Connection *c) {
    pthread_mutex_lock(&lock);
    c->is_suspended = true;
    pthread_mutex_unlock(&lock);
}

static void resume(struct MHD_Connection *c) {
    pthread_mutex_lock(&lock);
    c->is_suspended = false;
    pthread_cond_broadcast(&resumed);
    pthread_mutex_unlock(&lock);
}

void hn_stand_in_start(void) {
    hn_microhttpd_functions = (hn_microhttpd){.MHD_add_response_header = add_header,
                                              .MHD_create_response_from_buffer = from_buffer,
                                              .MHD_create_response_from_callback = from_callback,
                                              .MHD_create_response_from_fd = from_fd,
                                              .MHD_destroy_response = destroy,
                                              .MHD_get_connection_info = get_info,
                                              .MHD_get_connection_values = get_values,
                                              .MHD_get_response_header = get_response_header,
                                              .MHD_lookup_connection_value = lookup,
                                              .MHD_queue_response = queue_response,
                                              .MHD_resume_connection = resume,
                                              .MHD_suspend_connection = suspend};
}

// ---- reading a head ----

static bool add_pair(struct MHD_Connection *c, enum MHD_ValueKind kind, const char *key,
                     const char *value) {
    if (c->n_pairs == MOST_PAIRS) {
        return false;
    }
    c->pair[c->n_pairs++] = (pair){kind, key, value};
    return true;
}

/// Decodes %XX in place; what is no such code stays.
static void unescape(char *text) {
    char *out = text;
    while (*text) {
        if (text[0] == '%' && isxdigit((unsigned char)text[1]) &&
            isxdigit((unsigned char)text[2])) {
            const char digits[] = {text[1], text[2], 0};
            *out++ = (char)strtol(digits, NULL, 16);
            text += 3;
        } else {
            *out++ = *text++;
        }
    }
    *out = 0;
}

static void unescape_argument(char *text) {
    for (char *at = text; *at; at++) {
        *at = *at == '+' ? ' ' : *at;
    }
    unescape(text);
}

static bool read_arguments(struct MHD_Connection *c, char *text) {
    while (text) {
        char *next = strchr(text, '&');
        if (next) {
            *next++ = 0;
        }
        char *value = strchr(text, '=');
        if (value) {
            *value++ = 0;
            unescape_argument(value);
        }
        unescape_argument(text);
        if (!add_pair(c, MHD_GET_ARGUMENT_KIND, text, value)) {
            return false;
        }
        text = next;
    }
    return true;
}

/// name=value; name="value"; ...
static bool read_cookies(struct MHD_Connection *c, const char *text) {
    c->cookies = strdup(text);
    for (char *at = c->cookies, *next; at && *at; at = next) {
        next = strchr(at, ';');
        if (next) {
            *next++ = 0;
        }
        at += strspn(at, " \t");
        char *value = strchr(at, '=');
        if (value) {
            *value++ = 0;
            value += value[0] == '"';
            value[strcspn(value, "\"")] = 0;
        }
        if (!add_pair(c, MHD_COOKIE_KIND, at, value ? value : "")) {
            return false;
        }
    }
    return true;
}

/// Takes a line off the buffer: CR LF, or either of them, ends it and becomes zeros. NULL where no
/// end has come.
static char *take_line(struct MHD_Connection *c, size_t *at, size_t *n) {
    const size_t start = *at;
    while (*at < c->n && c->buffer[*at] != '\r' && c->buffer[*at] != '\n') {
        ++*at;
    }
    if (*at == c->n) {
        return NULL;
    }
    *n = *at - start;
    const bool is_pair = c->buffer[*at] == '\r' && *at + 1 < c->n && c->buffer[*at + 1] == '\n';
    c->buffer[(*at)++] = 0;
    if (is_pair) {
        c->buffer[(*at)++] = 0;
    }
    return c->buffer + start;
}

/// "GET /path HTTP/1.1"; the address may hold blanks.
static bool read_first_line(hn_dispatch *d, struct MHD_Connection *c, char *line, size_t n,
                            struct hn_request **r) {
    char *uri = memchr(line, ' ', n), *version = line + n;
    if (!uri) {
        return false;
    }
    *uri++ = 0;
    uri += strspn(uri, " ");
    while (version > uri && version[-1] != ' ') {
        version--;
    }
    if (version <= uri || (strcmp(version, "HTTP/1.1") != 0 && strcmp(version, "HTTP/1.0") != 0)) {
        return false;
    }
    version[-1] = 0;
    c->method = line;
    c->version = version;
    *r = hn_dispatch_address(d, uri, c);

    char *arguments = strchr(uri, '?');
    if (arguments) {
        *arguments++ = 0;
    }
    const bool fits = read_arguments(c, arguments);
    unescape(uri);
    c->url = uri;
    return fits;
}

static bool read_header(struct MHD_Connection *c, char *line) {
    char *value = strchr(line, ':');
    if (!value) {
        return false;
    }
    *value++ = 0;
    value += strspn(value, " \t");
    return add_pair(c, MHD_HEADER_KIND, line, value) &&
           (strcasecmp(line, "Cookie") != 0 || c->cookies || read_cookies(c, value));
}

/// Returns whether the library would call the server with this head.
static bool read_head(hn_dispatch *d, struct MHD_Connection *c, struct hn_request **r) {
    size_t at = 0, n;
    char *line = take_line(c, &at, &n);
    if (!line || !read_first_line(d, c, line, n, r)) {
        return false;
    }
    while ((line = take_line(c, &at, &n)) && line[0]) {
        if (line[0] == ' ' || line[0] == '\t' || !read_header(c, line)) {
            return false; // a line that goes on would be kept elsewhere
        }
    }
    c->header_size = at;
    return line != NULL;
}

// ---- a request ----

static void await(struct MHD_Connection *c) {
    pthread_mutex_lock(&lock);
    while (c->is_suspended) {
        pthread_cond_wait(&resumed, &lock);
    }
    pthread_mutex_unlock(&lock);
}

/// The calls of the library: with the head, with the body, and until there is an answer.
static void serve(hn_dispatch *d, struct MHD_Connection *c, const hn_stand_in_request *q,
                  struct hn_request **r) {
    size_t n = 0;
    if (hn_dispatch_request(d, c, c->url, c->method, c->version, NULL, &n, (void **)r) == MHD_NO ||
        c->response || (q->is_wanted && (*r)->stage == HN_STAGE_BODY && !q->is_wanted(*r))) {
        return;
    }
    n = q->body ? strlen(q->body) : 0;
    if (n > 0) {
        hn_dispatch_request(d, c, c->url, c->method, c->version, q->body, &n, (void **)r);
    }
    bool goes_on = true;
    while (goes_on && !c->response) {
        n = 0;
        goes_on = hn_dispatch_request(d, c, c->url, c->method, c->version, NULL, &n, (void **)r);
        await(c);
    }
    if (!c->response && (*r)->stage != HN_STAGE_SENT) {
        hn_fuzz_fail("no answer");
    }
}

static void read_stream(struct MHD_Connection *c, hn_strbuf *text) {
    char piece[PIECE];
    ssize_t n = 1;
    for (int i = 0; i < MOST_PIECES && n > 0; i++) {
        n = c->response->read(c->response->user, text->n, piece, sizeof piece);
        hn_strbuf_add_n(text, piece, n > 0 ? (size_t)n : 0);
    }
}

static void keep_answer(struct MHD_Connection *c, hn_stand_in_answer *out) {
    struct MHD_Response *response = c->response;
    const char *type = get_response_header(response, "Content-Type");
    const char *location = get_response_header(response, "Location");
    out->status = c->status;
    out->is_json = type && strstr(type, "json") && !strstr(type, "ndjson") &&
                   !get_response_header(response, "Content-Encoding");
    hn_strbuf_add(&out->location, location ? location : "");
    if (response->read) {
        read_stream(c, &out->text);
    } else if (response->bytes) {
        hn_strbuf_add_n(&out->text, response->bytes, response->n);
    }
    if ((c->status == MHD_HTTP_NO_CONTENT || c->status == MHD_HTTP_NOT_MODIFIED) &&
        out->text.n > 0) {
        hn_fuzz_fail("%u with a body", c->status);
    }
}

void hn_stand_in_ask(hn_dispatch *d, const hn_stand_in_request *q, hn_stand_in_answer *out) {
    struct MHD_Connection *c = calloc(1, sizeof *c);
    struct hn_request *r = NULL;
    if (!c) {
        hn_fuzz_fail("no memory");
    }
    *out = (hn_stand_in_answer){0};
    hn_strbuf_init(&out->location);
    hn_strbuf_init(&out->text);
    c->buffer = hn_fuzz_text(q->head, q->n_head);
    c->n = q->n_head;
    c->from = q->from;
    if (read_head(d, c, &r)) {
        serve(d, c, q, &r);
    }
    if (c->response) {
        keep_answer(c, out);
    }
    if (r) {
        hn_dispatch_completed(d, c, (void **)&r, MHD_REQUEST_TERMINATED_COMPLETED_OK);
    }
    if (c->response) {
        destroy(c->response);
    }
    free(c->cookies);
    free(c->buffer);
    free(c);
}

void hn_stand_in_answer_reset(hn_stand_in_answer *answer) {
    hn_strbuf_reset(&answer->location);
    hn_strbuf_reset(&answer->text);
}
