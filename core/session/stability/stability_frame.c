// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_frame.h"

#include "session/stability/stability_column.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const hn_map_class_look LOOKS[HN_STABILITY_CLASS_COUNT] = {
    {HN_STABILITY_PENDING, "not tried", "", -3, 0},
    {HN_STABILITY_FINE, "stable, velocities right to 1 %", "\xc2\xb7", 0, 0.35},
    {HN_STABILITY_INACCURATE, "stable, velocities less accurate", "~", 2, 0.35},
    {HN_STABILITY_GREW, "unstable: the error grew", "!", -1, 0.55},
    {HN_STABILITY_STOPPED, "stopped with a reason", "\xc3\x97", -2, 0.75},
    {HN_STABILITY_REFUSED, "refused", "-", -3, 1},
    {HN_STABILITY_SKIPPED, "out of time", "?", -3, 0.5},
};

const hn_map_class_look *hn_map_class_look_get(hn_stability_class kind) {
    return &LOOKS[kind];
}

uint32_t hn_map_class_colour(hn_stability_class kind, hn_theme theme) {
    const hn_surface *s = hn_surface_get(theme);
    switch (LOOKS[kind].slot) {
    case -1:
        return s->tear;
    case -2:
        return s->muted;
    case -3:
        return s->hairline;
    default:
        return hn_look_get(LOOKS[kind].slot)->colour[theme];
    }
}

int hn_map_height(const hn_map *map) {
    return HN_MAP_TOP + HN_MAP_PANEL * hn_map_n_methods(map);
}

double hn_map_field_top(int m) {
    return HN_MAP_TOP + (double)HN_MAP_PANEL * m;
}

// bytes of text that fit into a line: up to a blank, where there is one
static size_t fit(const char *text) {
    const size_t n = strlen(text);
    if (n <= HN_MAP_SAID_COLUMNS) {
        return n;
    }
    for (size_t k = HN_MAP_SAID_COLUMNS; k > 0; k--) {
        if (text[k] == ' ') {
            return k;
        }
    }
    return HN_MAP_SAID_COLUMNS;
}

int hn_map_said(const hn_map *map, int m, hn_map_said_line lines[HN_MAP_SAID_LINES]) {
    hn_strbuf said;
    int n = 0;
    hn_strbuf_init(&said);
    hn_map_agreement_text(&said, map, m);
    const char *rest = hn_strbuf_text(&said);
    while (*rest && n < HN_MAP_SAID_LINES) {
        const size_t k = fit(rest);
        const int cut = n == HN_MAP_SAID_LINES - 1 && rest[k];
        snprintf(lines[n++], sizeof(hn_map_said_line), "%.*s%s", (int)k, rest, cut ? "..." : "");
        rest += k + (rest[k] == ' ');
    }
    hn_strbuf_reset(&said);
    return n;
}

double hn_map_column_edge(const hn_map *map, int i) {
    return HN_MAP_LEFT + (double)HN_MAP_FIELD_WIDTH * i / hn_map_x(map)->n;
}

double hn_map_row_edge(const hn_map *map, int m, int j) {
    return hn_map_field_top(m) + HN_MAP_FIELD_HEIGHT * (1 - (double)j / hn_map_y(map)->n);
}

double hn_map_height_of(const hn_map *map, int m, double value) {
    const hn_map_axis *y = hn_map_y(map);
    const double low = y->value[0], high = y->value[y->n - 1];
    const double share =
        y->is_log ? log(value / low) / log(high / low) : (value - low) / (high - low);
    const double row = 0.5 + share * (y->n - 1);
    return hn_map_field_top(m) + HN_MAP_FIELD_HEIGHT * (1 - row / y->n);
}

int hn_map_crossing_x(const hn_map *map, int m, int i, int j, double *x) {
    if (hn_map_y(map)->is_step || i + 1 >= hn_map_x(map)->n) {
        return 0;
    }
    const double a = hn_map_get(map, m, i, j)->margin, b = hn_map_get(map, m, i + 1, j)->margin;
    if (isnan(a) || isnan(b) || (a > 1) == (b > 1)) {
        return 0;
    }
    const double edge = hn_map_column_edge(map, i + 1), width = edge - hn_map_column_edge(map, i);
    const int inside = a > 0 && b > 0 && isfinite(a) && isfinite(b); // else half-way
    const double share = inside ? log(a) / log(a / b) : 0.5;
    *x = edge + (share - 0.5) * width;
    return 1;
}

int hn_map_ticks(const hn_map_axis *a, int at[8]) {
    int n = 0;
    const int every = a->n <= 8 ? 1 : (a->n + 5) / 6;
    for (int i = 0; i < a->n && n < 8; i += every) {
        at[n++] = i;
    }
    return n;
}

void hn_map_axis_title(const hn_map_axis *a, char out[96]) {
    snprintf(out, 96, a->unit[0] ? "%s [%s]" : "%s", a->name, a->unit);
}

static void put_value(hn_strbuf *b, const hn_map_axis *a, int i) {
    if (a->name[0]) {
        hn_strbuf_printf(b, "%s = %.4g%s%s, ", a->name, a->value[i], a->unit[0] ? " " : "",
                         a->unit);
    }
}

void hn_map_cell_text(hn_strbuf *b, const hn_map *map, int m, int column, int row) {
    const hn_map_cell *cell = hn_map_get(map, m, column, row);
    const hn_stability_trial *t = &cell->trial;
    put_value(b, hn_map_x(map), column);
    put_value(b, hn_map_y(map), row);
    hn_strbuf_printf(b, "%s: %s", hn_map_method(map, m), LOOKS[t->kind].words);
    if (t->reason[0]) {
        hn_strbuf_printf(b, " (%s)", t->reason);
    } else if (hn_stability_is_stable(t->kind)) {
        hn_strbuf_printf(b, ", error %.2g, gap %.2g, %lld steps", t->error, t->gap, t->steps);
    }
    if (isfinite(cell->margin) && cell->margin > 0) {
        hn_strbuf_printf(b, "; the step is %.3g of the predicted limit", cell->margin);
    } else if (cell->margin > 0) {
        hn_strbuf_add(b, "; predicted to grow at any step");
    } else if (cell->margin == 0) {
        hn_strbuf_add(b, "; no limit is predicted");
    }
}
