// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/source_text.h"

#include <ctype.h>
#include <string.h>

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

const char *hn_source_skip_comment(const char *at) {
    if (*at == '#' || *at == '%' || (at[0] == '/' && at[1] == '/')) {
        // in C '%' is an operator and '#' a directive: what is behind them counts for nobody
        return at + strcspn(at, "\n");
    }
    if (at[0] == '/' && at[1] == '*') {
        const char *end = strstr(at + 2, "*/");
        return end ? end + 2 : at + strlen(at);
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
