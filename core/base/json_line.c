// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_line.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_blanks(const char *at) {
    return at + strspn(at, " \t\r\n");
}

/// Behind a text in quotes.
static const char *skip_text(const char *at) {
    for (at++; *at && *at != '"'; at++) {
        at += *at == '\\' && at[1];
    }
    return *at ? at + 1 : at;
}

/// Behind a value: the comma, the bracket or the end that follows it.
static const char *skip_value(const char *at) {
    int depth = 0;
    while (*at && (depth > 0 || !strchr(",]}", *at))) {
        depth += (*at == '{' || *at == '[') - (*at == '}' || *at == ']');
        at = *at == '"' ? skip_text(at) : at + 1;
    }
    return at;
}

/// The value of the member or the element of this name; NULL: there is none.
static const char *find_inside(const char *value, const char *name, size_t n) {
    const bool object = *value == '{';
    const long index = strtol(name, NULL, 10);
    if (!object && *value != '[') {
        return NULL;
    }
    const char *at = skip_blanks(value + 1);
    for (long k = 0; *at && *at != ']' && *at != '}'; k++) {
        const char *key = at;
        bool found = !object && k == index;
        if (object) {
            at = skip_text(key);
            found = (size_t)(at - key) == n + 2 && strncmp(key + 1, name, n) == 0;
            at = skip_blanks(skip_blanks(at) + 1);
        }
        if (found) {
            return at;
        }
        at = skip_value(at);
        at = skip_blanks(*at == ',' ? at + 1 : at);
    }
    return NULL;
}

int hn_json_line(const char *text, const char *pointer) {
    const char *at = skip_blanks(text);
    int line = 1;
    while (at && *pointer == '/') {
        const size_t n = strcspn(pointer + 1, "/");
        const char *inner = find_inside(at, pointer + 1, n);
        if (!inner) {
            break;
        }
        at = inner;
        pointer += n + 1;
    }
    for (const char *q = text; q < at; q++) {
        line += *q == '\n';
    }
    return line;
}
