// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/markup.h"

#include <string.h>

void hn_html_text(hn_strbuf *b, const char *text) {
    hn_html_text_n(b, text, strlen(text));
}

void hn_html_text_n(hn_strbuf *b, const char *text, size_t n) {
    for (const char *end = text + n; text < end; text++) {
        switch (*text) {
        case '&':
            hn_strbuf_add(b, "&amp;");
            break;
        case '<':
            hn_strbuf_add(b, "&lt;");
            break;
        case '>':
            hn_strbuf_add(b, "&gt;");
            break;
        case '"':
            hn_strbuf_add(b, "&quot;");
            break;
        default:
            hn_strbuf_add_n(b, text, 1);
        }
    }
}
