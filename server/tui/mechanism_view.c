// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/mechanism_view.h"

#include "base/units.h"
#include "render/look.h"
#include "tui/force_arrows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ACROSS = HN_DOTS_ACROSS, DOWN = HN_DOTS_DOWN };
enum { MOST_NAME = 8 }; // columns of a joint's name; a longer one is left out
enum { MARGIN = 4 };    // dots beside the motion: half of a joint, and an empty column

static const double ARROW_SHARE = 0.3;    // of the smaller side, for the longest arrow
static const double SHORTEST_ARROW = 2.5; // [dots]
static const double TEAR = 10;            // [dots] of an enlarged one
static const double SEEN_TEAR = 5;        // [dots] from which on it is drawn as it is
static const double MOST_ENLARGED = 1000; // a smaller gap is for the plot alone
static const double APART = 2.5;          // [dots] from which on linkages are told apart by marks
static const double HEAD = 3;             // [dots] of its strokes, along the arrow
static const double HEAD_WIDTH = 0.6;     // of that, across the arrow

typedef struct placing {
    const hn_model *model;
    const hn_envelope *envelope;
    hn_dots *dots;
    const double *points;
    double scale, x, y; ///< dots per metre; dot of the view's origin
} placing;

/// The whole motion above the row of the scale bar. A dot of braille is about as wide as it is
/// high.
static hn_placing fit(const hn_envelope *envelope, hn_area area) {
    const double *box = envelope->box;
    const double wide = fmax(box[2] - box[0], 1e-12), tall = fmax(box[3] - box[1], 1e-12);
    const double columns = area.columns * ACROSS, rows = (area.rows - 1) * DOWN;
    // a cell on each side stays empty: what touches the frame looks cut
    const double scale = fmin((columns - 2 * MARGIN) / wide, (rows - 4) / tall);
    return (hn_placing){.across = scale,
                        .down = scale,
                        .x = columns / 2 - scale * (box[0] + box[2]) / 2,
                        .y = rows / 2 + scale * (box[1] + box[3]) / 2};
}

hn_placing hn_mechanism_place(const hn_workbench *w, hn_area area) {
    const bool picture = hn_pictures_form(&w->pictures) != HN_PIXELS_OFF && w->place.across > 0;
    return picture ? w->place : fit(&w->envelope, area);
}

static placing place(const hn_model *model, const hn_envelope *envelope, hn_area area,
                     hn_dots *dots) {
    const hn_placing at = fit(envelope, area);
    return (placing){model, envelope, dots, NULL, at.across, at.x, at.y};
}

static void dot_of(const placing *p, int point, double out[2]) {
    double plane[2];
    hn_view_project(&p->envelope->look, p->points + 3 * point, plane);
    out[0] = p->x + p->scale * plane[0];
    out[1] = p->y - p->scale * plane[1];
}

static void line(const placing *p, int from, int to, int colour, int on, int off) {
    double a[2], b[2];
    dot_of(p, from, a);
    dot_of(p, to, b);
    hn_dots_line(p->dots, a[0], a[1], b[0], b[1], colour, on, off);
}

/// A small square of dots at a point: half wide and high by `size`.
static void knob(const placing *p, int point, int size, int colour) {
    double a[2];
    dot_of(p, point, a);
    for (int dy = -size; dy <= size; dy++) {
        for (int dx = -size; dx <= size; dx++) {
            if (abs(dx) == size || abs(dy) == size) {
                hn_dots_set(p->dots, (int)lround(a[0]) + dx, (int)lround(a[1]) + dy, colour);
            }
        }
    }
}

/// Hatching below a support.
static void support(const placing *p, int point) {
    double a[2];
    dot_of(p, point, a);
    for (int x = -4; x <= 4; x++) {
        hn_dots_set(p->dots, (int)lround(a[0]) + x, (int)lround(a[1]) + 3, HN_CELL_MUTED);
        if (x % 2 == 0) {
            hn_dots_set(p->dots, (int)lround(a[0]) + x - 1, (int)lround(a[1]) + 4, HN_CELL_MUTED);
        }
    }
}

static void draw_shape(const placing *p, const hn_shape *s, int colour, bool full) {
    const int on = full ? 1 : 2, off = full ? 0 : 2;

    // a shape of the selected method is a full line, a ghost's is dashed
    switch (s->kind) {
    case HN_SHAPE_BAR:
        line(p, s->p, s->q, colour, on, off);
        break;
    case HN_SHAPE_SPRING:
    case HN_SHAPE_DAMPER:
        line(p, s->p, s->q, HN_CELL_MUTED, 1, 1);
        break;
    case HN_SHAPE_GUIDE:
        line(p, s->p, s->q, HN_CELL_MUTED, 1, 3);
        break;
    case HN_SHAPE_POLYGON:
        for (int k = 0; k < s->n; k++) {
            line(p, s->p + k, s->p + (k + 1) % s->n, colour, on, off);
        }
        break;
    case HN_SHAPE_PIVOT:
        knob(p, s->p, 1, colour);
        break;
    case HN_SHAPE_SLIDER:
        knob(p, s->p, 2, colour);
        break;
    case HN_SHAPE_GROUND:
        support(p, s->p);
        break;
    default:
        break;
    }
}

/// A configuration with its open loops: half-joints that are apart are joined by a line of alarm.
static void draw_pose(placing *p, const double *points, int colour, bool full) {
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    if (!points || isnan(points[0])) {
        return;
    }
    p->points = points;
    for (int i = 0; i < drawing.n_shapes; i++) {
        draw_shape(p, &drawing.shapes[i], colour, full);
    }
    for (int i = 0; i < drawing.n_tears; i++) {
        double a[2], b[2];
        dot_of(p, drawing.tears[i][0], a);
        dot_of(p, drawing.tears[i][1], b);
        if (hypot(b[0] - a[0], b[1] - a[1]) > 1) {
            hn_dots_line(p->dots, a[0], a[1], b[0], b[1], HN_CELL_ALARM, 1, 0);
        }
    }
}

/// A length of 1, 2 or 5 times a power of ten that takes about a quarter of the width.
static void scale_bar(hn_cells *c, hn_area area, const placing *p) {
    const double want = area.columns * ACROSS / 4.0 / p->scale;
    const double power = pow(10, floor(log10(want))), lead = want / power;
    const double metres = power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
    const int columns = (int)lround(metres * p->scale / ACROSS);
    char text[HN_SI_TEXT];
    hn_si_format(metres, "m", 1, text);
    for (int x = 0; x < columns && columns < area.columns; x++) {
        hn_cells_put(c, area, 1 + x, area.rows - 1, HN_CELL_MUTED, 0,
                     x == 0             ? "├"
                     : x == columns - 1 ? "┤"
                                        : "─");
    }
    hn_cells_put(c, area, 2 + columns, area.rows - 1, HN_CELL_MUTED, 0, text);
}

/// A force in dots: where it acts, and how far it reaches from there.
typedef struct force_line {
    double x, y, dx, dy, length;
} force_line;

/// False: it is too short to be seen.
static bool lay_force(const placing *p, const hn_snapshot_load *load, double dots_per_newton,
                      force_line *out) {
    double from[2], force[2];
    hn_view_project(&p->envelope->look, load->place, from);
    hn_view_project(&p->envelope->look, load->force, force);
    const double dx = dots_per_newton * force[0], dy = -dots_per_newton * force[1];
    *out =
        (force_line){p->x + p->scale * from[0], p->y - p->scale * from[1], dx, dy, hypot(dx, dy)};
    return out->length >= SHORTEST_ARROW;
}

static double dots_per_newton(hn_area area, const hn_force_arrows *arrows) {
    return ARROW_SHARE * fmin(area.columns * ACROSS, area.rows * DOWN) / arrows->longest;
}

/// A shaft each, and two strokes back from the tip.
static void draw_forces(hn_area area, const placing *p, const hn_force_arrows *arrows) {
    for (int i = 0; i < arrows->n; i++) {
        force_line f;
        if (!lay_force(p, &arrows->load[i], dots_per_newton(area, arrows), &f)) {
            continue;
        }
        const double ux = HEAD * f.dx / f.length, uy = HEAD * f.dy / f.length;
        const double x = f.x + f.dx, y = f.y + f.dy;
        hn_dots_line(p->dots, f.x, f.y, x, y, HN_CELL_INK, 1, 0);
        for (int side = -1; side <= 1; side += 2) {
            hn_dots_line(p->dots, x, y, x - ux - side * HEAD_WIDTH * uy,
                         y - uy + side * HEAD_WIDTH * ux, HN_CELL_INK, 1, 0);
        }
    }
}

/// Returns whether nothing stands in n cells, nor in the one before and the one behind.
static bool is_free(const hn_cells *c, hn_area area, int x, int y, int n) {
    if (x < 0 || y < 0 || y >= area.rows || x + n > area.columns) {
        return false;
    }
    for (int k = x > 0 ? x - 1 : 0; k < x + n + 1 && k < area.columns; k++) {
        const hn_cell *cell = &c->at[(area.y + y) * c->columns + area.x + k];
        if (cell->glyph[0] && cell->glyph[0] != ' ') {
            return false;
        }
    }
    return true;
}

/// The size of each force beyond its tip, where nothing else stands there; all are in the list.
static void name_forces(hn_cells *c, hn_area area, const placing *p,
                        const hn_force_arrows *arrows) {
    for (int i = 0; i < arrows->n; i++) {
        const double *force = arrows->load[i].force;
        char text[HN_SI_TEXT];
        force_line f;
        if (!lay_force(p, &arrows->load[i], dots_per_newton(area, arrows), &f)) {
            continue;
        }
        hn_si_format(hypot(hypot(force[0], force[1]), force[2]), "N", 2, text);
        const int wide = hn_text_columns(text);

        // before or behind the tip, or in the middle above or below it
        const bool steep = fabs(f.dx) < fabs(f.dy);
        const int tip_x = (int)floor((f.x + f.dx) / ACROSS),
                  tip_y = (int)floor((f.y + f.dy) / DOWN);
        const int x = steep ? tip_x - wide / 2 : f.dx < 0 ? tip_x - wide - 1 : tip_x + 2;
        const int y = !steep ? tip_y : f.dy < 0 ? tip_y - 1 : tip_y + 1;
        if (is_free(c, area, x, y, wide)) {
            hn_cells_put(c, area, x, y, HN_CELL_INK, 0, text);
        }
    }
}

/// The names of the joints of the pose that was drawn last, each beside its joint where nothing
/// else stands: texts about joints use them.
static void name_joints(hn_cells *c, hn_area area, const placing *p) {
    static const signed char sides[][2] = {{1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {1, 0}, {-1, 0}};
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    for (int i = 0; i < drawing.n_points && p->points; i++) {
        const char *name = drawing.labels[i];
        const int wide = name ? hn_text_columns(name) : 0;
        if (wide == 0 || wide > MOST_NAME || isnan(p->points[3 * i])) {
            continue;
        }

        // the first side that is free
        double at[2];
        dot_of(p, i, at);
        const int x = (int)floor(at[0] / ACROSS), y = (int)floor(at[1] / DOWN);
        for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
            const int gap = sides[k][1] == 0 ? 2 : 1; // beside the knob, or above and below it
            const int left = sides[k][0] > 0 ? x + gap : x - gap - wide + 1;
            if (is_free(c, area, left, y + sides[k][1], wide)) {
                hn_cells_put(c, area, left, y + sides[k][1], HN_CELL_INK, 0, name);
                break;
            }
        }
    }
}

/// The widest open loop of the pose that was drawn last: where it is too short to be seen it is
/// drawn enlarged by 2, 5, 10, ...; *x, *y: dot of its end. Returns the enlargement; 1: none.
static double draw_tear(const placing *p, double *x, double *y) {
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    double from[2] = {0}, way[2] = {0}, length = 0;
    for (int i = 0; i < drawing.n_tears && p->points && !isnan(p->points[0]); i++) {
        double a[2], b[2];
        dot_of(p, drawing.tears[i][0], a);
        dot_of(p, drawing.tears[i][1], b);
        if (hypot(b[0] - a[0], b[1] - a[1]) > length) {
            length = hypot(b[0] - a[0], b[1] - a[1]);
            memcpy(from, a, sizeof from);
            way[0] = b[0] - a[0];
            way[1] = b[1] - a[1];
        }
    }
    if (!(length > 0) || length >= SEEN_TEAR || TEAR / length > MOST_ENLARGED) {
        return 1;
    }
    const double power = hn_round_125(TEAR / length);
    *x = from[0] + power * way[0];
    *y = from[1] + power * way[1];
    hn_dots_line(p->dots, from[0], from[1], *x, *y, HN_CELL_ALARM, 1, 0);
    return power;
}

/// Puts a text to the right or left of a cell, or near it above or below. Returns whether there is
/// room.
static bool put_beside(hn_cells *c, hn_area area, int column, int row, const char *text) {
    static const signed char rows[] = {0, -1, 1, -2, 2, -3, 3};
    const int wide = hn_text_columns(text);
    for (size_t k = 0; k < sizeof rows; k++) {
        for (int side = 0; side < 2; side++) {
            const int left = side == 0 ? column + 3 : column - 2 - wide;
            if (is_free(c, area, left, row + rows[k], wide)) {
                hn_cells_put(c, area, left, row + rows[k], HN_CELL_ALARM, 0, text);
                return true;
            }
        }
    }
    return false;
}

/// "gap enlarged ×20" beside the end of an enlarged tear; "gap ×20" where that has no room.
static void name_tear(hn_cells *c, hn_area area, double x, double y, double power) {
    const int column = (int)floor(x / ACROSS), row = (int)floor(y / DOWN);
    for (int i = 0; i < 2; i++) {
        char text[32];
        snprintf(text, sizeof text, i == 0 ? "gap enlarged ×%g" : "gap ×%g", power);
        if (put_beside(c, area, column, row, text)) {
            return;
        }
    }
}

/// The methods as they are now, or the mechanism that is dragged.
static void draw_present(placing *p, const hn_workbench *w) {
    const int frame = hn_workbench_frame(w);
    const size_t n = 3 * (size_t)hn_system_get_info(hn_model_system(w->model)).n_points;
    if (w->drag.on && w->drag.points) {
        draw_pose(p, w->drag.points, HN_CELL_INK, true);
        return;
    }

    // from below: reference, ghosts, the selected method
    draw_pose(p, hn_recording_reference(w->recording, frame), HN_LOOK_REFERENCE, true);
    for (int pass = 0; pass < 2; pass++) {
        for (int m = 0; m < w->n_methods; m++) {
            const hn_track *track = hn_recording_track(w->recording, m);
            if (!w->hidden[m] && (m == w->selected) == (pass == 1)) {
                draw_pose(p, track->points + (size_t)frame * n, track->slot, pass == 1);
            }
        }
    }
}

/// Distance of a point of method m from the same point of every other method that is shown [dots];
/// *at: its dot.
static double distance_from_others(placing *p, const hn_workbench *w, int m, int point,
                                   double at[2]) {
    const size_t n = 3 * (size_t)hn_system_get_info(hn_model_system(w->model)).n_points;
    const size_t first = (size_t)hn_workbench_frame(w) * n;
    double least = HUGE_VAL;
    p->points = hn_recording_track(w->recording, m)->points + first;
    dot_of(p, point, at);
    for (int o = 0; o < w->n_methods; o++) {
        double other[2];
        p->points = hn_recording_track(w->recording, o)->points + first;
        dot_of(p, point, other);
        if (o != m && !w->hidden[o] && isfinite(other[0])) {
            least = fmin(least, hypot(other[0] - at[0], other[1] - at[1]));
        }
    }
    return isfinite(at[0]) ? least : 0;
}

/// The mark of each method, as in the table, at the end of a bar where its linkage is apart from
/// those of the others.
static void mark_methods(hn_cells *c, hn_area area, placing *p, const hn_workbench *w) {
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    const double *const drawn_last = p->points;
    for (int m = 0; m < w->n_methods && !w->drag.on; m++) {
        double farthest = 0, place[2] = {0};
        for (int i = 0; i < 2 * drawing.n_shapes && !w->hidden[m]; i++) {
            const hn_shape *s = &drawing.shapes[i / 2];
            double at[2];
            const double apart = s->kind != HN_SHAPE_BAR
                                     ? 0
                                     : distance_from_others(p, w, m, i % 2 == 0 ? s->p : s->q, at);
            if (isfinite(apart) && apart > farthest) {
                farthest = apart;
                memcpy(place, at, sizeof place);
            }
        }
        if (farthest >= APART) {
            const hn_look *look = hn_look_get(hn_recording_track(w->recording, m)->slot);
            hn_cells_put(c, area, (int)floor(place[0] / ACROSS), (int)floor(place[1] / DOWN),
                         hn_recording_track(w->recording, m)->slot, HN_CELL_BOLD, look->glyph);
        }
    }
    p->points = drawn_last;
}

void hn_mechanism_view(hn_cells *c, hn_area area, const hn_workbench *w) {
    hn_dots dots = {0};
    if (hn_pictures_form(&w->pictures) != HN_PIXELS_OFF || area.columns < 4 || area.rows < 3 ||
        !hn_dots_resize(&dots, area.columns, area.rows)) {
        return;
    }
    placing p = place(w->model, &w->envelope, area, &dots);
    hn_force_arrows arrows;
    hn_force_arrows_take(w, &arrows);
    draw_present(&p, w);
    double tear[2] = {0};
    const bool own = !w->hidden[w->selected] && !w->drag.on; // the selected method's pose is last
    const double enlarged = own ? draw_tear(&p, &tear[0], &tear[1]) : 1;
    scale_bar(c, area, &p);
    draw_forces(area, &p, &arrows);
    hn_dots_show(c, area, &dots, w->form);
    mark_methods(c, area, &p, w);
    name_forces(c, area, &p, &arrows);
    if (enlarged > 1) {
        name_tear(c, area, tear[0], tear[1], enlarged);
    }
    // names would jump about a mechanism that moves
    if (!w->playing || w->why || w->reactions) {
        name_joints(c, area, &p);
    }
    hn_dots_free(&dots);
}

void hn_mechanism_preview(hn_cells *c, hn_area area, const hn_workbench *w) {
    const hn_preview *v = &w->preview;
    hn_dots dots = {0};
    if (!v->model || hn_pictures_form(&w->pictures) != HN_PIXELS_OFF || area.columns < 4 ||
        area.rows < 3 || !hn_dots_resize(&dots, area.columns, area.rows)) {
        return;
    }
    placing p = place(v->model, &v->envelope, area, &dots);
    draw_pose(&p, v->points, HN_CELL_INK, true);
    scale_bar(c, area, &p);
    hn_dots_show(c, area, &dots, w->form);
    hn_dots_free(&dots);
}
