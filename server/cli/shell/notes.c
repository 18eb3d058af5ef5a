// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/notes.h"

#include "base/visible.h"
#include "cli/shell/fold.h"
#include "terminal/width.h"

#include <stdarg.h>
#include <stdio.h>

void hn_cli_note_lines(const hn_strbuf *lines) {
    hn_strbuf visible, folded;
    hn_strbuf_init(&visible);
    hn_strbuf_init(&folded);
    hn_visible_add(&visible, hn_strbuf_text(lines), false);
    hn_fold_add(&folded, hn_strbuf_text(&visible), hn_terminal_error_limit());
    fputs(hn_strbuf_text(&folded), stderr);
    hn_strbuf_reset(&folded);
    hn_strbuf_reset(&visible);
}

void hn_cli_note(const char *format, ...) {
    enum { MOST = 4096 };
    char text[MOST];
    hn_strbuf b;
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, text);
    hn_cli_note_lines(&b);
    hn_strbuf_reset(&b);
}
