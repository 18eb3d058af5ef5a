// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FUZZ_STAND_IN_H
#define HN_FUZZ_STAND_IN_H
// A stand-in for libmicrohttpd, without sockets and event loops: it reads a head in memory as the
// library does (one buffer, zeros in place of the ends of names, values and lines, %XX decoded in
// place), calls the callbacks of the server and keeps the answer. What the library itself refuses
// is not passed on.

#include "http/routes/dispatch.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct hn_stand_in_request {
    const uint8_t *head; ///< with the empty line at its end
    size_t n_head;
    const char *body; ///< NULL: none
    const struct sockaddr *from;
    /// Whether the work on a request whose head was accepted is to be done; NULL: always.
    bool (*is_wanted)(const struct hn_request *r);
} hn_stand_in_request;

typedef struct hn_stand_in_answer {
    unsigned status; ///< 0: the library refused the head, or the work was not wanted
    bool is_json;
    hn_strbuf location; ///< the header, empty where there is none
    hn_strbuf text;     ///< of a stream its first bytes
} hn_stand_in_answer;

/// Puts the stand-in where the server looks for the library.
void hn_stand_in_start(void);
/// Does one request. Fails where an answer breaks a rule of HTTP: a header with a control
/// character, a body where there may be none, no answer at all.
void hn_stand_in_ask(hn_dispatch *d, const hn_stand_in_request *request, hn_stand_in_answer *out);
void hn_stand_in_answer_reset(hn_stand_in_answer *answer);
#endif
