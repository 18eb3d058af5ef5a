// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/paragraphs.h"

#include <stdbool.h>
#include <string.h>

/// Returns whether the line at text is prose: neither empty nor indented.
static bool is_prose(const char *text) {
    return *text && *text != '\n' && *text != ' ';
}

void hn_paragraphs_join(hn_strbuf *b, const char *text) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        const char *next = text + n + (text[n] == '\n');
        hn_strbuf_add_n(b, text, n);
        if (text[n] == '\n') {
            hn_strbuf_add(b, is_prose(text) && is_prose(next) ? " " : "\n");
        }
        text = next;
    }
}
