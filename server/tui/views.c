// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/views.h"

#include "base/units.h"
#include "cli/shell/plain.h"
#include "render/look.h"
#include "session/model/caption.h"
#include "session/verdict/verdict.h"
#include "study/incidents/wording.h"
#include "terminal/plot.h"
#include "tui/key_line.h"
#include "tui/list_view.h"
#include "tui/mechanism_view.h"
#include "tui/method_name.h"
#include "tui/methods.h"
#include "tui/reactions_view.h"
#include "tui/study_panel.h"
#include "tui/text_view.h"
#include "tui/why_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NUMBER_DIGITS = 2 }; // significant, as in the page
enum {
    LEAST_NAME = 7,
    SHORT_NAME = 14,
    MOST_NAME = 22,
    VERDICT_COLUMNS = 51,
    MOST_INCIDENTS = 512
};
enum { MESSAGE_LINES = 6, INCIDENT_LINES = 7 }; // at most; the longest incident has 7
enum { NOTICE_ROWS = 2 };                       // kept free below the views, at least
enum {
    WIDE_NUMBER = 9,
    TIGHT_NUMBER = 8,
    LEAST_NUMBERS = 2,
    ENERGY_NUMBERS = 3
};                                // columns of a number; gap and error, and energy
enum { BESIDE_TITLE = 6 };        // columns of a frame's edge that its title leaves
enum { LEAST_VIEW_COLUMNS = 32 }; // from which on the plot has room for its labels
enum { LEAST_VIEW_ROWS = 6 };     // of mechanism and plot, with their frame: fewer would be empty

/// [s] for which the clock waits before it is said that the methods are slower: a single late frame
/// is none.
static const double LATE = 1.0;

/// The verdict on a counter-example as long as nothing shows.
static const char OTHER_EQUATIONS[] = "it solves other equations";

/// An incident is news for this share of the motion.
static const double NEWS = 0.2;

// ---- places ----

static hn_area header_area(const hn_cells *c) {
    return (hn_area){1, 0, c->columns - 2, 1};
}

/// Rows below the views: a long incident takes more of them, as far as the views can be spared.
static int notice_rows(int columns, int rows, const hn_workbench *w) {
    const int needed = hn_text_rows(w->notice, columns - 2);
    const int most = rows - 1 - (w->n_methods + 2) - 1 - LEAST_VIEW_ROWS;
    const int wanted = needed < INCIDENT_LINES ? needed : INCIDENT_LINES;
    const int given = wanted < most ? wanted : most;
    return given > NOTICE_ROWS ? given : NOTICE_ROWS;
}

static hn_area table_area(int columns, int rows, const hn_workbench *w) {
    const int height = w->n_methods + 2;
    return (hn_area){0, rows - 1 - notice_rows(columns, rows, w) - height, columns, height};
}

hn_places hn_views_places(int columns, int rows, const hn_workbench *w) {
    const hn_area table = table_area(columns, rows, w);
    const int left = columns * 9 / 20;
    return (hn_places){.table = table, .plot = {left, 1, columns - left, table.y - 1}};
}

static hn_area inside_of(hn_area frame) {
    return (hn_area){frame.x + 1, frame.y + 1, frame.columns - 2, frame.rows - 2};
}

/// A panel takes the place of the views.
static hn_area panel_area(int columns, int rows) {
    return (hn_area){0, 1, columns, rows - 3};
}

bool hn_views_mechanism(int columns, int rows, const hn_workbench *w, hn_area *out) {
    const hn_places places = hn_views_places(columns, rows, w);
    if (w->panel == HN_PANEL_MAIN) {
        *out = inside_of((hn_area){0, 1, places.plot.x, places.plot.rows});
    } else if (!hn_list_view_picture(inside_of(panel_area(columns, rows)), w, out)) {
        return false;
    }
    return out->columns >= 4 && out->rows >= 3;
}

// ---- lines above and below ----

static void draw_header(hn_cells *c, const hn_workbench *w) {
    const hn_area area = header_area(c);
    const double t = hn_recording_time(w->recording, hn_workbench_frame(w));
    const hn_scene *scene = hn_model_scene(w->model);
    const double h = hn_methods_step(w);
    // time stands still behind a panel
    const bool runs = w->playing && w->panel == HN_PANEL_MAIN;
    int x = hn_cells_put(c, area, 0, 0, HN_CELL_INK, HN_CELL_BOLD, "holonom  ");
    x += hn_cells_printf(c, area, x, 0, HN_CELL_INK, 0, "%.30s  ", scene->id);
    x += hn_cells_printf(c, area, x, 0, HN_CELL_INK, 0, "t %.3f s of %.4g s  ×%g  %s  ", t,
                         hn_recording_duration(w->recording), w->speed,
                         runs ? "▶ running" : "‖ paused");
    if (isfinite(h)) {
        char step[HN_SI_TEXT];
        hn_si_format(h, "s", 3, step);
        x += hn_cells_printf(c, area, x, 0, HN_CELL_INK, 0, "dt %s  ", step);
    }
    const double slow =
        hn_recording_frame_seconds(w->recording) / hn_recording_frame_dt(w->recording);
    if (w->playing && slow > 2 && w->late >= LATE) {
        hn_cells_printf(c, area, x, 0, HN_CELL_ALARM, 0, "%.0f times slower than the clock", slow);
    }
}

/// Returns whether what was said does not fit one line; a line that is typed keeps its place.
static bool needs_two_lines(const hn_cells *c, const hn_workbench *w) {
    return w->prompt == HN_PROMPT_NONE && hn_text_columns(w->message) > c->columns - 2;
}

/// The last line: what is typed, or the keys.
static void draw_footer(hn_cells *c, const hn_workbench *w) {
    static const char *const asks[] = {[HN_PROMPT_STEP] = "dt of every method, as 0.02 or 20 ms: ",
                                       [HN_PROMPT_METHOD] = "method: ",
                                       [HN_PROMPT_PARAMETER] = "value: ",
                                       [HN_PROMPT_EXPORT] = "write to: ",
                                       [HN_PROMPT_ANSWER] = "answer: ",
                                       [HN_PROMPT_WANTED] = "error wanted: ",
                                       [HN_PROMPT_STUDY_TIME] = "length of motion to study [s]: "};
    const hn_area area = {1, c->rows - 1, c->columns - 2, 1};
    if (w->prompt != HN_PROMPT_NONE) {
        const int x = hn_cells_put(c, area, 0, 0, HN_CELL_INK, HN_CELL_BOLD, asks[w->prompt]);
        const int room = area.columns - x - 1;
        const int from = w->n_input > room && room > 0 ? w->n_input - room : 0;
        const int style = w->replaces ? HN_CELL_REVERSE : HN_CELL_PLAIN;
        const int end = x + hn_cells_put(c, area, x, 0, HN_CELL_INK, style, w->input + from);
        hn_cells_put(c, area, end, 0, HN_CELL_INK, HN_CELL_REVERSE, " ");
    } else if (!needs_two_lines(c, w)) {
        char keys[HN_TUI_LINE];
        const hn_area plot = hn_views_places(w->columns, w->rows, w).plot;
        hn_key_line(w, w->why && hn_why_has_more(plot, w), area.columns, keys);
        hn_cells_put(c, area, 0, 0, HN_CELL_MUTED, 0, keys);
    }
}

/// Text that ends in row `last`, in as many lines as it needs, `most` of them; what they cover is
/// wiped.
static void draw_lines(hn_cells *c, hn_area area, int last, int most, int colour,
                       const char *text) {
    const int needed = hn_text_rows(text, area.columns);
    const int rows = needed < most ? needed : most;
    const hn_area lines = {area.x, last - rows + 1, area.columns, rows};
    for (int y = lines.y; y <= last; y++) {
        hn_cells_printf(c, (hn_area){0, y, c->columns, 1}, 0, 0, HN_CELL_INK, 0, "%*s", c->columns,
                        "");
    }
    hn_cells_fold_fitted(c, lines, colour, text);
}

/// Returns whether an incident is worth the line: it has just happened, its method is the selected
/// one, which is still not well (`ill`), or it is the one that ended its method.
static bool is_news(const hn_workbench *w, const hn_incident *incident, int method, bool ill) {
    const double t = hn_recording_time(w->recording, hn_workbench_frame(w));
    const bool late = t - incident->t > NEWS * hn_recording_duration(w->recording);
    const hn_track_end end = hn_recording_end(w->recording, method);
    const bool last = end.failed && incident->t >= end.t;
    return incident->t <= t && !w->hidden[method] &&
           (!late || last || (ill && method == w->selected));
}

void hn_views_update(hn_workbench *w) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS];

    hn_methods_update(w);
    hn_why_follow(w);

    // the last one so far, of the selected method if it has any
    const int frame = hn_workbench_frame(w);
    const bool ill = hn_recording_verdict(w->recording, w->selected, frame).tone != HN_TONE_CALM;
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    int last = -1;
    for (int i = 0; i < n; i++) {
        const bool chosen = last >= 0 && whose[last] == w->selected;
        const bool better = whose[i] == w->selected || !chosen;
        if (better && is_news(w, &list[i], whose[i], ill)) {
            last = i;
        }
    }
    w->notice[0] = '\0';
    w->notice_of = last >= 0 ? whose[last] : 0;
    if (last >= 0 && w->panel == HN_PANEL_MAIN) {
        char message[480], name[HN_METHOD_NAME];
        hn_method_name(w, whose[last], MOST_NAME, name);
        hn_wording_behind_time(list[last].t, list[last].message, message, sizeof message);
        snprintf(w->notice, sizeof w->notice, "! %s at %.4g s: %s", name, list[last].t, message);
    }
}

/// Says at the end of a notice that is cut which keys show all of it.
static void say_the_rest(hn_cells *c, hn_area line, const hn_workbench *w) {
    char words[64];
    if (w->notice_of == w->selected) {
        snprintf(words, sizeof words, " … i: the rest");
    } else {
        snprintf(words, sizeof words, " … %d, then i: the rest", w->notice_of + 1);
    }
    hn_cells_put(c, line, line.columns - hn_text_columns(words), 0, HN_CELL_ALARM, 0, words);
}

/// Draws the last notice; else the newest incident.
static void draw_notice(hn_cells *c, const hn_workbench *w) {
    const hn_area area = {1, c->rows - 2, c->columns - 2, 1};
    if (w->message[0]) {
        // a long one takes the place of the keys, and of rows above
        draw_lines(c, area, area.y + needs_two_lines(c, w), MESSAGE_LINES, HN_CELL_INK, w->message);
    } else if (w->notice[0]) {
        const int rows = notice_rows(c->columns, c->rows, w);
        draw_lines(c, area, area.y, rows, HN_CELL_ALARM, w->notice);
        if (hn_text_rows(w->notice, area.columns) > rows) {
            say_the_rest(c, area, w);
        }
    }
}

// ---- the method table ----

/// Columns of numbers, the most important first; those that have no room are left out from the end.
typedef struct number_column {
    const char *head, *unit;
    const double *(*of)(const hn_track *t);
} number_column;

static const double *gap_of(const hn_track *t) {
    return t->gap;
}
static const double *error_of(const hn_track *t) {
    return t->error;
}
static const double *energy_of(const hn_track *t) {
    return t->energy;
}
static const double *step_ops_of(const hn_track *t) {
    return t->step_ops;
}

static const number_column NUMBERS[] = {{"now: gap", "m", gap_of},
                                        {"error", "m", error_of},
                                        {"energy", "J", energy_of},
                                        {"ops/step", "", step_ops_of}};
enum { N_NUMBERS = sizeof NUMBERS / sizeof *NUMBERS };

/// Places of the columns of the table, in columns of its inside.
typedef struct table_columns {
    int name, numbers, number, verdict; ///< number: width of one
    int name_width;
} table_columns;

/// Gap and error are shown even where the verdict is cut, the others while it has room; names are
/// shortened before the energy goes.
static table_columns lay_out(const hn_workbench *w, int width) {
    int longest = LEAST_NAME;
    for (int m = 0; m < w->n_methods; m++) {
        char name[HN_METHOD_NAME];
        hn_method_name(w, m, MOST_NAME, name);
        const int n = hn_text_columns(name);
        longest = n > longest ? n : longest;
    }
    const int short_name = width - 3 - 1 - VERDICT_COLUMNS - ENERGY_NUMBERS * WIDE_NUMBER;
    longest = short_name >= SHORT_NAME && short_name < longest ? short_name : longest;
    const int room = width - 3 - longest - 1 - VERDICT_COLUMNS;
    const int wide = room / WIDE_NUMBER;
    const int numbers = wide < LEAST_NUMBERS ? LEAST_NUMBERS : wide < N_NUMBERS ? wide : N_NUMBERS;
    const int number = wide < LEAST_NUMBERS ? TIGHT_NUMBER : WIDE_NUMBER;
    return (table_columns){3, numbers, number, 3 + longest + numbers * number + 1, longest};
}

/// Returns where number i ends.
static int number_end(table_columns at, int i) {
    return at.verdict - 1 - (at.numbers - 1 - i) * at.number;
}

static void put_number(hn_cells *c, hn_area area, int right, int y, double value,
                       const char *unit) {
    char text[HN_SI_TEXT];
    if (!isfinite(value)) {
        snprintf(text, sizeof text, "-");
    } else if (!unit[0]) {
        snprintf(text, sizeof text, "%.0f", value);
    } else if (fabs(value) < HN_SI_SMALLEST && value != 0) {
        snprintf(text, sizeof text, "%.0e %s", value, unit);
    } else {
        hn_si_format(hn_round_digits(value, NUMBER_DIGITS), unit, NUMBER_DIGITS, text);
    }
    hn_cells_put(c, area, right - hn_text_columns(text), y, HN_CELL_INK, 0, text);
}

/// Puts words of a verdict that say the same in less room, until it fits.
static void shorten(char *line, int room) {
    static const char *const words[][2] = {{" from the true motion", " off"},
                                           {"model error: closed, but ", "model error: "}};
    for (size_t i = 0; i < sizeof words / sizeof *words && hn_text_columns(line) > room; i++) {
        char *at = strstr(line, words[i][0]);
        if (at) {
            const char *rest = at + strlen(words[i][0]);
            memcpy(at, words[i][1], strlen(words[i][1]));
            memmove(at + strlen(words[i][1]), rest, strlen(rest) + 1);
        }
    }
}

static void draw_row(hn_cells *c, hn_area area, const hn_workbench *w, int m, int frame) {
    const hn_track *track = hn_recording_track(w->recording, m);
    const table_columns at = lay_out(w, area.columns);
    const hn_motion_verdict v = hn_recording_verdict(w->recording, m, frame);
    const int style = m == w->selected ? HN_CELL_REVERSE : HN_CELL_PLAIN;
    const bool calm = v.tone == HN_TONE_CALM;
    hn_cells_printf(c, area, 0, m, track->slot, HN_CELL_BOLD, "%d%s", m + 1,
                    hn_look_get(track->slot)->glyph);
    char name[HN_METHOD_NAME];
    hn_method_name(w, m, at.name_width, name);
    hn_cells_put(c, area, at.name, m, w->hidden[m] ? HN_CELL_MUTED : HN_CELL_INK, style, name);
    for (int i = 0; i < at.numbers; i++) {
        put_number(c, area, number_end(at, i), m, NUMBERS[i].of(track)[frame], NUMBERS[i].unit);
    }

    // the verdict, in words; hidden methods say so
    char line[HN_MOTION_VERDICT_TEXT + 32];
    snprintf(line, sizeof line, "%s %s%s%s", v.arrow, w->hidden[m] ? "(hidden) " : "",
             track->model_error ? "model error: " : "",
             track->model_error && strcmp(v.text, HN_STARTS_CLOSED) == 0 ? OTHER_EQUATIONS
                                                                         : v.text);
    if (w->form == HN_DOTS_ASCII) {
        hn_plain_powers(line);
    }
    shorten(line, area.columns - at.verdict);
    hn_cells_put_fitted(c, area, at.verdict, m, calm ? HN_CELL_INK : HN_CELL_ALARM,
                        calm ? HN_CELL_PLAIN : HN_CELL_BOLD, line);
}

/// The heads stand in the upper edge: numbers are those of the present frame, the verdict is about
/// all frames up to it.
static void draw_table(hn_cells *c, const hn_workbench *w) {
    const hn_area table = table_area(c->columns, c->rows, w);
    const hn_area inside = hn_cells_frame(c, table, "methods");
    const hn_area edge = {inside.x, table.y, inside.columns, 1};
    const table_columns at = lay_out(w, inside.columns);
    for (int i = 0; i < at.numbers; i++) {
        const int left = number_end(at, i) - (int)strlen(NUMBERS[i].head);
        hn_cells_printf(c, edge, left - 1, 0, HN_CELL_MUTED, 0, " %s ", NUMBERS[i].head);
    }
    hn_cells_put(c, edge, at.verdict + 1, 0, HN_CELL_MUTED, 0, " worst so far ");
    const int frame = hn_workbench_frame(w);
    for (int m = 0; m < w->n_methods; m++) {
        draw_row(c, inside, w, m, frame);
    }
}

// ---- the plot ----

/// Why there are no errors to draw; "" where there are.
static void why_no_error(const hn_workbench *w, char *out, size_t size) {
    char why[HN_RECORDING_WHY];
    hn_recording_why_unknown(w->recording, why);
    out[0] = '\0';
    if (hn_recording_is_asking(w->recording)) {
        snprintf(
            out, size,
            "The reference motion for these values is being computed; errors are known when it "
            "is there.");
    } else if (why[0]) {
        snprintf(out, size, "Errors stay unknown: no reference motion could be computed; %s", why);
    } else if (hn_recording_needs_reference(w->recording)) {
        snprintf(out, size,
                 "Errors are unknown: no reference motion is stored for these values. 'holonom "
                 "reference', with the same --set, computes and keeps it.");
    }
}

static void draw_plot(hn_cells *c, hn_area area, const hn_workbench *w) {
    static const char *const titles[] = {"loop gap (constraint violation) [m]",
                                         "error against the reference [m]",
                                         "energy change, size [J]"};
    const hn_area inside = hn_cells_frame(c, area, titles[w->plot]);
    char why[HN_TUI_MESSAGE];
    why_no_error(w, why, sizeof why);
    if (w->plot == HN_TUI_ERROR && why[0]) {
        hn_cells_fold(c, inside, 0, HN_CELL_INK, why);
        return;
    }
    const double dt = hn_recording_frame_dt(w->recording);
    hn_plot plot = {.dt = dt,
                    .t_end = hn_recording_duration(w->recording),
                    .cursor = hn_recording_time(w->recording, hn_workbench_frame(w)),
                    .logarithmic = true,
                    .floor = 1e-16,
                    .unit = w->plot == HN_TUI_ENERGY ? "J" : "m"};

    // one line a method that is shown, up to the present frame
    for (int m = 0; m < w->n_methods; m++) {
        const hn_track *t = hn_recording_track(w->recording, m);
        const double *const columns[] = {t->gap, t->error, t->energy};
        if (!w->hidden[m]) {
            const bool dashed = hn_look_get(t->slot)->n_dash > 0;
            plot.series[plot.n++] = (hn_series){.y = columns[w->plot],
                                                .n = hn_workbench_frame(w) + 1,
                                                .colour = t->slot,
                                                .glyph = hn_look_get(t->slot)->glyph,
                                                .on = dashed ? 3 : 1,
                                                .off = dashed ? 2 : 0};
        }
    }
    hn_plot_draw(c, inside, &plot, w->form);
}

// with less the views would be empty, or lie over each other
void hn_views_least_size(const hn_workbench *w, int *columns, int *rows) {
    const bool views = w->panel == HN_PANEL_MAIN;
    // the header, the views, the table with its frame, the notice, the keys
    const int needed = 1 + LEAST_VIEW_ROWS + w->n_methods + 2 + NOTICE_ROWS + 1;
    *columns = views ? LEAST_VIEW_COLUMNS : HN_TUI_LEAST_COLUMNS;
    *rows = views ? needed : HN_TUI_LEAST_ROWS;
}

bool hn_views_too_small(const hn_workbench *w, int columns, int rows) {
    int least_columns, least_rows;
    hn_views_least_size(w, &least_columns, &least_rows);
    return columns < least_columns || rows < least_rows;
}

/// Says the least size where the screen is smaller.
static bool draw_too_small(hn_cells *c, const hn_workbench *w) {
    int columns, rows;
    char words[96];
    if (!hn_views_too_small(w, c->columns, c->rows)) {
        return false;
    }
    hn_views_least_size(w, &columns, &rows);
    snprintf(words, sizeof words, "%dx%d is too small: %dx%d is needed; q quits", c->columns,
             c->rows, columns, rows);
    hn_cells_fold(c, (hn_area){0, 0, c->columns, c->rows}, 0, HN_CELL_ALARM, words);
    return true;
}

/// "crank-rocker, 1 degree of freedom", as much of it as `most` columns hold.
static void title_mechanism(const hn_workbench *w, int most, char *out, size_t size) {
    static const char *const ends[] = {"", " (", ", "};
    hn_model_caption(w->model, out, size);
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        char *end = ends[i][0] ? strstr(out, ends[i]) : NULL;
        if (end) {
            *end = '\0';
        }
        if (out[0] && hn_text_columns(out) <= most) {
            return;
        }
    }
    snprintf(out, size, "mechanism");
}

void hn_views_draw(hn_cells *c, const hn_workbench *w) {
    hn_cells_clear(c);
    if (draw_too_small(c, w)) {
        return;
    }
    draw_header(c, w);

    const hn_area whole = panel_area(c->columns, c->rows);
    if (w->panel == HN_PANEL_LIST) {
        hn_list_view_draw(c, whole, w);
    } else if (w->panel == HN_PANEL_TEXT || w->panel == HN_PANEL_EXERCISE) {
        hn_text_view_draw(c, whole, w);
    } else if (w->panel == HN_PANEL_STUDY) {
        hn_study_panel_draw(c, whole, w);
    } else {
        const hn_places places = hn_views_places(c->columns, c->rows, w);
        const hn_area left = {0, 1, places.plot.x, places.plot.rows};
        hn_reactions_update(w);
        char title[96];
        title_mechanism(w, left.columns - BESIDE_TITLE, title, sizeof title);
        hn_mechanism_view(c, hn_cells_frame(c, left, title), w);
        if (w->why) {
            hn_why_draw(c, places.plot, w);
        } else if (w->reactions) {
            hn_reactions_draw(c, places.plot, w);
        } else {
            draw_plot(c, places.plot, w);
        }
        draw_table(c, w);
    }
    draw_notice(c, w);
    draw_footer(c, w);
}
