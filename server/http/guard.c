#include "http/guard.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/// The host without its port; brackets of an IPv6 address are kept. 0 if it is malformed.
static int split_host(const char *text, char *name, size_t size) {
    const char *end = text[0] == '[' ? strchr(text, ']') : text + strcspn(text, ":");
    if (!end) {
        return 0;
    }
    end += text[0] == '[';
    size_t n = (size_t)(end - text);
    if (n == 0 || n >= size) {
        return 0;
    }
    memcpy(name, text, n);
    name[n] = 0;
    if (*end == 0) {
        return 1;
    }
    return *end == ':' && strlen(end + 1) <= 5 && strspn(end + 1, "0123456789") == strlen(end + 1);
}

/// A name cannot be trusted when every interface is served (a foreign name may be made to point here); a literal address can.
static int is_literal_address(const char *name) {
    unsigned char bytes[sizeof(struct in6_addr)];
    char inner[HN_HEADER_TEXT];
    size_t n = strlen(name);
    if (name[0] == '[' && n > 2 && n < sizeof inner) {
        memcpy(inner, name + 1, n - 2);
        inner[n - 2] = 0;
        return inet_pton(AF_INET6, inner, bytes) == 1;
    }
    return inet_pton(AF_INET, name, bytes) == 1;
}

int hn_host_is_ours(const hn_hosts *hosts, const char *host) {
    static const char *const loopback[] = {"localhost", "127.0.0.1", "[::1]"};
    char name[HN_HEADER_TEXT];
    if (!split_host(host, name, sizeof name)) {
        return 0;
    }
    for (size_t i = 0; i < sizeof loopback / sizeof *loopback; i++) {
        if (strcasecmp(name, loopback[i]) == 0) {
            return 1;
        }
    }
    for (int i = 0; i < hosts->n; i++) {
        if (strcasecmp(name, hosts->names[i]) == 0) {
            return 1;
        }
    }
    return hosts->any_address && is_literal_address(name);
}

int hn_guard_host(hn_request *r, const hn_hosts *hosts) {
    const char *host = hn_request_header(r, "Host");
    if (!host || !*host) {
        hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST, NULL, "the Host header is missing");
        return 0;
    }
    if (!hn_host_is_ours(hosts, host)) {
        hn_reply_problem(r, HN_PROBLEM_HOST, "start the server with --allow-host NAME",
                         "'%.100s' is not a name of this server", host);
        return 0;
    }
    const char *origin = hn_request_header(r, "Origin");
    if (!origin) {
        return 1;
    }
    const char *scheme_end = strstr(origin, "://");
    if (!scheme_end || !hn_host_is_ours(hosts, scheme_end + 3)) {
        hn_reply_problem(r, HN_PROBLEM_FOREIGN_ORIGIN, NULL,
                         "the origin '%.100s' is not served here", origin);
        return 0;
    }
    return 1;
}

/// 1 when the range (n bytes, "application/*") covers the type.
static int range_covers(const char *range, size_t n, const char *media_type) {
    if (n == 3 && memcmp(range, "*/*", 3) == 0) {
        return 1;
    }
    if (n > 2 && memcmp(range + n - 2, "/*", 2) == 0) {
        return strncasecmp(range, media_type, n - 1) == 0;
    }
    return strlen(media_type) == n && strncasecmp(range, media_type, n) == 0;
}

/// 1 when the parameters of a range say q=0.
static int is_refused(const char *params, size_t n) {
    char copy[64];
    snprintf(copy, sizeof copy, "%.*s", (int)(n < 63 ? n : 63), params);
    const char *q = strstr(copy, "q=");
    return q && strspn(q + 2, "0.") > 0 && !strpbrk(q + 2, "123456789");
}

int hn_accepts(const char *accept, const char *media_type) {
    int allowed = 0;
    if (!accept) {
        return 1;
    }
    while (*accept) {
        accept += strspn(accept, " \t,");
        size_t whole = strcspn(accept, ","), range = strcspn(accept, " \t;,");
        if (range > 0 && range_covers(accept, range, media_type)) {
            int exact = strlen(media_type) == range && accept[0] != '*';
            int refused = is_refused(accept + range, whole - range);
            if (exact) {
                return !refused;
            }
            allowed |= !refused;
        }
        accept += whole;
    }
    return allowed;
}

int hn_guard_accept(hn_request *r) {
    const char *accept = hn_request_header(r, "Accept");
    if (!r->route->schema || hn_accepts(accept, r->route->media_type)) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_NOT_ACCEPTABLE, NULL, "this address offers %s",
                     r->route->media_type);
    return 0;
}

int hn_is_json_type(const char *content_type) {
    static const char json[] = "application/json";
    size_t n = sizeof json - 1;
    return content_type && strncasecmp(content_type, json, n) == 0 &&
           (content_type[n] == 0 || strchr("; \t", content_type[n]));
}

int hn_guard_body_type(hn_request *r) {
    const char *type = hn_request_header(r, "Content-Type");
    if (!r->route->fields || hn_is_json_type(type)) {
        return 1;
    }
    hn_reply_problem(r, HN_PROBLEM_MEDIA_TYPE, "Content-Type: application/json",
                     type ? "the body is said to be '%.100s'"
                          : "the Content-Type header is missing%s",
                     type ? type : "");
    return 0;
}
