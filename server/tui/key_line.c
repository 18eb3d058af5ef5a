// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/key_line.h"

#include "terminal/width.h"
#include "tui/why_view.h"

#include <stdio.h>
#include <string.h>

/// Between two keys.
static const char GAP[] = "  ";

/// Keys of the main screen: while runs stand and while they go on, with room and without.
static const char SHORT_LINE[] =
    "Space run  ←→ step  1-8 method  d dt  g plot  i why  b map  s scene  ? menu  q";
static const char LONG_LINE[] = "Space run  ←→ step  1-8 method  d dt  g plot  i why  b map  "
                                "w cost  m methods  s scene  p values  ? menu  q";
static const char SHORT_STOP[] =
    "Space stop  ←→ step  1-8 method  d dt  g plot  i why  b map  s scene  ? menu q";
static const char LONG_STOP[] = "Space stop  ←→ step  1-8 method  d dt  g plot  i why  b map  "
                                "w cost  m methods  s scene  p values  ? menu  q";

static const char *const LISTS[] = {
    [HN_LIST_SCENES] = "letters search  Backspace  ↑↓ choose  Enter open  Esc back",
    [HN_LIST_METHODS] = "↑↓ choose  Enter change  x remove  Esc back",
    [HN_LIST_FORMULATIONS] = "↑↓ choose  Enter types the rest  letters find  Esc back",
    [HN_LIST_PARAMETERS] = "↑↓ choose  ←→ change  Enter type  letters find  Esc back",
    [HN_LIST_LESSONS] = "↑↓ choose  Enter open  letters find  Esc back",
    [HN_LIST_EXPORTS] = "↑↓ choose  Enter name a file  Esc back",
    [HN_LIST_ACTIONS] = "↑↓ choose  Enter do it  Esc back",
    [HN_LIST_REMEDIES] = "↑↓ choose  Enter try it  Esc back"};

/// Keys of a study: of a stability map or of a list, while it runs and after it.
static const char *study_line(const hn_tui_study *study) {
    const bool map = hn_tui_study_get_kind(study) == HN_TUI_STABILITY;
    if (hn_tui_study_running(study)) {
        return map ? "arrows choose a cell  Enter take its alpha and beta  t time  ? menu  Esc stop"
                   : "e error wanted  t time  ↑↓ scroll  ? menu  Esc stop";
    }
    return map ? "arrows choose a cell  Enter take its alpha and beta  t time  ? menu  Esc back"
               : "e error wanted  Enter add the cheapest  t time  ↑↓ scroll  ? menu  Esc back";
}

/// Keys of the main screen with what is open beside the picture. more: it goes on below.
static const char *main_line(const hn_workbench *w, bool more, int columns) {
    if (w->why && more) {
        return hn_why_has_remedy(w)
                   ? "Enter try a remedy  ↑↓ another method  PageDown more  i close  ? menu  q"
                   : "↑↓ another method  PageDown more  i close  Space run  ? menu  q";
    }
    if (w->why) {
        return hn_why_has_remedy(w) ? "Enter try a remedy  ↑↓ another method  i close  ? menu  q"
                                    : "↑↓ another method  i close  Space run  ? menu  q";
    }
    if (w->reactions) {
        return "←→ step  ↑↓ another method  PageDown more  r close  Space run  ? menu  q";
    }
    if (w->playing) {
        return hn_text_columns(LONG_STOP) <= columns ? LONG_STOP : SHORT_STOP;
    }
    return hn_text_columns(LONG_LINE) <= columns ? LONG_LINE : SHORT_LINE;
}

/// All keys of what is shown that a line of usual width has room for.
static const char *whole_line(const hn_workbench *w, bool more, int columns) {
    switch (w->panel) {
    case HN_PANEL_LIST:
        return LISTS[w->list];
    case HN_PANEL_TEXT:
        return "↑↓ line  PageUp PageDown Space page  Home End  Esc back";
    case HN_PANEL_EXERCISE:
        return "↑↓ part  Enter type  c check  h hint  PageUp PageDown  Esc back";
    case HN_PANEL_STUDY:
        return study_line(w->study);
    default:
        return main_line(w, more, columns);
    }
}

/// Returns where the end begins that is never left out: "? menu  q", or the last key.
static const char *end_of(const char *line) {
    const char *last = strstr(line, "? menu");
    for (const char *at = line; !last && (at = strstr(at, GAP)) != NULL; at += strlen(GAP)) {
        last = strstr(at + strlen(GAP), GAP) ? NULL : at + strlen(GAP);
    }
    return last ? last : line;
}

void hn_key_line(const hn_workbench *w, bool more, int columns, char out[HN_TUI_LINE]) {
    const char *line = whole_line(w, more, columns), *end = end_of(line), *to = end;
    for (;;) {
        snprintf(out, HN_TUI_LINE, "%.*s%s", (int)(to - line), line, end);
        if (hn_text_columns(out) <= columns || to == line) {
            break;
        }

        // back over one key and the gap behind it
        for (to -= strlen(GAP); to > line && strncmp(to - strlen(GAP), GAP, strlen(GAP)) != 0;) {
            to--;
        }
    }

    // the last key has its word where there is room
    const size_t n = strlen(out);
    if (n > 1 && strcmp(out + n - 2, " q") == 0 && hn_text_columns(out) + 5 <= columns) {
        snprintf(out + n, HN_TUI_LINE - n, " quit");
    }
}
