// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PROBLEM_H
#define HN_HTTP_PROBLEM_H
// Problem documents (RFC 9457): one table of kinds; each kind has one status, one title and a page
// about it under /api/v1/errors/.

#include "base/diag.h"
#include "base/strbuf.h"

/// kind, status, code, title, what it means
#define HN_PROBLEM_LIST(X)                                                                         \
    X(HN_PROBLEM_BAD_REQUEST, 400, "bad-request", "The request cannot be read",                    \
      "The request line, a header or the query breaks a rule of HTTP or of this API; the detail "  \
      "names it.")                                                                                 \
    X(HN_PROBLEM_BAD_JSON, 400, "bad-json", "The body is not JSON",                                \
      "The detail and the member `offset` name the byte at which the text is no longer JSON.")     \
    X(HN_PROBLEM_TOKEN, 401, "token", "This server asks for a token",                              \
      "Open the link that the server printed at its start, or send Authorization: Bearer TOKEN.")  \
    X(HN_PROBLEM_FOREIGN_ORIGIN, 403, "foreign-origin", "Another site may not call this server",   \
      "The Origin header names a host that this server does not serve.")                           \
    X(HN_PROBLEM_NOT_FOUND, 404, "not-found", "There is nothing here",                             \
      "No route, file or resource has this address; a near miss is suggested where there is one.") \
    X(HN_PROBLEM_METHOD, 405, "method-not-allowed", "This address does not accept this method",    \
      "The Allow header lists the methods that it accepts.")                                       \
    X(HN_PROBLEM_NOT_ACCEPTABLE, 406, "not-acceptable", "The answer has another media type",       \
      "The Accept header rules out what this address offers; the detail names what it offers.")    \
    X(HN_PROBLEM_LATE, 408, "timeout", "The request came too slowly",                              \
      "Head and body of a request have a time in all, and no pause in them may be long; the "      \
      "index "                                                                                     \
      "lists the limits.")                                                                         \
    X(HN_PROBLEM_CONFLICT, 409, "conflict", "The present state does not allow this request",       \
      "The request does not fit the state of the comparison, run or study; nothing was changed.")  \
    X(HN_PROBLEM_TOO_LARGE, 413, "too-large", "The body is too large",                             \
      "The index lists the largest body that is read.")                                            \
    X(HN_PROBLEM_ADDRESS, 414, "address-too-long", "The address is too long",                      \
      "The index lists the longest address that is read, and how many parameters it may have.")    \
    X(HN_PROBLEM_MEDIA_TYPE, 415, "media-type", "The body must be application/json",               \
      "Send the body as JSON and say so in the Content-Type header.")                              \
    X(HN_PROBLEM_HOST, 421, "unknown-host", "This server does not answer to that host name",       \
      "The Host header must name this machine's loopback or a host the server was started with.")  \
    X(HN_PROBLEM_INPUT, 422, "invalid-input", "The input is at fault",                             \
      "Each entry of `errors` names a field by JSON pointer, what is wrong and what to try.")      \
    X(HN_PROBLEM_BUSY, 429, "busy", "The server is busy: a limit of its work is reached",          \
      "Wait as long as the Retry-After header says, or delete a comparison.")                      \
    X(HN_PROBLEM_HEAD, 431, "head-too-long", "The head of the request is too long",                \
      "Request line and headers together may have 64 kB.")                                         \
    X(HN_PROBLEM_INTERNAL, 500, "internal", "The program is at fault",                             \
      "The request was correct, but the program failed to answer it.")                             \
    X(HN_PROBLEM_STUDIES_BUSY, 503, "studies-busy", "The largest number of studies is running",    \
      "Wait as long as the Retry-After header says, or stop a study that is running.")             \
    X(HN_PROBLEM_STOPPING, 503, "stopping", "The server is shutting down",                         \
      "The server is shutting down and accepts no new work.")                                      \
    X(HN_PROBLEM_VERSION, 505, "http-version", "This version of HTTP is not supported",            \
      "HTTP/1.0 and HTTP/1.1 are supported; a proxy in front of the server can translate later "   \
      "versions.")

typedef enum hn_http_problem {
#define HN_PROBLEM_ENUM(kind, status, code, title, about) kind,
    HN_PROBLEM_LIST(HN_PROBLEM_ENUM)
#undef HN_PROBLEM_ENUM
        HN_PROBLEM_COUNT
} hn_http_problem;

typedef struct hn_http_problem_info {
    unsigned status;
    const char *code, *title, *about;
} hn_http_problem_info;

/// Status, type and title of a kind of problem.
const hn_http_problem_info *hn_http_problem_get_info(hn_http_problem kind);

/// The document. `instance` (the address asked) may be NULL; `diags` may be NULL; `offset` < 0 is
/// left out; `hint` may be NULL.
void hn_http_problem_json(hn_strbuf *b, hn_http_problem kind, const char *detail, const char *hint,
                          const char *instance, long long offset, const hn_diags *diags);
#endif
