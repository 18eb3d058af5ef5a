// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_names.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/value_factor.h"
#include "grade/parts/value_places.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_CHANGED = 8, ///< names at once
    PROBES = 3       ///< states that a candidate must agree at before it is written as a formula
};

/// Names in place of which others stand, all at once: each with the one or two whose sum does.
typedef struct change {
    int n;
    struct changed {
        int name, put, added; ///< `added` is -1 where only one name stands there
    } at[MAX_CHANGED];
} change;

static void add_change(change *c, int name, int put, int added) {
    if (c->n < MAX_CHANGED) {
        c->at[c->n++] = (struct changed){name, put, added};
    }
}

/// The value of a formula with the change.
static double value_with(const hn_value_search *f, hn_ex e, const change *c, int state) {
    const hn_draw *d = f->sheet->draw;
    double x[HN_DRAW_NAMES];
    memcpy(x, d->value[state], sizeof x);
    for (int i = 0; i < c->n; i++) {
        const struct changed *at = &c->at[i];
        x[at->name] = d->value[state][at->put] + (at->added < 0 ? 0 : d->value[state][at->added]);
    }
    return hn_graph_eval(d->graph, e, x);
}

/// The formula with the change.
static hn_ex formula_with(const hn_value_search *f, hn_ex e, const change *c) {
    hn_graph *g = f->sheet->draw->graph;
    int names[MAX_CHANGED];
    hn_ex with[MAX_CHANGED], out = e;
    for (int i = 0; i < c->n; i++) {
        const struct changed *at = &c->at[i];
        const hn_ex put = hn_graph_symbol_expr(g, at->put);
        names[i] = at->name;
        with[i] = at->added < 0 ? put : hn_add(g, put, hn_graph_symbol_expr(g, at->added));
    }
    hn_substitute(g, &e, 1, names, with, c->n, &out);
    return out;
}

/// Returns whether two values may be those of one formula: hn_value_search_try() decides.
static bool is_near(const hn_value_search *f, double a, double b) {
    const double allowed = f->sheet->allowed[f->entry];
    return fabs(a - b) <= allowed + 1e-4 * fmax(fabs(a), fabs(b));
}

static int count_probes(const hn_value_search *f) {
    const int n = f->sheet->draw->n_states;
    return n < PROBES ? n : PROBES;
}

/// The whole reference with the change.
static void try_change(hn_value_search *f, const change *c, const char *id, const char *says) {
    const hn_ex reference = f->sheet->reference.e[f->entry];
    for (int i = 0; i < count_probes(f) && !f->note; i++) {
        if (!is_near(f, f->given[i], value_with(f, reference, c, i))) {
            return;
        }
    }
    hn_value_search_try(f, formula_with(f, reference, c), 1, id, 0.25, "%s", says);
}

/// The names that the reference uses. Returns how many.
static int list_used(const hn_value_search *f, int used[HN_DRAW_NAMES]) {
    const hn_draw *d = f->sheet->draw;
    int n = 0;
    for (int i = 0; i < d->n_names; i++) {
        if (hn_depends_on(d->graph, f->sheet->reference.e[f->entry], i)) {
            used[n++] = i;
        }
    }
    return n;
}

// ---- relative angles ----

/// The number at the end of a name, and the length of what stands before it; 0: none.
static int index_of(const char *name, size_t *stem) {
    *stem = strlen(name);
    while (*stem > 0 && strchr("0123456789", name[*stem - 1])) {
        --*stem;
    }
    return atoi(name + *stem);
}

/// The name of the same kind with the index before: th1 of th2; -1: none.
static int name_before(const hn_draw *d, int name) {
    size_t stem, other;
    const int index = index_of(d->name[name], &stem);
    for (int i = 0; i < d->n_names && index > 1; i++) {
        if (index_of(d->name[i], &other) == index - 1 && other == stem &&
            strncmp(d->name[i], d->name[name], stem) == 0) {
            return i;
        }
    }
    return -1;
}

/// Returns whether the name is that of a rate, as u2 and w2 are.
static bool is_rate(const char *name, size_t stem) {
    return stem == 1 && (name[0] == 'u' || name[0] == 'w');
}

/// The angle with this index as one from the link before, its rate too where `rates`.
static change make_relative(const hn_draw *d, const int *used, int n, int index, bool rates) {
    change c = {0};
    for (int i = 0; i < n; i++) {
        size_t stem;
        const int before = name_before(d, used[i]);
        const bool same = index_of(d->name[used[i]], &stem) == index && before >= 0;
        const bool turns = hn_draw_is_angle(d, used[i]);
        if (same && (turns || (rates && is_rate(d->name[used[i]], stem)))) {
            add_change(&c, used[i], used[i], before);
        }
    }
    return c;
}

/// Does something with a change; `says` is its sentence.
typedef void change_visit(hn_value_search *f, const change *c, const char *id, const char *says,
                          const void *user);

/// Calls `visit` for each angle that may be taken from the link before.
static void each_relative(hn_value_search *f, const int *used, int n, const char *where,
                          const void *user, change_visit *visit) {
    const hn_draw *d = f->sheet->draw;
    for (int i = 0; i < n; i++) {
        size_t stem;
        const int index = index_of(d->name[used[i]], &stem);
        for (int rates = 0; rates < 2; rates++) {
            const change c = make_relative(d, used, n, index, rates);
            char says[160];
            snprintf(says, sizeof says,
                     "angle %d is taken from link %d%s; the angles of the question are absolute",
                     index, index - 1, where);
            if (c.n > 0) {
                visit(f, &c, "relative-angle", says, user);
            }
        }
    }
}

static void try_everywhere(hn_value_search *f, const change *c, const char *id, const char *says,
                           const void *user) {
    (void)user;
    try_change(f, c, id, says);
}

void hn_value_names_try_relative(hn_value_search *f) {
    int used[HN_DRAW_NAMES];
    const int n = f->sheet->symbolic ? list_used(f, used) : 0;
    each_relative(f, used, n, "", NULL, try_everywhere);
}

// ---- one name in place of another ----

static bool has_same_unit(const hn_draw *d, int a, int b) {
    return strcmp(d->unit[a], d->unit[b]) == 0;
}

/// A name that may stand where `name` belongs.
static bool may_replace(const hn_draw *d, int put, int name) {
    return put != name && d->origin[put] != HN_DRAW_FIXED && has_same_unit(d, put, name);
}

static void try_exchanged(hn_value_search *f, const int *used, int n) {
    const hn_draw *d = f->sheet->draw;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            char says[120];
            change c = {0};
            add_change(&c, used[i], used[j], -1);
            add_change(&c, used[j], used[i], -1);
            snprintf(says, sizeof says, "%.40s and %.40s are exchanged", d->name[used[j]],
                     d->name[used[i]]);
            if (has_same_unit(d, used[i], used[j])) {
                try_change(f, &c, "exchanged-names", says);
            }
        }
    }
}

/// Calls `visit` for each name that may stand where a used one belongs.
static void each_other_name(hn_value_search *f, const int *used, int n, const char *where,
                            const void *user, change_visit *visit) {
    const hn_draw *d = f->sheet->draw;
    for (int i = 0; i < n; i++) {
        for (int put = 0; put < d->n_names; put++) {
            char says[120];
            change c = {0};
            add_change(&c, used[i], put, -1);
            snprintf(says, sizeof says, "%.40s stands where %.40s belongs%s", d->name[put],
                     d->name[used[i]], where);
            if (may_replace(d, put, used[i])) {
                visit(f, &c, "other-name", says, user);
            }
        }
    }
}

// ---- one term of a sum ----

/// A term, and by which factor it must be multiplied at each state to give the answer.
typedef struct term {
    int32_t node;
    int arg;
    hn_ex put; ///< what stands in its place
    double factor[HN_DRAW_STATES];
} term;

static hn_ex write_term(hn_graph *g, hn_op op, hn_ex *a, int n, double *c, const void *user) {
    const term *t = user;
    (void)op;
    (void)c;
    a[t->arg] = t->put;
    return hn_sum(g, a, n);
}

static hn_ex formula_of(const hn_value_search *f, const term *t) {
    return hn_value_rewrite(f->sheet->draw->graph, f->sheet->reference.e[f->entry], t->node, 0,
                            write_term, t);
}

/// Finds the factors of a term. False where it has none, as where the term is 0.
static bool find_factors(const hn_value_search *f, term *t) {
    const hn_value_sheet *s = f->sheet;
    const double *reference = s->reference.x[f->entry];
    t->put = hn_num(0);
    double rest[HN_DRAW_STATES];
    hn_draw_eval_all(s->draw, formula_of(f, t), rest);
    for (int i = 0; i < s->draw->n_states; i++) {
        t->factor[i] = (f->given[i] - rest[i]) / (reference[i] - rest[i]);
        if (!isfinite(t->factor[i])) {
            return false;
        }
    }
    return true;
}

static void try_factor_of(hn_value_search *f, term *t, hn_ex argument) {
    char text[40];
    const int n = f->sheet->draw->n_states;
    if (hn_value_factor_is_constant(t->factor, n)) {
        t->put = hn_scale(hn_value_factor_name(t->factor, n, text, sizeof text, NULL), argument);
        hn_value_search_try(f, formula_of(f, t), 1, "wrong-factor", 0.25,
                            "one term is %s times as large as it must be", text);
    }
}

/// A term in which names are changed.
typedef struct term_visit {
    term *t;
    hn_ex argument;
} term_visit;

static void try_in_term(hn_value_search *f, const change *c, const char *id, const char *says,
                        const void *user) {
    const term_visit *v = user;
    for (int i = 0; i < count_probes(f) && !f->note; i++) {
        const double right = hn_draw_eval(f->sheet->draw, v->argument, i);
        const double wrong = value_with(f, v->argument, c, i);
        if (!is_near(f, right * v->t->factor[i], wrong)) {
            return;
        }
    }
    v->t->put = formula_with(f, v->argument, c);
    hn_value_search_try(f, formula_of(f, v->t), 1, id, 0.25, "%s", says);
}

static void try_terms(hn_value_search *f, const int *used, int n) {
    hn_value_places list;
    const hn_graph *g = f->sheet->draw->graph;
    hn_value_places_find(&list, g, f->sheet->reference.e[f->entry]);
    for (int i = 0; i < list.n && list.whole; i++) {
        const hn_node_view view = hn_graph_node(g, list.node[i]);
        for (int k = 0; k < view.n_args && view.op == HN_OP_SUM; k++) {
            // the view's arguments may move when the graph grows
            term t = {.node = list.node[i], .arg = k};
            const term_visit v = {&t, hn_graph_node(g, list.node[i]).args[k]};
            if (find_factors(f, &t)) {
                try_factor_of(f, &t, v.argument);
                each_relative(f, used, n, " in one term", &v, try_in_term);
                each_other_name(f, used, n, " in one term", &v, try_in_term);
            }
        }
    }
}

/// The whole formula with another constant factor.
static void try_whole_factor(hn_value_search *f) {
    const hn_value_sheet *s = f->sheet;
    const int n = s->draw->n_states;
    double factor[HN_DRAW_STATES] = {0};
    for (int i = 0; i < n; i++) {
        factor[i] = f->given[i] / s->reference.x[f->entry][i];
        if (!isfinite(factor[i])) {
            return;
        }
    }
    if (hn_value_factor_is_constant(factor, n)) {
        char text[40];
        const double named = hn_value_factor_name(factor, n, text, sizeof text, NULL);
        hn_value_search_try(f, s->reference.e[f->entry], named, "wrong-factor", 0.25,
                            "this is %s times the right formula: a number in it is wrong", text);
    }
}

void hn_value_names_try(hn_value_search *f) {
    int used[HN_DRAW_NAMES];
    if (!f->sheet->symbolic) {
        return;
    }
    const int n = list_used(f, used);
    try_exchanged(f, used, n);
    each_other_name(f, used, n, "", NULL, try_everywhere);
    if (f->n_found == 0) {
        try_whole_factor(f);
    }
    if (f->n_found == 0) {
        try_terms(f, used, n);
    }
}
