// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/reactions_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_COLUMNS = 15, MOST_NAME = 30, NUMBER_COLUMNS = 9, PAGE = 6, COLUMNS = 6 };

/// A force below this share of the largest one is rounding, and shown as 0.
static const double NOTHING = 1e-10;

void hn_reactions_toggle(hn_workbench *w) {
    w->reactions = !w->reactions;
    w->why = false;
    if (w->forces) {
        w->forces->first = 0;
    }
}

void hn_reactions_scroll(hn_workbench *w, int by) {
    if (w->forces) {
        const int to = w->forces->first + by * PAGE;
        w->forces->first = to < 0 ? 0 : to;
    }
}

/// Lines of the view, drawn from `first` on.
typedef struct page {
    hn_cells *c;
    hn_area area;
    int first, line; ///< the next line
} page;

static bool is_shown(const page *p) {
    return p->line >= p->first && p->line - p->first < p->area.rows;
}

static void put_words(page *p, int colour, const char *text) {
    if (is_shown(p)) {
        hn_cells_put(p->c, p->area, 0, p->line - p->first, colour, 0, text);
    }
    p->line++;
}

/// A sentence of plain characters, in as many lines as it needs.
static void put_folded(page *p, const char *text) {
    const size_t width = p->area.columns > 0 ? (size_t)p->area.columns : 1;
    char line[160];
    while (*text) {
        size_t n = strlen(text);
        if (n > width) {
            for (n = width; n > 0 && text[n] != ' '; n--) {}
            n = n > 0 ? n : width;
        }
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        put_words(p, HN_CELL_MUTED, line);
        text += n;
        text += *text == ' ';
    }
}

/// The columns of the names where n numbers stand behind them.
static int name_columns(const page *p, int n) {
    const int left = p->area.columns - n * NUMBER_COLUMNS;
    return left < NAME_COLUMNS ? NAME_COLUMNS : left > MOST_NAME ? MOST_NAME : left;
}

/// Returns how many numbers there is room for behind a name.
static int number_room(const page *p, int n) {
    const int room = (p->area.columns - name_columns(p, n)) / NUMBER_COLUMNS;
    return n < room ? n : room;
}

/// A name and n numbers in columns; what has no room is left out from the end.
static void put_numbers(page *p, const char *name, const double *values, int n, double nothing) {
    if (is_shown(p)) {
        const int y = p->line - p->first, first = name_columns(p, n), room = number_room(p, n);
        hn_cells_printf(p->c, p->area, 1, y, HN_CELL_INK, 0, "%.*s", first - 1, name);
        for (int i = 0; i < room; i++) {
            hn_cells_printf(p->c, p->area, first + i * NUMBER_COLUMNS, y, HN_CELL_INK, 0, "%*.3g",
                            NUMBER_COLUMNS, fabs(values[i]) > nothing ? values[i] : 0.0);
        }
    }
    p->line++;
}

static const char *text_of(const cJSON *object, const char *name) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
    return text ? text : "";
}

static double number_at(const cJSON *object, const char *name, int i) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_GetNumberValue(i < 0 ? list : cJSON_GetArrayItem(list, i));
}

static double size_of(const cJSON *object, const char *name) {
    return hypot(hypot(number_at(object, name, 0), number_at(object, name, 1)),
                 number_at(object, name, 2));
}

/// The columns that a mechanism needs: of a planar one there are no forces across its plane, and of
/// one with pins alone no moments.
typedef struct columns {
    double nothing; ///< what is shown as 0 [N]
    bool across, moments;
} columns;

static columns find_columns(const cJSON *reactions) {
    columns out = {0};
    double force = 0, across = 0, moment = 0;
    const cJSON *one;
    cJSON_ArrayForEach(one, reactions) {
        force = fmax(force, size_of(one, "force"));
        across = fmax(across, fabs(number_at(one, "force", 2)));
        moment = fmax(moment, size_of(one, "moment"));
    }
    out.nothing = NOTHING * force;
    out.across = across > out.nothing;
    out.moments = moment > out.nothing;
    return out;
}

/// The heads of the columns; those that have no room are named below the numbers.
static void put_heads(page *p, const char *const *heads, int n) {
    if (is_shown(p)) {
        const int y = p->line - p->first, first = name_columns(p, n), room = number_room(p, n);
        hn_cells_put(p->c, p->area, 0, y, HN_CELL_MUTED, 0, "force [N] on");
        for (int i = 0; i < room; i++) {
            hn_cells_printf(p->c, p->area, first + i * NUMBER_COLUMNS, y, HN_CELL_MUTED, 0, "%*s",
                            NUMBER_COLUMNS, heads[i]);
        }
    }
    p->line++;
}

static void put_forces(page *p, const cJSON *reactions) {
    const columns shown = find_columns(reactions);
    const char *heads[COLUMNS] = {"size", "x", "y"};
    const cJSON *one;
    char line[160];
    int n = 3;
    if (!reactions || !reactions->child) {
        return;
    }
    if (shown.across) {
        heads[n++] = "z";
    }
    if (shown.moments) {
        heads[n++] = "[N m]";
    }
    put_heads(p, heads, n);
    cJSON_ArrayForEach(one, reactions) {
        double values[COLUMNS] = {size_of(one, "force")};
        for (int i = 0; i < 3; i++) {
            values[1 + i] = number_at(one, "force", i);
        }
        values[3 + shown.across] = size_of(one, "moment");
        snprintf(line, sizeof line, "%.40s: %.40s", text_of(one, "name"), text_of(one, "on"));
        put_numbers(p, line, values, n, shown.nothing);
    }
    const int room = number_room(p, n);
    if (room < n) {
        snprintf(line, sizeof line, "no room for %s%s%s", heads[room], room + 1 < n ? ", " : "",
                 room + 1 < n ? heads[room + 1] : "");
        put_words(p, HN_CELL_MUTED, line);
    }
}

static void put_efforts(page *p, const cJSON *efforts) {
    const cJSON *one;
    char line[160];
    if (efforts && efforts->child) {
        put_words(p, HN_CELL_MUTED, "effort along a coordinate");
    }
    cJSON_ArrayForEach(one, efforts) {
        snprintf(line, sizeof line, " %.40s, %.40s: %.4g %.8s", text_of(one, "name"),
                 text_of(one, "coordinate"), number_at(one, "value", -1), text_of(one, "unit"));
        put_words(p, HN_CELL_INK, line);
    }
}

static void put_multipliers(page *p, const hn_joint_forces *r) {
    const hn_system *sys = hn_model_system(r->model);
    const int n = hn_system_get_info(sys).nc;
    char line[80];
    if (n == 0) {
        put_words(p, HN_CELL_MUTED, "no loop and no constraint: no multipliers");
        return;
    }
    snprintf(line, sizeof line, "multipliers lambda: %s", hn_multiplier_marks[r->mark]);
    put_words(p, r->mark == HN_MULTIPLIERS_DETERMINED ? HN_CELL_MUTED : HN_CELL_ALARM, line);
    put_words(p, HN_CELL_MUTED, "forces (moments) that keep the loop closed");
    for (int i = 0; i < n && r->status == HN_OK; i++) {
        snprintf(line, sizeof line, "%.60s%s", hn_system_row_name(sys, i),
                 hn_system_row_is_length(sys, i) ? " [N]" : "");
        put_numbers(p, line, &r->lambda[i], 1, 0);
    }
}

void hn_reactions_update(const hn_workbench *w) {
    hn_joint_forces *r = w->forces;
    if (!w->reactions || !r) {
        return;
    }
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const hn_system_info info = hn_system_get_info(hn_model_system(r->model));
    const int frame = hn_workbench_frame(w);
    const size_t first = (size_t)frame * (size_t)info.n_user;
    hn_joint_forces_calc(r, hn_recording_time(w->recording, frame), track->q + first,
                         track->v + first, track->gap[frame]);
}

void hn_reactions_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    hn_joint_forces *r = w->forces;
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const int frame = hn_workbench_frame(w);
    char title[96];
    snprintf(title, sizeof title, "joint forces: %s (r closes)", track->name);
    const hn_area in = hn_cells_frame(c, area, title);
    if (!r) {
        return;
    }
    if (r->status != HN_OK) {
        hn_cells_fold(c, in, 0, HN_CELL_ALARM,
                      isfinite(track->gap[frame])
                          ? "the equations have no solution in this configuration: no forces"
                          : "the method has ended before this time: it has no forces here");
        return;
    }

    // as many lines as there are, from the one that was scrolled to
    const cJSON *reactions = cJSON_GetObjectItem(r->document, "reactions");
    for (int pass = 0; pass < 2; pass++) {
        page p = {c, in, pass == 0 ? 1 << 20 : r->first, 0};
        put_multipliers(&p, r);
        put_forces(&p, reactions);
        put_efforts(&p, cJSON_GetObjectItem(r->document, "efforts"));
        put_words(&p, HN_CELL_MUTED, "forces on the body named; world axes");
        put_folded(&p, "Each multiplier is the force (or moment) with which one loop constraint "
                       "holds the loop closed; J' lambda are these forces along the coordinates.");
        const int most = p.line > in.rows ? p.line - in.rows : 0;
        r->first = r->first < most ? r->first : most;
    }
}
