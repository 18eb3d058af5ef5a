// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/fold.h"

#include "terminal/line_break.h"

#include <stdbool.h>
#include <string.h>

enum { HANG = 2 }; // [columns]

/// Bytes of an escape sequence at the text's beginning; 0: there is none.
static size_t escape_length(const char *text) {
    const char *end = text[0] == '\033' && text[1] == '[' ? strpbrk(text + 2, "mK") : NULL;
    return end ? (size_t)(end - text) + 1 : 0;
}

/// Bytes of one character.
static size_t character_length(const char *text) {
    size_t n = 1;
    while ((text[n] & 0xc0) == 0x80) {
        n++;
    }
    return n;
}

int hn_fold_width(const char *text, size_t n) {
    int width = 0;
    for (size_t i = 0; i < n && text[i];) {
        const size_t escape = escape_length(text + i);
        i += escape ? escape : character_length(text + i);
        width += escape == 0;
    }
    return width;
}

size_t hn_fold_line(const char *text, int columns) {
    size_t n = 0, blank = 0, other = 0, factor = 0;
    int width = 0;
    while (text[n] && text[n] != '\n') {
        // a word that is longer than the line is not broken, but a product is behind a factor
        const bool here = text[n] == ' ' && hn_line_may_break(text, n);
        if (width >= columns && (blank > 0 || factor > 0 || other > 0 || text[n] == ' ')) {
            return here ? n : blank > 0 ? blank : factor > 0 ? factor : other > 0 ? other : n;
        }
        const size_t escape = escape_length(text + n);
        blank = here && width > 0 ? n : blank;
        other = text[n] == ' ' && width > 0 ? n : other;
        width += escape == 0;
        n += escape ? escape : character_length(text + n);
        factor = text[n - 1] == '*' && text[n] != ' ' ? n : factor;
    }
    return n;
}

/// Adds one line, without its end; what follows a break is indented `hang` columns further.
static void add_line(hn_strbuf *b, const char *line, int columns, int hang) {
    const int indent = (int)strspn(line, " ");
    size_t n = (size_t)indent + hn_fold_line(line + indent, columns - indent);
    hn_strbuf_add_n(b, line, n);
    for (line += n; line[0] && line[0] != '\n'; line += n) {
        line += strspn(line, " ");
        n = hn_fold_line(line, columns - indent - hang);
        hn_strbuf_printf(b, "\n%*s%.*s", indent + hang, "", (int)n, line);
    }
}

/// hang: of lines that begin at the left edge; `inset`: others are folded too.
static void add_folded(hn_strbuf *b, const char *text, int columns, int hang, bool inset) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        const bool flush = *text != ' ';
        if (columns == 0 || hn_fold_width(text, n) <= columns || (!flush && !inset)) {
            hn_strbuf_add_n(b, text, n);
        } else {
            add_line(b, text, columns, flush ? hang : HANG);
        }
        text += n;
        if (*text == '\n') {
            hn_strbuf_add(b, "\n");
            text++;
        }
    }
}

void hn_fold_add(hn_strbuf *b, const char *text, int columns) {
    add_folded(b, text, columns, HANG, true);
}

void hn_fold_prose(hn_strbuf *b, const char *text, int columns) {
    add_folded(b, text, columns, 0, true);
}

void hn_fold_paragraphs(hn_strbuf *b, const char *text, int columns) {
    add_folded(b, text, columns, 0, false);
}
