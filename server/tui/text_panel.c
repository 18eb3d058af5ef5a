// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/text_panel.h"

#include "base/shortest.h"
#include "terminal/cells.h"
#include "tui/list.h"
#include "tui/text_view.h"

#include <stdio.h>
#include <string.h>

void hn_text_panel_open(hn_workbench *w, const char *title) {
    hn_child_stop(&w->child);
    w->panel = HN_PANEL_TEXT;
    w->scroll = 0;
    w->marked = -1;
    w->lesson = -1;
    w->writes[0] = '\0';
    hn_strbuf_clear(&w->text);
    snprintf(w->title, sizeof w->title, "%s", title);
}

/// Rows that the line (n bytes) takes when it is folded.
static int rows_of(const hn_workbench *w, const char *line, size_t n) {
    char row[HN_TUI_PARAGRAPH];
    hn_text_view_paragraph(w, line, n, row);
    const int indent = hn_text_view_indent(row, w->columns - 4);
    const int rows = hn_text_rows(row + indent, w->columns - 4 - indent);
    return rows > 0 ? rows : 1;
}

/// The first line of the last full page.
static int last_page(const hn_workbench *w) {
    const char *text = hn_strbuf_text(&w->text), *at = text + strlen(text);
    int line = 0, rows = 0, last = 0;
    for (const char *c = text; *c; c++) {
        last += *c == '\n' && c[1] != '\0';
    }
    line = last;

    // upwards from the end, until the page is full
    at -= at > text && at[-1] == '\n';
    for (; at > text; line--) {
        const char *begin = at;
        while (begin > text && begin[-1] != '\n') {
            begin--;
        }
        rows += rows_of(w, begin, (size_t)(at - begin));
        if (rows > w->rows - 5) {
            return line < last ? line + 1 : last;
        }
        at = begin > text ? begin - 1 : begin;
    }
    return 0;
}

void hn_text_panel_scroll(hn_workbench *w, int line) {
    const int last = last_page(w);
    w->scroll = line < 0 ? 0 : line > last ? last : line;
}

/// Rows that the lines from first to before last take.
static int rows_between(const hn_workbench *w, int first, int last) {
    int line = 0, rows = 0;
    for (const char *at = hn_strbuf_text(&w->text); *at && line < last; line++) {
        const size_t n = strcspn(at, "\n");
        rows += line >= first ? rows_of(w, at, n) : 0;
        at += n + (at[n] == '\n');
    }
    return rows;
}

void hn_text_panel_reveal(hn_workbench *w, int first, int last) {
    int scroll = first < w->scroll ? first : w->scroll;
    while (scroll < first && rows_between(w, scroll, last) > w->rows - 5) {
        scroll++;
    }
    hn_text_panel_scroll(w, scroll);
}

void hn_text_panel_key(hn_workbench *w, int key) {
    hn_text_panel_scroll(w, w->scroll + (key == ' ' ? HN_TUI_PAGE : hn_list_step(key)));
}

void hn_text_panel_run(hn_workbench *w, const char *title, const char *const *words, int n) {
    char settings[HN_TUI_SETTINGS][128];
    const char *arguments[HN_TUI_WORDS + 2 * HN_TUI_SETTINGS + 1] = {NULL};
    int used = 0;
    for (int i = 0; i < n && i < HN_TUI_WORDS; i++) {
        arguments[used++] = words[i];
    }
    for (int i = 0; i < w->n_settings; i++) {
        char value[HN_SHORTEST_TEXT];
        hn_shortest_write(w->settings[i].value, value);
        snprintf(settings[i], sizeof settings[i], "%s=%s", w->settings[i].name, value);
        arguments[used++] = "--set";
        arguments[used++] = settings[i];
    }
    hn_text_panel_open(w, title);
    hn_strbuf_add(&w->text, "holonom");
    for (int i = 0; i < used; i++) {
        hn_strbuf_printf(&w->text, " %s", arguments[i]);
    }
    hn_strbuf_add(&w->text, "\n\n");
    if (!hn_child_start(&w->child, arguments, w->columns - 4)) {
        hn_workbench_say(w, "the command could not be started");
    }
}
