// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/map_plot.h"

#include "base/units.h"
#include "session/stability/stability_frame.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_COLUMNS = 12, AXIS_ROWS = 3, FOOT_ROWS = 5, SHADES = 4 };
enum { LARGE_COLUMNS = 4, LARGE_ROWS = 2, SENTENCE_ROWS = 6 }; // of a cell; below a large map
enum { LEGEND_COLUMNS = 17, LEGEND_ROWS = 11, MOST_ENTRIES = 12, ENTRY = 64 };

static const char PREDICTED[] = "━";
static const char *const SHADE[SHADES] = {"░", "▒", "▓", "█"};

// ---- what is shown ----

static double near_row(const hn_map_axis *y, double value) {
    const double low = y->value[0], high = y->value[y->n - 1];
    return y->is_log ? log(value / low) / log(high / low) * (y->n - 1)
                     : (value - low) / (high - low) * (y->n - 1);
}

/// Returns whether the predicted boundary passes in this cell: of a step by the column's limits,
/// otherwise where the margin passes 1 to the right or above.
static bool is_limit(const hn_map *map, int m, int column, int row) {
    const hn_map_axis *x = hn_map_x(map), *y = hn_map_y(map);
    const hn_map_column *c = hn_map_get_column(map, m, column);
    for (int k = 0; y->is_step && k < c->n_predicted; k++) {
        if (c->predicted[k] > 0 && lround(near_row(y, c->predicted[k])) == row) {
            return true;
        }
    }
    if (y->is_step) {
        return false;
    }
    const double here = hn_map_get(map, m, column, row)->margin;
    const double right = column + 1 < x->n ? hn_map_get(map, m, column + 1, row)->margin : here;
    const double above = row + 1 < y->n ? hn_map_get(map, m, column, row + 1)->margin : here;
    return here <= 1 && (right > 1 || above > 1);
}

void hn_map_plot_take(hn_map_plot *p, const hn_map *map, int m) {
    const double length = hn_system_length(hn_model_system(hn_map_model(map)));
    p->x = *hn_map_x(map);
    p->y = *hn_map_y(map);
    p->heat = !p->y.is_step && !p->x.is_step;
    snprintf(p->name, sizeof p->name, "%s", hn_map_method(map, m));
    for (int row = 0; row < p->y.n; row++) {
        for (int column = 0; column < p->x.n; column++) {
            const hn_map_cell *cell = hn_map_get(map, m, column, row);
            p->cell[row * p->x.n + column] =
                (hn_map_plot_cell){.kind = (unsigned char)cell->trial.kind,
                                   .limit = is_limit(map, m, column, row),
                                   .gap = cell->trial.gap * length,
                                   .error = cell->trial.error,
                                   .energy = cell->trial.energy,
                                   .margin = cell->margin};
        }
    }
}

static int nearest(const hn_map_axis *a, double value) {
    int best = 0;
    if (a->is_log && !(value > 0)) {
        return 0; // below all values of the axis
    }
    for (int i = 1; i < a->n; i++) {
        const double d = a->is_log ? fabs(log(a->value[i] / value)) : fabs(a->value[i] - value);
        const double b =
            a->is_log ? fabs(log(a->value[best] / value)) : fabs(a->value[best] - value);
        best = d < b ? i : best;
    }
    return best;
}

hn_map_place hn_map_plot_place(const hn_map_plot *p, double x, double y) {
    const hn_map_place none = {-1, -1};
    const bool shown = p->x.n > 0 && p->y.n > 0 && !isnan(x) && !isnan(y);
    return shown ? (hn_map_place){nearest(&p->x, x), nearest(&p->y, y)} : none;
}

/// Half a cell beyond the first or the last one counts as the axis.
static bool is_beyond(const hn_map_axis *a, double value) {
    const double at = a->is_log && !(value > 0) ? -HUGE_VAL : near_row(a, value);
    return a->n > 1 && (at < -0.5 || at > a->n - 0.5);
}

bool hn_map_plot_is_beyond(const hn_map_plot *p, double x, double y) {
    return is_beyond(&p->x, x) || is_beyond(&p->y, y);
}

// ---- the best cells ----

static const double LEAST = 1e-17; // smaller values are rounding
static const double WRONG = 1e-2;  // error of the velocity from which on a small gap is no merit

static const char SWEET_SPOT[] =
    "Small alpha and beta let the gap grow; near the boundary every step overshoots. The best "
    "place lies between, and it is another one for the gap, the motion and the energy.";

static const struct {
    const char *mark, *word;
} QUANTITY[HN_MAP_QUANTITIES] = {[HN_MAP_GAP] = {"g", "worst loop gap"},
                                 [HN_MAP_ERROR] = {"v", "error of velocity"},
                                 [HN_MAP_ENERGY] = {"e", "energy gained"}};

/// NaN: the cell did not come to its end.
static double value_of(const hn_map_plot_cell *cell, hn_map_quantity quantity) {
    const double values[HN_MAP_QUANTITIES] = {
        [HN_MAP_GAP] = cell->gap, [HN_MAP_ERROR] = cell->error, [HN_MAP_ENERGY] = cell->energy};
    const bool ran = hn_stability_is_stable((hn_stability_class)cell->kind);
    const bool known = ran && isfinite(values[quantity]);
    return known ? fmax(values[quantity], LEAST) : (double)NAN;
}

hn_map_place hn_map_plot_best(const hn_map_plot *p, hn_map_quantity quantity) {
    hn_map_place best = {-1, -1};
    double least = HUGE_VAL;
    for (int i = 0; p->heat && i < p->x.n * p->y.n; i++) {
        const double value = value_of(&p->cell[i], quantity);
        if (value < least) {
            least = value;
            best = (hn_map_place){i % p->x.n, i / p->x.n};
        }
    }
    return best;
}

// ---- shades ----

typedef struct range {
    double low, high; ///< powers of ten of the gaps
} range;

static range find_range(const hn_map_plot *p) {
    range r = {HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < p->x.n * p->y.n; i++) {
        if (hn_stability_is_stable((hn_stability_class)p->cell[i].kind) && p->cell[i].gap > 0) {
            r.low = fmin(r.low, log10(p->cell[i].gap));
            r.high = fmax(r.high, log10(p->cell[i].gap));
        }
    }
    return r.low <= r.high ? r : (range){0, 0};
}

static int shade_of(range r, double gap) {
    const double share = r.high > r.low && gap > 0 ? (log10(gap) - r.low) / (r.high - r.low) : 0;
    const int i = (int)(share * SHADES);
    return i < 0 ? 0 : i >= SHADES ? SHADES - 1 : i;
}

static int colour_of(hn_stability_class kind) {
    const int slot = hn_map_class_look_get(kind)->slot;
    return slot >= 0 ? slot : slot == -1 ? HN_CELL_ALARM : HN_CELL_MUTED;
}

static const char *glyph_of(const hn_map_plot *p, range r, const hn_map_plot_cell *cell) {
    const hn_stability_class kind = (hn_stability_class)cell->kind;
    if (p->heat && hn_stability_is_stable(kind)) {
        return SHADE[shade_of(r, cell->gap)];
    }
    const char *glyph = hn_map_class_look_get(kind)->glyph;
    return glyph[0] ? glyph : " ";
}

// ---- drawing ----

/// Columns and rows that a cell takes on the screen: 1 and 1, 2 and 1, or 4 and 2.
typedef struct extent {
    int columns, rows;
} extent;

/// As large as there is room for, with the sentences below a large map.
static extent cell_extent(const hn_map_plot *p, int columns, int rows) {
    const int large = LABEL_COLUMNS + LARGE_COLUMNS * p->x.n + 1 + LEGEND_COLUMNS;
    if (large <= columns && LARGE_ROWS * p->y.n + AXIS_ROWS + SENTENCE_ROWS <= rows) {
        return (extent){LARGE_COLUMNS, LARGE_ROWS};
    }
    return (extent){LABEL_COLUMNS + 2 * p->x.n <= columns ? 2 : 1, 1};
}

/// Row of the screen on which the cells of a row of the map begin; the lowest y stands below.
static int row_top(const hn_map_plot *p, extent e, int row) {
    return (p->y.n - 1 - row) * e.rows;
}

/// The outcome, and in the last column of a cell the predicted limit; a cell of one column shows
/// either.
static void draw_cell(hn_cells *c, hn_area area, const hn_map_plot *p, range r, int column, int row,
                      extent e) {
    const hn_map_plot_cell *cell = &p->cell[row * p->x.n + column];
    const int colour = colour_of((hn_stability_class)cell->kind);
    const bool shaded = p->heat && hn_stability_is_stable((hn_stability_class)cell->kind);
    const char *glyph = glyph_of(p, r, cell);
    for (int i = 0; i < e.rows * e.columns; i++) {
        const int dx = i % e.columns, dy = i / e.columns;
        const bool limit = cell->limit && dx == e.columns - 1;
        const bool sign = i == 0 || shaded; // a sign stands once in its cell
        hn_cells_put(c, area, LABEL_COLUMNS + column * e.columns + dx, row_top(p, e, row) + dy,
                     limit ? HN_CELL_INK : colour, 0,
                     limit  ? PREDICTED
                     : sign ? glyph
                            : " ");
    }
}

/// The axis across: a tick below the left edge of a cell, and below it the cell's value, of the
/// last cell too; a value that would run into the one before is left out.
static void draw_ticks(hn_cells *c, hn_area area, const hn_map_plot *p, extent e) {
    const int foot = p->y.n * e.rows;
    int at[HN_MAP_SIDE], free = 0, n = hn_map_ticks(&p->x, at);
    at[n++] = p->x.n - 1;
    for (int x = 0; x < p->x.n * e.columns; x++) {
        hn_cells_put(c, area, LABEL_COLUMNS + x, foot, HN_CELL_MUTED, 0, "─");
    }
    for (int i = 0; i < n; i++) {
        char label[32];
        const int x = at[i] * e.columns, wide = p->x.n * e.columns;
        const int used = snprintf(label, sizeof label, "%.3g", p->x.value[at[i]]);
        const int left = x + used > wide && wide > used ? wide - used : x;
        if (left >= free) {
            hn_cells_put(c, area, LABEL_COLUMNS + x, foot, HN_CELL_MUTED, 0, "┬");
            hn_cells_put(c, area, LABEL_COLUMNS + left, foot + 1, HN_CELL_MUTED, 0, label);
            free = left + used + 1;
        }
    }
}

static void draw_axes(hn_cells *c, hn_area area, const hn_map_plot *p, extent e) {
    const int foot = p->y.n * e.rows;
    char title[96], other[96];
    for (int y = 0; y < foot; y++) {
        hn_cells_put(c, area, LABEL_COLUMNS - 1, y, HN_CELL_MUTED, 0, "│");
    }
    for (int row = 0; row < p->y.n; row++) {
        hn_cells_printf(c, area, 0, row_top(p, e, row), HN_CELL_MUTED, 0, "%10.3g",
                        p->y.value[row]);
    }
    hn_map_axis_title(&p->y, title);
    hn_map_axis_title(&p->x, other);
    hn_cells_put(c, area, LABEL_COLUMNS - 1, foot, HN_CELL_MUTED, 0, "└");
    if (!p->x.name[0]) {
        hn_cells_printf(c, area, LABEL_COLUMNS, foot, HN_CELL_MUTED, 0, " vertical: %s", title);
        return;
    }
    draw_ticks(c, area, p, e);
    hn_cells_printf(c, area, LABEL_COLUMNS, foot + 2, HN_CELL_MUTED, 0, "across: %s, up: %s", other,
                    title);
}

typedef struct legend {
    int n;
    char entry[MOST_ENTRIES][ENTRY];
} legend;

static void HN_PRINTF(2, 3) add_entry(legend *l, const char *format, ...) {
    va_list list;
    va_start(list, format);
    if (l->n < MOST_ENTRIES) {
        vsnprintf(l->entry[l->n++], ENTRY, format, list);
    }
    va_end(list);
}

/// Outcomes that no cell has are left out.
static void fill_legend(legend *l, const hn_map_plot *p, range r) {
    char low[HN_SI_TEXT], high[HN_SI_TEXT];
    bool seen[HN_STABILITY_CLASS_COUNT] = {false}, limit = false;
    for (int i = 0; i < p->x.n * p->y.n; i++) {
        seen[p->cell[i].kind] = true;
        limit |= p->cell[i].limit;
    }
    for (int k = HN_STABILITY_FINE; k < HN_STABILITY_CLASS_COUNT; k++) {
        const hn_map_class_look *look = hn_map_class_look_get((hn_stability_class)k);
        if (!seen[k]) {
            continue;
        }
        if (!p->heat || !hn_stability_is_stable((hn_stability_class)k)) {
            add_entry(l, "%s %s", look->glyph, look->words);
        }
    }
    if (p->heat && r.high > r.low) {
        hn_si_format(pow(10, r.low), "m", 2, low);
        hn_si_format(pow(10, r.high), "m", 2, high);
        add_entry(l, "%s to %s worst loop gap, %s to %s", SHADE[0], SHADE[SHADES - 1], low, high);
    }
    if (limit) {
        add_entry(l, "%s predicted limit", PREDICTED);
    }
    if (hn_map_plot_best(p, HN_MAP_GAP).column >= 0) {
        add_entry(l, "g v e best gap, velocity, energy");
    }
}

/// Returns where a legend beside the map stands; no columns: it has no room there and goes below.
static hn_area beside_map(const hn_map_plot *p, hn_area area, extent e) {
    const int x = LABEL_COLUMNS + p->x.n * e.columns + 1;
    const int room = area.columns - x;
    return room >= LEGEND_COLUMNS ? (hn_area){area.x + x, area.y, room, area.rows} : (hn_area){0};
}

/// An entry a line, what is folded set in behind its sign.
static void draw_legend_beside(hn_cells *c, hn_area area, const legend *l) {
    int y = 0;
    for (int i = 0; i < l->n; i++) {
        const char *words = l->entry[i] + strcspn(l->entry[i], " ") + 1;
        const hn_area rest = {area.x + 2, area.y, area.columns - 2, area.rows};
        hn_cells_printf(c, area, 0, y, HN_CELL_MUTED, 0, "%.*s", (int)(words - l->entry[i]),
                        l->entry[i]);
        y = hn_cells_fold(c, rest, y, HN_CELL_MUTED, words);
    }
}

/// One entry after the other; none is broken over two lines.
static void draw_legend_below(hn_cells *c, hn_area area, int y, const legend *l) {
    int x = 0;
    for (int i = 0; i < l->n; i++) {
        const int width = hn_text_columns(l->entry[i]);
        if (x > 0 && x + width > area.columns) {
            x = 0;
            y++;
        }
        x += hn_cells_put(c, area, x, y, HN_CELL_MUTED, 0, l->entry[i]) + 3;
    }
}

/// A mark stands in the second column of its cell where there is one: the outcome in the first one
/// stays.
static void mark(hn_cells *c, hn_area area, const hn_map_plot *p, hn_map_place at, extent e,
                 int style, const char *glyph) {
    if (at.column >= 0) {
        const int x = LABEL_COLUMNS + e.columns * at.column + (e.columns > 1);
        hn_cells_put(c, area, x, row_top(p, e, at.row), HN_CELL_INK, style, glyph);
    }
}

/// The best cells, each with its letter, in the first column of the cell; a second one that falls
/// on the same cell stands in its second column, or is left to the sentences.
static void mark_best(hn_cells *c, hn_area area, const hn_map_plot *p, extent e) {
    for (int k = HN_MAP_QUANTITIES - 1; k >= 0; k--) {
        const hn_map_place at = hn_map_plot_best(p, (hn_map_quantity)k);
        int before = 0;
        for (int j = 0; j < k; j++) {
            const hn_map_place other = hn_map_plot_best(p, (hn_map_quantity)j);
            before += other.column == at.column && other.row == at.row;
        }
        if (at.column >= 0 && before < e.columns) {
            hn_cells_put(c, area, LABEL_COLUMNS + e.columns * at.column + before,
                         row_top(p, e, at.row), HN_CELL_INK, HN_CELL_BOLD, QUANTITY[k].mark);
        }
    }
}

static void draw(hn_cells *c, hn_area area, const hn_map_plot *p, extent e, hn_map_place present,
                 hn_map_place cursor) {
    const range r = find_range(p);
    legend entries = {0};
    for (int row = 0; row < p->y.n; row++) {
        for (int column = 0; column < p->x.n; column++) {
            draw_cell(c, area, p, r, column, row, e);
        }
    }
    draw_axes(c, area, p, e);
    mark_best(c, area, p, e);
    mark(c, area, p, present, e, HN_CELL_BOLD, "★");
    mark(c, area, p, cursor, e, HN_CELL_REVERSE, "⊕");

    // the legend beside it where there is room
    const hn_area beside = beside_map(p, area, e);
    fill_legend(&entries, p, r);
    if (beside.columns > 0) {
        draw_legend_beside(c, beside, &entries);
    } else {
        draw_legend_below(c, area, p->y.n * e.rows + AXIS_ROWS, &entries);
    }
}

void hn_map_plot_draw(hn_cells *c, hn_area area, const hn_map_plot *p, hn_map_place present,
                      hn_map_place cursor) {
    draw(c, area, p, cell_extent(p, area.columns, area.rows), present, cursor);
}

int hn_map_plot_rows(const hn_map_plot *p, int columns, int rows) {
    const extent e = cell_extent(p, columns, rows);
    const bool beside = beside_map(p, (hn_area){0, 0, columns, 1}, e).columns > 0;
    const int used = p->y.n * e.rows + (beside ? AXIS_ROWS : FOOT_ROWS);
    return beside && used < LEGEND_ROWS ? LEGEND_ROWS : used;
}

// ---- words ----

static void add_value(hn_strbuf *b, const hn_map_axis *a, int i) {
    if (a->name[0]) {
        hn_strbuf_printf(b, "%s%s = %.3g%s%s", b->n > 0 ? ", " : "", a->name, a->value[i],
                         a->unit[0] ? " " : "", a->unit);
    }
}

void hn_map_plot_words(hn_strbuf *b, const hn_map_plot *p, hn_map_place at) {
    const hn_map_plot_cell *cell = &p->cell[at.row * p->x.n + at.column];
    char gap[HN_SI_TEXT];
    add_value(b, &p->x, at.column);
    add_value(b, &p->y, at.row);
    hn_strbuf_printf(b, ": %s", hn_map_class_look_get((hn_stability_class)cell->kind)->words);
    if (hn_stability_is_stable((hn_stability_class)cell->kind)) {
        hn_si_format(cell->gap, "m", 2, gap);
        hn_strbuf_printf(b, "; worst gap %s", gap);
    }
    if (isfinite(cell->margin) && cell->margin > 0) {
        hn_strbuf_printf(b, "; the step is %.3g of the predicted limit", cell->margin);
    }
}

/// "g smallest worst loop gap: 19 µm at alpha = 11.1, beta = 17.6"; a small gap or energy beside a
/// wrong motion is said to be so.
static void add_best(hn_strbuf *b, const hn_map_plot *p, hn_map_quantity quantity) {
    const hn_map_place at = hn_map_plot_best(p, quantity);
    if (at.column < 0) {
        return;
    }
    const hn_map_plot_cell *cell = &p->cell[at.row * p->x.n + at.column];
    const double value = value_of(cell, quantity);
    char gap[HN_SI_TEXT];
    hn_strbuf where;
    hn_strbuf_init(&where);
    add_value(&where, &p->x, at.column);
    add_value(&where, &p->y, at.row);
    hn_strbuf_printf(b, "%s smallest %s: ", QUANTITY[quantity].mark, QUANTITY[quantity].word);
    if (quantity == HN_MAP_GAP) {
        hn_si_format(value, "m", 2, gap);
        hn_strbuf_add(b, gap);
    } else {
        hn_strbuf_printf(b, "%.2g %%", 100 * value);
    }
    hn_strbuf_printf(b, " at %s", hn_strbuf_text(&where));
    if (quantity != HN_MAP_ERROR && cell->error > WRONG) {
        hn_strbuf_printf(b, ", where the velocity is %.2g %% off", 100 * cell->error);
    }
    hn_strbuf_add(b, "\n");
    hn_strbuf_reset(&where);
}

void hn_map_plot_best_words(hn_strbuf *b, const hn_map_plot *p) {
    for (int k = 0; k < HN_MAP_QUANTITIES; k++) {
        add_best(b, p, (hn_map_quantity)k);
    }
    if (strcmp(p->x.name, "alpha") == 0 && p->heat) {
        hn_strbuf_printf(b, "%s\n", SWEET_SPOT);
    }
}

void hn_map_plot_text(hn_strbuf *b, const hn_map_plot *p, int columns, bool colours) {
    const hn_map_place none = {-1, -1};
    hn_cells cells = {0};
    const int rows = p->y.n + AXIS_ROWS + 2 * MOST_ENTRIES; // of a legend that is folded
    if (!hn_cells_resize(&cells, columns, rows)) {
        hn_strbuf_add(b, "no memory for the map\n");
        return;
    }
    draw(&cells, (hn_area){0, 0, columns, rows}, p, cell_extent(p, columns, 0), none, none);
    hn_strbuf_printf(b, "%s\n", p->name);
    hn_cells_text(b, &cells, colours);
    while (b->n > 1 && b->text[b->n - 1] == '\n' && b->text[b->n - 2] == '\n') {
        b->text[--b->n] = '\0';
    }
    hn_cells_free(&cells);
}
