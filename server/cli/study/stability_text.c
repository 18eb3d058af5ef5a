// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/table.h"
#include "cli/study/stability_text.h"
#include "session/stability/stability_frame.h"
#include "session/stability/stability_column.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char PREDICTED[] = "\xe2\x94\x81"; // a heavy line

static double near_row(const hn_map_axis *y, double value) {
    const double low = y->value[0], high = y->value[y->n - 1];
    return y->is_log ? log(value / low) / log(high / low) * (y->n - 1)
                     : (value - low) / (high - low) * (y->n - 1);
}

/// Returns 1 when the predicted boundary of this column passes between row j and the one above.
static bool is_boundary(const hn_map *map, int m, int column, int row) {
    const hn_map_column *c = hn_map_get_column(map, m, column);
    for (int k = 0; k < c->n_predicted; k++) {
        if (c->predicted[k] > 0 && lround(near_row(hn_map_y(map), c->predicted[k])) == row) {
            return true;
        }
    }
    return false;
}

static void put_row(hn_strbuf *b, const hn_map *map, int m, int row) {
    const hn_map_axis *x = hn_map_x(map), *y = hn_map_y(map);
    hn_strbuf_printf(b, "%10.3g \xe2\x94\x82", y->value[row]);
    for (int i = 0; i < x->n; i++) {
        const hn_stability_class kind = hn_map_get(map, m, i, row)->trial.kind;
        const char *glyph = hn_map_class_look_get(kind)->glyph;
        // two characters for each cell: the outcome, and the predicted boundary if it passes here
        hn_strbuf_add(b, glyph[0] ? glyph : " ");
        hn_strbuf_add(b, is_boundary(map, m, i, row) ? PREDICTED : " ");
    }
    hn_strbuf_add(b, "\n");
}

static void put_map(hn_strbuf *b, const hn_map *map, int m) {
    const hn_map_axis *x = hn_map_x(map), *y = hn_map_y(map);
    char title[96];
    hn_map_axis_title(y, title);
    hn_strbuf_printf(b, "\n%s\n%10s\n", hn_map_method(map, m), title);
    for (int row = y->n - 1; row >= 0; row--) {
        put_row(b, map, m, row);
    }
    hn_map_axis_title(x, title);
    hn_strbuf_printf(b, "%11s\xe2\x94\x94", "");
    if (x->name[0]) {
        hn_strbuf_printf(b, "%.3g .. %.3g   %s", x->value[0], x->value[x->n - 1], title);
    }
    hn_strbuf_add(b, "\n  ");
    hn_map_agreement_text(b, map, m);
    hn_strbuf_add(b, "\n");
}

static void put_legend(hn_strbuf *b) {
    hn_strbuf_add(b, "\n");
    for (int k = HN_STABILITY_FINE; k < HN_STABILITY_CLASS_COUNT; k++) {
        const hn_map_class_look *look = hn_map_class_look_get((hn_stability_class)k);
        hn_strbuf_printf(b, "%s %s   ", look->glyph, look->words);
    }
    hn_strbuf_printf(b, "%s predicted limit\n", PREDICTED);
}

static void put_limit(hn_table *t, const hn_map *map, int m) {
    const hn_map_column *c = hn_map_get_column(map, m, 0);
    const double predicted = c->n_predicted ? c->predicted[0] : (double)NAN;

    // no boundary was found and the largest step is stable too
    const int stable_all =
        isnan(c->unstable) &&
        hn_stability_is_stable(hn_map_get(map, m, 0, hn_map_y(map)->n - 1)->trial.kind);

    // the method, the largest accurate step, the predicted limit, and the largest stable step
    hn_table_cell(t, "%s", hn_map_method(map, m));
    if (c->accurate == 0) {
        hn_table_cell(t, "%s", "none");
    } else {
        hn_table_quantity(t, c->accurate, "s");
    }
    hn_table_quantity(t, predicted, "s");
    if (c->stable == 0) {
        hn_table_cell(t, "%s", "none");
    } else {
        hn_table_quantity(t, stable_all ? hn_map_y(map)->value[hn_map_y(map)->n - 1] : c->stable,
                          "s");
    }

    // the smallest unstable step, and the ratio of boundary and prediction
    hn_table_quantity(t, c->unstable, "s");
    if (predicted > 0 && c->stable > 0) {
        hn_table_cell(t, "%.3f", sqrt(c->stable * c->unstable) / predicted);
    } else {
        hn_table_cell(t, "%s", "-");
    }

    // how it ended
    hn_table_cell(t, "%.150s", c->how[0] ? c->how : stable_all ? "stable throughout" : "");
}

static void put_limits(hn_strbuf *b, const hn_map *map) {
    static const char *const heads[] = {
        "method", "velocities to 1 %", "predicted", "last stable", "first not",
        "ratio",  "how it ended there"};
    enum { N_HEADS = sizeof heads / sizeof *heads };
    hn_table t;
    hn_table_init(&t);
    for (int i = 0; i < N_HEADS; i++) {
        hn_table_column(&t, heads[i], i > 0 && i < N_HEADS - 1);
    }
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        put_limit(&t, map, m);
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        hn_strbuf_printf(b, "  %s: ", hn_map_method(map, m));
        hn_map_agreement_text(b, map, m);
        hn_strbuf_add(b, "\n");
    }
}

void hn_map_text(hn_strbuf *b, const hn_map *map) {
    const hn_scene *scene = hn_model_scene(hn_map_model(map));
    hn_strbuf_printf(b, "%s: where steps are stable, runs to t = %.4g s or %d steps\n",
                     scene->title ? scene->title : scene->id, hn_map_time(map),
                     HN_STABILITY_LEAST_STEPS);
    if (!hn_map_x(map)->name[0] && hn_map_y(map)->is_step) {
        put_limits(b, map);
        return;
    }
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        put_map(b, map, m);
    }
    put_legend(b);
}
