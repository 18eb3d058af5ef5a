// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/follow_on.h"

#include "grade/parts/part_list.h"
#include "grade/parts/value_entry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// The earlier answers that a formula uses, as bits of the parts, and the formula with their
/// values.
typedef struct formula {
    unsigned used;
    hn_strbuf text;
} formula;

static const char *formula_of(const hn_part *p) {
    return hn_part_text(p->node, "follows");
}

/// The part before part i that is named between braces at `at`; -1: none.
static int find_part(const hn_variant *x, int i, const char *at, size_t n) {
    for (int k = 0; k < i; k++) {
        if (strlen(x->part[k].id) == n && strncmp(x->part[k].id, at, n) == 0) {
            return k;
        }
    }
    return -1;
}

/// Writes the formula of part i with values in place of the parts that it names. False: a name
/// stands for no earlier part, or its value is not there (NaN).
static bool fill_in(const hn_variant *x, int i, const double *value, formula *f) {
    const char *at = formula_of(&x->part[i]);
    f->used = 0;
    hn_strbuf_clear(&f->text);
    for (const char *open; (open = strchr(at, '{')) != NULL;) {
        const size_t n = strcspn(open + 1, "}");
        const int k = find_part(x, i, open + 1, n);
        if (k < 0 || !isfinite(value[k])) {
            return false;
        }
        f->used |= 1u << k;
        hn_strbuf_add_n(&f->text, at, (size_t)(open - at));
        hn_strbuf_printf(&f->text, "(%.17g)", value[k]);
        at = open + n + 2;
    }
    hn_strbuf_add(&f->text, at);
    return f->used != 0 && !f->text.failed;
}

/// The number that was handed in for a part, in the part's unit; NaN: none, or it cannot be read.
static double read_number(const hn_part *p, const cJSON *given) {
    hn_value_sheet s;
    hn_draw draw;
    hn_diag diag = {0};
    hn_part_result r = {.mistake = ""};
    double x[HN_DRAW_STATES] = {0};
    hn_ex e;
    if (p->kind != &hn_part_values || hn_value_is_symbolic(p)) {
        return (double)NAN;
    }
    const bool read = hn_value_open(&s, p, &draw, &diag) == HN_OK && s.reference.n == 1 &&
                      hn_value_entry_read(&s, given, x, &e, &r);
    hn_draw_reset(&draw);
    return read ? x[0] : (double)NAN;
}

/// Returns whether `given` is right where the reference is the formula.
static bool is_right_by(const hn_part *p, const char *text, const cJSON *given) {
    static const char *const DROPPED[] = {"faults", "second", "follows"};
    hn_part other = *p;
    hn_part_result r[HN_PART_RESULTS];
    hn_diag diag = {0};
    int n = 0;
    cJSON *node = cJSON_Duplicate(p->node, 1);
    for (size_t i = 0; i < sizeof DROPPED / sizeof *DROPPED; i++) {
        cJSON_DeleteItemFromObjectCaseSensitive(node, DROPPED[i]);
    }
    cJSON_ReplaceItemInObjectCaseSensitive(node, "answer", cJSON_CreateString(text));
    other.node = node;
    const bool right = p->kind->grade(&other, given, r, &n, &diag) == HN_OK && n == 1 && r[0].right;
    cJSON_Delete(node);
    return right;
}

/// "answer to part c, which is wrong", "answers to parts a and b, which are wrong"
static void name_parts(const hn_variant *x, unsigned parts, char *out, size_t size) {
    const bool several = (parts & (parts - 1)) != 0;
    size_t used = (size_t)snprintf(out, size, several ? "answers to parts" : "answer to part");
    const char *before = " ";
    for (int k = 0; k < x->n_parts && used < size; k++) {
        if (parts >> k & 1) {
            used += (size_t)snprintf(out + used, size - used, "%s%.8s", before, x->part[k].id);
            before = " and ";
        }
    }
    if (used < size) {
        snprintf(out + used, size - used, ", which %s wrong", several ? "are" : "is");
    }
}

/// The parts whose answers in the verdict are wrong.
static unsigned find_wrong(const hn_variant *x, int i, const hn_verdict *v) {
    unsigned wrong = 0;
    for (int e = 0; e < v->n_entries; e++) {
        const int k = find_part(x, i, v->entry[e].name, strlen(v->entry[e].name));
        wrong |= k >= 0 && !v->entry[e].right ? 1u << k : 0;
    }
    return wrong;
}

bool hn_follow_on_find(const hn_variant *x, int i, const cJSON *submission, const hn_verdict *v,
                       hn_part_result *r) {
    double value[HN_GRADE_MAX_PARTS];
    char names[120];
    formula f;
    if (!formula_of(&x->part[i])[0] || r->right || r->unreadable) {
        return false;
    }
    for (int k = 0; k < i; k++) {
        value[k] =
            read_number(&x->part[k], cJSON_GetObjectItemCaseSensitive(submission, x->part[k].id));
    }
    hn_strbuf_init(&f.text);
    bool found = fill_in(x, i, value, &f) && (f.used & find_wrong(x, i, v)) != 0;

    // 0 from 0 shows nothing
    const cJSON *given = cJSON_GetObjectItemCaseSensitive(submission, x->part[i].id);
    found = found && fabs(read_number(&x->part[i], given)) > 0 &&
            is_right_by(&x->part[i], hn_strbuf_text(&f.text), given);
    hn_strbuf_reset(&f.text);
    if (found) {
        name_parts(x, f.used & find_wrong(x, i, v), names, sizeof names);
        hn_part_wrong(r, "follow-on", 1,
                      "computed rightly from your %s: the mistake counts there alone", names);
        r->alone = 0;
        r->likely = false;
    }
    return found;
}

/// Returns whether the formula of part i, with values in place of earlier answers, gives `right`.
static bool gives(const hn_variant *x, int i, const double *value, const cJSON *right) {
    formula f;
    hn_strbuf_init(&f.text);
    const bool is =
        fill_in(x, i, value, &f) && is_right_by(&x->part[i], hn_strbuf_text(&f.text), right);
    hn_strbuf_reset(&f.text);
    return is;
}

hn_status hn_follow_on_prove(const hn_variant *x, int i, hn_diag *diag) {
    const hn_part *p = &x->part[i];
    double value[HN_GRADE_MAX_PARTS];
    if (!formula_of(p)[0]) {
        return HN_OK;
    }
    cJSON *right = p->kind->right(p, diag);
    for (int k = 0; k < i; k++) {
        const bool number = x->part[k].kind == &hn_part_values;
        cJSON *other = number ? x->part[k].kind->right(&x->part[k], diag) : NULL;
        value[k] = read_number(&x->part[k], other);
        cJSON_Delete(other);
    }
    const bool same = gives(x, i, value, right);

    // two other sets of answers: one of them may give the same number by chance
    bool moved = false;
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < i; k++) {
            value[k] *= 0.7 + 0.1 * k;
        }
        moved |= !gives(x, i, value, right);
    }
    cJSON_Delete(right);
    if (same && moved) {
        return HN_OK;
    }
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/follows",
                       "{c} stands for the answer to part c, a number", "part %s: \"follows\" %s",
                       p->id,
                       same ? "is the same whatever the earlier answers are"
                            : "is not the answer where the earlier answers are right");
}
