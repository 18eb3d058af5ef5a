// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/exam_changes.h"

#include "dynamics/compile/compile.h"
#include "expr/diff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREE = 0.017453292519943295; // [rad]

typedef struct list {
    const hn_export_exam *exam;
    hn_export_part part;
    int i;
    hn_exam_change *out;
    int n, most;
} list;

static hn_graph *graph_of(const hn_export_exam *exam) {
    return hn_system_graph(exam->e.sys);
}

static hn_ex entry_of(const hn_export_exam *exam, hn_export_part part, int i) {
    return hn_export_exam_entry(exam, part)[i];
}

static bool has(const list *l, int symbol) {
    return hn_depends_on(graph_of(l->exam), entry_of(l->exam, l->part, l->i), symbol);
}

static void add(list *l, hn_exam_change_kind kind, int from, int to) {
    if (l->n < l->most) {
        l->out[l->n++] = (hn_exam_change){.kind = kind, .from = from, .to = to};
    }
}

bool hn_exam_is_plain(const hn_export_exam *exam) {
    return exam->nq == exam->nv && exam->e.info.n_user == exam->nq;
}

static hn_unit_kind kind_of(const hn_export_exam *exam, int i) {
    const int at = hn_system_user_coordinate(exam->e.sys, i);
    return hn_model_scene(exam->e.model)->coordinates[at].kind;
}

bool hn_exam_is_angle(const hn_export_exam *exam, int i) {
    return kind_of(exam, i) == HN_ANGLE;
}

/// One coordinate or velocity in place of another of its kind.
static void add_names(list *l, const int *symbols, bool are_velocities) {
    for (int a = 0; a < l->exam->nv; a++) {
        if (!has(l, symbols[a])) {
            continue;
        }
        for (int b = 0; b < l->exam->nv; b++) {
            if (b != a && kind_of(l->exam, b) == kind_of(l->exam, a)) {
                add(l, HN_CHANGE_NAME, symbols[a], symbols[b]);
                if (are_velocities) {
                    add(l, HN_CHANGE_ONE, symbols[a], symbols[b]);
                }
            }
        }
        if (are_velocities) {
            add(l, HN_CHANGE_POWER, symbols[a], symbols[a]);
        }
    }
}

static void add_angles(list *l) {
    bool any = false;
    for (int a = 0; a < l->exam->nq; a++) {
        const int symbol = l->exam->e.x.q_symbols[a];
        if (kind_of(l->exam, a) == HN_ANGLE && has(l, symbol)) {
            add(l, HN_CHANGE_QUARTER, symbol, symbol);
            any = true;
        }
    }
    if (any) {
        add(l, HN_CHANGE_DEGREES, -1, -1);
        add(l, HN_CHANGE_RADIANS, -1, -1);
    }
}

/// An angle counted from another one, or with another one in it: with their rates, and alone.
static void add_origins(list *l) {
    static const hn_exam_change_kind kinds[] = {HN_CHANGE_SUM, HN_CHANGE_DIFFERENCE};
    const int *q = l->exam->e.x.q_symbols, *v = l->exam->e.x.v_symbols;
    for (int a = 0; a < l->exam->nq; a++) {
        const bool counts = hn_exam_is_angle(l->exam, a) && (has(l, q[a]) || has(l, v[a]));
        for (int b = 0; b < l->exam->nq && counts; b++) {
            for (int k = 0; k < 4 && b != a && hn_exam_is_angle(l->exam, b); k++) {
                const int n = l->n;
                add(l, kinds[k % 2], q[a], q[b]);
                if (l->n > n) {
                    l->out[n].rates = k < 2;
                }
            }
        }
    }
}

/// Parameters of forces alone, as g, a stiffness or a torque.
static void add_missing(list *l) {
    const hn_scene *scene = hn_model_scene(l->exam->e.model);
    for (int p = 0; p < scene->n_params; p++) {
        const int symbol = hn_graph_find_symbol(graph_of(l->exam), scene->params[p].name);
        if (symbol < 0 || l->part != HN_EXPORT_FORCE || !has(l, symbol)) {
            continue;
        }
        bool in_mass = false;
        for (int k = 0; k < l->exam->size[HN_EXPORT_MASS] && !in_mass; k++) {
            in_mass =
                hn_depends_on(graph_of(l->exam), entry_of(l->exam, HN_EXPORT_MASS, k), symbol);
        }
        if (!in_mass) {
            add(l, HN_CHANGE_WITHOUT, symbol, symbol);
        }
    }
}

int hn_exam_changes_list(const hn_export_exam *exam, hn_export_part part, int i,
                         hn_exam_change *out, int most) {
    list l = {exam, part, i, out, 0, most};
    add_missing(&l);
    if (hn_exam_is_plain(exam)) {
        add_angles(&l);
        add_names(&l, exam->e.x.q_symbols, false);
        add_names(&l, exam->e.x.v_symbols, true);
        add_origins(&l);
    }
    return l.n;
}

/// Adds `sign` times another angle to an angle, and its rate to the rate where both are changed.
static void add_angle(const hn_export_exam *exam, const hn_exam_change *c, double sign, double *x) {
    const int *q = exam->e.x.q_symbols, *v = exam->e.x.v_symbols;
    int a = 0, b = 0;
    for (int i = 0; i < exam->nq; i++) {
        a = q[i] == c->from ? i : a;
        b = q[i] == c->to ? i : b;
    }
    x[q[a]] += sign * x[q[b]];
    x[v[a]] += c->rates ? sign * x[v[b]] : 0;
}

/// Changes the values of the symbols at a state.
static void change_symbols(const hn_export_exam *exam, const hn_exam_change *c, double *x) {
    switch (c->kind) {
    case HN_CHANGE_NAME:
        x[c->from] = x[c->to];
        break;
    case HN_CHANGE_SUM:
    case HN_CHANGE_DIFFERENCE:
        add_angle(exam, c, c->kind == HN_CHANGE_SUM ? 1 : -1, x);
        break;
    case HN_CHANGE_QUARTER:
        x[c->from] += 90 * DEGREE;
        break;
    case HN_CHANGE_WITHOUT:
        x[c->from] = 0;
        break;
    case HN_CHANGE_DEGREES:
    case HN_CHANGE_RADIANS:
        for (int a = 0; a < exam->nq; a++) {
            const bool is_angle = kind_of(exam, a) == HN_ANGLE;
            const double unit = c->kind == HN_CHANGE_DEGREES ? 1 / DEGREE : DEGREE;
            x[exam->e.x.q_symbols[a]] *= is_angle ? unit : 1;
        }
        break;
    case HN_CHANGE_ONE:
    case HN_CHANGE_POWER:
        break; // a factor of the terms
    }
}

/// Returns what a change multiplies a term by at the values x.
static double factor_of(const hn_exam_change *c, const double *x) {
    return c->kind == HN_CHANGE_ONE     ? x[c->to] / x[c->from]
           : c->kind == HN_CHANGE_POWER ? 1 / x[c->from]
                                        : 1;
}

hn_status hn_exam_change_apply(const hn_export_exam *exam, hn_export_part part, int i,
                               const hn_exam_change *change, double whole[HN_EXPORT_EXAM_STATES],
                               hn_export_sum *terms) {
    hn_graph *g = graph_of(exam);
    const hn_ex entry = entry_of(exam, part, i);
    const int symbol = change->from;
    const bool is_factor = change->kind == HN_CHANGE_ONE || change->kind == HN_CHANGE_POWER;
    double *x = malloc(((size_t)hn_graph_n_symbols(g) + 1) * sizeof *x);
    if (!x) {
        return HN_ERR_MEMORY;
    }
    memset(x, 0, ((size_t)hn_graph_n_symbols(g) + 1) * sizeof *x);
    *terms = exam->sum[part][i];
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        hn_export_exam_symbols(exam, k, x);
        const double factor = factor_of(change, x);
        change_symbols(exam, change, x);
        whole[k] = factor * hn_graph_eval(g, entry, x);
        for (int m = 0; m < terms->n; m++) {
            const bool counts = !is_factor || hn_depends_on(g, terms->term[m], symbol);
            terms->t[m][k] = (counts ? factor : 1) * hn_graph_eval(g, terms->term[m], x);
        }
    }
    free(x);
    return hn_graph_failed(g) ? HN_ERR_MEMORY : HN_OK;
}

const char *hn_exam_symbol_name(const hn_export_exam *exam, int symbol) {
    return hn_graph_symbol_name(graph_of(exam), symbol);
}
