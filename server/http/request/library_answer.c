// SPDX-License-Identifier: GPL-3.0-or-later
#define HN_MICROHTTPD_OWN_NAMES // the exported function bears the library's name
#include "http/request/library_answer.h"

#include "base/strbuf.h"
#include "build.h"
#include "http/ground/closing_head.h"
#include "http/ground/problem_document.h"
#include "http/request/early_answer.h"

#include <stdbool.h>
#include <stddef.h>

/// Refusals of the library, by the status of its answer.
static const struct {
    unsigned status;
    hn_http_problem kind;
    const char *detail;
} REFUSALS[] = {
    {400, HN_PROBLEM_BAD_REQUEST,
     "the request line, a header, the length or a chunk of the body breaks a rule of HTTP"},
    {413, HN_PROBLEM_TOO_LARGE, "the body is longer than the server accepts for any address"},
    {414, HN_PROBLEM_ADDRESS, "the address is longer than the head of a request may be"},
    {431, HN_PROBLEM_HEAD, "the head is longer than 64 kB"},
    {500, HN_PROBLEM_INTERNAL, "the HTTP library could not serve the request"},
    {505, HN_PROBLEM_VERSION, "the request line does not end in HTTP/1.0 or HTTP/1.1"},
};

/// The library finds itself at fault where its buffer is full of what no handler has taken. The
/// server takes all of a body that comes: only the line before a chunk can be so long.
static unsigned find_status(struct MHD_Connection *connection, unsigned status) {
    const bool is_chunked = hn_microhttpd_functions.MHD_lookup_connection_value(
                                connection, MHD_HEADER_KIND, "Transfer-Encoding") != NULL;
    return status == 500 && is_chunked ? 400 : status;
}

/// The problem document of a status; empty where the library's page has to do.
static void put_document(hn_strbuf *b, unsigned status) {
    for (size_t i = 0; i < sizeof REFUSALS / sizeof *REFUSALS; i++) {
        if (REFUSALS[i].status == status) {
            hn_http_problem_json(b, REFUSALS[i].kind, REFUSALS[i].detail, NULL, NULL, -1, NULL);
        }
    }
}

/// The library's answer with the document in place of its page.
static enum MHD_Result queue(struct MHD_Connection *connection, unsigned status,
                             const hn_strbuf *document) {
    const hn_microhttpd *f = &hn_microhttpd_functions;
    struct MHD_Response *response = f->MHD_create_response_from_buffer(
        document->n, (void *)hn_strbuf_text(document), MHD_RESPMEM_MUST_COPY);
    if (!response) {
        return MHD_NO;
    }
    f->MHD_add_response_header(response, "Content-Type", "application/problem+json");
    f->MHD_add_response_header(response, "Holonom-Build", hn_build_name());
    f->MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    f->MHD_add_response_header(response, "Cache-Control", "no-store");
    const enum MHD_Result queued = f->MHD_queue_response(connection, status, response);
    f->MHD_destroy_response(response);
    return queued;
}

/// A length at fault. The library sends the head of such an answer twice, so that no client can
/// read it: it is written to the socket here, and the library is left to close the connection.
static enum MHD_Result answer_and_close(struct MHD_Connection *connection, unsigned status,
                                        const hn_strbuf *document) {
    const union MHD_ConnectionInfo *info = hn_microhttpd_functions.MHD_get_connection_info(
        connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_closing_head_put(&b, status, "application/problem+json", document->n);
    hn_strbuf_printf(&b, "\r\n%s", hn_strbuf_text(document));
    if (info && !b.failed) {
        hn_answer_last(info->connect_fd, hn_strbuf_text(&b), b.n);
    }
    hn_strbuf_reset(&b);
    return MHD_NO;
}

enum MHD_Result MHD_queue_response(struct MHD_Connection *connection, unsigned queued_status,
                                   struct MHD_Response *page) {
    const hn_microhttpd *f = &hn_microhttpd_functions;
    const unsigned status = find_status(connection, queued_status);
    hn_strbuf document;
    hn_strbuf_init(&document);
    put_document(&document, status);
    const bool has_text = document.n > 0 && !document.failed;
    const bool has_length =
        f->MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Content-Length") != NULL;
    const enum MHD_Result queued = !has_text    ? f->MHD_queue_response(connection, status, page)
                                   : has_length ? answer_and_close(connection, status, &document)
                                                : queue(connection, status, &document);
    hn_strbuf_reset(&document);
    return queued;
}
