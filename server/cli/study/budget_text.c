// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/budget_text.h"

#include "cli/shell/fold.h"
#include "cli/shell/table.h"
#include "render/look.h"
#include "terminal/bars.h"
#include "terminal/width.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { NAME = 48, MOST_BESIDE = HN_TABLE_COLUMNS - 1 /* methods; a column is for the causes */ };

/// One of the two tables: the error at the end by cause, or the change of energy by item.
typedef struct sheet {
    const hn_budgets *budgets;
    int energy, n_parts;
    int n;
    const hn_budget_row *rows[HN_BUDGETS_METHODS]; ///< those that have something to tell
    char plain[HN_BUDGETS_METHODS][NAME];          ///< name of the formulation
    char name[HN_BUDGETS_METHODS][NAME + 8];       ///< no two are the same
} sheet;

static sheet gather(const hn_budgets *a, int energy) {
    sheet s = {
        .budgets = a, .energy = energy, .n_parts = energy ? HN_ENERGY_COUNT : HN_CAUSE_COUNT};
    for (int m = 0; m < hn_budgets_n(a); m++) {
        const hn_budget_row *row = hn_budgets_at(a, m);
        const bool has =
            energy ? row->status == HN_OK : hn_budget_coordinate(hn_budgets_model(a), row) != NULL;
        if (has && s.n < HN_BUDGETS_METHODS) {
            s.rows[s.n++] = row;
        }
    }
    return s;
}

static const char *name_of(const sheet *s, int part) {
    return s->energy ? hn_energy_item_words((hn_energy_item)part)->name
                     : hn_cause_words((hn_cause)part)->name;
}

static const char *unit_of(const sheet *s, int i) {
    const hn_coordinate *c = hn_budget_coordinate(hn_budgets_model(s->budgets), s->rows[i]);
    return s->energy || !c ? "J" : hn_coordinate_unit(c, "1");
}

/// "a2 [rad]", or the time that a budget of energy goes to.
static void put_subject(hn_table *t, const sheet *s, int i) {
    if (s->energy) {
        hn_table_quantity(t, s->rows[i]->budget.t, "s");
    } else {
        const hn_model *model = hn_budgets_model(s->budgets);
        hn_table_cell(t, "%s [%s]", hn_budget_coordinate(model, s->rows[i])->name, unit_of(s, i));
    }
}

/// A number in the unit of its budget, without a prefix: parts that are added have one unit.
static void put_part(hn_table *t, double value) {
    if (isfinite(value)) {
        hn_table_cell(t, "%.3g", value);
    } else {
        hn_table_cell(t, "-");
    }
}

static double whole_of(const sheet *s, int i) {
    return s->energy ? s->rows[i]->budget.energy : s->rows[i]->budget.error;
}

/// The sum of the parts, marked where it is not the error.
static void put_sum(hn_table *t, const hn_budget_row *row) {
    if (isfinite(row->budget.sum)) {
        hn_table_cell(t, "%.3g%s", row->budget.sum, hn_budget_holds(row) ? "" : "*");
    } else {
        hn_table_cell(t, "-");
    }
}

/// A line a method, a column a cause.
static void fill_by_method(hn_table *t, const sheet *s) {
    hn_table_column(t, "method", 0);
    hn_table_column(t, s->energy ? "to t" : "coordinate", s->energy);
    hn_table_column(t, s->energy ? "change" : "error at the end", 1);
    for (int k = 0; k < s->n_parts; k++) {
        hn_table_column(t, name_of(s, k), 1);
    }
    if (!s->energy) {
        hn_table_column(t, "their sum", 1);
    }

    // the parts of every method
    for (int i = 0; i < s->n; i++) {
        hn_table_cell(t, "%s", s->rows[i]->spelling);
        put_subject(t, s, i);
        put_part(t, whole_of(s, i));
        for (int k = 0; k < s->n_parts; k++) {
            put_part(t, hn_budget_part(s->rows[i], s->energy, k));
        }
        if (!s->energy) {
            put_sum(t, s->rows[i]);
        }
    }
}

enum { WHOLE = -1, SUM = -2 }; // lines of the narrow form beside those of the parts

/// One line of the narrow form: a cause, and a number of every method of the block.
static void put_line(hn_table *t, const sheet *s, int from, int to, const char *name, int part) {
    hn_table_cell(t, "%s", name);
    for (int i = from; i < to; i++) {
        if (part == SUM) {
            put_sum(t, s->rows[i]);
        } else {
            put_part(t,
                     part == WHOLE ? whole_of(s, i) : hn_budget_part(s->rows[i], s->energy, part));
        }
    }
}

/// Short names of the methods, told apart by a number where one comes again: "Baumgarte (2)".
static void name_methods(sheet *s) {
    for (int i = 0; i < s->n; i++) {
        hn_method_spec spec;
        hn_diag diag = {0};
        int before = 0;
        const bool known = hn_method_parse(s->rows[i]->spelling, &spec, &diag) == HN_OK;
        snprintf(s->plain[i], NAME, "%.*s", NAME - 1,
                 known ? spec.formulation->short_name : s->rows[i]->spelling);
        for (int k = 0; k < i; k++) {
            before += strcmp(s->plain[k], s->plain[i]) == 0;
        }
        snprintf(s->name[i], sizeof s->name[i], before ? "%s (%d)" : "%s", s->plain[i], before + 1);
    }
}

/// A line a cause, a column a method, for the methods from `from` to before `to`. Returns whether
/// the table has room for all of them.
static bool fill_by_cause(hn_strbuf *b, const sheet *s, int from, int to) {
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "", 0);
    for (int i = from; i < to; i++) {
        hn_table_column(&t, s->name[i], 1);
        hn_table_spare(&t, 1);
    }

    // the whole, its parts, and their sum
    put_line(&t, s, from, to, s->energy ? "change" : "error at the end", WHOLE);
    for (int k = 0; k < s->n_parts; k++) {
        put_line(&t, s, from, to, name_of(s, k), k);
    }
    if (!s->energy) {
        put_line(&t, s, from, to, "their sum", SUM);
    }
    hn_table_write(b, &t);
    const bool whole = t.n_left_out == 0;
    hn_table_reset(&t);
    return whole;
}

/// Returns how many methods have room side by side: blocks of nearly the same size.
static int block_size(const sheet *s) {
    int n_blocks = 1, size = s->n;
    for (bool whole = false; !whole && size > 1; n_blocks++) {
        size = (s->n + n_blocks - 1) / n_blocks;
        whole = size <= MOST_BESIDE;
        for (int from = 0; whole && from < s->n; from += size) {
            hn_strbuf tried;
            hn_strbuf_init(&tried);
            whole = fill_by_cause(&tried, s, from, from + size < s->n ? from + size : s->n);
            hn_strbuf_reset(&tried);
        }
    }
    return size;
}

/// For narrow terminals: a line a cause, a column a method, in as few blocks as there is room for;
/// every cause is shown.
static void put_by_cause(hn_strbuf *b, sheet *s) {
    name_methods(s);
    const int size = block_size(s);
    for (int from = 0; from < s->n; from += size) {
        fill_by_cause(b, s, from, from + size < s->n ? from + size : s->n);
    }
    int width = 0;
    for (int i = 0; i < s->n; i++) {
        const int columns = hn_fold_width(s->name[i], strlen(s->name[i]));
        width = columns > width ? columns : width;
    }
    for (int i = 0; i < s->n; i++) {
        const hn_coordinate *c = hn_budget_coordinate(hn_budgets_model(s->budgets), s->rows[i]);
        const int columns = hn_fold_width(s->name[i], strlen(s->name[i]));
        hn_strbuf_printf(b, "  %s%*s  %s", s->name[i], width - columns, "", s->rows[i]->spelling);
        if (s->energy) {
            hn_strbuf_printf(b, ", to t = %g s\n", s->rows[i]->budget.t);
        } else {
            hn_strbuf_printf(b, ", error of %s [%s]\n", c->name, unit_of(s, i));
        }
    }
}

/// A line a method where there is room for every column.
static void put_sheet(hn_strbuf *b, const hn_budgets *a, int energy) {
    sheet s = gather(a, energy);
    hn_strbuf wide;
    hn_table t;
    hn_strbuf_init(&wide);
    hn_table_init(&t);
    fill_by_method(&t, &s);
    hn_table_write(&wide, &t);
    if (t.n_left_out == 0) {
        hn_strbuf_add(b, hn_strbuf_text(&wide));
    } else {
        put_by_cause(b, &s);
    }
    hn_table_reset(&t);
    hn_strbuf_reset(&wide);
}

/// Why a method has no budget, or only one of a part of its run.
static void put_reasons(hn_strbuf *b, const hn_budgets *a) {
    for (int m = 0; m < hn_budgets_n(a); m++) {
        const hn_budget_row *row = hn_budgets_at(a, m);
        if (row->reason[0]) {
            hn_strbuf_printf(b, "  %s: %s, %s\n", row->spelling, hn_budget_state(row), row->reason);
        }
    }
}

/// Writes what the mark at a sum means: below the table of errors, to which it belongs.
static void put_notes(hn_strbuf *b, const hn_budgets *a) {
    for (int m = 0; m < hn_budgets_n(a); m++) {
        const hn_budget_row *row = hn_budgets_at(a, m);
        char note[HN_BUDGET_NOTE];
        hn_budget_note(hn_budgets_model(a), row, note);
        if (note[0]) {
            hn_strbuf_printf(b, "  * %s: %s\n", row->spelling, note);
        }
    }
}

static void put_legend(hn_strbuf *b) {
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_cause_words((hn_cause)i)->name,
                         hn_cause_words((hn_cause)i)->about);
    }
    for (int i = HN_ENERGY_LOOPS; i < HN_ENERGY_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_energy_item_words((hn_energy_item)i)->name,
                         hn_energy_item_words((hn_energy_item)i)->about);
    }
    hn_strbuf_add(
        b, "  Some integrators solve the constraint equations themselves, as in ggl@radau5: there "
           "truncation is the error of formulation and integrator together. \"-\": not known.\n");
}

void hn_budgets_text(hn_strbuf *b, const hn_budgets *a) {
    const hn_scene *scene = hn_model_scene(hn_budgets_model(a));
    hn_strbuf_printf(b, "%s, to t = %g s\n\nWhere the error at the end comes from\n",
                     scene->title ? scene->title : scene->id, hn_budgets_time(a));
    put_sheet(b, a, 0);
    put_notes(b, a);
    hn_strbuf_add(b, "\nEnergy put in (+) or taken out (-), in J\n");
    put_sheet(b, a, 1);
    put_reasons(b, a);
    put_legend(b);
}

/// The parts of one error, each against the largest of them; a sentence where they do not add up.
static void put_bars(hn_strbuf *b, const sheet *s, int i) {
    hn_strbuf_printf(b, "\n%s: %.3g %s\n", s->rows[i]->spelling, whole_of(s, i), unit_of(s, i));
    if (!s->energy && !hn_budget_holds(s->rows[i])) {
        char note[HN_BUDGET_NOTE];
        hn_budget_note(hn_budgets_model(s->budgets), s->rows[i], note);
        hn_strbuf_printf(b, "  %s\n", note);
        return;
    }

    // the largest part has the longest bar
    hn_bar bars[HN_CAUSE_COUNT + HN_ENERGY_COUNT];
    double most = 0;
    for (int k = 0; k < s->n_parts; k++) {
        most = fmax(most, fabs(hn_budget_part(s->rows[i], s->energy, k)));
    }
    for (int k = 0; k < s->n_parts; k++) {
        const double part = hn_budget_part(s->rows[i], s->energy, k);
        bars[k].share = most > 0 ? part / most : (double)NAN;
        bars[k].colour = hn_look_slot(i);
        snprintf(bars[k].label, sizeof bars[k].label, "%s", name_of(s, k));
        if (isnan(part)) {
            snprintf(bars[k].value, sizeof bars[k].value, "not known");
        } else {
            snprintf(bars[k].value, sizeof bars[k].value, part == 0 ? "%.0f %s" : "%+.2e %s", part,
                     unit_of(s, i));
        }
    }
    hn_bars_text(b, bars, s->n_parts, hn_terminal_columns(), hn_terminal_colours());
}

void hn_budgets_bars_text(hn_strbuf *b, const hn_budgets *a) {
    for (int energy = 0; energy < 2; energy++) {
        const sheet s = gather(a, energy);
        hn_strbuf_add(b, energy ? "\nEnergy put in (+) or taken out (-)\n"
                                : "Where the error at the end comes from\n");
        for (int i = 0; i < s.n; i++) {
            put_bars(b, &s, i);
        }
    }
    put_reasons(b, a);
}
