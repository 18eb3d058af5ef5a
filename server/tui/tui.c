// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/tui.h"

#include "base/clock.h"
#include "render/look.h"
#include "terminal/keys.h"
#include "terminal/kitty_image.h"
#include "tui/controls.h"
#include "tui/drag.h"
#include "tui/mechanism_picture.h"
#include "tui/screen.h"
#include "tui/study_panel.h"
#include "tui/views.h"

#include <langinfo.h>
#include <locale.h>
#include <math.h>
#include <poll.h>
#include <string.h>

static const double LATE = 1.5; // [s] until a picture of pixels has arrived

/// Content of the screen.
typedef struct view {
    hn_cells cells;
    hn_mechanism_picture picture;
    hn_strbuf sequence; ///< of the picture, while it is sent
    bool wiped;         ///< the picture is gone, whoever wiped it
} view;

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

/// The mouse drags a joint; a click selects a method in the table, or a time in the plot.
static void point_at(hn_workbench *w, const hn_cells *c, hn_mouse mouse) {
    enum { LABELS = 9 };
    const hn_places places = hn_views_places(c->columns, c->rows, w);
    const int row = mouse.y - places.table.y - 1;
    hn_area mechanism;
    if (w->panel != HN_PANEL_MAIN || !hn_views_mechanism(c->columns, c->rows, w, &mechanism)) {
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

    // a press on what is seen
    if (hn_views_too_small(w, c->columns, c->rows)) {
        return;
    }
    if (mouse.what == HN_MOUSE_PRESS && inside(mechanism, mouse)) {
        hn_drag_begin(w, mechanism, mouse.x, mouse.y);
    } else if (inside(places.table, mouse) && row >= 0 && row < w->n_methods) {
        w->selected = row;
    } else if (inside(places.plot, mouse) && !w->why && !w->reactions) {
        const double share =
            (mouse.x - places.plot.x - LABELS) / (double)(places.plot.columns - LABELS - 1);
        w->clock = fmax(0, fmin(1, share)) * hn_recording_last(w->recording);
        w->playing = false;
    }
}

static void ask(const char *question) {
    if (question) {
        hn_screen_ask(question);
    }
}

static void obey(hn_workbench *w, view *v, int key, hn_mouse mouse) {
    if (key == HN_KEY_MOUSE) {
        point_at(w, &v->cells, mouse);
    } else if (key == HN_KEY_ANSWER) {
        const int theme = w->pictures.theme;
        ask(hn_pictures_answer(&w->pictures, hn_screen_answer()));
        if (w->pictures.theme != theme) {
            hn_screen_set_theme(w->pictures.theme);
        }
    } else if (key == HN_KEY_RESIZE) {
        v->wiped = true;
    } else if (key != HN_KEY_NONE) {
        hn_controls_key(w, key);
    }
    if (w->copy) {
        w->copy = false;
        hn_screen_copy(hn_strbuf_text(&w->link));
    }
}

/// A picture that came late once is not sent again: everything else would come late with it.
static void judge_line(hn_workbench *w) {
    if (w->pictures.wanted == HN_PIXELS_AUTO && hn_screen_delay() > LATE) {
        w->pictures.wanted = HN_PIXELS_OFF;
        hn_workbench_say(w,
                         "a picture took %.1f s to arrive: the mechanism is in characters; c tries "
                         "pictures again",
                         hn_screen_delay());
    }
}

/// The sequences that the mechanism's picture needs: a new one, or that the old one goes.
static void make_picture(hn_workbench *w, view *v) {
    hn_area area;
    const hn_pixels form = hn_pictures_form(&w->pictures), there = v->picture.form;
    const bool wanted =
        form != HN_PIXELS_OFF && hn_views_mechanism(v->cells.columns, v->cells.rows, w, &area);
    const bool moved = wanted && memcmp(&area, &v->picture.area, sizeof area) != 0;
    hn_strbuf_clear(&v->sequence);

    // what is elsewhere, or of another kind, goes first
    if (there != HN_PIXELS_OFF && (!wanted || moved || form != there || v->wiped)) {
        hn_mechanism_picture_remove(&v->picture, &v->sequence);
        hn_screen_rewrite(v->picture.area.y, v->picture.area.rows);
    }
    if (wanted) {
        hn_mechanism_picture_show(&v->picture, &v->sequence, w, area);
        hn_screen_farewell(form == HN_PIXELS_KITTY ? HN_KITTY_REMOVE_ALL : NULL);
    }
    v->wiped = false;
}

/// One picture in the present size of the terminal; false: no memory for it.
static bool show(hn_workbench *w, view *v, const hn_tui_opts *opts) {
    int columns, rows, width, height;
    hn_screen_size(&columns, &rows);
    hn_screen_pixels(&width, &height);
    if ((columns != v->cells.columns || rows != v->cells.rows) &&
        !hn_cells_resize(&v->cells, columns, rows)) {
        return false;
    }
    w->columns = columns;
    w->rows = rows;
    ask(hn_pictures_resize(&w->pictures, columns, rows, width, height));
    judge_line(w);
    hn_views_update(w);
    make_picture(w, v);
    hn_views_draw(&v->cells, w);
    hn_screen_show(&v->cells, opts->ascii, &v->sequence);
    return true;
}

/// Time goes on by `seconds`, for the motion and for the studies behind it.
static void tick(hn_workbench *w, double seconds) {
    hn_workbench_tick(w, seconds);
    hn_study_panel_follow(w);
}

bool hn_tui_run(hn_workbench *w, const hn_tui_opts *opts) {
    view v = {.picture = {.form = HN_PIXELS_OFF}};
    choose_characters();
    if (!hn_screen_open(opts->theme < 0 ? HN_THEME_DARK : opts->theme, opts->colours)) {
        return false;
    }
    hn_strbuf_init(&v.sequence);
    w->form = form_of(opts);
    w->computes = true;
    w->pictures = hn_pictures_start(opts->pictures, opts->theme);
    ask(hn_pictures_question(&w->pictures));
    double before = hn_clock_wall();
    int n = 0;
    while (!w->quit && !hn_screen_gone() && (opts->frames == 0 || n < opts->frames)) {
        if (hn_screen_ready()) {
            n++;
            if (!show(w, &v, opts)) {
                break;
            }
        }

        // all keys that have come, so that nothing lags behind a held key
        hn_mouse mouse = {0};
        int key = hn_screen_key(HN_TUI_FRAME, &mouse);
        while (key != HN_KEY_NONE && !w->quit) {
            obey(w, &v, key, mouse);
            key = hn_screen_key(0, &mouse);
        }
        const double now = hn_clock_wall();
        tick(w, now - before);
        before = now;
    }
    hn_cells_free(&v.cells);
    hn_strbuf_reset(&v.sequence);
    hn_screen_close();
    return true;
}

/// Everything that the views need is recorded: up to the present time, or all where remedies are
/// tried at the end.
static void wait_for_frames(hn_workbench *w) {
    const int wanted = w->why ? hn_recording_last(w->recording) : (int)w->clock;
    hn_recording_want(w->recording, wanted);
    while (hn_recording_frames(w->recording) <= wanted || hn_recording_is_asking(w->recording)) {
        poll(NULL, 0, 5);
    }
}

/// The card of the reasons is whole: shorter steps have been tried.
static void wait_for_trial(hn_workbench *w) {
    hn_step_report step;
    while (hn_workbench_step_report(w, &step) && step.finding == HN_STEP_RUNNING) {
        poll(NULL, 0, 5);
    }
}

static void go_to(hn_workbench *w, double t) {
    const int last = hn_recording_last(w->recording);
    const double frame = round(t / hn_recording_frame_dt(w->recording));
    w->clock = t >= hn_recording_duration(w->recording) ? last : fmax(0, fmin(frame, last));
    w->playing = false;
    wait_for_frames(w);
}

/// Types the keys; after each, what it started is waited for.
static void type_keys(hn_workbench *w, const hn_tui_opts *opts) {
    const char *rest = opts->keys ? opts->keys : "";
    for (int key = hn_tui_key_read(&rest); key != 0; key = hn_tui_key_read(&rest)) {
        hn_controls_key(w, key);
        while (w->child.pid != 0 || hn_study_panel_is_busy(w)) {
            tick(w, 0);
            poll(NULL, 0, 5);
        }
        wait_for_frames(w);
        tick(w, 0);
        wait_for_trial(w);
    }
}

void hn_tui_frame(hn_strbuf *b, hn_workbench *w, const hn_tui_opts *opts) {
    hn_cells cells = {0};
    w->columns = opts->columns > 0 ? opts->columns : HN_TUI_COLUMNS;
    w->rows = opts->rows > 0 ? opts->rows : HN_TUI_ROWS;
    w->form = form_of(opts);
    go_to(w, opts->t);
    type_keys(w, opts);
    tick(w, 0);
    wait_for_trial(w);
    if (hn_cells_resize(&cells, w->columns, w->rows)) {
        hn_views_update(w);
        hn_views_draw(&cells, w);
        hn_cells_text(b, &cells, opts->colours);
        hn_cells_free(&cells);
    }
}
