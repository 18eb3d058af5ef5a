// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/route.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_ROUTES = 100 };

/// 1 when the path fits the template; what stands for each {...} goes to `parts`.
static bool fits(const char *template, const char *path, char (*parts)[HN_HEADER_TEXT]) {
    int n = 0;
    while (*template) {
        if (*template == '{') {
            size_t length = strcspn(path, "/");
            if (length == 0 || length >= HN_HEADER_TEXT || n == HN_MAX_PARTS) {
                return false;
            }
            memcpy(parts[n], path, length);
            parts[n++][length] = 0;
            path += length;
            template = strchr(template, '}') + 1;
        } else if (*template ++ != *path++) {
            return false;
        }
    }
    return *path == 0;
}

static void allow(char *list, size_t size, const char *method) {
    size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s%s", used ? ", " : "", method,
             strcmp(method, "GET") == 0 ? ", HEAD" : "");
}

hn_route_match hn_route_find(const hn_route_table *table, const char *method, const char *path,
                             char (*parts)[HN_HEADER_TEXT]) {
    const char *wanted = strcmp(method, "HEAD") == 0 ? "GET" : method;
    hn_route_match match = {0};
    for (int i = 0; i < table->n; i++) {
        if (!fits(table->row[i].path, path, parts)) {
            continue;
        }
        if (strcmp(table->row[i].method, wanted) == 0) {
            match.route = &table->row[i];
        }
        allow(match.allow, sizeof match.allow, table->row[i].method);
    }
    if (match.allow[0]) {
        allow(match.allow, sizeof match.allow, "OPTIONS");
    }
    return match;
}

const char *hn_route_nearest(const hn_route_table *table, const char *path) {
    const char *paths[MAX_ROUTES];
    HN_ASSERT(table->n <= MAX_ROUTES);
    for (int i = 0; i < table->n; i++) {
        paths[i] = table->row[i].path;
    }
    return hn_nearest_name(path, paths, table->n);
}

int hn_route_media_type(const hn_route *route, int i, char out[64]) {
    const char *at = route->media_type;
    for (; at && *at && i > 0; i--) {
        at += strcspn(at, " ");
        at += *at == ' ';
    }
    if (!at || !*at) {
        return 0;
    }
    snprintf(out, 64, "%.*s", (int)strcspn(at, " "), at);
    return 1;
}
