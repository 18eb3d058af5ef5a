// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers, vectors and formulas. The reference is a formula for each entry; an answer is compared
// with it at the numbers of the variant (number, vector), or at random states (formula, formulas).
// A wrong entry is compared with the mistakes that the exercise lists, then with those that every
// formula invites.
#include "grade/parts/part_list.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/spelling.h"
#include "grade/parts/value_mistakes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARS = 2000 };

// ---- what the student wrote ----

/// Whether a unit may begin at text[i]: behind a number, a bracket or a blank, never inside a
/// number (the unit "1/s" begins with a digit, and so does the end of "0.11/s").
static bool may_begin_unit(const char *text, size_t i) {
    const bool inside = strchr("0123456789.", text[i - 1]) && strchr("0123456789.", text[i]);
    return !inside && (strchr("0123456789.) ", text[i - 1]) || strncmp(text + i, "°", 2) == 0);
}

/// A formula with a unit behind it, as "2*pi rad/s": the unit is the longest end that is one.
static hn_status read_quantity(hn_value_sheet *s, const char *text, hn_ex *e, hn_unit *unit,
                               hn_diag *diag) {
    char head[MAX_CHARS];
    *unit = s->unit;
    hn_status status = hn_draw_parse(s->draw, text, e, diag);
    for (size_t i = 1; status != HN_OK && text[i]; i++) {
        if (may_begin_unit(text, i)) {
            snprintf(head, sizeof head, "%.*s", (int)i, text);
            if (hn_unit_parse(text + i, unit) && text[i + strspn(text + i, " ")] &&
                hn_draw_parse(s->draw, head, e, NULL) == HN_OK) {
                status = HN_OK;
            }
        }
    }
    return status;
}

/// 1 when a formula that should be a number has names in it.
static int uses_names(const hn_value_sheet *s, hn_ex e) {
    int uses = 0;
    for (int i = 0; i < s->draw->n_names; i++) {
        uses |= hn_depends_on(s->draw->graph, e, i);
    }
    return uses;
}

/// The reason why a formula cannot be read.
static void refuse_formula(const char *text, const hn_diag *diag, hn_part_result *r) {
    hn_part_unreadable(r, "'%.60s' cannot be read: %.180s%s%.80s", text, diag->message,
                       diag->hint[0] ? "; " : "", diag->hint);
}

/// The reason why a number cannot be read, with the slip that is most frequent.
static void refuse_number(const hn_value_sheet *s, const char *text, hn_part_result *r) {
    const char *unit = hn_part_text(s->p->node, "unit");
    char *end;
    strtod(text, &end);
    const char *tail = end + strspn(end, " ");
    if (end == text || !*tail) {
        hn_part_unreadable(r, "'%.60s' is no number; a number is asked for%s%s", text,
                           unit[0] ? ", if you like with its unit: 1.2 " : "", unit);
    } else if (*tail == ',') {
        hn_part_unreadable(r, "'%.60s' has a comma at column %d; write decimals with a point", text,
                           (int)(tail - text) + 1);
    } else {
        hn_part_unreadable(r, "'%.60s': '%.30s' at column %d is no unit known here; asked for: %s",
                           text, tail, (int)(tail - text) + 1, unit[0] ? unit : "a plain number");
    }
}

/// Reads text as the student wrote it; 0 after it has said why it cannot be read.
static int read_text(hn_value_sheet *s, const char *text, hn_ex *e, hn_unit *unit,
                     hn_part_result *r) {
    hn_diag diag = {0};
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_status status = HN_ERR_INPUT;

    // a number with its unit, as it stands or in the parser's own spelling; or a formula
    if (!s->symbolic && strlen(text) < MAX_CHARS) {
        status = read_quantity(s, text, e, unit, &diag);
    }
    if (status != HN_OK) {
        status = hn_spelling_normalise(&plain, text, &diag);
        if (status == HN_OK && s->symbolic) {
            status = hn_draw_parse(s->draw, hn_strbuf_text(&plain), e, &diag);
        } else if (status == HN_OK) {
            status = read_quantity(s, hn_strbuf_text(&plain), e, unit, &diag);
        }
    }
    if (status != HN_OK && s->symbolic) {
        refuse_formula(text, &diag, r);
    } else if (status != HN_OK) {
        refuse_number(s, text, r);
    }
    hn_strbuf_reset(&plain);
    return status == HN_OK;
}

/// The values of one entry; 0 after the result has said what is wrong with it.
static int read_entry(hn_value_sheet *s, const cJSON *node, double x[HN_DRAW_STATES], hn_ex *e,
                      hn_part_result *r) {
    hn_unit unit = s->unit;
    *e = hn_num(0);
    hn_part_keep_given(r, node);
    if (!node || cJSON_IsNull(node) || (cJSON_IsString(node) && !*node->valuestring)) {
        hn_part_wrong(r, "blank", 0, "nothing was handed in here");
        return 0;
    }
    if (cJSON_IsNumber(node)) {
        *e = hn_num(node->valuedouble);
    } else if (!cJSON_IsString(node)) {
        hn_part_unreadable(r, "expected %s", s->symbolic ? "a formula in quotes" : "a number");
        return 0;
    } else if (!read_text(s, node->valuestring, e, &unit, r)) {
        return 0;
    }
    if (!s->symbolic && uses_names(s, *e)) {
        hn_part_unreadable(r, "a number is asked for, not a formula");
        return 0;
    }
    if (!hn_unit_fits(&unit, &s->unit)) {
        hn_part_wrong(r, "unit", 0, "this unit measures something else; asked for: %s",
                      hn_part_text(s->p->node, "unit"));
        return 0;
    }

    // in the unit that is asked for
    for (int i = 0; i < s->draw->n_states; i++) {
        x[i] = hn_draw_eval(s->draw, *e, i) * unit.factor / s->unit.factor;
    }
    return 1;
}

// ---- the functions of the kind ----

static void name_entry(const hn_value_sheet *s, int k, hn_part_result *r) {
    if (s->reference.columns) {
        snprintf(r->name, sizeof r->name, "%d%d", k / s->reference.columns + 1,
                 k % s->reference.columns + 1);
    } else if (s->reference.n > 1) {
        snprintf(r->name, sizeof r->name, "%d", k + 1);
    }
}

static hn_status grade_entry(hn_value_sheet *s, int k, const cJSON *node, hn_part_result *r) {
    double x[HN_DRAW_STATES];
    hn_ex e;
    *r = (hn_part_result){.mistake = ""};
    name_entry(s, k, r);
    snprintf(r->expected, sizeof r->expected, s->symbolic ? "the formula" : "%.6g %s",
             s->reference.x[k][0], hn_part_text(s->p->node, "unit"));
    if (!read_entry(s, node, x, &e, r)) {
        return HN_OK;
    }
    if (hn_value_is_right(s, k, x)) {
        hn_part_right(r);
        return HN_OK;
    }
    return hn_value_explain(s, k, x, r);
}

static hn_status grade_sheet(hn_value_sheet *s, const cJSON *given, hn_part_result *results,
                             int *n) {
    const cJSON *list[HN_VALUE_ENTRIES];
    int columns = 0;
    const int count = given ? hn_value_flatten(given, list, &columns) : 0;
    const int transposed = s->reference.columns && columns && count == s->reference.n &&
                           columns != s->reference.columns;
    *n = s->reference.n;

    // a shape that does not fit is said once, in the first entry
    if (given && (count != s->reference.n || transposed)) {
        for (int k = 0; k < *n; k++) {
            results[k] = (hn_part_result){.mistake = ""};
            name_entry(s, k, &results[k]);
            hn_part_keep_given(&results[k], k ? NULL : given);
            hn_part_wrong(&results[k], transposed ? "transposed" : "shape", 0,
                          transposed ? "rows and columns are exchanged: %d columns are asked for"
                                     : "entries asked for: %d; handed in: %d",
                          transposed ? s->reference.columns : s->reference.n, count);
        }
        return HN_OK;
    }
    for (int k = 0; k < *n; k++) {
        HN_TRY(grade_entry(s, k, given ? list[k] : NULL, &results[k]));
    }
    return HN_OK;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *results, int *n,
                       hn_diag *diag) {
    hn_value_sheet s;
    hn_draw draw;
    hn_status status = hn_value_open(&s, p, &draw, diag);
    if (status == HN_OK) {
        status = grade_sheet(&s, given, results, n);
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
                                     "part %s, entry %d: %.12g and by the second means %.12g",
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
        hn_strbuf_printf(b, " or %.3g %s", absolute, unit);
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
    hn_strbuf_printf(b, unit[0] ? " in %s, or with its unit: \"1.2 %s\"" : "%s%s", unit,
                     unit[0] ? unit : "");

    if (!hn_value_is_symbolic(p)) {
        put_tolerance(b, p);
    }

    // the names that a formula may use
    const cJSON *states = cJSON_GetObjectItemCaseSensitive(p->node, "states"), *m;
    hn_strbuf_add(b, states ? "; names:" : "");
    cJSON_ArrayForEach(m, states) {
        hn_strbuf_printf(b, " %s", m->string);
    }
}

const hn_part_kind hn_part_values = {
    .name = "values",
    .fields = "answer second unit states conditions tolerance faults",
    .ask = ask,
    .grade = grade,
    .right = right,
    .fault = fault,
    .prove = prove,
};
