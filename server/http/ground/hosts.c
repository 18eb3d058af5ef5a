// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/hosts.h"

#include <arpa/inet.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

enum { HOST_TEXT = 256 };

/// The host without its port; brackets of an IPv6 address are kept. 0 if it is malformed.
static bool split_host(const char *text, char *name, size_t size) {
    const char *end = text[0] == '[' ? strchr(text, ']') : text + strcspn(text, ":");
    if (!end) {
        return false;
    }
    end += text[0] == '[';
    size_t n = (size_t)(end - text);
    if (n == 0 || n >= size) {
        return false;
    }
    memcpy(name, text, n);
    name[n] = 0;
    if (*end == 0) {
        return true;
    }
    return *end == ':' && strlen(end + 1) <= 5 && strspn(end + 1, "0123456789") == strlen(end + 1);
}

/// A name cannot be trusted when every interface is served (a foreign name may be made to point
/// here); a literal address can.
static bool is_literal_address(const char *name) {
    unsigned char bytes[sizeof(struct in6_addr)];
    char inner[HOST_TEXT];
    size_t n = strlen(name);
    if (name[0] == '[' && n > 2 && n < sizeof inner) {
        memcpy(inner, name + 1, n - 2);
        inner[n - 2] = 0;
        return inet_pton(AF_INET6, inner, bytes) == 1;
    }
    return inet_pton(AF_INET, name, bytes) == 1;
}

bool hn_host_is_ours(const hn_hosts *hosts, const char *host) {
    static const char *const loopback[] = {"localhost", "127.0.0.1", "[::1]"};
    char name[HOST_TEXT];
    if (!split_host(host, name, sizeof name)) {
        return false;
    }
    for (size_t i = 0; i < sizeof loopback / sizeof *loopback; i++) {
        if (strcasecmp(name, loopback[i]) == 0) {
            return true;
        }
    }
    for (int i = 0; i < hosts->n; i++) {
        if (strcasecmp(name, hosts->names[i]) == 0) {
            return true;
        }
    }
    return hosts->any_address && is_literal_address(name);
}
