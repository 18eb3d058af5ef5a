// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/rubric_apply.h"

#include "base/suggest.h"
#include "grade/mistakes.h"
#include "grade/parts/part_list.h"
#include "grade/parts/value_sheet.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NAMES = 160, FEW_NAMES = 16 };

/// Names of the parts, or of the one matrix. Returns how many.
static int list_parts(const hn_exercise *e, const char *names[HN_GRADE_MAX_PARTS]) {
    for (int i = 0; i < e->n_parts; i++) {
        names[i] = e->parts[i].id;
    }
    names[0] = e->n_parts ? names[0] : e->answer;
    return e->n_parts ? e->n_parts : 1;
}

/// Mistakes that every exercise can have; those that its parts list come on top.
static const char *const GENERAL[] = {"sign",           "half",         "double",
                                      "degrees",        "radians",      "milli",
                                      "kilo",           "gravity",      "sine",
                                      "missing-name",   "sign-term",    "other-entry",
                                      "other",          "choice",       "transposed",
                                      "missing-term",   "not-finite",   "shape",
                                      "unit",           "not-null",     "rank",
                                      "power-of-ten",   "other-place",  "other-axis",
                                      "inexact",        "other-branch", "half-turn",
                                      "absolute",       "relative",     "swapped",
                                      "not-assembled",  "stuck",        "some-points",
                                      "change-point",   "out-of-range", "no-scene",
                                      "inaccurate",     "costly",       "ended-early",
                                      "zero",           "constant",     "rounded",
                                      "double-term",    "half-term",    "no-root",
                                      "not-squared",    "no-power",     "no-divisor",
                                      "relative-angle", "other-name",   "exchanged-names",
                                      "wrong-factor",   "follow-on"};
enum { N_GENERAL = sizeof GENERAL / sizeof *GENERAL };

/// Calls for every mistake that a part names by itself: its faults, its tests, its wrong options.
static void each_mistake(const hn_part *p, void (*use)(void *user, const char *id), void *user) {
    static const char *const lists[][2] = {
        {"faults", "id"}, {"checks", "id"}, {"options", "fault"}, {"reasons", "fault"}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const cJSON *m;
        cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, lists[i][0])) {
            const char *id = hn_part_text(m, lists[i][1]);
            if (id[0]) {
                use(user, id);
            }
        }
    }
}

typedef struct name_list {
    const char **names;
    int n;
} name_list;

static void add_name(void *user, const char *id) {
    name_list *list = user;
    bool known = false;
    for (int i = 0; i < list->n; i++) {
        known |= strcmp(list->names[i], id) == 0;
    }
    if (!known && list->n < MAX_NAMES) {
        list->names[list->n++] = id;
    }
}

static int list_mistakes(const hn_exercise *e, const char *names[MAX_NAMES]) {
    name_list list = {.names = names};
    for (int i = 0; i < N_GENERAL; i++) {
        names[list.n++] = GENERAL[i];
    }
    for (int i = 0; i < e->n_parts; i++) {
        each_mistake(&e->parts[i], add_name, &list);
    }
    return list.n;
}

void hn_rubric_put_mistakes(hn_strbuf *b, const hn_exercise *e) {
    for (int i = 0; i < e->n_parts; i++) {
        const char *names[MAX_NAMES];
        name_list list = {.names = names};
        each_mistake(&e->parts[i], add_name, &list);
        for (int k = 0; k < list.n; k++) {
            if (k == 0) {
                hn_strbuf_printf(b, "  mistakes of part %s:", e->parts[i].id);
            }
            hn_strbuf_printf(b, " %s", names[k]);
        }
        hn_strbuf_add(b, list.n ? "\n" : "");
    }
}

static bool is_listed(const char *const *names, int n, const char *name) {
    for (int i = 0; i < n; i++) {
        if (strcmp(names[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/// The name that was meant; where none is near, all of them, or who lists them where they are many.
static void suggest_name(const char *word, const char *const *names, int n,
                         char hint[HN_DIAG_HINT]) {
    if (n > FEW_NAMES) {
        hn_suggest(hint, word, names, n,
                   "'holonom rubric check' lists those of a rubric without faults");
    } else {
        hn_suggest_or_list(hint, word, names, n, "one of: ");
    }
}

/// Every member of a section has one of these names.
static hn_status check_names(const hn_rubric *r, const char *section, const char *what,
                             const char *const *names, int n, hn_diags *diags) {
    const cJSON *m;
    hn_status status = HN_OK;
    cJSON_ArrayForEach(m, hn_rubric_section(r, section)) {
        const bool known = is_listed(names, n, m->string) ||
                           (strcmp(section, "shares") == 0 && hn_grade_is_mistake(m->string));
        if (!known) {
            char hint[HN_DIAG_HINT];
            suggest_name(m->string, names, n, hint);
            status =
                hn_rubric_fault(r, diags, section, m->string, hint, "exercise %s has no %s '%.40s'",
                                hn_rubric_exercise(r), what, m->string);
        }
    }
    return status;
}

static const cJSON *member(const hn_rubric *r, const char *section, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(hn_rubric_section(r, section), name);
}

/// A tolerance belongs to numbers and formulas that are compared by value.
static hn_status check_kinds(const hn_rubric *r, const hn_exercise *e, hn_diags *diags) {
    hn_status status = HN_OK;
    for (int i = 0; i < e->n_parts; i++) {
        const hn_part *p = &e->parts[i];
        if (member(r, "tolerance", p->id) && p->kind != &hn_part_values) {
            status =
                hn_rubric_fault(r, diags, "tolerance", p->id, NULL,
                                "part %s is of the kind '%s', whose tolerance no rubric changes",
                                p->id, hn_part_text(p->node, "kind"));
        }
    }
    return status;
}

/// No more costs than there are hints.
static hn_status check_hints(const hn_rubric *r, const hn_exercise *e, hn_diags *diags) {
    const int n = cJSON_GetArraySize(hn_rubric_section(r, "hints"));
    return n > e->n_hints
               ? hn_rubric_fault(r, diags, "hints", NULL, NULL, "exercise %s has %d hint%s, not %d",
                                 e->id, e->n_hints, e->n_hints == 1 ? "" : "s", n)
               : HN_OK;
}

static hn_status check_total(const hn_rubric *r, const hn_exercise *e, hn_diags *diags) {
    const cJSON *total = hn_rubric_section(r, "total");
    const char *names[HN_GRADE_MAX_PARTS];
    const int n = list_parts(e, names);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double own = e->n_parts ? e->parts[i].points : hn_exercise_points(e);
        sum += hn_part_number(hn_rubric_section(r, "points"), names[i], own);
    }
    if (total && !(cJSON_IsNumber(total) && fabs(sum - total->valuedouble) <= 1e-9 * (sum + 1))) {
        return hn_rubric_fault(r, diags, "total", NULL, NULL,
                               "the points of the parts sum up to %g, not %g", sum,
                               total->valuedouble);
    }
    return HN_OK;
}

static void apply_part(const hn_rubric *r, hn_part *p) {
    cJSON *node = (cJSON *)p->node; // the exercise's own tree
    const cJSON *tolerance = member(r, "tolerance", p->id);
    p->points = hn_part_number(hn_rubric_section(r, "points"), p->id, p->points);
    if (tolerance) {
        cJSON_DeleteItemFromObjectCaseSensitive(node, "tolerance");
        cJSON_AddItemToObject(node, "tolerance", cJSON_Duplicate(tolerance, 1));
    }
}

hn_status hn_rubric_check(const hn_rubric *r, const hn_exercise *e, hn_diags *diags) {
    const char *parts[HN_GRADE_MAX_PARTS], *mistakes[MAX_NAMES];
    const int n_parts = list_parts(e, parts), n_mistakes = list_mistakes(e, mistakes);
    if (strcmp(hn_rubric_exercise(r), e->id) != 0) {
        return hn_rubric_fault(r, diags, "exercise", NULL, NULL,
                               "the rubric is for exercise '%.40s', not %s", hn_rubric_exercise(r),
                               e->id);
    }
    const hn_status checked[] = {check_names(r, "visibility", "part", parts, n_parts, diags),
                                 check_names(r, "points", "part", parts, n_parts, diags),
                                 check_names(r, "tolerance", "part", parts, n_parts, diags),
                                 check_names(r, "shares", "mistake", mistakes, n_mistakes, diags),
                                 check_kinds(r, e, diags),
                                 check_hints(r, e, diags),
                                 check_total(r, e, diags)};
    for (size_t i = 0; i < sizeof checked / sizeof *checked; i++) {
        HN_TRY(checked[i]);
    }
    return HN_OK;
}

hn_status hn_rubric_apply(hn_rubric *r, hn_exercise *e, hn_diags *diags) {
    HN_TRY(hn_rubric_check(r, e, diags));

    // the parts, or the one matrix
    double sum = 0;
    for (int i = 0; i < e->n_parts; i++) {
        apply_part(r, &e->parts[i]);
        sum += e->parts[i].points;
    }
    const double entries = (double)e->n_rows * e->n_columns;
    const cJSON *tolerance = member(r, "tolerance", e->n_parts ? "" : e->answer);
    e->points = e->n_parts ? sum
                           : hn_part_number(hn_rubric_section(r, "points"), e->answer,
                                            e->points * entries) /
                                 entries;
    e->relative = hn_part_number(tolerance, "relative", e->relative);
    e->absolute = hn_part_number(tolerance, "absolute", e->absolute);
    e->rubric = r;
    return HN_OK;
}

// ---- words ----

/// A tolerance for counts: nothing but the right number is within it.
static const double EXACT = 1e-8;

/// "passes every answer rounded to 3 digits": a number rounded to d digits errs by at most half of
/// the last, which is 0.5 * 10^(1 - d) of a number that begins with 1.
static void put_meaning(hn_strbuf *b, double relative, double absolute, bool symbolic) {
    const int digits = (int)ceil(1 - log10(2 * relative) - 1e-9);
    if (symbolic) {
        hn_strbuf_printf(b,
                         "%g of the largest value over the random states: passes formulas whose "
                         "numbers have %d digits",
                         relative, digits);
    } else if (relative <= EXACT) {
        hn_strbuf_add(b, "exact: passes the right number alone");
    } else {
        hn_strbuf_printf(b, "%g %%: passes every answer rounded to %d digit%s", 100 * relative,
                         digits, digits == 1 ? "" : "s");
    }
    if (absolute > 1e-9) {
        hn_strbuf_printf(b, "; or a difference of %g", absolute);
    }
}

void hn_rubric_text(hn_strbuf *b, const hn_exercise *e) {
    hn_strbuf_printf(b, "%s: %s, %g points\n", e->id, e->title, hn_exercise_points(e));
    for (int i = 0; i < e->n_parts; i++) {
        const hn_part *p = &e->parts[i];
        hn_strbuf_printf(b, "  %-8s %5g point%s  %-9s", p->id, p->points,
                         p->points == 1 ? " " : "s", hn_part_text(p->node, "kind"));
        if (p->kind == &hn_part_values) {
            double relative, absolute;
            hn_value_tolerance(p, &relative, &absolute);
            put_meaning(b, relative, absolute, hn_value_is_symbolic(p));
        }
        hn_strbuf_add(b, "\n");
    }
    if (!e->n_parts) {
        hn_strbuf_printf(b, "  %-8s %5g point%s for each of %d entries  ", e->answer, e->points,
                         e->points == 1 ? "" : "s", e->n_rows * e->n_columns);
        put_meaning(b, e->relative, e->absolute, true);
        hn_strbuf_add(b, "\n");
    }
    for (int i = 0; i < e->n_parts; i++) {
        const char *shown = hn_rubric_visibility(e->rubric, e->parts[i].id);
        if (strcmp(shown, "visible") != 0) {
            hn_strbuf_printf(b, "  %-8s in Gradescope: %s\n", e->parts[i].id, shown);
        }
    }
    for (int i = 1; i <= e->n_hints && e->rubric; i++) {
        const double cost =
            hn_rubric_hints_cost(e->rubric, i) - hn_rubric_hints_cost(e->rubric, i - 1);
        hn_strbuf_printf(b, "  hint %d costs %g point%s\n", i, cost, cost == 1 ? "" : "s");
    }
}

static void put_tolerance(hn_strbuf *b, const char *name, double relative, double absolute,
                          bool first) {
    hn_strbuf_printf(b, "%s\n    \"%s\": {\"relative\": %g, \"absolute\": %g}", first ? "" : ",",
                     name, relative, absolute);
}

/// Returns whether every mistake of this id earns the same share in all parts. One of the general
/// ids has shares that depend on the kind of the answer.
static bool has_one_share(const hn_exercise *e, const char *id, double share) {
    bool one = !is_listed(GENERAL, N_GENERAL, id);
    for (int i = 0; i < e->n_parts; i++) {
        const cJSON *m;
        cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(e->parts[i].node, "faults")) {
            one &= strcmp(hn_part_text(m, "id"), id) != 0 || hn_part_number(m, "share", 0) == share;
        }
    }
    return one;
}

/// The shares that the exercise itself gives for its listed mistakes.
static void put_shares(hn_strbuf *b, const hn_exercise *e) {
    const char *names[MAX_NAMES];
    name_list list = {.names = names};
    for (int i = 0; i < e->n_partial; i++) {
        hn_strbuf_printf(b, "%s\"%s\": %g", i ? ", " : "", e->partial[i].key, e->partial[i].value);
    }
    for (int i = 0; i < e->n_parts; i++) {
        const cJSON *m;
        if (hn_part_text(e->parts[i].node, "follows")[0] &&
            !is_listed(names, list.n, "follow-on")) {
            add_name(&list, "follow-on");
            hn_strbuf_printf(b, "%s\"follow-on\": 1", list.n > 1 ? ", " : "");
        }
        cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(e->parts[i].node, "faults")) {
            const char *id = hn_part_text(m, "id");
            const double share = hn_part_number(m, "share", 0);
            if (!is_listed(names, list.n, id) && has_one_share(e, id, share) &&
                e->parts[i].kind == &hn_part_values) {
                add_name(&list, id);
                hn_strbuf_printf(b, "%s\"%s\": %g", list.n > 1 ? ", " : "", id, share);
            }
        }
    }
}

void hn_rubric_write(hn_strbuf *b, const hn_exercise *e) {
    const char *names[HN_GRADE_MAX_PARTS];
    const int n = list_parts(e, names);
    hn_strbuf_printf(b, "{\n  \"rubric\": 1,\n  \"exercise\": \"%s\",\n  \"total\": %g,\n", e->id,
                     hn_exercise_points(e));
    hn_strbuf_add(b, "  \"points\": {");
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(b, "%s\"%s\": %g", i ? ", " : "", names[i],
                         e->n_parts ? e->parts[i].points : hn_exercise_points(e));
    }
    hn_strbuf_add(b, "},\n  \"tolerance\": {");
    bool first = true;
    for (int i = 0; i < e->n_parts; i++) {
        double relative, absolute;
        if (e->parts[i].kind == &hn_part_values) {
            hn_value_tolerance(&e->parts[i], &relative, &absolute);
            put_tolerance(b, names[i], relative, absolute, first);
            first = false;
        }
    }
    if (!e->n_parts) {
        put_tolerance(b, e->answer, e->relative, e->absolute, true);
    }
    hn_strbuf_add(b, "\n  },\n  \"shares\": {");
    put_shares(b, e);
    hn_strbuf_add(b, "},\n  \"hints\": [");
    for (int i = 0; i < e->n_hints; i++) {
        hn_strbuf_add(b, i ? ", 0" : "0");
    }
    hn_strbuf_add(b, "]\n}\n");
}
