// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/json_scan.h"

#include <string.h>

static const char *skip_string(const char *at) {
    for (at++; *at && *at != '"'; at++) {
        at += *at == '\\' && at[1];
    }
    return at + (*at == '"');
}

const char *hn_json_skip(const char *at) {
    int depth = 0;
    do {
        if (*at == '"') {
            at = skip_string(at);
            continue;
        }
        depth += *at == '[' || *at == '{';
        depth -= *at == ']' || *at == '}';
        at++;
    } while (*at && (depth > 0 || !strchr(",]}", *at)));
    return at;
}

const char *hn_json_next_member(const char **at, const char **key, size_t *n) {
    const char *member = *at + (**at == '{' || **at == ',');
    if (*member != '"') {
        return NULL;
    }
    const char *colon = skip_string(member), *value = colon + (*colon == ':');
    *key = member + 1;
    *n = (size_t)(colon - 1 - *key);
    *at = hn_json_skip(value);
    return value;
}

const char *hn_json_member(const char *object, const char *name) {
    const size_t n = strlen(name);
    for (const char *at = object + 1; *at == '"';) {
        const char *key = at + 1, *colon = skip_string(at);
        const char *value = colon + 1;
        if ((size_t)(colon - 1 - key) == n && memcmp(key, name, n) == 0) {
            return value;
        }
        at = hn_json_skip(value);
        at += *at == ',';
    }
    return NULL;
}

const char *hn_json_next(const char **at) {
    const char *item = *at + (**at == '[' || **at == ',');
    if (*item == ']' || !*item) {
        return NULL;
    }
    *at = hn_json_skip(item);
    return item;
}
