// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers, vectors and formulas. The reference is a formula for each entry; an answer is compared
// with it at the numbers of the variant (number, vector), or at random states (formula, formulas).
// A wrong entry is compared with the mistakes that the exercise lists, then with those that every
// formula invites.
#include "grade/parts/part_list.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/spelling.h"
#include "grade/parts/unit_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_ENTRIES = HN_PART_RESULTS, STATES = 12, MAX_CHARS = 2000 };

/// Entries of an answer with their values at all states. An entry that an answer leaves out (null
/// in a fault) is that of the reference.
typedef struct values {
    int n, columns; ///< columns 0: no matrix
    hn_ex e[MAX_ENTRIES];
    double x[MAX_ENTRIES][HN_DRAW_STATES];
} values;

/// An answer being graded.
typedef struct sheet {
    const hn_part *p;
    hn_draw *draw;
    hn_diag *diag;
    values reference;
    double allowed[MAX_ENTRIES];
    int symbolic; ///< formulas are asked for, not numbers
    hn_unit unit;
} sheet;

static int is_symbolic(const hn_part *p) {
    return strncmp(hn_part_text(p->node, "kind"), "formula", 7) == 0;
}

// ---- shapes ----

/// The entries of an answer: one, a list, or a list of rows. Returns how many, -1 if too many.
static int flatten(const cJSON *node, const cJSON *list[MAX_ENTRIES], int *columns) {
    int n = 0;
    const cJSON *row, *entry;
    *columns = 0;

    // one entry
    if (!cJSON_IsArray(node)) {
        list[0] = node;
        return 1;
    }

    // a list; its entries may be rows
    cJSON_ArrayForEach(row, node) {
        if (!cJSON_IsArray(row)) {
            if (n == MAX_ENTRIES) {
                return -1;
            }
            list[n++] = row;
            continue;
        }

        // a row: its entries, one after another
        *columns = cJSON_GetArraySize(row);
        cJSON_ArrayForEach(entry, row) {
            if (n == MAX_ENTRIES) {
                return -1;
            }
            list[n++] = entry;
        }
    }
    return n;
}

/// Reads formulas of the exercise itself; `base` (may be NULL) stands in for null entries.
static hn_status read_reference(sheet *s, const cJSON *node, const values *base, values *out) {
    const cJSON *list[MAX_ENTRIES];

    // as many entries as the base
    out->n = flatten(node, list, &out->columns);
    if (out->n < 1 || (base && out->n != base->n)) {
        return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                           "part %s: the answer needs 1 to %d entries, the same in every fault",
                           s->p->id, MAX_ENTRIES);
    }

    // only null may stand for no formula, and only over a base
    for (int k = 0; k < out->n; k++) {
        const char *text = cJSON_GetStringValue(list[k]);
        if (!text && !(base && cJSON_IsNull(list[k]))) {
            return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                               "part %s: an entry of an answer is no formula in quotes", s->p->id);
        }

        // the formula, or the one that it leaves as it is
        if (text) {
            HN_TRY(hn_draw_parse(s->draw, text, &out->e[k], s->diag));
        } else {
            out->e[k] = base->e[k];
        }

        // its value in every state
        for (int i = 0; i < s->draw->n_states; i++) {
            out->x[k][i] = hn_draw_eval(s->draw, out->e[k], i);
        }
    }
    return HN_OK;
}

// ---- opening ----

static hn_status set_tolerance(sheet *s) {
    const cJSON *tolerance = cJSON_GetObjectItemCaseSensitive(s->p->node, "tolerance");
    const double relative = hn_part_number(tolerance, "relative", s->symbolic ? 1e-6 : 5e-3);
    const double absolute = hn_part_number(tolerance, "absolute", s->symbolic ? 1e-9 : 1e-12);
    for (int k = 0; k < s->reference.n; k++) {
        double size = 0;
        for (int i = 0; i < s->draw->n_states; i++) {
            if (!isfinite(s->reference.x[k][i])) {
                return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                                   "part %s: the reference is not finite for seed %llu", s->p->id,
                                   (unsigned long long)s->p->seed);
            }
            size = fmax(size, fabs(s->reference.x[k][i]));
        }
        s->allowed[k] = absolute + relative * size;
    }
    return HN_OK;
}

/// The states and the reference. hn_draw_reset(s->draw) and free afterwards in any case.
static hn_status open_sheet(sheet *s, const hn_part *p, hn_draw *draw, hn_diag *diag) {
    *s = (sheet){.p = p, .draw = draw, .diag = diag, .symbolic = is_symbolic(p)};
    const cJSON *states = cJSON_GetObjectItemCaseSensitive(p->node, "states");
    const int n = states || s->symbolic ? STATES : 1;
    HN_TRY(hn_draw_init(draw, states, cJSON_GetObjectItemCaseSensitive(p->node, "conditions"),
                        p->draw, n, p->seed ^ 0x5ca1ab1e, diag));
    if (!hn_unit_parse(hn_part_text(p->node, "unit"), &s->unit)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/unit", NULL, "part %s: no unit '%.40s'",
                           p->id, hn_part_text(p->node, "unit"));
    }
    HN_TRY(read_reference(s, cJSON_GetObjectItemCaseSensitive(p->node, "answer"), NULL,
                          &s->reference));
    return set_tolerance(s);
}

// ---- what the student wrote ----

/// Whether a unit may begin at text[i]: behind a number, a bracket or a blank, never inside a
/// number (the unit "1/s" begins with a digit, and so does the end of "0.11/s").
static bool may_begin_unit(const char *text, size_t i) {
    const bool inside = strchr("0123456789.", text[i - 1]) && strchr("0123456789.", text[i]);
    return !inside && (strchr("0123456789.) ", text[i - 1]) || strncmp(text + i, "°", 2) == 0);
}

/// A formula with a unit behind it, as "2*pi rad/s": the unit is the longest end that is one.
static hn_status read_quantity(sheet *s, const char *text, hn_ex *e, hn_unit *unit, hn_diag *diag) {
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
static int uses_names(const sheet *s, hn_ex e) {
    int uses = 0;
    for (int i = 0; i < s->draw->n_names; i++) {
        uses |= hn_depends_on(s->draw->graph, e, i);
    }
    return uses;
}

/// Reads text as the student wrote it; 0 after it has said why it cannot be read.
static int read_text(sheet *s, const char *text, hn_ex *e, hn_unit *unit, hn_part_result *r) {
    hn_diag diag = {0};
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_status status;

    // a formula, or a number with its unit
    if (s->symbolic) {
        hn_spelling_normalise(&plain, text);
        status = hn_draw_parse(s->draw, hn_strbuf_text(&plain), e, &diag);
    } else {
        status = strlen(text) < MAX_CHARS ? read_quantity(s, text, e, unit, &diag) : HN_ERR_LIMIT;
        if (status != HN_OK) { // once more, in the parser's own spelling
            hn_spelling_normalise(&plain, text);
            status = read_quantity(s, hn_strbuf_text(&plain), e, unit, &diag);
        }
    }

    // the reason, with the slip that is most frequent
    if (status != HN_OK) {
        const int comma = strchr(text, ',') && !s->symbolic;
        hn_part_unreadable(r, "'%.60s' cannot be read: %.160s%s%.80s%s", text, diag.message,
                           diag.hint[0] ? "; " : "", diag.hint,
                           comma ? "; write decimals with a point" : "");
    }
    hn_strbuf_reset(&plain);
    return status == HN_OK;
}

/// The values of one entry; 0 after the result has said what is wrong with it.
static int read_entry(sheet *s, const cJSON *node, double x[HN_DRAW_STATES], hn_ex *e,
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

// ---- mistakes ----

/// 1 when the values are those of `x`, times a factor, at all states.
static int agrees(const sheet *s, int k, const double *given, const double *x, double factor) {
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

static int is_right(const sheet *s, int k, const double *given) {
    for (int i = 0; i < s->draw->n_states; i++) {
        if (!(fabs(given[i] - s->reference.x[k][i]) <= s->allowed[k])) {
            return 0;
        }
    }
    return 1;
}

/// A mistake that the exercise lists, alone or together with a sign.
static hn_status find_listed(sheet *s, int k, const double *given, hn_part_result *r, int *found) {
    const cJSON *fault;
    for (int both = 0; both < 2 && !*found; both++) {
        for (int i = 0; (fault = hn_part_fault_at(s->p, i)) != NULL && !*found; i++) {
            values wrong = {0};
            HN_TRY(read_reference(s, cJSON_GetObjectItemCaseSensitive(fault, "answer"),
                                  &s->reference, &wrong));
            if (!is_right(s, k, wrong.x[k]) && agrees(s, k, given, wrong.x[k], both ? -1 : 1)) {
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
static int find_factor(const sheet *s, int k, const double *given, hn_part_result *r) {
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
static int has_replaced(sheet *s, int k, const double *given, const int *names, int n, double a,
                        double b) {
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
static int find_angles(sheet *s, int k, const double *given, hn_part_result *r) {
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
static int find_names(sheet *s, int k, const double *given, hn_part_result *r) {
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
static int find_entry(const sheet *s, int k, const double *given, hn_part_result *r) {
    for (int j = 0; j < s->reference.n; j++) {
        if (j != k && (agrees(s, k, given, s->reference.x[j], 1) ||
                       agrees(s, k, given, s->reference.x[j], -1))) {
            hn_part_wrong(r, "other-entry", 0.25, "this is entry %d, perhaps with its sign", j + 1);
            return 1;
        }
    }
    return 0;
}

static hn_status explain(sheet *s, int k, const double *given, hn_part_result *r) {
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

// ---- the functions of the kind ----

static void name_entry(const sheet *s, int k, hn_part_result *r) {
    if (s->reference.columns) {
        snprintf(r->name, sizeof r->name, "%d%d", k / s->reference.columns + 1,
                 k % s->reference.columns + 1);
    } else if (s->reference.n > 1) {
        snprintf(r->name, sizeof r->name, "%d", k + 1);
    }
}

static hn_status grade_entry(sheet *s, int k, const cJSON *node, hn_part_result *r) {
    double x[HN_DRAW_STATES];
    hn_ex e;
    *r = (hn_part_result){.mistake = ""};
    name_entry(s, k, r);
    snprintf(r->expected, sizeof r->expected, s->symbolic ? "the formula" : "%.6g %s",
             s->reference.x[k][0], hn_part_text(s->p->node, "unit"));
    if (!read_entry(s, node, x, &e, r)) {
        return HN_OK;
    }
    if (is_right(s, k, x)) {
        hn_part_right(r);
        return HN_OK;
    }
    return explain(s, k, x, r);
}

static hn_status grade_sheet(sheet *s, const cJSON *given, hn_part_result *results, int *n) {
    const cJSON *list[MAX_ENTRIES];
    int columns = 0;
    const int count = given ? flatten(given, list, &columns) : 0;
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
                                     : "the answer needs %d entries",
                          transposed ? s->reference.columns : s->reference.n);
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
    sheet s;
    hn_draw draw;
    hn_status status = open_sheet(&s, p, &draw, diag);
    if (status == HN_OK) {
        status = grade_sheet(&s, given, results, n);
    }
    hn_draw_reset(&draw);
    return status;
}

/// Values as a student would hand them in, in the shape of the reference.
static cJSON *write_answer(const sheet *s, const values *v, const cJSON *shape) {
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
    sheet s;
    hn_draw draw;
    cJSON *out = NULL;
    if (open_sheet(&s, p, &draw, diag) == HN_OK) {
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
    sheet s;
    hn_draw draw;
    cJSON *out = NULL;
    if (!node) {
        return NULL;
    }
    *id = hn_part_text(node, "id");
    if (open_sheet(&s, p, &draw, diag) == HN_OK) {
        values wrong = {0};
        const cJSON *answer = cJSON_GetObjectItemCaseSensitive(node, "answer");
        cJSON *whole = complete(answer, cJSON_GetObjectItemCaseSensitive(p->node, "answer"));
        if (read_reference(&s, answer, &s.reference, &wrong) == HN_OK) {
            out = write_answer(&s, &wrong, whole);
        }
        cJSON_Delete(whole);
    }
    hn_draw_reset(&draw);
    return out;
}

/// The formulas of "second" have the values of the reference.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    sheet s;
    hn_draw draw;
    values second = {0};

    // both forms, each with its values
    const cJSON *node = cJSON_GetObjectItemCaseSensitive(p->node, "second");
    hn_status status = open_sheet(&s, p, &draw, diag);
    if (status == HN_OK && !node) {
        status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                             "part %s has no second form of its answer", p->id);
    }
    status = status == HN_OK ? read_reference(&s, node, &s.reference, &second) : status;

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

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(p->node, "answer");
    const int n = cJSON_IsArray(answer) ? cJSON_GetArraySize(answer) : 0;
    const char *unit = hn_part_text(p->node, "unit");
    const char *what = is_symbolic(p) ? "formula" : "number";

    // how many, and of which kind
    if (n && cJSON_IsArray(answer->child)) {
        hn_strbuf_printf(b, "%d rows of %d formulas in quotes: [[\"...\", ...], ...]", n,
                         cJSON_GetArraySize(answer->child));
    } else if (n) {
        hn_strbuf_printf(b, "a list of %d %ss%s", n, what,
                         is_symbolic(p) ? " in quotes: [\"...\", ...]" : ": [1.2, ...]");
    } else {
        hn_strbuf_printf(b, "a %s%s", what, is_symbolic(p) ? " in quotes" : "");
    }

    // the unit, which may be left out
    hn_strbuf_printf(b, unit[0] ? " in %s, or with its unit: \"1.2 %s\"" : "%s%s", unit,
                     unit[0] ? unit : "");

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
