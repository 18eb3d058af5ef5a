// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/early_answer.h"

#include "http/ground/closing_head.h"

#include <sys/socket.h>

enum { MAX_PIECES = 64 }; // of 4 kB: more than a head has

void hn_answer_early(hn_request *r) {
    HN_ASSERT(r->stage == HN_STAGE_ANSWERED && !r->response);
    hn_strbuf answer;
    hn_strbuf_init(&answer);
    hn_closing_head_put(&answer, r->status, r->media_type ? r->media_type : "text/plain",
                        r->text.n);
    for (int i = 0; i < r->n_headers; i++) {
        if (!hn_closing_head_has(r->headers[i].name)) {
            hn_strbuf_printf(&answer, "%s: %s\r\n", r->headers[i].name, r->headers[i].value);
        }
    }
    hn_strbuf_add(&answer, "\r\n");
    hn_strbuf_add_n(&answer, hn_strbuf_text(&r->text), r->text.n);

    // it fits into what the system keeps for a socket; a client that has gone needs none
    const int fd = hn_request_socket(r);
    if (fd >= 0 && !answer.failed) {
        const ssize_t sent =
            send(fd, hn_strbuf_text(&answer), answer.n, MSG_DONTWAIT | MSG_NOSIGNAL);
        (void)sent;
    }
    hn_strbuf_reset(&answer);
    r->stage = HN_STAGE_SENT;
}

static void drain(int fd) {
    char piece[4096];
    for (int i = 0; i < MAX_PIECES && recv(fd, piece, sizeof piece, MSG_DONTWAIT) > 0; i++) {}
    shutdown(fd, SHUT_RDWR);
}

void hn_request_drain(const hn_request *r) {
    drain(hn_request_socket(r));
}

void hn_answer_last(int fd, const char *bytes, size_t n) {
    const ssize_t sent = send(fd, bytes, n, MSG_DONTWAIT | MSG_NOSIGNAL);
    (void)sent; // a client that has gone needs no answer
    drain(fd);
}
