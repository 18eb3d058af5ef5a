// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/position_form.h"

#include "expr/print.h"

#include <stdbool.h>
#include <stdio.h>

enum { LONGEST_FORM = 1 << 16 }; // bytes of one unknown

const char *hn_position_name(const hn_system *sys, int coordinate) {
    const int place = hn_system_position_of(sys, coordinate);
    return place >= 0
               ? hn_graph_symbol_name(hn_system_graph(sys),
                                      hn_system_get_exprs(sys).q_symbols[place])
               : hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, coordinate)].name;
}

// making ----

/// Returns 1 if both systems have the same numbers of coordinates and constraint rows, so that the
/// chart of one is valid for the other.
static bool is_same_shape(const hn_system *a, const hn_system *b) {
    const hn_system_info x = hn_system_get_info(a), y = hn_system_get_info(b);
    return x.nq == y.nq && x.nv == y.nv && x.nc == y.nc;
}

static hn_status make_dyads(hn_position_form *f, const hn_system *sys) {
    hn_dyads_free(f->dyads);
    f->dyads = NULL;
    f->sys = sys;
    return hn_dyads_create(sys, f->chart.dep, f->chart.rank, f->arena, &f->dyads);
}

static hn_status find_form(hn_position_form *f, const hn_model *model, const hn_system *symbolic) {
    const hn_system *sys = hn_model_system(model);
    hn_status status = hn_chart_init(&f->chart, sys, 1, f->arena, NULL);
    if (status != HN_OK) {
        return status;
    }

    // independent coordinates at the start; none or no loops: no form
    f->chart.plain_only = 1;
    const double *q = hn_model_q(model);
    f->exists = hn_chart_choose(&f->chart, 0, q, HN_CHART_PREFERRED) == HN_OK &&
                hn_chart_locate(&f->chart, &f->chart.here, 0, q) == HN_OK;
    if (!f->exists || f->chart.nc == 0) {
        return HN_OK;
    }

    // parameters as symbols first; numbers where that is refused
    if (symbolic && is_same_shape(symbolic, sys)) {
        status = make_dyads(f, symbolic);
    }
    if (status == HN_OK && (!f->dyads || hn_dyads_refusal(f->dyads))) {
        status = make_dyads(f, sys);
    }

    // signs of the assembly mode at the start
    if (status == HN_OK && !hn_dyads_refusal(f->dyads)) {
        (void)hn_dyads_take_branch(f->dyads, 0, q); // sign 0: both assembly modes coincide
    }
    return status;
}

hn_status hn_position_form_create(const hn_model *model, const hn_system *symbolic,
                                  hn_position_form *out) {
    *out = (hn_position_form){.arena = hn_arena_create(0), .sys = hn_model_system(model)};
    return out->arena ? find_form(out, model, symbolic) : HN_ERR_MEMORY;
}

void hn_position_form_free(hn_position_form *f) {
    hn_dyads_free(f->dyads);
    hn_chart_destroy(&f->chart);
    hn_arena_free(f->arena);
    *f = (hn_position_form){0};
}

// writing ----

void hn_position_answer(const hn_position_form *f, char *text, size_t size) {
    const char *refusal = f->dyads ? hn_dyads_refusal(f->dyads) : NULL;
    const int n = f->dyads ? hn_dyads_proper(f->dyads) : 0;
    if (!f->exists) {
        snprintf(text, size, "none: %s", f->chart.why);
    } else if (!f->dyads) {
        snprintf(text, size, "none: there are no loops to close");
    } else if (refusal) {
        snprintf(text, size, "Newton, because %s", refusal);
    } else if (n > 0) {
        snprintf(text, size, "dyads: closed form (%d of them%s)", n,
                 hn_dyads_count(f->dyads) > n ? ", and single unknowns" : "");
    } else {
        snprintf(text, size, "closed form, one unknown after the other");
    }
}

static int n_steps(const hn_position_form *f) {
    return f->dyads && !hn_dyads_refusal(f->dyads) ? hn_dyads_count(f->dyads) : 0;
}

static void put_rows(hn_strbuf *b, const hn_position_form *f, const hn_dyad *d) {
    for (int i = 0; i < d->n; i++) {
        hn_strbuf_printf(b, "%s%s", i ? " and " : "", hn_system_row_name(f->sys, d->row[i]));
    }
}

static void put_sign_value(hn_strbuf *b, double sign) {
    hn_strbuf_add(b, sign > 0 ? "+1" : sign < 0 ? "-1" : "+1 or -1");
}

static void put_independent(hn_strbuf *b, const hn_position_form *f) {
    for (int j = 0; j < f->chart.r; j++) {
        hn_strbuf_printf(b, "%s%s", j ? ", " : "", hn_position_name(f->chart.sys, f->chart.ind[j]));
    }
}

/// Prints into a buffer of its own; dots replace an expression longer than LONGEST_FORM.
static void print_short(hn_strbuf *piece, const hn_graph *g, hn_ex e, hn_print_form form) {
    hn_strbuf_init(piece);
    hn_print(piece, g, e, form, form == HN_PRINT_LATEX ? 6 : 0);
    if (piece->failed || piece->n > LONGEST_FORM) {
        hn_strbuf_reset(piece);
        hn_strbuf_init(piece);
        hn_strbuf_add(piece, form == HN_PRINT_LATEX ? "\\ldots" : "...");
    }
}

static void add_printed(hn_strbuf *b, const hn_graph *g, hn_ex e, hn_print_form form) {
    hn_strbuf piece;
    print_short(&piece, g, e, form);
    hn_strbuf_add(b, hn_strbuf_text(&piece));
    hn_strbuf_reset(&piece);
}

static hn_ex unknown_of(const hn_position_form *f, const hn_dyad *d, int i) {
    const int place = hn_system_position_of(f->sys, d->unknown[i]);
    return hn_graph_symbol_expr(hn_system_graph(f->sys),
                                hn_system_get_exprs(f->sys).q_symbols[place]);
}

static void write_line(hn_strbuf *b, const hn_graph *g, hn_ex name, hn_ex is, hn_print_form form) {
    hn_strbuf_add(b, "  ");
    hn_print(b, g, name, form, 6);
    hn_strbuf_add(b, form == HN_PRINT_LATEX ? " &= " : " = ");
    add_printed(b, g, is, form);
    hn_strbuf_add(b, form == HN_PRINT_LATEX ? " \\\\\n" : "\n");
}

static void write_step(hn_strbuf *b, const hn_position_form *f, int k, hn_print_form form) {
    const hn_graph *g = hn_system_graph(f->sys);
    const hn_dyad d = hn_dyads_at(f->dyads, k);
    for (int i = 0; i < hn_dyads_n_parts(f->dyads, k); i++) {
        const hn_dyad_part p = hn_dyads_part(f->dyads, k, i);
        write_line(b, g, p.name, p.is, form);
    }
    for (int i = 0; i < d.n; i++) {
        write_line(b, g, unknown_of(f, &d, i), hn_dyads_expression(f->dyads, k, i), form);
    }
}

void hn_position_form_text(hn_strbuf *b, const hn_position_form *f) {
    char answer[HN_CHART_TEXT + 80];
    if (f->exists && !f->dyads) {
        return;
    }

    // independent coordinates, and how the others follow
    hn_position_answer(f, answer, sizeof answer);
    hn_strbuf_add(b, "\nq = f(q_r) (the pose from the independent coordinates)\n");
    if (f->exists) {
        hn_strbuf_add(b, "independent: ");
        put_independent(b, f);
        hn_strbuf_add(b, "\n");
    }
    hn_strbuf_printf(b, "the others: %s\n", answer);

    // one dyad or single unknown after the other
    for (int k = 0; k < n_steps(f); k++) {
        const hn_dyad d = hn_dyads_at(f->dyads, k);
        const char *sign = hn_dyads_sign_name(f->dyads, k);
        hn_strbuf_printf(b, "%s, %s, from ", hn_dyad_kind_name(d.kind), hn_dyad_kind_about(d.kind));
        put_rows(b, f, &d);
        if (sign) {
            hn_strbuf_printf(b, ", %s = ", sign);
            put_sign_value(b, hn_dyads_sign(f->dyads, k));
            hn_strbuf_add(b, " as it is assembled");
        }
        hn_strbuf_add(b, "\n");
        write_step(b, f, k, HN_PRINT_TEXT);
    }
}

void hn_position_form_latex(hn_strbuf *b, const hn_position_form *f) {
    if (n_steps(f) == 0) {
        return;
    }
    hn_strbuf_add(b, "% the pose from the independent coordinates ");
    put_independent(b, f);
    hn_strbuf_add(b, "\n\\begin{align*}\n");
    for (int k = 0; k < n_steps(f); k++) {
        write_step(b, f, k, HN_PRINT_LATEX);
    }
    hn_strbuf_add(b, "\\end{align*}\n");
}

static void put_printed(hn_strbuf *b, const char *key, const hn_graph *g, hn_ex e,
                        hn_print_form form) {
    hn_strbuf piece;
    print_short(&piece, g, e, form);
    hn_json_put_string(b, key, hn_strbuf_text(&piece));
    hn_strbuf_reset(&piece);
}

static void put_line(hn_strbuf *b, const hn_graph *g, hn_ex name, hn_ex is) {
    hn_json_object(b);
    put_printed(b, "name", g, name, HN_PRINT_TEXT);
    put_printed(b, "text", g, is, HN_PRINT_TEXT);
    put_printed(b, "name_latex", g, name, HN_PRINT_LATEX);
    put_printed(b, "latex", g, is, HN_PRINT_LATEX);
    hn_json_end_object(b);
}

static void put_lines(hn_strbuf *b, const hn_position_form *f, int k) {
    const hn_dyad d = hn_dyads_at(f->dyads, k);
    const hn_graph *g = hn_system_graph(f->sys);
    hn_json_key(b, "parts");
    hn_json_array(b);
    for (int i = 0; i < hn_dyads_n_parts(f->dyads, k); i++) {
        const hn_dyad_part p = hn_dyads_part(f->dyads, k, i);
        put_line(b, g, p.name, p.is);
    }
    hn_json_end_array(b);
    hn_json_key(b, "unknowns");
    hn_json_array(b);
    for (int i = 0; i < d.n; i++) {
        put_line(b, g, unknown_of(f, &d, i), hn_dyads_expression(f->dyads, k, i));
    }
    hn_json_end_array(b);
}

static void put_step(hn_strbuf *b, const hn_position_form *f, int k) {
    const hn_dyad d = hn_dyads_at(f->dyads, k);
    const char *sign = hn_dyads_sign_name(f->dyads, k);

    // kind of dyad, and the constraint rows it solves
    hn_json_object(b);
    hn_json_put_string(b, "kind", hn_dyad_kind_name(d.kind));
    hn_json_put_string(b, "meets", hn_dyad_kind_about(d.kind));
    hn_json_key(b, "rows");
    hn_json_array(b);
    for (int i = 0; i < d.n; i++) {
        hn_json_string(b, hn_system_row_name(f->sys, d.row[i]));
    }
    hn_json_end_array(b);

    // sign of the root that the assembly mode takes
    if (sign) {
        hn_json_key(b, "sign");
        hn_json_object(b);
        hn_json_put_string(b, "name", sign);
        hn_json_put_int(b, "value", (long long)hn_dyads_sign(f->dyads, k));
        hn_json_end_object(b);
    }
    put_lines(b, f, k);
    hn_json_end_object(b);
}

void hn_position_form_json(hn_strbuf *b, const hn_position_form *f) {
    char answer[HN_CHART_TEXT + 80];
    hn_position_answer(f, answer, sizeof answer);
    hn_json_key(b, "position");
    hn_json_object(b);
    hn_json_key(b, "independent");
    hn_json_array(b);
    for (int j = 0; f->exists && j < f->chart.r; j++) {
        hn_json_string(b, hn_position_name(f->chart.sys, f->chart.ind[j]));
    }
    hn_json_end_array(b);
    hn_json_put_string(b, "answers", answer);
    hn_json_key(b, "steps");
    hn_json_array(b);
    for (int k = 0; k < n_steps(f); k++) {
        put_step(b, f, k);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
