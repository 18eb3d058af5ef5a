// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/token.h"

#include "http/request/context.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

static const char COOKIE[] = "holonom_token";

int hn_token_make(char out[HN_TOKEN]) {
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    unsigned char random[HN_TOKEN - 1];
    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) {
        return 0;
    }
    for (size_t i = 0; i < sizeof random; i++) {
        out[i] = letters[random[i] & 63];
    }
    out[HN_TOKEN - 1] = 0;
    return 1;
}

/// Compares in a time that does not tell how much is right.
static bool is_token(const char *shown, const char *token) {
    const size_t n = strlen(token);
    if (!shown || strlen(shown) != n) {
        return false;
    }
    unsigned char difference = 0;
    for (size_t i = 0; i < n; i++) {
        difference |= (unsigned char)(shown[i] ^ token[i]);
    }
    return difference == 0;
}

/// Returns what follows the scheme in an Authorization header, whatever the case of its letters
/// (RFC 9110, section 11.1); NULL for another scheme.
static const char *read_bearer(const char *header) {
    static const char scheme[] = "Bearer ";
    const size_t n = sizeof scheme - 1;
    return header && strncasecmp(header, scheme, n) == 0 ? header + n + strspn(header + n, " ")
                                                         : NULL;
}

/// A guest reads: nothing is changed, and no reference motion is computed.
static bool may_guest(const hn_request *r, const char *method) {
    const int reads = strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0;
    const char *compute = hn_request_query(r, "compute");
    return reads && (!compute || strcmp(compute, "true") != 0);
}

/// The page without the token in its address, which would stay in the browser's history. The new
/// address is relative: a proxy may serve this one below a prefix.
static void redirect(hn_request *r, const char *token) {
    hn_reply_empty(r, MHD_HTTP_SEE_OTHER);
    const char *last = strrchr(r->path, '/');
    hn_reply_header_add(r, "Location", ".%s", last ? last : "/");
    // the path of a cookie is the folder of the address as the browser has it, with the prefix
    const bool is_at_root = !last || last == r->path;
    hn_reply_header_add(r, "Set-Cookie", "%s=%s; %sHttpOnly; SameSite=Strict", COOKIE, token,
                        is_at_root ? "" : "Path=/; ");
}

int hn_token_check(hn_request *r, const char *method) {
    const char *token = r->context->opts.token, *header = hn_request_header(r, "Authorization");
    const char *query = hn_request_query(r, "token");
    if (!token || strcmp(r->path, "/healthz") == 0) {
        return 1;
    }
    if (is_token(query, token) && !r->route && strcmp(method, "GET") == 0) {
        redirect(r, token);
        return 0;
    }
    if (is_token(query, token) ||
        is_token(MHD_lookup_connection_value(r->connection, MHD_COOKIE_KIND, COOKIE), token) ||
        is_token(read_bearer(header), token)) {
        return 1;
    }

    // no token, or a wrong one; a cookie may be of an earlier server, so it makes a guest
    const bool is_wrong = query || read_bearer(header);
    if (r->context->opts.guests && !is_wrong && may_guest(r, method)) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_TOKEN,
                     is_wrong && r->context->opts.guests
                         ? "take the token that the server printed, or read as a guest without one"
                         : "open the link that the server printed, or send Authorization: Bearer "
                           "TOKEN",
                     is_wrong ? "the token that was sent is not that of this server"
                     : r->context->opts.guests ? "guests may read; this needs the token"
                                               : "this server asks for a token");
    hn_reply_header_add(r, "WWW-Authenticate", "Bearer realm=\"holonom\"");
    return 0;
}
