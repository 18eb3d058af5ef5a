// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/guard.h"

#include "base/suggest.h"
#include "http/request/context.h"

#include <arpa/inet.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_QUERY = 16 };
enum { ENDS_OF_LINES = 4 }; ///< bytes of CR LF CR LF

/// Length of an authority of n bytes without a port that its scheme implies.
static size_t trim_port(const char *authority, size_t n) {
    return n > 3 && strncmp(authority + n - 3, ":80", 3) == 0    ? n - 3
           : n > 4 && strncmp(authority + n - 4, ":443", 4) == 0 ? n - 4
                                                                 : n;
}

bool hn_guard_is_same_host(const char *a, size_t n_a, const char *b, size_t n_b) {
    const size_t n = trim_port(a, n_a);
    return n == trim_port(b, n_b) && strncasecmp(a, b, n) == 0;
}

/// Returns whether an Origin header names the host and port of the Host header.
static bool is_same_origin(const char *origin, const char *host) {
    const size_t scheme = strncmp(origin, "http://", 7) == 0    ? 7
                          : strncmp(origin, "https://", 8) == 0 ? 8
                                                                : 0;
    const char *authority = origin + scheme;
    return scheme > 0 && hn_guard_is_same_host(authority, strlen(authority), host, strlen(host));
}

/// A page may call the server that it came from: same name, same port.
static bool check_origin(hn_request *r, const char *host) {
    const char *origin = hn_request_header(r, "Origin");
    if (!origin || is_same_origin(origin, host)) {
        return true;
    }
    hn_reply_problem(r, HN_PROBLEM_FOREIGN_ORIGIN, NULL,
                     "the origin '%.100s' is not that of this server, '%.100s'", origin, host);
    return false;
}

/// Headers that say what a request is: one that has two values means something else to a proxy.
static const char *const ONCE[] = {"Host", "Content-Length", "Transfer-Encoding", "Content-Type",
                                   "Authorization"};
enum { N_ONCE = sizeof ONCE / sizeof *ONCE };

static enum MHD_Result count_header(void *cls, enum MHD_ValueKind kind, const char *key,
                                    const char *value) {
    int *n = cls;
    (void)kind;
    (void)value;
    for (int i = 0; i < N_ONCE; i++) {
        n[i] += strcasecmp(key, ONCE[i]) == 0;
    }
    return MHD_YES;
}

/// Describes where the value before ends, and whether a zero byte was found. The library keeps a
/// head in one buffer, with zeros in place of the ends of lines: between a value and the next name
/// there are zeros alone, unless a zero byte in the value has cut it, or the value goes on in a
/// second line, which RFC 9112, section 5.2, lets a server refuse.
typedef struct value_look {
    const char *end;
    bool found;
} value_look;

static enum MHD_Result look_for_cut(void *cls, enum MHD_ValueKind kind, const char *key,
                                    const char *value) {
    value_look *look = cls;
    const ptrdiff_t apart = look->end ? key - look->end : 0;
    (void)kind;
    for (ptrdiff_t i = 0; i < apart && apart <= HN_HEAD_BYTES; i++) {
        look->found |= look->end[i] != '\0';
    }
    look->end = value ? value + strlen(value) : NULL;
    return MHD_YES;
}

/// Returns where the head of the request ends in the library's buffer; NULL where a library keeps
/// its pieces elsewhere.
static const char *find_end_of_head(const hn_request *r) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(r->connection, MHD_CONNECTION_INFO_REQUEST_HEADER_SIZE);
    return info && r->head ? r->head + info->header_size : NULL;
}

/// Returns whether the library ended the head at a line that begins with a zero byte. Behind the
/// last value there are two ends of lines, which are zeros now, and nothing else.
static bool has_cut_head(const hn_request *r, const char *value_end) {
    const char *end = find_end_of_head(r);
    const ptrdiff_t apart = end && value_end ? end - value_end : 0;
    bool found = apart > ENDS_OF_LINES;
    if (apart <= 0 || apart > HN_HEAD_BYTES) {
        return false;
    }
    for (ptrdiff_t i = 0; i < apart; i++) {
        found |= value_end[i] != '\0';
    }
    return found;
}

/// Returns whether a zero byte cut the value of a header, or the head.
static bool has_zero_byte(const hn_request *r) {
    value_look look = {0};
    MHD_get_connection_values(r->connection, MHD_HEADER_KIND, look_for_cut, &look);
    return look.found || (look.end && look.end[1] != '\0') || has_cut_head(r, look.end);
}

/// Takes the blanks off the end of a value, which are no part of it (RFC 9110, section 5.5). The
/// value lies in the library's buffer, which may be written.
static enum MHD_Result trim_value(void *cls, enum MHD_ValueKind kind, const char *key,
                                  const char *value) {
    (void)cls;
    (void)kind;
    (void)key;
    for (size_t n = value ? strlen(value) : 0; n > 0 && strchr(" \t", value[n - 1]); n--) {
        ((char *)value)[n - 1] = '\0';
    }
    return MHD_YES;
}

/// Refuses a request whose head does not say for certain where it ends: what follows on the
/// connection is not read as a request.
HN_PRINTF(3, 4)
static bool refuse_head(hn_request *r, const char *hint, const char *format, ...) {
    char detail[HN_DIAG_MESSAGE];
    va_list args;
    va_start(args, format);
    vsnprintf(detail, sizeof detail, format, args);
    va_end(args);
    hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, hint, "%s", detail);
    hn_reply_header_add(r, "Connection", "close");
    return false;
}

/// Checks how the length of the body is given: in one way, and in one that is known here. The value
/// is as the library read it: it does not take "chunked" with a blank behind it.
static bool check_length(hn_request *r) {
    const char *encoding = hn_request_header(r, "Transfer-Encoding");
    if (encoding && strcasecmp(encoding, "chunked") != 0) {
        return refuse_head(r, "send a Content-Length",
                           "the Transfer-Encoding is '%.40s'; only chunked is accepted", encoding);
    }
    if (encoding && hn_request_header(r, "Content-Length")) {
        return refuse_head(
            r, "send one of them",
            "both Content-Length and Transfer-Encoding are given; only one is allowed");
    }
    return true;
}

/// Keeps a name that is no token (RFC 9110, section 5.1): a proxy that forgives a blank before the
/// colon reads a header there that this server does not.
static enum MHD_Result find_odd_name(void *cls, enum MHD_ValueKind kind, const char *key,
                                     const char *value) {
    static const char token[] = "!#$%&'*+-.^_`|~0123456789abcdefghijklmnopqrstuvwxyz"
                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const char **odd = cls;
    (void)kind;
    (void)value;
    *odd = *key && key[strspn(key, token)] == '\0' ? NULL : key;
    return *odd ? MHD_NO : MHD_YES;
}

bool hn_guard_headers(hn_request *r) {
    int n[N_ONCE] = {0};
    const char *odd = NULL;
    if (has_zero_byte(r)) {
        return refuse_head(
            r, NULL,
            "a header holds a zero byte or continues on a second line; neither is allowed");
    }
    MHD_get_connection_values(r->connection, MHD_HEADER_KIND, find_odd_name, &odd);
    if (odd) {
        return refuse_head(r, "no blank stands before the colon of a header",
                           "'%.40s' is not the name of a header: letters, digits and "
                           "!#$%%&'*+-.^_`|~ are allowed",
                           odd);
    }
    MHD_get_connection_values(r->connection, MHD_HEADER_KIND, count_header, n);
    for (int i = 0; i < N_ONCE; i++) {
        if (n[i] > 1) {
            return refuse_head(r, NULL, "the header %s is given %d times; it may be given once",
                               ONCE[i], n[i]);
        }
    }

    if (!check_length(r)) {
        return false;
    }
    MHD_get_connection_values(r->connection, MHD_HEADER_KIND, trim_value, NULL);
    return true;
}

int hn_guard_host(hn_request *r, const hn_hosts *hosts) {
    const char *host = hn_request_header(r, "Host");
    if (!host || !*host) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL, "the Host header is missing");
        hn_reply_header_add(r, "Connection", "close");
        return 0;
    }
    if (!hn_host_is_ours(hosts, host)) {
        hn_reply_problem(r, HN_PROBLEM_HOST, "start the server with --allow-host NAME",
                         "'%.100s' is not a name of this server", host);
        return 0;
    }
    return check_origin(r, host);
}

int hn_guard_site(hn_request *r) {
    const char *site = hn_request_header(r, "Sec-Fetch-Site");
    if (!site || r->route->work == HN_WORK_LIGHT || strcmp(site, "same-origin") == 0 ||
        strcmp(site, "none") == 0) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_FOREIGN_ORIGIN, NULL,
                     "a page of another site asks this server to compute (Sec-Fetch-Site: %.40s)",
                     site);
    return 0;
}

/// 1 when the range (n bytes, "application/*") covers the type.
static bool range_covers(const char *range, size_t n, const char *media_type) {
    if (n == 3 && memcmp(range, "*/*", 3) == 0) {
        return true;
    }
    if (n > 2 && memcmp(range + n - 2, "/*", 2) == 0) {
        return strncasecmp(range, media_type, n - 1) == 0;
    }
    return strlen(media_type) == n && strncasecmp(range, media_type, n) == 0;
}

/// The weight that the parameters of a range give it (RFC 9110, section 12.4.2), in thousandths;
/// one that cannot be read is that of a range without any.
static int read_weight(const char *params, size_t n) {
    enum { WHOLE = 1000 };
    const char *at = params, *const end = params + n;
    while (at < end && strncasecmp(at, "q=", 2) != 0) {
        at += strcspn(at, ";,");
        at += at < end;
        at += at < end ? strspn(at, " \t") : 0;
    }
    if (end - at < 3 || (at[2] != '0' && at[2] != '1')) {
        return WHOLE;
    }
    int weight = WHOLE * (at[2] - '0'), place = WHOLE / 10;
    for (at += 3 + (at[3] == '.'); at < end && *at >= '0' && *at <= '9' && place > 0; at++) {
        weight += place * (*at - '0');
        place /= 10;
    }
    return weight < WHOLE ? weight : WHOLE;
}

/// How closely a range names a type: 0 */*, 1 application/*, 2 the type itself.
static int closeness(const char *range, size_t n) {
    return range[0] == '*' ? 0 : n > 2 && memcmp(range + n - 2, "/*", 2) == 0 ? 1 : 2;
}

int hn_accept_weight(const char *accept, const char *media_type) {
    int weight = 0, closest = -1;
    if (!accept) {
        return 1;
    }
    while (*accept) {
        accept += strspn(accept, " \t,");
        const size_t whole = strcspn(accept, ","), range = strcspn(accept, " \t;,");
        if (range > 0 && range_covers(accept, range, media_type) &&
            closeness(accept, range) > closest) {
            closest = closeness(accept, range);
            weight = read_weight(accept + range, whole - range);
        }
        accept += whole;
    }
    return weight;
}

int hn_accepts(const char *accept, const char *media_type) {
    return hn_accept_weight(accept, media_type) > 0;
}

int hn_guard_accept(hn_request *r) {
    const char *accept = hn_request_header(r, "Accept");
    char type[64];
    for (int i = 0; r->route->schema && hn_route_media_type(r->route, i, type); i++) {
        if (hn_accepts(accept, type)) {
            return 1;
        }
    }
    if (!r->route->schema) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_NOT_ACCEPTABLE, NULL, "this address offers %s",
                     r->route->media_type);
    return 0;
}

/// Describes what a route knows of a query, while it is walked through.
typedef struct query_check {
    const hn_route *route;
    int takes_token;
    char unknown[64], twice[64];
    unsigned seen; ///< bit by row of the route's parameters
} query_check;

static enum MHD_Result check_query(void *cls, enum MHD_ValueKind kind, const char *key,
                                   const char *value) {
    query_check *check = cls;
    const hn_route_query *q = check->route->query;
    (void)kind;
    (void)value;
    unsigned bit = 1;
    while (q && q->name && strcmp(q->name, key) != 0) {
        q++;
        bit <<= 1;
    }
    if (q && q->name) {
        const bool is_twice = (check->seen & bit) && strcmp(q->type, "array") != 0;
        check->seen |= bit;
        if (is_twice) {
            snprintf(check->twice, sizeof check->twice, "%s", key);
        }
        return is_twice ? MHD_NO : MHD_YES;
    }
    if (check->takes_token && strcmp(key, "token") == 0) {
        return MHD_YES;
    }
    snprintf(check->unknown, sizeof check->unknown, "%s", key);
    return MHD_NO;
}

int hn_guard_query(hn_request *r) {
    query_check check = {.route = r->route, .takes_token = r->context->opts.token != NULL};
    MHD_get_connection_values(r->connection, MHD_GET_ARGUMENT_KIND, check_query, &check);
    if (check.twice[0]) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL,
                         "the query parameter '%s' is given twice; it takes one value",
                         check.twice);
        return 0;
    }
    if (!check.unknown[0]) {
        return 1;
    }

    // the known names, or the one that was meant
    char hint[HN_DIAG_HINT];
    const char *names[MAX_QUERY];
    int n = 0;
    for (const hn_route_query *q = r->route->query; q && q->name && n < MAX_QUERY; q++) {
        names[n++] = q->name;
    }
    hn_suggest_or_list(hint, check.unknown, names, n,
                       n ? "parameters: " : "this address takes no parameters");
    hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, hint, "the query parameter '%s' is unknown here",
                     check.unknown);
    return 0;
}

/// Returns whether the parameters of a media type leave the text in UTF-8, which JSON always has.
static bool is_utf8(const char *parameters) {
    for (const char *at = parameters; (at = strchr(at, ';')) != NULL;) {
        at += 1 + strspn(at + 1, " \t");
        if (strncasecmp(at, "charset=", 8) == 0) {
            at += 8 + (at[8] == '"');
            const size_t n = strcspn(at, "\"; \t");
            return (n == 5 && strncasecmp(at, "utf-8", n) == 0) ||
                   (n == 8 && strncasecmp(at, "us-ascii", n) == 0);
        }
    }
    return true;
}

bool hn_is_json_type(const char *content_type) {
    static const char json[] = "application/json";
    size_t n = sizeof json - 1;
    return content_type && strncasecmp(content_type, json, n) == 0 &&
           (content_type[n] == 0 || strchr("; \t", content_type[n])) && is_utf8(content_type + n);
}

int hn_guard_body_type(hn_request *r) {
    const char *type = hn_request_header(r, "Content-Type");
    const char *coding = hn_request_header(r, "Content-Encoding");
    if (!r->route->fields) {
        return 1;
    }
    if (coding && *coding && strcasecmp(coding, "identity") != 0) {
        hn_reply_problem(r, HN_PROBLEM_MEDIA_TYPE, "send the text itself, uncompressed",
                         "the Content-Encoding of the body is '%.100s'", coding);
        return 0;
    }
    if (hn_is_json_type(type)) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_MEDIA_TYPE, "Content-Type: application/json; the text in UTF-8",
                     type ? "the Content-Type of the body is '%.100s'"
                          : "the Content-Type header is missing%s",
                     type ? type : "");
    return 0;
}
