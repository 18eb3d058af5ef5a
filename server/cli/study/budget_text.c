// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/budget_text.h"

#include "cli/shell/table.h"

static void put_errors(hn_strbuf *b, const hn_accounts *a) {
    hn_table t;
    hn_table_init(&t);

    // columns: the error, the part of each cause, and their sum
    hn_table_column(&t, "method", 0);
    hn_table_column(&t, "error of", 0);
    hn_table_column(&t, "at the end", 1);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_table_column(&t, hn_cause_name((hn_cause)i), 1);
    }
    hn_table_column(&t, "their sum", 1);

    // a line for each method that has an error at its end
    for (int m = 0; m < hn_accounts_n(a); m++) {
        const hn_account_row *row = hn_accounts_at(a, m);
        const hn_coordinate *c = hn_account_coordinate(hn_accounts_model(a), row);
        if (!c) {
            continue;
        }
        const char *unit = c->kind == HN_LENGTH ? "m" : "rad";
        hn_table_cell(&t, "%s", row->spelling);
        hn_table_cell(&t, "%s", c->name);
        hn_table_quantity(&t, row->account.error, unit);
        for (int i = 0; i < HN_CAUSE_COUNT; i++) {
            hn_table_quantity(&t, hn_account_part(row, 0, i), unit);
        }
        hn_table_quantity(&t, row->account.sum, unit);
    }

    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static void put_energies(hn_strbuf *b, const hn_accounts *a) {
    hn_table t;
    hn_table_init(&t);

    // columns: the change of energy, and the part of each cause
    hn_table_column(&t, "method", 0);
    hn_table_column(&t, "to t", 1);
    hn_table_column(&t, "change", 1);
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        hn_table_column(&t, hn_bill_name((hn_bill_item)i), 1);
    }

    // a line for each method that has an account
    for (int m = 0; m < hn_accounts_n(a); m++) {
        const hn_account_row *row = hn_accounts_at(a, m);
        if (row->status != HN_OK) {
            continue;
        }
        hn_table_cell(&t, "%s", row->spelling);
        hn_table_quantity(&t, row->account.t, "s");
        hn_table_quantity(&t, row->account.energy, "J");
        for (int i = 0; i < HN_BILL_COUNT; i++) {
            hn_table_quantity(&t, hn_account_part(row, 1, i), "J");
        }
    }

    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static void put_reasons(hn_strbuf *b, const hn_accounts *a) {
    for (int m = 0; m < hn_accounts_n(a); m++) {
        const hn_account_row *row = hn_accounts_at(a, m);
        if (row->reason[0]) {
            hn_strbuf_printf(b, "  %s: %s, %s\n", row->spelling, hn_account_state(row),
                             row->reason);
        }
        char note[HN_ACCOUNT_NOTE];
        hn_account_note(hn_accounts_model(a), row, note);
        if (note[0]) {
            hn_strbuf_printf(b, "  %s: %s\n", row->spelling, note);
        }
    }
}

static void put_legend(hn_strbuf *b) {
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_cause_name((hn_cause)i),
                         hn_cause_about((hn_cause)i));
    }
    for (int i = HN_BILL_LOOPS; i < HN_BILL_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_bill_name((hn_bill_item)i),
                         hn_bill_about((hn_bill_item)i));
    }
    hn_strbuf_add(b, "  A formulation without equations of its own has its part in truncation; "
                     "\"-\": it cannot be determined.\n");
}

void hn_accounts_text(hn_strbuf *b, const hn_accounts *a) {
    const hn_scene *scene = hn_model_scene(hn_accounts_model(a));
    hn_strbuf_printf(b, "%s, to t = %g s\n\nWhere the error at the end comes from\n",
                     scene->title ? scene->title : scene->id, hn_accounts_time(a));
    put_errors(b, a);
    hn_strbuf_add(b, "\nWho put energy in (+) or took it out (-)\n");
    put_energies(b, a);
    put_reasons(b, a);
    put_legend(b);
}
