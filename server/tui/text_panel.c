// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/text_panel.h"

#include <stdio.h>
#include <string.h>

void hn_text_panel_open(hn_workbench *w, const char *title) {
    hn_child_stop(&w->child);
    w->panel = HN_PANEL_TEXT;
    w->scroll = 0;
    hn_strbuf_clear(&w->text);
    snprintf(w->title, sizeof w->title, "%s", title);
}

void hn_text_panel_run(hn_workbench *w, const char *title, const char *const *words, int n) {
    char settings[HN_TUI_SETTINGS][128];
    const char *arguments[HN_TUI_WORDS + 2 * HN_TUI_SETTINGS + 1] = {NULL};
    int used = 0;
    for (int i = 0; i < n && i < HN_TUI_WORDS; i++) {
        arguments[used++] = words[i];
    }
    // exercises have numbers of their own; everything else is of the scene as it is shown
    for (int i = 0; i < w->n_settings && strcmp(words[0], "problem") != 0; i++) {
        snprintf(settings[i], sizeof settings[i], "%s=%.17g", w->settings[i].name,
                 w->settings[i].value);
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
