// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/accounts/accounts_doc.h"

#include "session/accounts/accounts_internal.h"
#include "session/store/csv.h"

#include <math.h>

static void put_error(hn_strbuf *b, const hn_account_row *row, const hn_coordinate *c) {
    // no error at the end: null
    hn_json_key(b, "error");
    if (!c) {
        hn_json_null(b);
        return;
    }

    // the error, the sum of its parts, and how far the two differ
    hn_json_object(b);
    hn_json_put_string(b, "coordinate", c->name);
    hn_json_put_string(b, "unit", c->kind == HN_LENGTH ? "m" : "rad");
    hn_json_put_number(b, "value", row->account.error);
    hn_json_put_number(b, "sum", row->account.sum);
    hn_json_put_number(b, "mismatch", hn_account_mismatch(row));
    hn_json_put_bool(b, "holds", hn_account_holds(row));
    hn_json_put_number(b, "holds_until", row->holds_until);

    // the part of every cause
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_json_put_number(b, hn_cause_name((hn_cause)i), hn_account_part(row, 0, i));
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_energy(hn_strbuf *b, const hn_account_row *row) {
    const hn_account *a = &row->account;
    hn_json_key(b, "energy");
    hn_json_object(b);
    hn_json_put_number(b, "change", a->energy);
    hn_json_put_number(b, "swing", a->swing);
    hn_json_put_bool(b, "conservative", a->conservative);
    hn_json_put_number(b, "loops_back_and_forth", a->loop_work_abs);
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        hn_json_put_number(b, hn_bill_name((hn_bill_item)i), hn_account_part(row, 1, i));
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

void hn_account_put(hn_strbuf *b, const hn_model *model, const hn_account_row *row) {
    hn_json_object(b);
    hn_json_put_string(b, "method", row->spelling);
    hn_json_put_string(b, "state", hn_account_state(row));
    hn_json_put_string(b, "reason", row->reason);
    if (row->status == HN_OK) {
        hn_json_put_number(b, "t", row->account.t);
        hn_json_put_int(b, "steps", row->account.steps);
        put_error(b, row, hn_account_coordinate(model, row));
        put_energy(b, row);
    }
    hn_json_end_object(b);
}

void hn_accounts_json(hn_strbuf *b, const hn_accounts *a) {
    const hn_scene *scene = hn_model_scene(a->model);
    hn_json_object(b);
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    hn_json_put_number(b, "time", a->request.time);
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < a->n; i++) {
        hn_account_put(b, a->model, &a->rows[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_cell(hn_strbuf *b, double value) {
    hn_strbuf_add(b, ",");
    hn_csv_number(b, value);
}

static void put_row(hn_strbuf *b, const hn_accounts *a, const hn_account_row *row) {
    const hn_coordinate *c = hn_account_coordinate(a->model, row);
    const int is_one = row->status == HN_OK;

    // the method, how its run ended, and how far it came
    hn_csv_text(b, row->spelling);
    hn_strbuf_printf(b, ",%s", hn_account_state(row));
    put_cell(b, is_one ? row->account.t : (double)NAN);
    put_cell(b, is_one ? (double)row->account.steps : (double)NAN);

    // the error and its parts, in the unit of the coordinate
    hn_strbuf_add(b, ",");
    hn_csv_text(b, c ? c->name : "");
    hn_strbuf_printf(b, ",%s", !c ? "" : c->kind == HN_LENGTH ? "m" : "rad");
    put_cell(b, c ? row->account.error : (double)NAN);
    put_cell(b, c ? row->account.sum : (double)NAN);
    put_cell(b, c ? hn_account_mismatch(row) : (double)NAN);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        put_cell(b, c ? hn_account_part(row, 0, i) : (double)NAN);
    }

    // the change of energy and its parts, in joules
    put_cell(b, is_one ? row->account.energy : (double)NAN);
    put_cell(b, is_one ? row->account.swing : (double)NAN);
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        put_cell(b, is_one ? hn_account_part(row, 1, i) : (double)NAN);
    }

    // why it ended
    hn_strbuf_add(b, ",");
    hn_csv_text(b, row->reason);
    hn_strbuf_add(b, "\n");
}

void hn_accounts_csv(hn_strbuf *b, const hn_accounts *a) {
    hn_strbuf_add(b, "method,state,t,steps,coordinate,unit,error,error_sum,mismatch");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, ",error_%s", hn_cause_name((hn_cause)i));
    }
    hn_strbuf_add(b, ",energy_change,energy_swing");
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        hn_strbuf_printf(b, ",energy_%s", hn_bill_name((hn_bill_item)i));
    }
    hn_strbuf_add(b, ",reason\n");
    for (int i = 0; i < a->n; i++) {
        put_row(b, a, &a->rows[i]);
    }
}
