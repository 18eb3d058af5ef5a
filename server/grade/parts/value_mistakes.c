// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_mistakes.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>

/// 1 when the values are those of `x`, times a factor, at all states.
static int agrees(const hn_value_sheet *s, int k, const double *given, const double *x,
                  double factor) {
    double worst = 0, size = 0;
    for (int i = 0; i < s->draw->n_states; i++) {
        const double difference = fabs(given[i] - factor * x[i]);
        if (!isfinite(difference)) {
            return 0;
        }
        worst = fmax(worst, difference);
        size = fmax(size, fabs(factor * x[i]));
    }
    // a mistake is told as finely as a right answer, relative to its own size
    const double own = fmax(fabs(s->reference.x[k][0]), 1e-300);
    const double scaled =
        s->symbolic ? s->allowed[k] + 1e-6 * size : s->allowed[k] * fmax(size, 1e-300) / own;
    return worst <= scaled;
}

/// A mistake that the exercise lists, alone or together with a sign.
static hn_status find_listed(hn_value_sheet *s, int k, const double *given, hn_part_result *r,
                             int *found) {
    const cJSON *fault;
    for (int both = 0; both < 2 && !*found; both++) {
        for (int i = 0; (fault = hn_part_fault_at(s->p, i)) != NULL && !*found; i++) {
            hn_values wrong = {0};
            HN_TRY(hn_value_read(s, cJSON_GetObjectItemCaseSensitive(fault, "answer"),
                                 &s->reference, &wrong));
            if (!hn_value_is_right(s, k, wrong.x[k]) &&
                agrees(s, k, given, wrong.x[k], both ? -1 : 1)) {
                const double share = hn_part_number(fault, "share", 0);
                hn_part_wrong(r, hn_part_text(fault, "id"), both ? share / 2 : share, "%s%s",
                              hn_part_text(fault, "says"),
                              both ? "; and the sign is wrong as well" : "");
                *found = 1;
            }
        }
    }
    return HN_OK;
}

/// Factors between the answer and the reference that everyone gets wrong.
static int find_factor(const hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    static const struct {
        const char *id, *says;
        double factor, share;
        int numbers; ///< of numbers alone
    } rows[] = {
        {"sign", "the sign is wrong", -1, 0.5, 0},
        {"half", "half of the right value: a factor 2 is missing", 0.5, 0.25, 0},
        {"double", "twice the right value: a factor 1/2 is missing", 2, 0.25, 0},
        {"degrees", "this looks like degrees; radians are asked for", 57.29577951308232, 0.5, 0},
        {"radians", "the angle was turned into radians twice", 0.017453292519943295, 0.5, 0},
        {"milli", "a factor of 1000: check the unit", 1000, 0.5, 1},
        {"kilo", "a factor of 1/1000: check the unit", 0.001, 0.5, 1},
        {"gravity", "the acceleration of gravity is missing", 1 / 9.81, 0.25, 1},
    };

    // some ratios are a mistake in numbers alone
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if ((!rows[i].numbers || !s->symbolic) &&
            agrees(s, k, given, s->reference.x[k], rows[i].factor)) {
            hn_part_wrong(r, rows[i].id, rows[i].share, "%s", rows[i].says);
            return 1;
        }
    }
    return 0;
}

/// The reference with some names replaced by a + b * itself; 1 when the answer has these values.
static int has_replaced(hn_value_sheet *s, int k, const double *given, const int *names, int n,
                        double a, double b) {
    hn_graph *g = s->draw->graph;
    hn_ex with[HN_DRAW_NAMES], e = s->reference.e[k];
    double x[HN_DRAW_STATES];
    for (int i = 0; i < n; i++) {
        with[i] = hn_add(g, hn_num(a), hn_scale(b, hn_graph_symbol_expr(g, names[i])));
    }
    hn_substitute(g, &s->reference.e[k], 1, names, with, n, &e);
    for (int i = 0; i < s->draw->n_states; i++) {
        x[i] = hn_draw_eval(s->draw, e, i);
    }
    return agrees(s, k, given, x, 1) || agrees(s, k, given, x, -1);
}

/// Angles in degrees, sine for cosine.
static int find_angles(hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    int names[HN_DRAW_NAMES], n = 0;
    for (int i = 0; i < s->draw->n_names; i++) {
        if (hn_draw_is_angle(s->draw, i)) {
            names[n++] = i;
        }
    }
    if (n == 0) {
        return 0;
    }
    if (has_replaced(s, k, given, names, n, 0, 57.29577951308232) ||
        has_replaced(s, k, given, names, n, 0, 0.017453292519943295)) {
        hn_part_wrong(r, "degrees", 0.5, "sine and cosine were taken of degrees");
        return 1;
    }
    if (has_replaced(s, k, given, names, n, 1.5707963267948966, -1)) {
        hn_part_wrong(r, "sine", 0.25, "sine and cosine are exchanged");
        return 1;
    }
    return 0;
}

/// A name left out, or another in its place: formulas alone, for a number tells too little.
static int find_names(hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    // each name that the reference holds
    for (int i = 0; i < s->draw->n_names && s->symbolic; i++) {
        if (!hn_depends_on(s->draw->graph, s->reference.e[k], i)) {
            continue;
        }

        // as if it were 1, 0, or negative
        if (has_replaced(s, k, given, &i, 1, 1, 0)) {
            hn_part_wrong(r, "missing-name", 0.25, "the factor %s is missing", s->draw->name[i]);
            return 1;
        }
        if (has_replaced(s, k, given, &i, 1, 0, 0)) {
            hn_part_wrong(r, "missing-term", 0.25, "the terms with %s are missing",
                          s->draw->name[i]);
            return 1;
        }
        if (has_replaced(s, k, given, &i, 1, 0, -1)) {
            hn_part_wrong(r, "sign-term", 0.5, "the terms with %s have the wrong sign",
                          s->draw->name[i]);
            return 1;
        }
    }
    return 0;
}

/// The value of another entry.
static int find_entry(const hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    for (int j = 0; j < s->reference.n; j++) {
        if (j != k && (agrees(s, k, given, s->reference.x[j], 1) ||
                       agrees(s, k, given, s->reference.x[j], -1))) {
            hn_part_wrong(r, "other-entry", 0.25, "this is entry %d, perhaps with its sign", j + 1);
            return 1;
        }
    }
    return 0;
}

hn_status hn_value_explain(hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    int found = 0;
    if (!isfinite(given[0])) {
        hn_part_wrong(r, "not-finite", 0, "the formula has no finite value at some states");
        return HN_OK;
    }
    HN_TRY(find_listed(s, k, given, r, &found));
    if (!found && !find_factor(s, k, given, r) && !find_angles(s, k, given, r) &&
        !find_names(s, k, given, r) && !find_entry(s, k, given, r)) {
        hn_part_wrong(r, "other", 0, "no known mistake gives this");
    }
    return hn_graph_failed(s->draw->graph) ? HN_ERR_MEMORY : HN_OK;
}
