// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_doc.h"

#include "session/stability/stability.h"
#include "session/stability/stability_column.h"
#include "session/store/csv.h"
#include "session/store/ending_json.h"
#include "study/incidents/watch.h"

#include <math.h>
#include <stdio.h>

static void put_axis(hn_strbuf *b, const char *key, const hn_map_axis *a) {
    hn_json_key(b, key);
    if (!a->name[0]) {
        hn_json_null(b);
        return;
    }
    hn_json_object(b);
    hn_json_put_string(b, "name", a->name);
    hn_json_put_string(b, "unit", a->unit);
    hn_json_put_string(b, "kind", a->is_param ? "parameter" : a->is_step ? "step" : "setting");
    hn_json_put_string(b, "scale", a->is_log ? "log" : "lin");
    hn_json_put_numbers(b, "values", a->value, (size_t)a->n);
    hn_json_end_object(b);
}

/// Why a trial is not stable, with the figure that its reason names: the loop gap in
/// characteristic lengths, the energy above the motion's in its range, or the time reached.
static hn_ending ending_of(const hn_stability_trial *t) {
    hn_ending e = hn_ending_named(t->reason[0] ? hn_stability_class_name(t->kind) : "");
    const double open = t->status == HN_OK ? HN_STABILITY_OPEN : HN_RUN_LOST_GAP;
    if (t->kind != HN_STABILITY_GREW && t->kind != HN_STABILITY_STOPPED) {
        return e;
    }
    if (t->kind == HN_STABILITY_GREW && t->gap > open) {
        snprintf(e.quantity, sizeof e.quantity, "gap");
        e.value = t->gap;
        e.limit = open;
    } else if (t->status == HN_OK && t->energy > HN_STABILITY_GROWN) {
        snprintf(e.quantity, sizeof e.quantity, "energy");
        e.value = t->energy;
        e.limit = t->energy > HN_STABILITY_RUNAWAY ? HN_STABILITY_RUNAWAY : HN_STABILITY_GROWN;
    } else {
        snprintf(e.quantity, sizeof e.quantity, "t");
        e.value = t->t_reached;
    }
    return e;
}

static void put_cell(hn_strbuf *b, const hn_map_cell *cell) {
    const hn_stability_trial *t = &cell->trial;
    hn_json_object(b);
    hn_json_put_string(b, "class", hn_stability_class_name(t->kind));
    if (t->reason[0]) {
        hn_json_put_string(b, "reason", t->reason);
    }
    const hn_ending ending = ending_of(t);
    hn_ending_put_json(b, &ending, t->reason, t->t_reached);
    hn_json_put_number(b, "t", t->t_reached);
    hn_json_put_number(b, "error", t->error);
    hn_json_put_number(b, "energy", t->energy);
    hn_json_put_number(b, "gap", t->gap);
    hn_json_put_int(b, "steps", t->steps);
    hn_json_put_number(b, "margin", cell->margin);
    hn_json_end_object(b);
}

static void put_column(hn_strbuf *b, const hn_map_column *c) {
    static const char *const verdicts[] = {
        [HN_MAP_UNTOLD] = "not known",
        [HN_MAP_AGREE] = "agrees",
        [HN_MAP_UNSEEN] = "too-slow-to-see",
        [HN_MAP_EARLIER] = "earlier",
        [HN_MAP_LATER] = "later",
    };
    hn_json_object(b);
    hn_json_put_numbers(b, "predicted", c->predicted, (size_t)c->n_predicted);
    hn_json_put_number(b, "visible", c->visible);
    hn_json_put_number(b, "last_stable", c->stable);
    hn_json_put_number(b, "first_unstable", c->unstable);
    hn_json_put_number(b, "accurate", c->accurate);
    hn_json_put_string(b, "how", c->how);
    hn_json_put_string(b, "verdict", verdicts[c->verdict]);
    hn_json_end_object(b);
}

static void put_agreement(hn_strbuf *b, const hn_map *map, int m) {
    const hn_map_agreement a = hn_map_agrees(map, m);
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_map_agreement_text(&text, map, m);
    hn_json_key(b, "agreement");
    hn_json_object(b);
    hn_json_put_string(b, "by", a.by_columns ? "columns" : "cells");
    hn_json_put_int(b, "compared", a.compared);
    hn_json_put_int(b, "agree", a.agree);
    hn_json_put_int(b, "too_slow_to_see", a.unseen);
    hn_json_put_int(b, "earlier", a.earlier);
    hn_json_put_int(b, "later", a.later);
    hn_json_put_string(b, "text", hn_strbuf_text(&text));
    hn_json_end_object(b);
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

static void put_stiff(hn_strbuf *b, hn_map_stiffness stiff) {
    hn_json_key(b, "stiff");
    if (stiff == HN_MAP_STIFF_UNKNOWN) {
        hn_json_null(b);
    } else {
        hn_json_bool(b, stiff == HN_MAP_STIFF);
    }
}

// The map of steps that chose this map: for each method its boundaries, and what they mean.
static void put_steps(hn_strbuf *b, const hn_map *steps) {
    hn_json_key(b, "steps");
    if (!steps) {
        hn_json_null(b);
        return;
    }
    hn_json_array(b);
    for (int m = 0; m < hn_map_n_methods(steps); m++) {
        hn_json_object(b);
        hn_json_put_string(b, "method", hn_map_method(steps, m));
        put_agreement(b, steps, m);
        hn_json_key(b, "column");
        put_column(b, hn_map_get_column(steps, m, 0));
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_method(hn_strbuf *b, const hn_map *map, int m) {
    hn_json_object(b);

    // the method and how well it agrees
    hn_json_put_string(b, "method", hn_map_method(map, m));
    put_agreement(b, map, m);

    // the boundary in each column
    hn_json_key(b, "columns");
    hn_json_array(b);
    for (int i = 0; i < hn_map_x(map)->n; i++) {
        put_column(b, hn_map_get_column(map, m, i));
    }
    hn_json_end_array(b);

    // the outcome of each cell, row by row
    hn_json_key(b, "rows");
    hn_json_array(b);
    for (int j = 0; j < hn_map_y(map)->n; j++) {
        hn_json_array(b);
        for (int i = 0; i < hn_map_x(map)->n; i++) {
            put_cell(b, hn_map_get(map, m, i, j));
        }
        hn_json_end_array(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

void hn_map_json(hn_strbuf *b, const hn_map *map) {
    hn_json_object(b);
    hn_json_put_string(b, "study", "stability");
    hn_json_put_string(b, "scene", hn_model_scene(hn_map_model(map))->id);
    hn_json_put_number(b, "time", hn_map_time(map));
    hn_json_put_bool(b, "finished", !hn_map_stopped(map) && !hn_map_out_of_time(map));
    hn_json_put_bool(b, "stopped", hn_map_stopped(map));
    hn_json_put_number(b, "elapsed", hn_map_elapsed(map));
    hn_json_put_string(b, "preset", hn_map_preset(map));
    put_stiff(b, hn_map_is_stiff(map));
    // the preset whose map tells more, where this one rests on a stability that decides nothing
    hn_json_put_string(b, "telling", hn_map_telling(map));
    put_steps(b, hn_map_steps(map));
    put_axis(b, "x", hn_map_x(map));
    put_axis(b, "y", hn_map_y(map));
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        put_method(b, map, m);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_row(hn_strbuf *b, const hn_map *map, int m, int column, int row) {
    const hn_map_axis *x = hn_map_x(map), *y = hn_map_y(map);
    const hn_map_cell *cell = hn_map_get(map, m, column, row);
    const hn_map_column *c = hn_map_get_column(map, m, column);
    const hn_stability_trial *t = &cell->trial;

    // the numbers of the row, before and after the class
    const double at[] = {x->name[0] ? x->value[column] : (double)NAN, y->value[row]};
    const double seen[] = {t->error,
                           t->energy,
                           t->gap,
                           t->t_reached,
                           (double)t->steps,
                           cell->margin,
                           c->n_predicted ? c->predicted[0] : (double)NAN};

    // the method, the place in the map, the outcome
    hn_csv_text(b, hn_map_method(map, m));
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        hn_strbuf_add(b, ",");
        hn_csv_number(b, at[i]);
    }
    hn_strbuf_printf(b, ",%s", hn_stability_class_name(t->kind));
    for (size_t i = 0; i < sizeof seen / sizeof *seen; i++) {
        hn_strbuf_add(b, ",");
        hn_csv_number(b, seen[i]);
    }

    // why it ended
    hn_strbuf_add(b, ",");
    hn_csv_text(b, t->reason);
    hn_strbuf_add(b, "\n");
}

void hn_map_csv(hn_strbuf *b, const hn_map *map) {
    const hn_map_axis *x = hn_map_x(map);
    hn_strbuf_printf(
        b, "method,%s,%s,class,error,energy,gap,t,steps,margin,predicted_boundary,reason\n",
        x->name[0] ? x->name : "x", hn_map_y(map)->name);
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        for (int j = 0; j < hn_map_y(map)->n; j++) {
            for (int i = 0; i < x->n; i++) {
                put_row(b, map, m, i, j);
            }
        }
    }
}
