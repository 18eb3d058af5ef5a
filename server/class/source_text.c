// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/source_text.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

hn_source_style hn_source_style_of(const char *file) {
    static const struct {
        const char *ending;
        hn_source_style style;
    } ENDINGS[] = {{".py", HN_SOURCE_PYTHON}, {".m", HN_SOURCE_OCTAVE}, {".jl", HN_SOURCE_JULIA}};
    const char *dot = strrchr(file, '.');
    for (size_t i = 0; dot && i < sizeof ENDINGS / sizeof *ENDINGS; i++) {
        if (strcasecmp(dot, ENDINGS[i].ending) == 0) {
            return ENDINGS[i].style;
        }
    }
    return HN_SOURCE_C;
}

bool hn_source_is_by_lines(hn_source_style style) {
    return style == HN_SOURCE_PYTHON || style == HN_SOURCE_JULIA;
}

bool hn_source_begins_name(char c) {
    return isalpha((unsigned char)c) || c == '_';
}

bool hn_source_continues_name(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

bool hn_source_is_function(const char *name, size_t n) {
    static const char *const known[] = {"sin",  "cos",  "tan", "asin", "acos", "atan", "atan2",
                                        "sqrt", "pow",  "exp", "log",  "abs",  "fabs", "sinh",
                                        "cosh", "tanh", "dot", "min",  "max"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strlen(known[i]) == n && strncmp(name, known[i], n) == 0) {
            return true;
        }
    }
    return false;
}

static const char *skip_line(const char *at) {
    return at + strcspn(at, "\n");
}

/// Skips what ends with the two letters of `end`, or with the text.
static const char *skip_block(const char *at, const char *end) {
    const char *found = strstr(at + 2, end);
    return found ? found + 2 : at + strlen(at);
}

const char *hn_source_skip_comment(hn_source_style style, const char *at) {
    switch (style) {
    case HN_SOURCE_C:
        return *at == '#' || (at[0] == '/' && at[1] == '/') ? skip_line(at)
               : at[0] == '/' && at[1] == '*'               ? skip_block(at, "*/")
                                                            : NULL;
    case HN_SOURCE_PYTHON:
        return *at == '#' ? skip_line(at) : NULL;
    case HN_SOURCE_OCTAVE:
        return (*at == '%' || *at == '#') && at[1] == '{' ? skip_block(at, *at == '%' ? "%}" : "#}")
               : *at == '%' || *at == '#'                 ? skip_line(at)
                                                          : NULL;
    case HN_SOURCE_JULIA:
        return at[0] == '#' && at[1] == '=' ? skip_block(at, "=#")
               : *at == '#'                 ? skip_line(at)
                                            : NULL;
    }
    return NULL;
}

const char *hn_source_skip_quotes(const char *begin, const char *at) {
    const char before = at > begin ? at[-1] : ' ';
    if (strncmp(at, "\"\"\"", 3) == 0 || strncmp(at, "'''", 3) == 0) {
        const char mark[4] = {*at, *at, *at, 0};
        const char *end = strstr(at + 3, mark);
        return end ? end + 3 : at + strlen(at);
    }
    if (*at != '"' &&
        (*at != '\'' || hn_source_continues_name(before) || strchr(")]}'.", before))) {
        return NULL;
    }
    const char *end = at + 1;
    while (*end && *end != *at && *end != '\n') {
        end += end[0] == '\\' && end[1] ? 2 : 1;
    }
    return *end == *at ? end + 1 : end;
}
