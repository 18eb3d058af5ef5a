// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/budgets/budgets_doc.h"

#include "session/budgets/budgets_internal.h"
#include "session/store/csv.h"
#include "session/store/ending_json.h"

#include <math.h>

static void put_error(hn_strbuf *b, const hn_budget_row *row, const hn_coordinate *c) {
    // no error at the end: null
    hn_json_key(b, "error");
    if (!c) {
        hn_json_null(b);
        return;
    }

    // the error, the sum of its parts, and how far the two differ
    hn_json_object(b);
    hn_json_put_string(b, "coordinate", c->name);
    hn_json_put_string(b, "unit", hn_coordinate_unit(c, "1"));
    hn_json_put_number(b, "value", row->budget.error);
    hn_json_put_number(b, "sum", row->budget.sum);
    hn_json_put_number(b, "mismatch", hn_budget_mismatch(row));
    hn_json_put_bool(b, "holds", hn_budget_holds(row));
    hn_json_put_number(b, "holds_until", row->holds_until);

    // the part of every cause
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_json_put_number(b, hn_cause_words((hn_cause)i)->name, hn_budget_part(row, 0, i));
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_energy(hn_strbuf *b, const hn_budget_row *row) {
    const hn_budget *a = &row->budget;
    hn_json_key(b, "energy");
    hn_json_object(b);
    hn_json_put_number(b, "change", a->energy);
    hn_json_put_number(b, "swing", a->swing);
    hn_json_put_bool(b, "conservative", a->conservative);
    hn_json_put_number(b, "loops_back_and_forth", a->loop_work_abs);
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_ENERGY_COUNT; i++) {
        hn_json_put_number(b, hn_energy_item_words((hn_energy_item)i)->name,
                           hn_budget_part(row, 1, i));
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

void hn_budget_put(hn_strbuf *b, const hn_model *model, const hn_budget_row *row) {
    hn_json_object(b);
    hn_json_put_string(b, "method", row->spelling);
    hn_json_put_string(b, "state", hn_budget_state(row));
    hn_json_put_string(b, "reason", row->reason);
    const bool refused = row->status != HN_OK && row->status != HN_ERR_STOPPED;
    const bool failed = row->status == HN_OK && row->budget.state == HN_RUN_FAILED;
    const bool has_figures = row->status == HN_ERR_NO_CONVERGENCE;
    const hn_ending ending = failed || has_figures
                                 ? row->budget.ending
                                 : hn_ending_named(refused ? hn_status_name(row->status) : "");
    hn_ending_put_json(b, &ending, row->reason,
                       row->status == HN_OK || has_figures ? row->budget.t : (double)NAN);
    if (row->status == HN_OK) {
        hn_json_put_number(b, "t", row->budget.t);
        hn_json_put_int(b, "steps", row->budget.steps);
        put_error(b, row, hn_budget_coordinate(model, row));
        put_energy(b, row);
    }
    hn_json_end_object(b);
}

void hn_budgets_json(hn_strbuf *b, const hn_budgets *a) {
    const hn_scene *scene = hn_model_scene(a->model);
    hn_json_object(b);
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    hn_json_put_number(b, "time", a->request.time);
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < a->n; i++) {
        hn_budget_put(b, a->model, &a->rows[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_cell(hn_strbuf *b, double value) {
    hn_strbuf_add(b, ",");
    hn_csv_number(b, value);
}

static void put_row(hn_strbuf *b, const hn_budgets *a, const hn_budget_row *row) {
    const hn_coordinate *c = hn_budget_coordinate(a->model, row);
    const int is_one = row->status == HN_OK;

    // the method, how its run ended, and how far it came
    hn_csv_text(b, row->spelling);
    hn_strbuf_printf(b, ",%s", hn_budget_state(row));
    put_cell(b, is_one ? row->budget.t : (double)NAN);
    put_cell(b, is_one ? (double)row->budget.steps : (double)NAN);

    // the error and its parts, in the unit of the coordinate
    hn_strbuf_add(b, ",");
    hn_csv_text(b, c ? c->name : "");
    hn_strbuf_printf(b, ",%s", c ? hn_coordinate_unit(c, "1") : "");
    put_cell(b, c ? row->budget.error : (double)NAN);
    put_cell(b, c ? row->budget.sum : (double)NAN);
    put_cell(b, c ? hn_budget_mismatch(row) : (double)NAN);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        put_cell(b, c ? hn_budget_part(row, 0, i) : (double)NAN);
    }

    // the change of energy and its parts, in joules
    put_cell(b, is_one ? row->budget.energy : (double)NAN);
    put_cell(b, is_one ? row->budget.swing : (double)NAN);
    for (int i = 0; i < HN_ENERGY_COUNT; i++) {
        put_cell(b, is_one ? hn_budget_part(row, 1, i) : (double)NAN);
    }

    // why it ended
    hn_strbuf_add(b, ",");
    hn_csv_text(b, row->reason);
    hn_strbuf_add(b, "\n");
}

void hn_budgets_csv(hn_strbuf *b, const hn_budgets *a) {
    hn_strbuf_add(b, "method,state,t,steps,coordinate,unit,error,error_sum,mismatch");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, ",error_%s", hn_cause_words((hn_cause)i)->name);
    }
    hn_strbuf_add(b, ",energy_change,energy_swing");
    for (int i = 0; i < HN_ENERGY_COUNT; i++) {
        hn_strbuf_printf(b, ",energy_%s", hn_energy_item_words((hn_energy_item)i)->name);
    }
    hn_strbuf_add(b, ",reason\n");
    for (int i = 0; i < a->n; i++) {
        put_row(b, a, &a->rows[i]);
    }
}
