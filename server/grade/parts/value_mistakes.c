// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_mistakes.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdio.h>

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

/// Factors between the answer and the reference that everyone gets wrong; `again`: as a second
/// mistake beside another.
static const struct factor_row {
    const char *id, *says, *again;
    double factor, share;
    int numbers; ///< of numbers alone
} FACTORS[] = {
    {"sign", "the sign is wrong", "the sign is wrong as well", -1, 0.5, 0},
    {"half", "half of the right value: a factor 2 is missing", "a factor 2 is missing as well", 0.5,
     0.25, 0},
    {"double", "twice the right value: a factor 1/2 is missing", "a factor 1/2 is missing as well",
     2, 0.25, 0},
    {"degrees", "this looks like degrees; radians are asked for",
     "this looks like degrees as well; radians are asked for", 57.29577951308232, 0.5, 0},
    {"radians", "the angle was turned into radians twice",
     "the angle was turned into radians twice as well", 0.017453292519943295, 0.5, 0},
    {"milli", "a factor of 1000: check the unit", "a factor of 1000 as well: check the unit", 1000,
     0.5, 1},
    {"kilo", "a factor of 1/1000: check the unit", "a factor of 1/1000 as well: check the unit",
     0.001, 0.5, 1},
    {"gravity", "the acceleration of gravity is missing",
     "the acceleration of gravity is missing as well", 1 / 9.81, 0.25, 1},
};
enum { N_FACTORS = sizeof FACTORS / sizeof *FACTORS };

/// A mistake that the exercise lists: its values, and whether they are wrong for entry k.
static hn_status read_fault(hn_value_sheet *s, int k, const cJSON *fault, hn_values *wrong,
                            bool *differs) {
    *wrong = (hn_values){0};
    HN_TRY(
        hn_value_read(s, cJSON_GetObjectItemCaseSensitive(fault, "answer"), &s->reference, wrong));
    *differs = !hn_value_is_right(s, k, wrong->x[k]);
    return HN_OK;
}

/// A listed mistake, alone, or together with a factor.
static hn_status find_listed(hn_value_sheet *s, int k, const double *given, bool pairs,
                             hn_part_result *r, int *found) {
    const cJSON *fault;
    for (int i = 0; (fault = hn_part_fault_at(s->p, i)) != NULL && !*found; i++) {
        hn_values wrong;
        bool differs;
        HN_TRY(read_fault(s, k, fault, &wrong, &differs));
        const double share = hn_part_number(fault, "share", 0);
        if (!pairs && differs && agrees(s, k, given, wrong.x[k], 1)) {
            hn_part_wrong(r, hn_part_text(fault, "id"), share, "%s", hn_part_text(fault, "says"));
            *found = 1;
        }
        for (int f = 0; f < N_FACTORS && pairs && differs && !*found; f++) {
            if ((!FACTORS[f].numbers || !s->symbolic) &&
                agrees(s, k, given, wrong.x[k], FACTORS[f].factor)) {
                hn_part_wrong(r, hn_part_text(fault, "id"), share * FACTORS[f].share, "%s; and %s",
                              hn_part_text(fault, "says"), FACTORS[f].again);
                *found = 1;
            }
        }
    }
    return HN_OK;
}

/// Two listed mistakes at once, when they change different terms or different factors: the answer
/// is a + b - reference, or a b / reference.
static hn_status find_two_listed(hn_value_sheet *s, int k, const double *given, hn_part_result *r,
                                 int *found) {
    const cJSON *first, *second;
    const double *x = s->reference.x[k];
    for (int i = 0; (first = hn_part_fault_at(s->p, i)) != NULL && !*found; i++) {
        for (int j = 0; j < i && !*found; j++) {
            hn_values a, b;
            bool differs[2];
            double sum[HN_DRAW_STATES], product[HN_DRAW_STATES];
            second = hn_part_fault_at(s->p, j);
            HN_TRY(read_fault(s, k, first, &a, &differs[0]));
            HN_TRY(read_fault(s, k, second, &b, &differs[1]));
            for (int n = 0; n < s->draw->n_states; n++) {
                sum[n] = a.x[k][n] + b.x[k][n] - x[n];
                product[n] = a.x[k][n] * b.x[k][n] / x[n];
            }
            if (differs[0] && differs[1] &&
                (agrees(s, k, given, sum, 1) || agrees(s, k, given, product, 1))) {
                hn_part_wrong(r, hn_part_text(second, "id"),
                              hn_part_number(first, "share", 0) *
                                  hn_part_number(second, "share", 0),
                              "two mistakes at once: %s; and %s", hn_part_text(second, "says"),
                              hn_part_text(first, "says"));
                *found = 1;
            }
        }
    }
    return HN_OK;
}

static int find_factor(const hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    for (int i = 0; i < N_FACTORS; i++) {
        if ((!FACTORS[i].numbers || !s->symbolic) &&
            agrees(s, k, given, s->reference.x[k], FACTORS[i].factor)) {
            hn_part_wrong(r, FACTORS[i].id, FACTORS[i].share, "%s", FACTORS[i].says);
            return 1;
        }
    }
    return 0;
}

/// The reference with some names replaced by a + b * itself: 1 when the answer has these values, -1
/// when it has them with the other sign, else 0.
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
    return agrees(s, k, given, x, 1) ? 1 : agrees(s, k, given, x, -1) ? -1 : 0;
}

/// Writes a mistake found with its own sign or with the other one.
static int write_signed(hn_part_result *r, int sign, const char *id, double share,
                        const char *says) {
    if (sign != 0) {
        hn_part_wrong(r, id, sign < 0 ? share / 2 : share, "%s%s", says,
                      sign < 0 ? "; and the sign is wrong as well" : "");
    }
    return sign != 0;
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
    const int degrees = has_replaced(s, k, given, names, n, 0, 57.29577951308232);
    const int radians = has_replaced(s, k, given, names, n, 0, 0.017453292519943295);
    if (write_signed(r, degrees ? degrees : radians, "degrees", 0.5,
                     "sine and cosine were taken of degrees")) {
        return 1;
    }
    if (has_replaced(s, k, given, names, n, 1.5707963267948966, -1)) {
        hn_part_wrong(r, "sine", 0.25, "sine and cosine are exchanged");
        return 1;
    }
    return 0;
}

/// What may have become of one name: left out as a factor, its terms left out, or turned round.
static int find_name(hn_value_sheet *s, int k, const double *given, int name, hn_part_result *r) {
    char says[80];
    snprintf(says, sizeof says, "the factor %.40s is missing", s->draw->name[name]);
    if (write_signed(r, has_replaced(s, k, given, &name, 1, 1, 0), "missing-name", 0.25, says)) {
        return 1;
    }
    snprintf(says, sizeof says, "the terms with %.40s are missing", s->draw->name[name]);
    if (write_signed(r, has_replaced(s, k, given, &name, 1, 0, 0), "missing-term", 0.25, says)) {
        return 1;
    }
    if (has_replaced(s, k, given, &name, 1, 0, -1)) {
        hn_part_wrong(r, "sign-term", 0.5, "the terms with %s have the wrong sign",
                      s->draw->name[name]);
        return 1;
    }
    return 0;
}

/// One name, or two factors at once: formulas alone, for a number tells too little.
static int find_names(hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    int used[HN_DRAW_NAMES], n = 0;
    for (int i = 0; i < s->draw->n_names && s->symbolic; i++) {
        if (hn_depends_on(s->draw->graph, s->reference.e[k], i)) {
            used[n++] = i;
        }
    }
    for (int i = 0; i < n; i++) {
        if (find_name(s, k, given, used[i], r)) {
            return 1;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            char says[120];
            const int both[2] = {used[j], used[i]};
            snprintf(says, sizeof says, "the factors %.40s and %.40s are missing",
                     s->draw->name[both[0]], s->draw->name[both[1]]);
            if (write_signed(r, has_replaced(s, k, given, both, 2, 1, 0), "missing-name", 0.1,
                             says)) {
                return 1;
            }
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

/// Lowest and highest value of the states.
static void find_range(const double *x, int n, double *low, double *high) {
    *low = *high = x[0];
    for (int i = 1; i < n; i++) {
        *low = fmin(*low, x[i]);
        *high = fmax(*high, x[i]);
    }
}

/// 0 in every state where the right value is not; rounding is far below 1e-12 of the size.
static bool is_zero(const hn_value_sheet *s, int k, const double *given) {
    double low, high, lowest, highest;
    find_range(given, s->draw->n_states, &low, &high);
    find_range(s->reference.x[k], s->draw->n_states, &lowest, &highest);
    return fmax(fabs(low), fabs(high)) <= 1e-12 * fmax(fabs(lowest), fabs(highest));
}

/// An answer that is 0, or a formula that is the same in every state where the right one is not: it
/// has missed the question, and what may be missing in it would be a guess.
static bool find_constant(const hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    double low, high, lowest, highest;
    if (is_zero(s, k, given)) {
        hn_part_wrong(r, "zero", 0, "this is 0; the right answer is not");
        return true;
    }
    find_range(given, s->draw->n_states, &low, &high);
    find_range(s->reference.x[k], s->draw->n_states, &lowest, &highest);
    const bool same = high - low <= 1e-12 * fmax(fabs(low), fabs(high));
    if (s->symbolic && same && highest - lowest > s->allowed[k]) {
        hn_part_wrong(r, "constant", 0,
                      "this has the same value whatever its names are; the right answer has not");
        return true;
    }
    return false;
}

hn_status hn_value_explain(hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    int found = 0;
    if (!isfinite(given[0])) {
        hn_part_wrong(r, "not-finite", 0, "the formula has no finite value at some states");
        return HN_OK;
    }

    // one mistake explains more than two: pairs come last
    HN_TRY(find_listed(s, k, given, false, r, &found));
    if (found && is_zero(s, k, given)) { // named, but worth nothing
        r->share = 0;
    }
    found = found || find_constant(s, k, given, r) || find_factor(s, k, given, r) ||
            find_angles(s, k, given, r) || find_names(s, k, given, r) || find_entry(s, k, given, r);
    if (!found) {
        HN_TRY(find_listed(s, k, given, true, r, &found));
    }
    if (!found) {
        HN_TRY(find_two_listed(s, k, given, r, &found));
    }
    if (!found) {
        hn_part_wrong(r, "other", 0, "no known mistake gives this");
    }
    return hn_graph_failed(s->draw->graph) ? HN_ERR_MEMORY : HN_OK;
}
