// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/study_panel.h"

#include "base/shortest.h"
#include "render/look.h"
#include "terminal/keys.h"
#include "terminal/short_spelling.h"
#include "terminal/width.h"
#include "tui/methods.h"
#include "tui/seconds.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAP_COLUMNS = 24,
    MOST_MAP_ROWS = 24,
    LEAST_MAP_ROWS = 6,
    LEAST_DOUBLED_ROWS = 18,
    AROUND_MAP = 16, // the frame, the axes, and seven lines of sentences below
    SIDE_COLUMNS = 46,
    MOST_ROWS = 1 << 20, // more than any text has
    BETWEEN_CORNERS = 6  // columns of the upper edge that its title leaves
};

static const char FALLBACK[] = "baumgarte@rk4:h=0.01";

// ---- opening ----

/// Rows of a map, as many as the screen has room for; a tall screen draws each twice as high.
static int map_rows(const hn_workbench *w) {
    const int room = w->rows - AROUND_MAP;
    if (room / 2 >= LEAST_DOUBLED_ROWS && room / 2 <= MOST_MAP_ROWS) {
        return room / 2;
    }
    return room < LEAST_MAP_ROWS ? LEAST_MAP_ROWS : room > MOST_MAP_ROWS ? MOST_MAP_ROWS : room;
}

/// The method of a map: the selected one where it has alpha and beta, else the first that has them,
/// else Baumgarte's at a usual step.
static const char *mapped_method(const hn_workbench *w, double *alpha, double *beta) {
    for (int pass = -1; pass < w->n_methods; pass++) {
        const char *spelling = w->methods[pass < 0 ? w->selected : pass];
        hn_method_spec spec;
        hn_diag diag = {0};
        if (hn_method_parse(spelling, &spec, &diag) == HN_OK &&
            hn_method_find_option(&spec, "alpha", NULL) &&
            hn_method_find_option(&spec, "beta", NULL) &&
            strcmp(spec.formulation->name, "baumgarte") == 0) {
            *alpha = hn_method_option(&spec, "alpha", 0);
            *beta = hn_method_option(&spec, "beta", 0);
            return spelling;
        }
    }
    *alpha = *beta = (double)NAN;
    return FALLBACK;
}

/// Starts a study of the scene over `time` of motion [s]; 0: a short one.
static hn_status start(hn_workbench *w, hn_tui_study_kind kind, double time, hn_tui_study **out,
                       hn_diags *diags) {
    const hn_model_source source = hn_workbench_source(w);
    const char *methods[HN_COMPARISON_MAX_METHODS];
    int n = 0;
    for (; kind == HN_TUI_COST && n < w->n_methods; n++) {
        methods[n] = w->methods[n];
    }
    if (kind == HN_TUI_STABILITY) {
        methods[n++] = mapped_method(w, &w->present[0], &w->present[1]);
    }

    const hn_tui_study_request request = {.library = w->library,
                                          .source = &source,
                                          .kind = kind,
                                          .methods = methods,
                                          .n_methods = n,
                                          .time = time,
                                          .columns = MAP_COLUMNS,
                                          .rows = map_rows(w)};
    return hn_tui_study_start(&request, out, diags);
}

void hn_study_panel_open(hn_workbench *w, hn_tui_study_kind kind) {
    hn_diags diags = {0};
    if (kind == HN_TUI_STABILITY && hn_system_get_info(hn_model_system(w->model)).nc == 0) {
        hn_workbench_say(w,
                         "%s has no loop: there is nothing to stabilise, and no map of alpha "
                         "and beta",
                         hn_model_scene(w->model)->id);
        return;
    }
    hn_study_panel_close(w);
    if (start(w, kind, w->study_time[kind], &w->study, &diags) != HN_OK) {
        hn_workbench_say_fault(w, &diags);
        return;
    }
    w->map_rows = map_rows(w);
    w->panel = HN_PANEL_STUDY;
    w->scroll = 0;
    w->at = (hn_map_place){-1, -1};
}

void hn_study_panel_close(hn_workbench *w) {
    hn_tui_study_free(w->study);
    hn_tui_study_free(w->longer);
    w->study = w->longer = NULL;
    w->longer_failed = false;
    w->panel = HN_PANEL_MAIN;
}

/// The cheapest method of a study, without its step; false: there is none.
static bool find_cheapest(const hn_workbench *w, const hn_tui_study *study, hn_tui_cheapest *out) {
    char spelling[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    const bool known = hn_tui_study_get_kind(study) == HN_TUI_COST &&
                       hn_tui_study_wanted(study, w->wanted, &b, spelling) && spelling[0] &&
                       hn_method_parse(spelling, &spec, &diag) == HN_OK;
    hn_strbuf_reset(&b);
    if (known) {
        *out = (hn_tui_cheapest){.time = hn_tui_study_time(study)};
        snprintf(out->wanted, sizeof out->wanted, "%s", w->wanted);
        snprintf(out->method, sizeof out->method, "%s@%s", spec.formulation->name,
                 spec.stepper->name);
    }
    return known;
}

// ---- the whole motion, behind a short study ----

/// Returns whether the whole motion is to be measured too: nobody typed a time, and the short study
/// has its answer, which another length may turn round.
static bool wants_longer(const hn_workbench *w) {
    return w->study && !w->longer && !w->longer_failed && w->study_time[HN_TUI_COST] == 0 &&
           hn_tui_study_is_whole(w->study) &&
           hn_tui_study_time(w->study) < hn_model_scene(w->model)->duration;
}

/// Whether the screen has room for another number of rows than the map was started with.
static bool wants_other_rows(const hn_workbench *w) {
    return w->study && w->map_rows != map_rows(w) &&
           hn_tui_study_get_kind(w->study) == HN_TUI_STABILITY;
}

/// Makes the map anew where its size does not fit the screen any more; one that runs is stopped
/// first.
static void follow_size(hn_workbench *w) {
    if (!wants_other_rows(w)) {
        return;
    }
    if (hn_tui_study_running(w->study)) {
        hn_tui_study_stop(w->study);
    } else {
        const hn_panel panel = w->panel;
        hn_study_panel_open(w, HN_TUI_STABILITY);
        w->panel = w->study ? panel : HN_PANEL_MAIN;
    }
}

bool hn_study_panel_is_busy(const hn_workbench *w) {
    return w->study &&
           (hn_tui_study_running(w->study) || w->longer || wants_longer(w) || wants_other_rows(w));
}

void hn_study_panel_follow(hn_workbench *w) {
    hn_diags diags = {0};
    follow_size(w);
    if (wants_longer(w)) {
        w->longer_failed =
            start(w, HN_TUI_COST, hn_model_scene(w->model)->duration, &w->longer, &diags) != HN_OK;
    }
    if (!w->longer || hn_tui_study_running(w->longer)) {
        return;
    }

    // it takes the place of the short one, whose answer is said beside its own
    if (hn_tui_study_is_whole(w->longer)) {
        find_cheapest(w, w->study, &w->cheapest);
        hn_tui_study_free(w->study);
        w->study = w->longer;
    } else {
        hn_tui_study_free(w->longer);
        w->longer_failed = true;
    }
    w->longer = NULL;
}

bool hn_study_panel_set_time(hn_workbench *w, const char *text) {
    const hn_tui_study_kind kind = hn_tui_study_get_kind(w->study);
    const double most = hn_model_scene(w->model)->duration;
    double time;
    if (!hn_seconds_read(text, &time) || time > most) {
        hn_workbench_say(w, "'%.40s' is no time of motion above 0 and up to %g s; type one as 5",
                         text, most);
        return false;
    }
    w->study_time[kind] = time;
    find_cheapest(w, w->study, &w->cheapest);
    hn_study_panel_open(w, kind);
    return true;
}

// ---- keys ----

/// The value of a cell as it is taken: a step of a logarithmic axis has digits that mean nothing.
static double four_digits(double value) {
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    return strtod(text, NULL);
}

/// Enter on a map: alpha and beta of the cell go to the method, which starts again.
static void take_cell(hn_workbench *w) {
    static hn_map_plot map;
    double alpha, beta;
    hn_tui_study_map(w->study, &map);
    if (w->at.column < 0) {
        return;
    }
    const char *spelling = mapped_method(w, &alpha, &beta);
    hn_methods_set_baumgarte(w, spelling, four_digits(map.x.value[w->at.column]),
                             four_digits(map.y.value[w->at.row]));
}

/// Enter on a work-precision study: the cheapest method for the wanted error joins the methods.
static void take_cheapest(hn_workbench *w) {
    char spelling[HN_SPEC_MAX], shown[HN_SPEC_MAX];
    const double time = hn_tui_study_time(w->study);
    hn_strbuf b;
    hn_strbuf_init(&b);
    const bool known = hn_tui_study_wanted(w->study, w->wanted, &b, spelling);
    hn_strbuf_reset(&b);
    if (spelling[0]) {
        hn_short_spelling(spelling, shown, sizeof shown);
        w->panel = HN_PANEL_MAIN;
        hn_methods_add(w, spelling);
        hn_workbench_say(w, "%s, the cheapest up to t = %g s, runs beside the others", shown, time);
    } else {
        hn_workbench_say(w, known ? "no run of this study is accurate enough"
                                  : "the cheapest method is known when the study is done");
    }
}

static void move_cursor(hn_workbench *w, int dx, int dy) {
    static hn_map_plot map;
    hn_tui_study_map(w->study, &map);
    if (map.x.n == 0) {
        return;
    }

    // the first step begins at the present point
    if (w->at.column < 0) {
        const hn_map_place here = hn_map_plot_place(&map, w->present[0], w->present[1]);
        w->at = here.column < 0 ? (hn_map_place){map.x.n / 2, map.y.n / 2} : here;
    }
    const int column = w->at.column + dx, row = w->at.row + dy;
    w->at.column = column < 0 ? 0 : column >= map.x.n ? map.x.n - 1 : column;
    w->at.row = row < 0 ? 0 : row >= map.y.n ? map.y.n - 1 : row;
    w->scroll = 0; // the line of the cell is the first
}

/// Whether the answer is the same for a study of another length that was made before; or that it
/// may change, where none was.
static void add_other_length(hn_strbuf *b, const hn_workbench *w) {
    const hn_tui_cheapest *before = &w->cheapest;
    const double whole = hn_model_scene(w->model)->duration;
    hn_tui_cheapest now;
    if (!find_cheapest(w, w->study, &now)) {
        return;
    }
    const bool other =
        before->time > 0 && before->time != now.time && strcmp(before->wanted, now.wanted) == 0;
    if (other && strcmp(before->method, now.method) == 0) {
        hn_strbuf_printf(b, "For %g s and for %g s of motion the cheapest is %s.\n", before->time,
                         now.time, now.method);
    } else if (other) {
        hn_strbuf_printf(b, "For %g s of motion the cheapest is %s, for %g s it was %s.\n",
                         now.time, now.method, before->time, before->method);
    } else if (w->longer) {
        hn_strbuf_printf(b, "For %g s of motion; %g s are being measured, %.0f %% done.\n",
                         now.time, whole, 100 * hn_tui_study_share(w->longer));
    } else if (now.time < whole) {
        hn_strbuf_printf(b,
                         "For %g s of motion; for %g s another may be cheaper (t measures it).\n",
                         now.time, whole);
    }
}

/// All that there is to read: the answer about the wanted error, then the words of the study.
static void add_words(hn_strbuf *b, const hn_workbench *w) {
    char spelling[HN_SPEC_MAX];
    add_other_length(b, w);
    if (hn_tui_study_wanted(w->study, w->wanted, b, spelling)) {
        hn_strbuf_add(b, "\n\n");
    }
    hn_tui_study_words(w->study, b);
}

/// The same of a map: the cell under the cursor, of the present point before there is one; the best
/// cells, then the map as a whole.
static void add_map_words(hn_strbuf *b, const hn_workbench *w, const hn_map_plot *map) {
    const hn_map_place here = hn_map_plot_place(map, w->present[0], w->present[1]);
    const bool chosen = w->at.column >= 0;
    if (chosen || here.column >= 0) {
        hn_map_plot_words(b, map, chosen ? w->at : here);
        hn_strbuf_add(b, chosen ? " (Enter takes these)\n" : " (★ is in this cell)\n");
    }
    hn_map_plot_best_words(b, map);
    hn_tui_study_words(w->study, b);
}

/// Returns whether the text of a work-precision study stands to the right of its plot.
static bool is_beside(hn_area in) {
    return in.columns >= 60 + SIDE_COLUMNS;
}

/// Returns the area of its legend and text, beside the plot or below it.
static hn_area beside_plot(hn_area in, const hn_cost_plot *plot) {
    const int below = plot->scatter.n + 4;
    return is_beside(in) ? (hn_area){in.x + in.columns - SIDE_COLUMNS, in.y, SIDE_COLUMNS, in.rows}
                         : (hn_area){in.x + 1, in.y + in.rows - below, in.columns - 2, below};
}

/// Everything that there is to read in a study; `in`: the inside of its frame. Returns where it
/// stands; no rows: there is no room.
static hn_area text_of(hn_strbuf *b, hn_area in, const hn_workbench *w) {
    static hn_map_plot map;
    static hn_cost_plot cost;
    hn_area out = {in.x + 1, in.y + 1, in.columns - 2, in.rows - 1};
    if (hn_tui_study_get_kind(w->study) == HN_TUI_COST) {
        hn_tui_study_cost(w->study, &cost);
        const hn_area side = beside_plot(in, &cost);
        const int used = cost.scatter.n + is_beside(in);
        out = (hn_area){side.x, side.y + used, side.columns, side.rows - used};
        add_words(b, w);
    } else {
        hn_tui_study_map(w->study, &map);
        if (map.x.n == 0) {
            add_words(b, w);
            return out;
        }
        const int rows = hn_map_plot_rows(&map, in.columns, in.rows - 1);
        const bool beyond = hn_map_plot_is_beyond(&map, w->present[0], w->present[1]);
        out = (hn_area){out.x, out.y + rows, out.columns, out.rows - rows - beyond};
        add_map_words(b, w, &map);
    }
    return out;
}

/// Scrolls the text by so many of its rows; pages: by so many times what fits.
static void scroll(hn_workbench *w, int rows, int pages) {
    const hn_area in = {1, 2, w->columns - 2, w->rows - 5}; // of the frame
    hn_strbuf b;
    hn_strbuf_init(&b);
    const hn_area area = text_of(&b, in, w);
    const int all = hn_text_rows(hn_strbuf_text(&b), area.columns);
    const int last = all > area.rows ? all - area.rows : 0;
    const int to = w->scroll + rows + pages * (area.rows > 1 ? area.rows : 1);
    w->scroll = to < 0 ? 0 : to > last ? last : to;
    hn_strbuf_reset(&b);
}

void hn_study_panel_key(hn_workbench *w, int key) {
    const bool map = hn_tui_study_get_kind(w->study) == HN_TUI_STABILITY;
    const int down = (key == HN_KEY_DOWN) - (key == HN_KEY_UP);
    const int across = (key == HN_KEY_RIGHT) - (key == HN_KEY_LEFT);
    const int page = (key == HN_KEY_PAGE_DOWN) - (key == HN_KEY_PAGE_UP);
    const int end = (key == HN_KEY_END) - (key == HN_KEY_HOME);
    if (key == HN_KEY_ESCAPE && hn_tui_study_running(w->study)) {
        hn_tui_study_stop(w->study);
    } else if (key == HN_KEY_ESCAPE || key == 'q') {
        hn_study_panel_close(w);
    } else if (map && key == HN_KEY_ENTER) {
        take_cell(w);
    } else if (!map && key == HN_KEY_ENTER) {
        take_cheapest(w);
    } else if (!map && key == 'e') {
        hn_workbench_ask(w, HN_PROMPT_WANTED, w->wanted);
    } else if (key == 't') {
        char text[HN_SHORTEST_TEXT];
        hn_shortest_write(hn_tui_study_time(w->study), text);
        hn_workbench_ask(w, HN_PROMPT_STUDY_TIME, text);
    } else if (map && (down || across)) {
        move_cursor(w, across, -down);
    } else if (down || page || end) {
        scroll(w, down + MOST_ROWS * end, page);
    }
}

// ---- drawing ----

/// Draws the text of the study from the row that is scrolled to, and says in the frame (`edge`)
/// that there is more of it.
static void draw_text(hn_cells *c, hn_area in, const hn_workbench *w) {
    const hn_area edge = {in.x, in.y + in.rows, in.columns, 1};
    hn_strbuf b;
    hn_strbuf_init(&b);
    const hn_area area = text_of(&b, in, w);
    const int all = hn_text_rows(hn_strbuf_text(&b), area.columns);
    hn_cells_fold(c, area, -w->scroll, HN_CELL_INK, hn_strbuf_text(&b));
    if (all - w->scroll > area.rows) {
        hn_cells_put(c, edge, 1, 0, HN_CELL_MUTED, 0, " PageDown: more ");
    } else if (w->scroll > 0) {
        hn_cells_put(c, edge, 1, 0, HN_CELL_MUTED, 0, " PageUp: back ");
    }
    hn_strbuf_reset(&b);
}

/// A line a method: its glyph, how many points are done, how many ended early.
static void draw_legend(hn_cells *c, hn_area area, const hn_cost_plot *p) {
    for (int m = 0; m < p->scatter.n && m < area.rows; m++) {
        hn_cells_put(c, area, 0, m, p->scatter.series[m].colour, HN_CELL_BOLD,
                     p->scatter.series[m].glyph);
        int x = 2 + hn_cells_printf(c, area, 2, m, HN_CELL_INK, 0, "%d/%d ", p->done[m], p->levels);
        if (p->failed[m] > 0) {
            x +=
                hn_cells_printf(c, area, x, m, HN_CELL_ALARM, 0, "╳ %d ended early ", p->failed[m]);
        }
        char shown[HN_SPEC_MAX];
        hn_short_spelling(p->name[m], shown, sizeof shown);
        hn_cells_put(c, area, x, m, HN_CELL_INK, 0, shown);
    }
}

/// A method has the colour and glyph of the table: the study is about its methods, in its order.
static void take_looks(hn_cost_plot *plot, const hn_workbench *w) {
    for (int m = 0; m < plot->scatter.n && m < w->n_methods; m++) {
        const int slot = hn_recording_track(w->recording, m)->slot;
        plot->scatter.series[m].colour = slot;
        plot->scatter.series[m].glyph = hn_look_get(slot)->glyph;
    }
}

/// The plot, and beside or below it a legend and what there is to read.
static void draw_cost(hn_cells *c, hn_area in, const hn_workbench *w) {
    static hn_cost_plot plot;
    hn_tui_study_cost(w->study, &plot);
    take_looks(&plot, w);
    const hn_area side = beside_plot(in, &plot);
    const hn_area left = is_beside(in)
                             ? (hn_area){in.x, in.y + 1, in.columns - SIDE_COLUMNS - 2, in.rows - 1}
                             : (hn_area){in.x, in.y + 1, in.columns, in.rows - side.rows - 1};
    if (!hn_cost_plot_draw(c, left, &plot, w->form)) {
        hn_cells_put(c, in, 1, 2, HN_CELL_MUTED, 0,
                     hn_tui_study_running(w->study) ? "the reference solution is computed first"
                                                    : "no points to draw");
    } else {
        hn_cells_put(c, in, 1, 0, HN_CELL_MUTED, 0, hn_cost_plot_title(&plot));
    }
    draw_legend(c, side, &plot);
    draw_text(c, in, w);
}

static void draw_map(hn_cells *c, hn_area in, const hn_workbench *w) {
    static hn_map_plot map;
    hn_tui_study_map(w->study, &map);
    if (map.x.n == 0) {
        draw_text(c, in, w);
        return;
    }
    const hn_map_place here = hn_map_plot_place(&map, w->present[0], w->present[1]);
    char shown[HN_SPEC_MAX];
    hn_short_spelling(map.name, shown, sizeof shown);
    const int used = 1 + hn_cells_put(c, in, 1, 0, HN_CELL_INK, HN_CELL_BOLD, shown);
    const char *const square = w->form == HN_DOTS_ASCII ? "beta^2" : "beta²";
    char law[80];
    snprintf(law, sizeof law, "the gap e obeys e'' + 2 alpha e' + %s e = 0", square);
    if (used + 2 + hn_text_columns(law) > in.columns) { // what an equation lacks would be another
        snprintf(law, sizeof law, "e'' + 2 alpha e' + %s e = 0", square);
    }
    if (used + 2 + hn_text_columns(law) <= in.columns) {
        hn_cells_put(c, in, used + 2, 0, HN_CELL_MUTED, 0, law);
    }
    hn_map_plot_draw(c, (hn_area){in.x, in.y + 1, in.columns, in.rows - 1}, &map, here, w->at);

    // below it what it says
    draw_text(c, in, w);
    if (hn_map_plot_is_beyond(&map, w->present[0], w->present[1])) {
        hn_cells_printf(c, in, 1, in.rows - 1, HN_CELL_INK, 0,
                        "★ at the edge: now alpha = %.4g, beta = %.4g, beyond the map",
                        w->present[0], w->present[1]);
    }
}

/// The name of the study, its length of motion, how far it is, and the key that ends it.
static void write_title(const hn_workbench *w, int room, char title[HN_TUI_LINE]) {
    const bool cost = hn_tui_study_get_kind(w->study) == HN_TUI_COST;
    const char *name = cost ? "what accuracy costs" : "stability over alpha and beta";
    const double time = hn_tui_study_time(w->study);
    const double done = 100 * hn_tui_study_share(w->study);
    char state[48] = "", ends[32] = "Esc goes back";
    if (hn_tui_study_running(w->study) && hn_tui_study_stopping(w->study)) {
        snprintf(title, HN_TUI_LINE, "%s in %g s: stopping, what is done stays", name, time);
        return;
    }
    if (hn_tui_study_running(w->study)) {
        snprintf(state, sizeof state, "%.0f %% done, ", done);
        snprintf(ends, sizeof ends, "Esc stops");
    } else if (hn_tui_study_stopping(w->study)) {
        snprintf(state, sizeof state, "stopped at %.0f %%, ", done);
    }

    // where it is too long the line of the keys alone says how to move
    static const char *const moves[] = {"arrows move, ★ is now, ", "★ is now, ", ""};
    for (int i = cost ? 2 : 0; i < 3; i++) {
        snprintf(title, HN_TUI_LINE, "%s in %g s: %s%s%s", name, time, state, moves[i], ends);
        if (hn_text_columns(title) <= room) {
            return;
        }
    }
}

void hn_study_panel_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    char title[HN_TUI_LINE];
    write_title(w, area.columns - BETWEEN_CORNERS, title);
    const hn_area in = hn_cells_frame(c, area, title);
    if (hn_tui_study_get_kind(w->study) == HN_TUI_COST) {
        draw_cost(c, in, w);
    } else {
        draw_map(c, in, w);
    }
}
