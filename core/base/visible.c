// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/visible.h"

#include <string.h>

size_t hn_control_length(const char *text) {
    const unsigned char first = (unsigned char)text[0];
    const unsigned char second = first ? (unsigned char)text[1] : 0;
    if ((first > 0 && first < 0x20) || first == 0x7f) {
        return 1;
    }
    return first == 0xc2 && second >= 0x80 && second <= 0x9f ? 2 : 0;
}

/// The same, but 0 for a line break or a tab where the text may have several lines.
static size_t length_here(const char *text, bool of_one_line) {
    return !of_one_line && (*text == '\n' || *text == '\t') ? 0 : hn_control_length(text);
}

bool hn_has_control(const char *text, bool of_one_line) {
    while (*text && length_here(text, of_one_line) == 0) {
        text++;
    }
    return *text != '\0';
}

void hn_visible_add(hn_strbuf *b, const char *text, bool of_one_line) {
    while (*text) {
        const size_t n = length_here(text, of_one_line);
        hn_strbuf_add_n(b, n ? "?" : text, 1);
        text += n ? n : 1;
    }
}
