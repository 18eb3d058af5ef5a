// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/tui.h"

#include "base/clock.h"
#include "tui/controls.h"
#include "tui/drag.h"
#include "tui/keys.h"
#include "tui/screen.h"
#include "tui/views.h"

#include <langinfo.h>
#include <locale.h>
#include <math.h>
#include <poll.h>
#include <string.h>

static const double FRAME = 1.0 / 20; // [s] between two pictures; a slow line shows fewer

static hn_dot_form form_of(const hn_tui_opts *opts) {
    return opts->ascii ? HN_DOTS_ASCII : opts->blocks ? HN_DOTS_BLOCKS : HN_DOTS_BRAILLE;
}

/// ncurses writes wide characters only where the locale has them; numbers keep their points.
static void choose_characters(void) {
    setlocale(LC_CTYPE, "");
    if (strcmp(nl_langinfo(CODESET), "UTF-8") != 0) {
        setlocale(LC_CTYPE, "C.UTF-8");
    }
}

static bool inside(hn_area area, hn_mouse m) {
    return m.x >= area.x && m.y >= area.y && m.x < area.x + area.columns &&
           m.y < area.y + area.rows;
}

/// The inside of the frame around the mechanism.
static hn_area mechanism_area(const hn_places *places) {
    return (hn_area){1, 2, places->plot.x - 2, places->plot.rows - 2};
}

/// The mouse drags a joint; a click selects a method in the table, or a time in the plot.
static void point_at(hn_workbench *w, const hn_cells *c, hn_mouse mouse) {
    enum { LABELS = 9 };
    const hn_places places = hn_views_places(c->columns, c->rows, w);
    const hn_area mechanism = mechanism_area(&places);
    const int row = mouse.y - places.table.y - 1;
    if (w->panel != HN_PANEL_MAIN) {
        return;
    }

    // what is held follows until it is let go
    if (w->drag.on && mouse.what == HN_MOUSE_MOVE) {
        hn_drag_move(w, mechanism, mouse.x, mouse.y);
        return;
    }
    if (mouse.what == HN_MOUSE_RELEASE) {
        hn_drag_end(w);
        return;
    }

    // a press
    if (mouse.what == HN_MOUSE_PRESS && inside(mechanism, mouse)) {
        hn_drag_begin(w, mechanism, mouse.x, mouse.y);
    } else if (inside(places.table, mouse) && row >= 0 && row < w->n_methods) {
        w->selected = row;
    } else if (inside(places.plot, mouse) && !w->why) {
        const double share =
            (mouse.x - places.plot.x - LABELS) / (double)(places.plot.columns - LABELS - 1);
        w->clock = fmax(0, fmin(1, share)) * hn_recording_last(w->recording);
        w->playing = false;
    }
}

static void obey(hn_workbench *w, const hn_cells *c, int key, hn_mouse mouse) {
    if (key == HN_KEY_MOUSE) {
        point_at(w, c, mouse);
    } else if (key != HN_KEY_NONE && key != HN_KEY_RESIZE) {
        hn_controls_key(w, key);
    }
    if (w->copy) {
        w->copy = false;
        hn_screen_copy(hn_strbuf_text(&w->link));
    }
}

/// One picture in the present size of the terminal; false: no memory for it.
static bool show(hn_workbench *w, hn_cells *cells, const hn_tui_opts *opts) {
    int columns, rows;
    hn_screen_size(&columns, &rows);
    if ((columns != cells->columns || rows != cells->rows) &&
        !hn_cells_resize(cells, columns, rows)) {
        return false;
    }
    w->columns = columns;
    w->rows = rows;
    hn_views_draw(cells, w);
    hn_screen_show(cells, opts->ascii);
    return true;
}

bool hn_tui_run(hn_workbench *w, const hn_tui_opts *opts) {
    hn_cells cells = {0};
    choose_characters();
    if (!hn_screen_open(opts->theme, opts->colours)) {
        return false;
    }
    w->form = form_of(opts);
    double before = hn_clock_wall();
    int n = 0;
    while (!w->quit && !hn_screen_gone() && (opts->frames == 0 || n < opts->frames)) {
        if (hn_screen_ready()) {
            n++;
            if (!show(w, &cells, opts)) {
                break;
            }
        }

        // all keys that have come, so that nothing lags behind a held key
        hn_mouse mouse = {0};
        int key = hn_screen_key(FRAME, &mouse);
        while (key != HN_KEY_NONE && !w->quit) {
            obey(w, &cells, key, mouse);
            key = hn_screen_key(0, &mouse);
        }
        const double now = hn_clock_wall();
        hn_workbench_tick(w, now - before);
        before = now;
    }
    hn_cells_free(&cells);
    hn_screen_close();
    return true;
}

/// Everything up to the present time is recorded.
static void wait_for_frames(hn_workbench *w) {
    hn_recording_want(w->recording, (int)w->clock);
    while (hn_recording_frames(w->recording) <= (int)w->clock) {
        poll(NULL, 0, 5);
    }
}

static void go_to(hn_workbench *w, double t) {
    const double frame = round(t / hn_recording_frame_dt(w->recording));
    w->clock = fmax(0, fmin(frame, hn_recording_last(w->recording)));
    w->playing = false;
    wait_for_frames(w);
}

/// Types the keys; after each, what it started is waited for.
static void type_keys(hn_workbench *w, const hn_tui_opts *opts) {
    const char *rest = opts->keys ? opts->keys : "";
    for (int key = hn_tui_key_read(&rest); key != 0; key = hn_tui_key_read(&rest)) {
        hn_controls_key(w, key);
        while (w->child.pid != 0 || (w->study && hn_tui_study_running(w->study))) {
            hn_workbench_tick(w, 0);
            poll(NULL, 0, 5);
        }
        wait_for_frames(w);
        hn_workbench_tick(w, 0);
    }
}

void hn_tui_frame(hn_strbuf *b, hn_workbench *w, const hn_tui_opts *opts) {
    hn_cells cells = {0};
    w->columns = opts->columns > 0 ? opts->columns : HN_TUI_COLUMNS;
    w->rows = opts->rows > 0 ? opts->rows : HN_TUI_ROWS;
    w->form = form_of(opts);
    go_to(w, opts->t);
    type_keys(w, opts);
    if (hn_cells_resize(&cells, w->columns, w->rows)) {
        hn_views_draw(&cells, w);
        hn_cells_text(b, &cells, opts->colours);
        hn_cells_free(&cells);
    }
}
