// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/controls.h"

#include "terminal/keys.h"
#include "tui/link.h"
#include "tui/panels.h"
#include "tui/prompt.h"
#include "tui/reactions_view.h"
#include "tui/remedies.h"
#include "tui/text_panel.h"
#include "tui/undo.h"
#include "tui/views.h"
#include "tui/why_view.h"

#include <math.h>
#include <string.h>

static const double SPEEDS[] = {0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10};
enum { N_SPEEDS = sizeof SPEEDS / sizeof *SPEEDS };

static void go(hn_workbench *w, double frame) {
    const int last = hn_recording_last(w->recording);
    w->clock = frame < 0 ? 0 : frame > last ? last : frame;
    w->playing = false;
}

static void change_speed(hn_workbench *w, int by) {
    int i = 0;
    while (i < N_SPEEDS - 1 && SPEEDS[i] < w->speed) {
        i++;
    }
    i += by;
    w->speed = SPEEDS[i < 0 ? 0 : i >= N_SPEEDS ? N_SPEEDS - 1 : i];
}

// ---- keys of the main view ----

static void play(hn_workbench *w) {
    if (!w->playing && w->clock >= hn_recording_last(w->recording)) {
        w->clock = 0;
    }
    w->playing = !w->playing;
}

static void copy_link(hn_workbench *w) {
    hn_strbuf_clear(&w->link);
    hn_workbench_link(w, &w->link);
    w->copy = true;

    // whole, in lines of the panel's width: a terminal need not take what it is sent
    const char *rest = hn_strbuf_text(&w->link);
    const size_t width = w->columns > 24 ? (size_t)w->columns - 4 : 20;
    hn_text_panel_open(w, "link: Esc goes back");
    hn_strbuf_add(&w->text, "The link was sent to the terminal's clipboard (OSC 52). Whether the "
                            "terminal took it is not known; this is the whole link:\n\n");
    while (*rest) {
        const size_t n = strlen(rest) < width ? strlen(rest) : width;
        hn_strbuf_printf(&w->text, "%.*s\n", (int)n, rest);
        rest += n;
    }
    hn_strbuf_add(&w->text, "\nIt opens in a browser while 'holonom serve' runs; where the page "
                            "has another address, put that in place of the part before #. "
                            "'holonom tui LINK' opens it here.\n");
}

static void select_method(hn_workbench *w, int by) {
    w->selected = (w->selected + by + w->n_methods) % w->n_methods;
}

/// Actions on the clock. Returns whether the action was one of them.
static bool act_on_clock(hn_workbench *w, hn_tui_action action) {
    static const struct {
        hn_tui_action action;
        int frames;
    } moves[] = {
        {HN_TUI_NEXT, 1}, {HN_TUI_BACK, -1}, {HN_TUI_NEXT_TEN, 10}, {HN_TUI_BACK_TEN, -10}};
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        if (moves[i].action == action) {
            go(w, floor(w->clock) + moves[i].frames);
            return true;
        }
    }

    // the start, the speed
    switch (action) {
    case HN_TUI_PLAY:
        play(w);
        return true;
    case HN_TUI_START:
    case HN_TUI_FIRST:
        go(w, 0);
        return true;
    case HN_TUI_LAST:
        go(w, hn_recording_last(w->recording));
        return true;
    case HN_TUI_SLOWER:
    case HN_TUI_FASTER:
        change_speed(w, action == HN_TUI_FASTER ? 1 : -1);
        return true;
    default:
        return false;
    }
}

static void act(hn_workbench *w, hn_tui_action action) {
    if (act_on_clock(w, action)) {
        return;
    }
    switch (action) {
    // the selected method
    case HN_TUI_UP:
    case HN_TUI_DOWN:
        select_method(w, action == HN_TUI_DOWN ? 1 : -1);
        break;
    case HN_TUI_CYCLE:
        select_method(w, 1);
        break;
    case HN_TUI_HIDE:
        w->hidden[w->selected] = !w->hidden[w->selected];
        break;

    // what is shown
    case HN_TUI_PLOT:
        w->plot = (w->plot + 1) % HN_TUI_PLOTS;
        break;
    case HN_TUI_WHY:
        w->why = !w->why;
        w->why_first = 0;
        w->reactions = false;
        break;
    case HN_TUI_REACTIONS:
        hn_reactions_toggle(w);
        break;
    case HN_TUI_PICTURES:
        hn_workbench_say(w, "%s", hn_pictures_next(&w->pictures));
        break;
    case HN_TUI_LINK:
        copy_link(w);
        break;
    case HN_TUI_UNDO:
    case HN_TUI_REDO:
        hn_undo_go(w, action == HN_TUI_REDO ? 1 : -1);
        break;
    case HN_TUI_QUIT:
        w->quit = true;
        break;
    default:
        hn_panel_open(w, action);
        break;
    }
}

/// A letter or digit that does nothing here says so, with the way to those that do.
static void say_unknown(hn_workbench *w, int key) {
    if (key >= '1' && key <= '8') {
        hn_workbench_say(w, "there is no method %c, but 1 to %d; m adds one", key, w->n_methods);
    } else if (key > ' ' && key < 127) {
        hn_workbench_say(w, "%c has no meaning here; ? lists the keys", key);
    }
}

void hn_controls_key(hn_workbench *w, int key) {
    // nothing changes that cannot be seen
    if (hn_views_too_small(w, w->columns, w->rows)) {
        w->quit = w->quit || key == 'q';
        return;
    }
    w->message[0] = '\0';
    if (w->prompt != HN_PROMPT_NONE) {
        hn_prompt_key(w, key);
    } else if (w->panel != HN_PANEL_MAIN) {
        hn_panel_key(w, key);
        const hn_tui_action chosen = (hn_tui_action)w->chosen;
        w->chosen = HN_TUI_NONE;
        act(w, chosen);
    } else if (key >= '1' && key < '1' + w->n_methods) {
        w->selected = key - '1';
    } else if (key == HN_KEY_ESCAPE) {
        w->why = w->reactions = false;
    } else if (key == HN_KEY_ENTER && w->why) {
        hn_remedies_open(w);
    } else if (w->why && (key == HN_KEY_PAGE_UP || key == HN_KEY_PAGE_DOWN)) {
        hn_why_scroll(w, hn_views_places(w->columns, w->rows, w).plot,
                      key == HN_KEY_PAGE_DOWN ? 1 : -1);
    } else if (w->reactions && (key == HN_KEY_PAGE_UP || key == HN_KEY_PAGE_DOWN)) {
        hn_reactions_scroll(w, key == HN_KEY_PAGE_DOWN ? 1 : -1);
    } else if (hn_tui_action_of(key) == HN_TUI_NONE) {
        say_unknown(w, key);
    } else {
        act(w, hn_tui_action_of(key));
    }
    hn_why_follow(w);
}
