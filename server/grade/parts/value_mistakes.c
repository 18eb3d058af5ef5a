// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_mistakes.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/value_names.h"
#include "grade/parts/value_pairs.h"
#include "grade/parts/value_search.h"
#include "grade/parts/value_slips.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Factors between the answer and the reference that everyone gets wrong; `again`: as a second
/// mistake beside another.
static const struct factor_row {
    const char *id, *says, *again;
    double factor, share;
    int numbers; ///< of numbers alone
    /// Numbers in units of angle; numbers that are no counts; those with gravity in their formula.
    enum { ANY, ANGLES, UNITS, WEIGHTS } of;
} FACTORS[] = {
    {"sign", "the sign is wrong", "the sign is wrong as well", -1, 0.5, 0, ANY},
    {"half", "half of the right value: a factor 2 is missing", "a factor 2 is missing as well", 0.5,
     0.25, 0, UNITS},
    {"double", "twice the right value: a factor 1/2 is missing", "a factor 1/2 is missing as well",
     2, 0.25, 0, UNITS},
    {"degrees", "this looks like degrees; radians are asked for",
     "this looks like degrees as well; radians are asked for", 57.29577951308232, 0.5, 0, ANGLES},
    {"radians", "the angle was turned into radians twice",
     "the angle was turned into radians twice as well", 0.017453292519943295, 0.5, 0, ANGLES},
    {"milli", "a factor of 1000: check the unit", "a factor of 1000 as well: check the unit", 1000,
     0.5, 1, UNITS},
    {"kilo", "a factor of 1/1000: check the unit", "a factor of 1/1000 as well: check the unit",
     0.001, 0.5, 1, UNITS},
    {"gravity", "the acceleration of gravity is missing",
     "the acceleration of gravity is missing as well", 1 / 9.81, 0.25, 0, WEIGHTS},
};
enum { N_FACTORS = sizeof FACTORS / sizeof *FACTORS };
/// Factors of units that a number without a written unit may be in: cm, their squares, micro, nano,
/// pico.
static const double UNIT_FACTORS[] = {100, 0.01, 1e4, 1e-4, 1e6, 1e-6, 1e9, 1e-9, 1e12, 1e-12};

/// Tolerance for a formula with numbers of three digits, relative to its size: what numbers
/// themselves are allowed.
static const double ROUNDED = 5e-3;
/// From here on a count is rarely one slip's by chance: a slip or two of a formula give a number of
/// this size, and a hundred numbers are as near.
static const double LARGE_COUNT = 20;

/// A mistake that the exercise lists: its values, and whether they are wrong for entry k.
static hn_status read_fault(hn_value_sheet *s, int k, const cJSON *fault, hn_values *wrong,
                            bool *differs) {
    *wrong = (hn_values){0};
    HN_TRY(
        hn_value_read(s, cJSON_GetObjectItemCaseSensitive(fault, "answer"), &s->reference, wrong));
    *differs = !hn_value_is_right(s, k, wrong->x[k]);
    return HN_OK;
}

/// Finds the next listed mistake that is wrong for the entry, from number *i on, and moves *i
/// behind it. *fault is NULL when there is none.
static hn_status find_listed(const hn_value_search *f, int *i, const cJSON **fault,
                             hn_values *wrong) {
    bool differs = false;
    while (!differs && (*fault = hn_part_fault_at(f->sheet->p, *i)) != NULL) {
        HN_TRY(read_fault(f->sheet, f->entry, *fault, wrong, &differs));
        ++*i;
    }
    return HN_OK;
}

/// A listed mistake alone.
static hn_status try_listed(hn_value_search *f) {
    const cJSON *fault;
    hn_values wrong;
    for (int i = 0;;) {
        HN_TRY(find_listed(f, &i, &fault, &wrong));
        if (!fault) {
            return HN_OK;
        }
        hn_value_search_try(f, wrong.e[f->entry], 1, hn_part_text(fault, "id"),
                            hn_part_number(fault, "share", 0), "%s", hn_part_text(fault, "says"));
    }
}

/// Returns whether the right answer may have gravity as a factor: as 9.81 in its text, or as a name
/// of that value.
static bool has_gravity(const hn_value_sheet *s, int k) {
    bool found = false;
    for (int i = 0; i < s->draw->n_names && !found; i++) {
        found = s->draw->value[0][i] == 9.81 && hn_depends_on(s->draw->graph, s->reference.e[k], i);
    }
    char *text = cJSON_PrintUnformatted(cJSON_GetObjectItemCaseSensitive(s->p->node, "answer"));
    found |= text && strstr(text, "9.81");
    cJSON_free(text);
    return found;
}

static bool applies(const hn_value_search *f, int m) {
    const hn_value_sheet *s = f->sheet;
    if (FACTORS[m].of == WEIGHTS && !has_gravity(s, f->entry)) {
        return false;
    }
    if (s->symbolic) { // radians are in its names, and a formula has no unit of its own
        return !FACTORS[m].numbers;
    }
    // half a count is another count, not the same one without a factor
    return FACTORS[m].of == ANGLES ? s->unit.power[HN_UNIT_ANGLE] != 0
           : FACTORS[m].of != ANY  ? !hn_value_is_count(s)
                                   : true;
}

/// A listed mistake together with a factor.
static hn_status try_listed_pairs(hn_value_search *f) {
    const cJSON *fault;
    hn_values wrong;
    for (int i = 0;;) {
        HN_TRY(find_listed(f, &i, &fault, &wrong));
        if (!fault) {
            f->alone = 0;
            return HN_OK;
        }
        f->alone = hn_part_number(fault, "share", 0);
        f->closeness = 1;
        for (int m = 0; m < N_FACTORS; m++) {
            if (applies(f, m)) {
                hn_value_search_try(f, wrong.e[f->entry], FACTORS[m].factor,
                                    hn_part_text(fault, "id"), f->alone * FACTORS[m].share,
                                    "%s; and %s", hn_part_text(fault, "says"), FACTORS[m].again);
            }
        }
    }
}

/// Two listed mistakes at once, when they change different terms or different factors: the answer
/// is a + b - reference, or a b / reference.
static hn_status try_two_listed(hn_value_search *f) {
    hn_value_sheet *s = f->sheet;
    hn_graph *g = s->draw->graph;
    const int k = f->entry;
    const cJSON *first, *second;
    for (int i = 0; (first = hn_part_fault_at(s->p, i)) != NULL; i++) {
        for (int j = 0; j < i; j++) {
            hn_values a, b;
            bool differs[2];
            second = hn_part_fault_at(s->p, j);
            HN_TRY(read_fault(s, k, first, &a, &differs[0]));
            HN_TRY(read_fault(s, k, second, &b, &differs[1]));
            const hn_ex both[2] = {hn_sub(g, hn_add(g, a.e[k], b.e[k]), s->reference.e[k]),
                                   hn_div(g, hn_mul(g, a.e[k], b.e[k]), s->reference.e[k])};
            const double share =
                hn_part_number(first, "share", 0) * hn_part_number(second, "share", 0);
            f->alone = hn_part_number(second, "share", 0);
            f->closeness = 1;
            for (int m = 0; m < 2 && differs[0] && differs[1]; m++) {
                hn_value_search_try(f, both[m], 1, hn_part_text(second, "id"), share,
                                    "two mistakes at once: %s; and %s",
                                    hn_part_text(second, "says"), hn_part_text(first, "says"));
            }
        }
    }
    f->alone = 0;
    return HN_OK;
}

static void try_factors(hn_value_search *f) {
    const hn_value_sheet *s = f->sheet;
    for (int i = 0; i < N_FACTORS; i++) {
        if (applies(f, i)) {
            hn_value_search_try(f, s->reference.e[f->entry], FACTORS[i].factor, FACTORS[i].id,
                                FACTORS[i].share, "%s", FACTORS[i].says);
        }
    }

    // a formula has no unit of its own, and a count has none at all
    const bool unit = !s->symbolic && !hn_value_is_count(s);
    for (size_t i = 0; unit && i < sizeof UNIT_FACTORS / sizeof *UNIT_FACTORS; i++) {
        hn_value_search_try(f, s->reference.e[f->entry], UNIT_FACTORS[i], "power-of-ten", 0.5,
                            "a factor of %g: check the unit", UNIT_FACTORS[i]);
    }
}

/// The wrong sign together with another factor, as of an angle in degrees turned the wrong way.
static void try_signed_factors(hn_value_search *f) {
    f->closeness = 1;
    for (int i = 1; i < N_FACTORS; i++) {
        f->alone = FACTORS[i].share;
        if (applies(f, i)) {
            hn_value_search_try(f, f->sheet->reference.e[f->entry], -FACTORS[i].factor,
                                FACTORS[i].id, FACTORS[i].share * FACTORS[0].share, "%s; and %s",
                                FACTORS[i].says, FACTORS[0].again);
        }
    }
    f->alone = 0;
}

/// The reference with some names replaced by a + b * itself.
static hn_ex replace_names(const hn_value_search *f, const int *names, int n, double a, double b) {
    hn_graph *g = f->sheet->draw->graph;
    const hn_ex *reference = &f->sheet->reference.e[f->entry];
    hn_ex with[HN_DRAW_NAMES], e = *reference;
    for (int i = 0; i < n; i++) {
        with[i] = hn_add(g, hn_num(a), hn_scale(b, hn_graph_symbol_expr(g, names[i])));
    }
    hn_substitute(g, reference, 1, names, with, n, &e);
    return e;
}

/// A candidate with its own sign or with the other one.
static void try_signed(hn_value_search *f, hn_ex e, const char *id, double share,
                       const char *says) {
    if (!hn_value_search_try(f, e, 1, id, share, "%s", says)) {
        f->alone = share;
        hn_value_search_try(f, e, -1, id, share / 2, "%s; and the sign is wrong as well", says);
        f->alone = 0;
    }
}

/// Returns whether a number cannot tell two candidates apart: at all states they are as near as an
/// answer may be.
static bool is_alike(const hn_value_search *f, hn_ex a, hn_ex b) {
    const hn_value_sheet *s = f->sheet;
    for (int i = 0; i < s->draw->n_states; i++) {
        const double x = hn_draw_eval(s->draw, a, i), y = hn_draw_eval(s->draw, b, i);
        const double own = fmax(fabs(s->reference.x[f->entry][i]), 1e-300);
        if (!(fabs(x - y) <= 2 * s->allowed[f->entry] * fmax(fabs(x), fabs(y)) / own)) {
            return false;
        }
    }
    return true;
}

/// Angles in degrees, sine for cosine.
static void try_angles(hn_value_search *f) {
    static const double DEGREES[] = {57.29577951308232, 0.017453292519943295};
    const hn_draw *d = f->sheet->draw;
    int names[HN_DRAW_NAMES], n = 0;
    for (int i = 0; i < d->n_names; i++) {
        if (hn_draw_is_angle(d, i)) {
            names[n++] = i;
        }
    }
    for (int i = 0; i < 2 && n > 0; i++) {
        // the cosine of a few hundredths is that of 0, so the angle may not be there at all
        const hn_ex turned = replace_names(f, names, n, 0, DEGREES[i]);
        const bool left_out = is_alike(f, turned, replace_names(f, names, n, 0, 0));
        try_signed(f, turned, "degrees", 0.5,
                   left_out ? "the angle was left out, or sine and cosine were taken of degrees"
                            : "sine and cosine were taken of degrees");
    }
    if (n > 0) {
        hn_value_search_try(f, replace_names(f, names, n, 1.5707963267948966, -1), 1, "sine", 0.25,
                            "sine and cosine are exchanged");
    }
}

/// Tries what may have become of one name: left out as a factor, its terms left out, or turned
/// round.
static void try_name(hn_value_search *f, int name) {
    char says[80];
    const char *word = f->sheet->draw->name[name];
    snprintf(says, sizeof says, "the factor %.40s is missing", word);
    try_signed(f, replace_names(f, &name, 1, 1, 0), "missing-name", 0.25, says);
    snprintf(says, sizeof says, "the terms with %.40s are missing", word);
    try_signed(f, replace_names(f, &name, 1, 0, 0), "missing-term", 0.25, says);
    hn_value_search_try(f, replace_names(f, &name, 1, 0, -1), 1, "sign-term", 0.5,
                        "the terms with %s have the wrong sign", word);
}

/// Two factors left out at once. An angle is rarely a factor: it stands in a sine.
static void try_two_names(hn_value_search *f, const int *used, int n) {
    const hn_draw *d = f->sheet->draw;
    for (int i = 0; i < n && f->n_found == 0; i++) {
        for (int j = 0; j < i; j++) {
            char says[120];
            const int both[2] = {used[j], used[i]};
            if (hn_draw_is_angle(d, both[0]) || hn_draw_is_angle(d, both[1])) {
                continue;
            }
            snprintf(says, sizeof says, "the factors %.40s and %.40s are missing", d->name[both[0]],
                     d->name[both[1]]);
            try_signed(f, replace_names(f, both, 2, 1, 0), "missing-name", 0.1, says);
        }
    }
}

/// One name, or two factors at once: formulas alone, for a number tells too little.
static void try_names(hn_value_search *f) {
    const hn_value_sheet *s = f->sheet;
    int used[HN_DRAW_NAMES], n = 0;
    for (int i = 0; i < s->draw->n_names && s->symbolic; i++) {
        if (hn_depends_on(s->draw->graph, s->reference.e[f->entry], i)) {
            used[n++] = i;
        }
    }
    for (int i = 0; i < n; i++) {
        try_name(f, used[i]);
    }
    if (!f->note) {
        try_two_names(f, used, n);
    }
}

/// The value of another entry.
static void try_entries(hn_value_search *f) {
    const hn_values *reference = &f->sheet->reference;
    for (int j = 0; j < reference->n; j++) {
        for (int sign = 1; sign >= -1 && j != f->entry; sign -= 2) {
            hn_value_search_try(f, reference->e[j], sign, "other-entry", 0.25,
                                "this is entry %d, perhaps with its sign", j + 1);
        }
    }
}

/// Lowest and highest value of the states.
static void find_range(const double *x, int n, double *low, double *high) {
    *low = *high = x[0];
    for (int i = 1; i < n; i++) {
        *low = fmin(*low, x[i]);
        *high = fmax(*high, x[i]);
    }
}

/// 0 in every state where the right value is not. Rounding is far below 1e-12 of the size of a
/// formula; a number may be small because its unit is another one.
static bool is_zero(const hn_value_sheet *s, int k, const double *given) {
    double low, high, lowest, highest;
    find_range(given, s->draw->n_states, &low, &high);
    find_range(s->reference.x[k], s->draw->n_states, &lowest, &highest);
    const double share = s->symbolic ? 1e-12 : 1e-15;
    return fmax(fabs(low), fabs(high)) <= share * fmax(fabs(lowest), fabs(highest));
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

/// A formula that agrees with the right one as well as one with numbers of three digits would.
static bool find_rounded(const hn_value_sheet *s, int k, const double *given, hn_part_result *r) {
    double worst = 0, size = 0;
    for (int i = 0; i < s->draw->n_states; i++) {
        worst = fmax(worst, fabs(given[i] - s->reference.x[k][i]));
        size = fmax(size, fabs(s->reference.x[k][i]));
    }
    if (!s->symbolic || !(worst <= ROUNDED * size)) {
        return false;
    }
    hn_part_wrong(r, "rounded", 0.5,
                  "right to %.2g %% of its size; a formula must be right to %.2g %%: write numbers "
                  "with more digits, or by their names",
                  100 * worst / size, 100 * s->allowed[k] / size);
    return true;
}

/// A count: a whole number where a whole number is right. Two mistakes together give nearly every
/// small number, so that a pair which gives this one explains nothing. A drawn whole number may be
/// off by rounding, far below 1e-9.
static bool is_count(const hn_value_sheet *s, int k, const double *given) {
    const double right = s->reference.x[k][0];
    return !s->symbolic && fabs(given[0] - round(given[0])) < 1e-9 &&
           fabs(right - round(right)) < 1e-9;
}

/// A number that is the right one rounded to two or three digits, which is not exact enough.
static bool find_rounded_number(const hn_value_sheet *s, int k, const double *given,
                                hn_part_result *r) {
    const double right = s->reference.x[k][0];
    for (int digits = 2; digits <= 3 && !s->symbolic; digits++) {
        char rounded[40];
        snprintf(rounded, sizeof rounded, "%.*g", digits, right);
        if (fabs(given[0] - strtod(rounded, NULL)) <= 1e-9 * fabs(right)) {
            hn_part_wrong(r, "rounded", 0.5,
                          "right to %d digits, but it must be right to %.2g %%: write more digits",
                          digits, 100 * s->allowed[k] / fabs(right));
            return true;
        }
    }
    return false;
}

/// The mistakes of which a formula, or one of its terms, may have two at once.
static hn_status try_singles(hn_value_search *f, bool term) {
    if (!term) {
        HN_TRY(try_listed(f));
    }
    try_factors(f);
    try_angles(f);
    hn_value_names_try_relative(f);
    try_names(f);
    hn_value_slips_try(f);
    hn_value_names_try(f);
    return HN_OK;
}

/// Two mistakes at once; those that need the fewest words first.
static hn_status try_pairs(hn_value_search *f) {
    try_signed_factors(f);
    if (f->n_found == 0) {
        HN_TRY(try_listed_pairs(f));
    }
    if (f->n_found == 0) {
        HN_TRY(try_two_listed(f));
    }
    return f->n_found == 0 ? hn_value_pairs_try(f, try_singles) : HN_OK;
}

hn_status hn_value_explain(hn_value_sheet *s, int k, const double *given, hn_ex formula,
                           hn_part_result *r) {
    hn_value_search f;
    hn_value_search_begin(&f, s, k, given, formula, r);
    if (!isfinite(given[0])) {
        hn_part_wrong(r, "not-finite", 0, "the formula has no finite value at some states");
        return HN_OK;
    }

    // one mistake; what is 0, or the same everywhere, is nothing but that
    HN_TRY(try_listed(&f));
    if (f.n_found > 0 && is_zero(s, k, given)) { // named, but worth nothing
        r->share = 0;
    }
    if (f.n_found == 0 && find_constant(s, k, given, r)) {
        return HN_OK;
    }
    if (!is_zero(s, k, given)) {
        try_factors(&f);
        try_angles(&f);
        hn_value_names_try_relative(&f);
        try_names(&f);
        try_entries(&f);
    }

    // one mistake explains more than two: pairs come last
    if (f.n_found == 0 && find_rounded(s, k, given, r)) {
        return HN_OK;
    }
    const bool count = is_count(s, k, given);
    if (f.n_found == 0 && !count && find_rounded_number(s, k, given, r)) {
        return HN_OK;
    }
    if (f.n_found == 0 && (!count || fabs(given[0]) >= LARGE_COUNT) && !is_zero(s, k, given)) {
        hn_value_slips_try(&f);
    }
    if (f.n_found == 0) {
        hn_value_names_try(&f);
    }
    if (f.n_found == 0 && !count) {
        HN_TRY(try_pairs(&f));
    }
    if (f.n_found == 0) {
        hn_part_wrong(r, "other", 0, "wrong; the cause is none of the known mistakes");
    }
    return hn_graph_failed(s->draw->graph) ? HN_ERR_MEMORY : HN_OK;
}
