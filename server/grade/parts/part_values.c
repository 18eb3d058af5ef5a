// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers, vectors and formulas. The reference is a formula for each entry; an answer is compared
// with it at the numbers of the variant (number, vector), or at random states (formula, formulas).
// A wrong entry is compared with the mistakes that the exercise lists, then with those that every
// formula invites.
#include "grade/parts/blank.h"
#include "grade/parts/comma_list.h"
#include "grade/parts/list_text.h"
#include "grade/parts/part_list.h"
#include "grade/parts/spelling.h"
#include "grade/parts/value_entry.h"
#include "grade/parts/value_likeness.h"
#include "grade/parts/value_mistakes.h"
#include "grade/parts/value_search.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the functions of the kind ----

static void name_entry(const hn_value_sheet *s, int k, hn_part_result *r) {
    if (s->reference.columns) {
        snprintf(r->name, sizeof r->name, "%d%d", k / s->reference.columns + 1,
                 k % s->reference.columns + 1);
    } else if (s->reference.n > 1) {
        snprintf(r->name, sizeof r->name, "%d", k + 1);
    }
}

/// The number with its unit, or the formula as the exercise writes it.
static void write_expected(const hn_value_sheet *s, int k, hn_part_result *r) {
    const cJSON *list[HN_VALUE_ENTRIES];
    int columns;
    const int n =
        hn_value_flatten(cJSON_GetObjectItemCaseSensitive(s->p->node, "answer"), list, &columns);
    const char *formula = k < n ? cJSON_GetStringValue(list[k]) : NULL;
    if (s->symbolic && formula) {
        snprintf(r->expected, sizeof r->expected, "%s", formula);
    } else {
        const char *unit = hn_part_text(s->p->node, "unit");
        snprintf(r->expected, sizeof r->expected, "%.6g%s%s", s->reference.x[k][0],
                 unit && unit[0] ? " " : "", unit ? unit : "");
    }
}

/// Returns whether a number is the right one after whole periods, as an angle after whole turns.
static bool is_right_turned(const hn_value_sheet *s, int k, const double *x) {
    const double period = hn_part_number(s->p->node, "period", 0);
    if (s->symbolic || !(period > 0)) {
        return false;
    }
    double turned[HN_DRAW_STATES];
    for (int i = 0; i < s->draw->n_states; i++) {
        turned[i] = x[i] - period * round((x[i] - s->reference.x[k][i]) / period);
    }
    return hn_value_is_right(s, k, turned);
}

static hn_status grade_entry(hn_value_sheet *s, int k, const cJSON *node, hn_part_result *r) {
    double x[HN_DRAW_STATES];
    hn_ex e;
    *r = (hn_part_result){.mistake = ""};
    name_entry(s, k, r);
    write_expected(s, k, r);
    if (!hn_value_entry_read(s, node, x, &e, r)) {
        return HN_OK;
    }
    if (hn_value_is_right(s, k, x) || is_right_turned(s, k, x)) {
        const char *stray = hn_value_search_stray_name(s, k, e);
        if (stray) {
            hn_part_wrong(
                r, "stray-name", 0.5,
                "right with the numbers of this variant alone: with another %.40s it is wrong",
                stray);
        } else {
            hn_part_right(r);
        }
        return HN_OK;
    }

    // its last word may be a unit that is a number's name as well
    char read_as[HN_PART_READ_AS];
    double before[HN_DRAW_STATES];
    hn_ex head;
    memcpy(read_as, r->read_as, sizeof read_as);
    if (hn_value_entry_read_before_unit(s, node, before, &head, r) &&
        hn_value_is_right(s, k, before)) {
        hn_part_right(r);
        return HN_OK;
    }
    memcpy(r->read_as, read_as, sizeof read_as);
    HN_TRY(hn_value_explain(s, k, x, e, r));

    if (s->symbolic && cJSON_IsString(node)) {
        hn_spelling_remark_bare(node->valuestring, r->explanation, sizeof r->explanation);
    }

    // a known mistake has the same values whoever makes it; a wrong factor may be any number
    const bool rare = strcmp(r->mistake, "other") == 0 || strcmp(r->mistake, "wrong-factor") == 0;
    r->likeness = hn_value_likeness(s, node, rare);
    return HN_OK;
}

/// Returns what to write where the number of entries is wrong: one text or object that stands for
/// several is not read.
static const char *shape_advice(const hn_value_sheet *s, const cJSON *given, int count) {
    const bool one = cJSON_IsObject(given) || cJSON_IsString(given);
    const bool more = !s->symbolic && count > s->reference.n;
    return one    ? ": write a list, [..., ...]"
           : more ? ": where a comma stands for decimals, write a point"
                  : "";
}

/// Returns whether commas may be those of decimals: in one text that stands for several numbers, or
/// in a list of twice as many numbers as are asked for.
static bool has_unclear_commas(const hn_value_sheet *s, const cJSON *given, int count) {
    const char *text = cJSON_GetStringValue(given);
    return !s->symbolic && s->reference.n > 1 &&
           (text ? hn_comma_list_is_unclear(text) : count == 2 * s->reference.n);
}

/// Reads "-0.399, 0.950", a list without its brackets, or one in round brackets; owned. NULL: it
/// is no text, or one that does not have the number of entries that is asked for.
static cJSON *read_bare_list(const hn_value_sheet *s, const cJSON *given) {
    const char *text = cJSON_GetStringValue(given);
    if (!text || s->reference.n < 2) {
        return NULL;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    const size_t n = strlen(text);
    const bool round = n > 1 && text[0] == '(' && strchr(text, ')') == text + n - 1;
    hn_strbuf_add(&b, "[");
    hn_strbuf_add_n(&b, text + round, n - 2 * (size_t)round);
    hn_strbuf_add(&b, "]");
    cJSON *list = hn_list_text_read(hn_strbuf_text(&b)), *m;
    bool fits = list && cJSON_GetArraySize(list) == s->reference.n;
    hn_strbuf_reset(&b);

    // each entry as it stands between two marks; between semicolons in a row of its own
    cJSON_ArrayForEach(m, list) {
        const cJSON *one = cJSON_GetArraySize(m) == 1 ? m->child : m;
        fits &= cJSON_IsNumber(one) || (cJSON_IsString(one) && one->valuestring[0]);
    }
    if (!fits) {
        cJSON_Delete(list);
        return NULL;
    }
    return list;
}

static hn_status grade_sheet(hn_value_sheet *s, const cJSON *given, hn_part_result *results,
                             int *n) {
    const cJSON *list[HN_VALUE_ENTRIES];
    int columns = 0;
    const int count = given ? hn_value_flatten(given, list, &columns) : 0;
    const bool transposed = s->reference.columns && columns && count == s->reference.n &&
                            columns != s->reference.columns;
    const bool misshapen = given && (count != s->reference.n || transposed);
    *n = s->reference.n;

    // a shape that does not fit is said once, in the first entry
    for (int k = 0; k < *n && misshapen; k++) {
        hn_part_result *r = &results[k];
        *r = (hn_part_result){.mistake = ""};
        name_entry(s, k, r);
        write_expected(s, k, r);
        hn_part_keep_given(r, k ? NULL : given);
        if (has_unclear_commas(s, given, count)) {
            hn_part_unreadable(r,
                               "'%.60s': %d numbers are asked for, and a comma may stand for "
                               "decimals or part two of them; write a list with points, [1.5, 2.3]",
                               results[0].given, s->reference.n);
        } else if (transposed) {
            hn_part_wrong(r, "transposed", 0,
                          "rows and columns are exchanged: %d columns are asked for",
                          s->reference.columns);
        } else {
            hn_part_wrong(r, "shape", 0, "entries asked for: %d; handed in: %d%s", s->reference.n,
                          count, shape_advice(s, given, count));
        }
    }
    if (misshapen) {
        return HN_OK;
    }
    for (int k = 0; k < *n; k++) {
        HN_TRY(grade_entry(s, k, given ? list[k] : NULL, &results[k]));
    }
    hn_part_qualify(results, *n);
    return HN_OK;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *results, int *n,
                       hn_diag *diag) {
    hn_value_sheet s;
    hn_draw draw;
    hn_status status = hn_value_open(&s, p, &draw, diag);
    if (status == HN_OK) {
        cJSON *bare = read_bare_list(&s, given);
        status = grade_sheet(&s, bare ? bare : given, results, n);
        cJSON_Delete(bare);
    }
    hn_draw_reset(&draw);
    return status;
}

/// Values as a student would hand them in, in the shape of the reference.
static cJSON *write_answer(const hn_value_sheet *s, const hn_values *v, const cJSON *shape) {
    if (s->symbolic) {
        return cJSON_Duplicate(shape, 1);
    }
    if (!cJSON_IsArray(shape)) {
        return cJSON_CreateNumber(v->x[0][0]);
    }
    cJSON *list = cJSON_CreateArray();
    for (int k = 0; k < v->n; k++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(v->x[k][0]));
    }
    return list;
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    hn_value_sheet s;
    hn_draw draw;
    cJSON *out = NULL;
    if (hn_value_open(&s, p, &draw, diag) == HN_OK) {
        out = write_answer(&s, &s.reference, cJSON_GetObjectItemCaseSensitive(p->node, "answer"));
    }
    hn_draw_reset(&draw);
    return out;
}

static cJSON *blank(const hn_part *p) {
    return hn_value_is_symbolic(p) ? hn_blank_texts(p) : hn_blank_numbers(p);
}

/// Null entries of a fault filled in with those of the reference.
static cJSON *complete(const cJSON *fault, const cJSON *reference) {
    if (!cJSON_IsArray(fault)) {
        return cJSON_Duplicate(cJSON_IsNull(fault) ? reference : fault, 1);
    }
    cJSON *out = cJSON_CreateArray();
    const cJSON *m, *other = reference->child;
    cJSON_ArrayForEach(m, fault) {
        cJSON_AddItemToArray(out, other ? complete(m, other) : cJSON_Duplicate(m, 1));
        other = other ? other->next : NULL;
    }
    return out;
}

static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    const cJSON *node = hn_part_fault_at(p, i);
    hn_value_sheet s;
    hn_draw draw;
    cJSON *out = NULL;
    if (!node) {
        return NULL;
    }
    *id = hn_part_text(node, "id");
    if (hn_value_open(&s, p, &draw, diag) == HN_OK) {
        hn_values wrong = {0};
        const cJSON *answer = cJSON_GetObjectItemCaseSensitive(node, "answer");
        cJSON *whole = complete(answer, cJSON_GetObjectItemCaseSensitive(p->node, "answer"));
        if (hn_value_read(&s, answer, &s.reference, &wrong) == HN_OK) {
            out = write_answer(&s, &wrong, whole);
        }
        cJSON_Delete(whole);
    }
    hn_draw_reset(&draw);
    return out;
}

/// The largest difference of both means, as a share of the value; below 1 of its unit.
static double find_worst(const hn_value_sheet *s, const hn_values *second) {
    double worst = 0;
    for (int k = 0; k < s->reference.n; k++) {
        for (int i = 0; i < s->draw->n_states; i++) {
            const double x = s->reference.x[k][i], y = second->x[k][i];
            worst = fmax(worst, fabs(x - y) / fmax(fabs(x), 1));
        }
    }
    return worst;
}

double hn_value_worst_difference(const hn_part *p) {
    hn_value_sheet s;
    hn_draw draw;
    hn_values second = {0};
    hn_diag diag;
    const cJSON *node = cJSON_GetObjectItemCaseSensitive(p->node, "second");
    hn_status status = p->kind == &hn_part_values && node ? HN_OK : HN_ERR_UNSUPPORTED;
    if (status != HN_OK) {
        return (double)NAN;
    }
    status = hn_value_open(&s, p, &draw, &diag);
    HN_THEN(status, hn_value_read(&s, node, &s.reference, &second));
    const double worst = status == HN_OK ? find_worst(&s, &second) : (double)NAN;
    hn_draw_reset(&draw);
    return worst;
}

/// The formulas of "second" have the values of the reference.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    hn_value_sheet s;
    hn_draw draw;
    hn_values second = {0};

    // both forms, each with its values
    const cJSON *node = cJSON_GetObjectItemCaseSensitive(p->node, "second");
    hn_status status = hn_value_open(&s, p, &draw, diag);
    if (status == HN_OK && !node) {
        status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                             "part %s has no second form of its answer", p->id);
    }
    status = status == HN_OK ? hn_value_read(&s, node, &s.reference, &second) : status;

    // equal to rounding, and within what a student is allowed
    for (int k = 0; k < s.reference.n && status == HN_OK; k++) {
        for (int i = 0; i < draw.n_states && status == HN_OK; i++) {
            const double x = s.reference.x[k][i], y = second.x[k][i];
            if (!(fabs(x - y) <= fmin(1e-9 * fmax(fabs(x), 1), s.allowed[k]))) {
                status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                                     "part %s: entry %d is %.12g and by the second means %.12g",
                                     p->id, k + 1, x, y);
            }
        }
    }
    hn_draw_reset(&draw);
    return status;
}

/// "; right to 0.5 %" or "; exact": how exact a number must be.
static void put_tolerance(hn_strbuf *b, const hn_part *p) {
    double relative, absolute;
    hn_value_tolerance(p, &relative, &absolute);
    const char *unit = hn_part_text(p->node, "unit");

    // counts have no tolerance but that of their reading
    if (relative < 1e-8 && absolute < 1e-8) {
        hn_strbuf_add(b, "; exact");
        return;
    }
    hn_strbuf_printf(b, "; right to %.3g %%", 100 * relative);
    if (absolute > 1e-9) {
        hn_strbuf_printf(b, " or %.3g%s%s", absolute, unit[0] ? " " : "", unit);
    }
}

/// Returns whether a given angle or rate is read as the part's own of that index (draw.h): t1 as
/// th1, w1 as u1.
static bool is_read_as_own(const hn_part *p, int i, const cJSON *states) {
    char other[64];
    if (!hn_draw_turns(p->draw, i)) {
        return false;
    }
    for (int k = 0; hn_spelling_alias(p->draw->name[i], k, other, sizeof other); k++) {
        if (cJSON_GetObjectItemCaseSensitive(states, other)) {
            return true;
        }
    }
    return false;
}

/// The names that a formula may use: the part's own, then those of the numbers that the exercise
/// gives, with these: the question may give them without a name. What follows from other names is
/// left out: it may be what is asked for.
static void put_names(hn_strbuf *b, const hn_part *p) {
    const cJSON *states = cJSON_GetObjectItemCaseSensitive(p->node, "states"), *m;
    if (!states) {
        return;
    }
    hn_strbuf_add(b, "; names:");
    cJSON_ArrayForEach(m, states) {
        hn_strbuf_printf(b, " %s", m->string);
    }
    const char *before = "; with numbers given:";
    for (int i = 0; p->draw && i < p->draw->n_names; i++) {
        const bool own = cJSON_GetObjectItemCaseSensitive(states, p->draw->name[i]) != NULL;
        if (p->draw->origin[i] != HN_DRAW_DERIVED && !own && !is_read_as_own(p, i, states)) {
            char number[80];
            snprintf(number, sizeof number, "%.30s = {%.30s}", p->draw->name[i], p->draw->name[i]);
            hn_strbuf_printf(b, "%s ", before);
            hn_draw_text(b, p->draw, number);
            before = ",";
        }
    }
}

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(p->node, "answer");
    const int n = cJSON_IsArray(answer) ? cJSON_GetArraySize(answer) : 0;
    const char *unit = hn_part_text(p->node, "unit");
    const char *what = hn_value_is_symbolic(p) ? "formula" : "number";

    // how many, and of which kind
    if (n && cJSON_IsArray(answer->child)) {
        hn_strbuf_printf(b, "%d rows of %d formulas in quotes: [[\"...\", ...], ...]", n,
                         cJSON_GetArraySize(answer->child));
    } else if (n) {
        hn_strbuf_printf(b, "a list of %d %ss%s", n, what,
                         hn_value_is_symbolic(p) ? " in quotes: [\"...\", ...]" : ": [1.2, ...]");
    } else {
        hn_strbuf_printf(b, "a %s%s", what, hn_value_is_symbolic(p) ? " in quotes" : "");
    }

    // the unit, which may be left out
    hn_strbuf_printf(b, unit[0] ? " in %s, or with its unit: \"... %s\"" : "%s%s", unit,
                     unit[0] ? unit : "");

    if (!hn_value_is_symbolic(p)) {
        put_tolerance(b, p);
    }

    put_names(b, p);
}

const hn_part_kind hn_part_values = {
    .name = "values",
    .fields = "answer second unit period states conditions tolerance follows faults",
    .ask = ask,
    .grade = grade,
    .blank = blank,
    .right = right,
    .fault = fault,
    .prove = prove,
};
