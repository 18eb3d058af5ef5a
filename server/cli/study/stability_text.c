// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/stability_text.h"

#include "cli/shell/table.h"
#include "session/stability/stability_column.h"
#include "terminal/map_plot.h"
#include "terminal/width.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put_map(hn_strbuf *b, hn_map_plot *plot, const hn_map *map, int m) {
    hn_map_plot_take(plot, map, m);
    hn_strbuf_add(b, "\n");
    hn_map_plot_text(b, plot, hn_terminal_columns(), hn_terminal_colours());
    hn_map_plot_best_words(b, plot);
    hn_strbuf_add(b, "  ");
    hn_map_agreement_text(b, map, m);
    hn_strbuf_add(b, "\n");
}

static void put_maps(hn_strbuf *b, const hn_map *map) {
    hn_map_plot *plot = malloc(sizeof *plot);
    for (int m = 0; plot && m < hn_map_n_methods(map); m++) {
        put_map(b, plot, map, m);
    }
    b->failed |= !plot;
    free(plot);
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
    static const char *const heads[] = {"method",
                                        "step for 1 % error",
                                        "predicted",
                                        "last stable",
                                        "first unstable",
                                        "observed / predicted",
                                        "what happened at the first unstable step"};
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
    hn_strbuf_printf(b, "%s: which steps are stable, tried by runs to t = %.4g s or of %d steps\n",
                     scene->title ? scene->title : scene->id, hn_map_time(map),
                     HN_STABILITY_LEAST_STEPS);
    if (!hn_map_x(map)->name[0] && hn_map_y(map)->is_step) {
        put_limits(b, map);
        return;
    }

    // the steps come first where a map of steps has chosen this one
    const hn_map *steps = hn_map_steps(map);
    for (int m = 0; steps && m < hn_map_n_methods(steps); m++) {
        hn_strbuf_add(b, "  ");
        hn_map_steps_text(b, map, m);
        hn_strbuf_add(b, "\n");
    }
    put_maps(b, map);
}

void hn_map_plots_text(hn_strbuf *b, const hn_map *map) {
    put_maps(b, map);
}
