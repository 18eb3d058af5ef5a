// SPDX-License-Identifier: GPL-3.0-or-later
// Each row makes the formulas that a wrong entry would show. The first row one of whose formulas
// agrees with the entry at every state, closed or open, names the mistake; so more special rows
// come first.
#include "grade/mistakes.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_VARIANTS = 64 };

/// Variants of a wrong entry: formulas, and for each what it refers to ("J21", "th2 for
/// th1").
typedef struct variants {
    int n;
    hn_ex e[MAX_VARIANTS];
    char by[MAX_VARIANTS][32];
} variants;

typedef struct place {
    hn_exam *exam;
    int row, column;
    hn_ex reference, given;
} place;

static void add(variants *v, hn_ex e, const char *by) {
    if (v->n < MAX_VARIANTS) {
        v->e[v->n] = e;
        snprintf(v->by[v->n++], sizeof v->by[0], "%s", by);
    }
}

static hn_ex reference_at(const place *at, int row, int column) {
    return at->exam->reference[row * at->exam->problem->n_columns + column];
}

static void entry_name(const place *at, int row, int column, char *out, size_t size) {
    snprintf(out, size, "%.8s%d%d", at->exam->problem->answer, row + 1, column + 1);
}

/// `e` with the names from..to-1 each replaced by a + b * itself.
static hn_ex replace_names(const place *at, hn_ex e, int from, int to, double a, double b) {
    hn_graph *g = at->exam->graph;
    int symbols[HN_GRADE_MAX_NAMES], n = 0;
    hn_ex with[HN_GRADE_MAX_NAMES], out = e;
    for (int i = from; i < to; i++) {
        symbols[n] = at->exam->symbol[i];
        with[n++] = hn_add(g, hn_num(a), hn_scale(b, hn_graph_symbol_expr(g, at->exam->symbol[i])));
    }
    hn_substitute(g, &e, 1, symbols, with, n, &out);
    return out;
}

/// 1 if the formula has the values of the entry at all states, within the tolerance.
static bool agrees(const place *at, hn_ex e, const double *value) {
    double worst = 0, size = 0;
    for (int s = 0; s < at->exam->n_states; s++) {
        const double x = hn_exam_value(at->exam, e, s), difference = fabs(x - value[s]);
        if (!isfinite(difference)) {
            return false;
        }
        worst = fmax(worst, difference);
        size = fmax(size, fabs(x));
    }
    return worst <= hn_exam_allowed(at->exam, size);
}

// ---- the rows ----

static void make_zero(const place *at, variants *v) {
    (void)at;
    add(v, hn_num(0), "");
}

static void make_sign(const place *at, variants *v) {
    add(v, hn_neg(at->reference), "");
}

/// Angles taken in degrees, or turned into degrees; with and without the factor that
/// differentiation brings.
static void make_degrees(const place *at, variants *v) {
    const double factor = acos(-1) / 180;
    const hn_exercise *p = at->exam->problem;
    for (int inverse = 0; inverse < 2; inverse++) {
        double k = inverse ? 1 / factor : factor;
        hn_ex e = replace_names(at, at->reference, p->n_params, p->n_names, 0, k);
        add(v, e, inverse ? "180/pi" : "pi/180");
        add(v, hn_scale(k, e), inverse ? "180/pi" : "pi/180");
    }
    add(v, hn_scale(factor, at->reference), "pi/180");
    add(v, hn_scale(1 / factor, at->reference), "180/pi");
}

/// The entry of another row of the same column.
static void make_row(const place *at, variants *v) {
    for (int i = 0; i < at->exam->problem->n_rows; i++) {
        char name[32];
        entry_name(at, i, at->column, name, sizeof name);
        if (i != at->row) {
            add(v, reference_at(at, i, at->column), name);
        }
    }
}

/// Adds those of `all` whose derivative is the right entry.
static void add_undifferentiated(const place *at, const variants *all, variants *v) {
    const hn_exercise *p = at->exam->problem;
    const double *right = at->exam->expected[at->row * p->n_columns + at->column];
    const int coordinate = at->exam->symbol[p->n_params + at->column];
    for (int i = 0; i < all->n; i++) {
        hn_ex slope;
        hn_diff(at->exam->graph, all->e[i], &coordinate, 1, &slope);
        if (agrees(at, slope, right)) {
            add(v, all->e[i], all->by[i]);
        }
    }
}

static void make_undifferentiated_row(const place *at, variants *v) {
    variants all = {.n = 0};
    make_row(at, &all);
    add_undifferentiated(at, &all, v);
}

/// sin for cos and cos for sin: every coordinate x becomes pi/2 - x.
static void make_swapped(const place *at, variants *v) {
    const hn_exercise *p = at->exam->problem;
    hn_ex e = replace_names(at, at->reference, p->n_params, p->n_names, acos(-1) / 2, -1);
    add(v, e, "");
    add(v, hn_neg(e), "");
}

static void make_undifferentiated_swap(const place *at, variants *v) {
    variants all = {.n = 0};
    make_swapped(at, &all);
    add_undifferentiated(at, &all, v);
}

static void make_column(const place *at, variants *v) {
    for (int j = 0; j < at->exam->problem->n_columns; j++) {
        char name[32];
        entry_name(at, at->row, j, name, sizeof name);
        if (j != at->column) {
            add(v, reference_at(at, at->row, j), name);
            add(v, hn_neg(reference_at(at, at->row, j)), name);
        }
    }
}

/// One parameter, or all of them, left out.
static void make_length(const place *at, variants *v) {
    const hn_exercise *p = at->exam->problem;
    for (int i = 0; i <= p->n_params; i++) {
        hn_ex e = i < p->n_params ? replace_names(at, at->reference, i, i + 1, 1, 0)
                                  : replace_names(at, at->reference, 0, p->n_params, 1, 0);
        add(v, e, i < p->n_params ? p->names[i].name : "");
        add(v, hn_neg(e), i < p->n_params ? p->names[i].name : "");
    }
}

/// One name in place of another of its kind.
static void make_variable(const place *at, variants *v) {
    const hn_exercise *p = at->exam->problem;
    hn_graph *g = at->exam->graph;
    for (int i = 0; i < p->n_names; i++) {
        if (!hn_depends_on(g, at->reference, at->exam->symbol[i])) {
            continue;
        }

        // a parameter in place of a parameter, a coordinate in place of a coordinate
        const int first = i < p->n_params ? 0 : p->n_params;
        const int end = i < p->n_params ? p->n_params : p->n_names;
        for (int k = first; k < end; k++) {
            char by[32];
            hn_ex with = hn_graph_symbol_expr(g, at->exam->symbol[k]), e = at->reference;
            hn_substitute(g, &at->reference, 1, &at->exam->symbol[i], &with, 1, &e);
            snprintf(by, sizeof by, "%.8s for %.8s", p->names[k].name, p->names[i].name);
            if (k != i) {
                add(v, e, by);
                add(v, hn_neg(e), by);
            }
        }
    }
}

static void make_phi(const place *at, variants *v) {
    add(v, at->exam->phi[at->row], "");
}

/// The derivative of the wrong thing: of the whole row by time would hold rates, so only factors
/// are left.
static void make_factor(const place *at, variants *v) {
    static const double factors[] = {2, 0.5, -2, -0.5};
    for (int i = 0; i < 4; i++) {
        add(v, hn_scale(factors[i], at->reference), "");
    }
}

static void make_number(const place *at, variants *v) {
    if (hn_is_number(at->given, NULL)) {
        add(v, at->given, "");
    }
}

static const struct {
    const char *id, *text;
    void (*make)(const place *, variants *);
} MISTAKES[] = {
    {"zero", "the entry is 0, but phi does depend on this coordinate", make_zero},
    {"number", "a number cannot be right at every state: a formula is asked for", make_number},
    {"sign", "the sign is wrong", make_sign},
    {"row",
     "this is the entry of the other row; a term that was not differentiated looks like that too",
     make_undifferentiated_row},
    {"row", "this is the entry of the other row", make_row},
    {"swapped",
     "sine and cosine are exchanged; a term that was not differentiated looks like that too",
     make_undifferentiated_swap},
    {"swapped", "sine and cosine are exchanged", make_swapped},
    {"degrees", "this looks like degrees; angles are in radians", make_degrees},
    {"length", "a length is missing", make_length},
    {"column", "this is the entry of another column, perhaps with its sign", make_column},
    {"variable", "a name stands in place of another", make_variable},
    {"undifferentiated", "this is phi itself, not its derivative", make_phi},
    {"factor", "right but for a factor", make_factor},
};

/// Not in the table, for no formula shows it: the right one with a rounded number in it.
static const hn_grade_mistake ROUNDED = {
    .id = "rounded",
    .text = "nearly right: write a number that was rounded with seven digits or more, pi by its "
            "name; if none was, a small term is wrong"};
static const double NEARLY = 5e-3; // relative to the entry's size: numbers of three digits

bool hn_grade_is_mistake(const char *id) {
    // two that are no rows of the table; transposed: of the whole matrix, found by its shape
    bool known = strcmp(id, "transposed") == 0 || strcmp(id, ROUNDED.id) == 0;
    for (size_t k = 0; k < sizeof MISTAKES / sizeof MISTAKES[0]; k++) {
        known |= strcmp(id, MISTAKES[k].id) == 0;
    }
    return known;
}

/// Second mistakes that go with any other: a factor, or coordinates that are turned into others.
static const struct second {
    const char *id, *text;
    double factor, a, b; ///< every coordinate x is a + b x
} SECONDS[] = {
    {"sign", "the sign is wrong as well", -1, 0, 1},
    {"factor", "a factor of 2 is wrong as well", 2, 0, 1},
    {"factor", "a factor of 1/2 is wrong as well", 0.5, 0, 1},
    {"swapped", "sine and cosine are exchanged as well", 1, 1.5707963267948966, -1},
    {"degrees", "this looks like degrees as well; angles are in radians", 1, 0,
     0.017453292519943295},
};

/// 1 if the formula with the second mistake has the values of the entry at all states.
static bool agrees_turned(const place *at, hn_ex e, const double *value,
                          const struct second *also) {
    double worst = 0, size = 0;
    const hn_exercise *p = at->exam->problem;
    for (int s = 0; s < at->exam->n_states; s++) {
        double state[HN_GRADE_MAX_NAMES];
        for (int i = 0; i < p->n_names; i++) {
            const double x = at->exam->state[s][i];
            state[i] = i < p->n_params ? x : also->a + also->b * x;
        }
        const double x = also->factor * hn_graph_eval(at->exam->graph, e, state);
        worst = fmax(worst, fabs(x - value[s]));
        size = fmax(size, fabs(x));
        if (!isfinite(x) || !(worst <= hn_exam_allowed(at->exam, fmax(size, fabs(value[s]))))) {
            return false;
        }
    }
    return worst <= hn_exam_allowed(at->exam, size);
}

/// Returns whether a formula names a parameter (a length), rather than coordinates alone.
static bool names_parameter(const place *at, hn_ex e) {
    for (int i = 0; i < at->exam->problem->n_params; i++) {
        if (hn_depends_on(at->exam->graph, e, at->exam->symbol[i])) {
            return true;
        }
    }
    return false;
}

static bool has_numbers_for_lengths(const place *at) {
    return names_parameter(at, at->reference) && !names_parameter(at, at->given);
}

/// Returns the mistake that no row explains. Numbers in place of the lengths are right for one
/// mechanism alone.
static hn_grade_mistake find_nothing(const place *at) {
    const bool numbers = has_numbers_for_lengths(at);
    return (hn_grade_mistake){
        .id = "other",
        .text = numbers
                    ? "no length is named here: write lengths by their names, not as numbers, for "
                      "the formula is tried with other lengths too"
                    : "wrong; the cause is none of the known mistakes: differentiate the row once "
                      "more, term by term"};
}

/// Two mistakes at once: one of the rows, and a second on top of it. If no length is named, a
/// factor may be a length that was written as a number.
static hn_grade_mistake find_pair(const place *at, const double *value) {
    static const char TWO[] = "a factor of 2 is wrong as well; if it is a length, write its name";
    static const char HALF[] =
        "a factor of 1/2 is wrong as well; if it is a length, write its name";
    const bool numbers = has_numbers_for_lengths(at);
    for (size_t k = 0; k < sizeof MISTAKES / sizeof MISTAKES[0]; k++) {
        variants v = {.n = 0};
        MISTAKES[k].make(at, &v);
        for (size_t m = 0; m < sizeof SECONDS / sizeof SECONDS[0]; m++) {
            const bool is_length = numbers && strcmp(SECONDS[m].id, "factor") == 0;
            const char *also = !is_length ? SECONDS[m].text : SECONDS[m].factor > 1 ? TWO : HALF;
            for (int i = 0; i < v.n; i++) {
                if (agrees_turned(at, v.e[i], value, &SECONDS[m])) {
                    hn_grade_mistake found = {.id = MISTAKES[k].id,
                                              .text = MISTAKES[k].text,
                                              .second = SECONDS[m].id,
                                              .also = also};
                    memcpy(found.by, v.by[i], sizeof found.by);
                    return found;
                }
            }
        }
    }
    return find_nothing(at);
}

/// Returns whether the values differ from the right ones by no more than a rounded number makes
/// them.
static bool is_nearly_right(const place *at, const double *value) {
    const int index = at->row * at->exam->problem->n_columns + at->column;
    for (int s = 0; s < at->exam->n_states; s++) {
        const double difference = fabs(value[s] - at->exam->expected[index][s]);
        if (!(difference <= NEARLY * at->exam->size[index])) {
            return false;
        }
    }
    return true;
}

hn_grade_mistake hn_grade_find_mistake(hn_exam *exam, int row, int column, hn_ex given,
                                       const double *value) {
    place at = {.exam = exam, .row = row, .column = column, .given = given};
    at.reference = reference_at(&at, row, column);

    // the first row that explains the entry
    for (size_t k = 0; k < sizeof MISTAKES / sizeof MISTAKES[0]; k++) {
        variants v = {.n = 0};
        MISTAKES[k].make(&at, &v);
        for (int i = 0; i < v.n; i++) {
            if (agrees(&at, v.e[i], value)) {
                hn_grade_mistake found = {.id = MISTAKES[k].id, .text = MISTAKES[k].text};
                memcpy(found.by, v.by[i], sizeof found.by);
                return found;
            }
        }
    }
    return is_nearly_right(&at, value) ? ROUNDED : find_pair(&at, value);
}
