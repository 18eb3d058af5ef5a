// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise_check.h"

#include "base/hash.h"
#include "expr/print.h"
#include "grade/exam.h"
#include "grade/follow_on.h"
#include "grade/grade.h"
#include "grade/parts/value_sheet.h"
#include "grade/variant.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SEEDS = 100000 };

/// The variant under test.
typedef struct trial {
    hn_variant variant;
    hn_exercise_report *report;
    int good;
    char first[2 * HN_GRADE_TEXT]; ///< what is wrong with this variant, "" if nothing
} trial;

static void complain(trial *t, const char *part, const char *format, ...) HN_PRINTF(3, 4);

static void complain(trial *t, const char *part, const char *format, ...) {
    t->good = 0;
    if (!t->first[0]) {
        char text[HN_GRADE_TEXT];
        va_list list;
        va_start(list, format);
        vsnprintf(text, sizeof text, format, list);
        va_end(list);
        snprintf(t->first, sizeof t->first, "seed %llu%s%s: %s",
                 (unsigned long long)t->variant.seed, part[0] ? ", part " : "", part,
                 hn_part_without_name(part, text));
    }
}

/// Complains of what stands in the file, with its line. `i`: index of a part, -1: none.
static void complain_of_file(trial *t, int i, const hn_diag *diag) {
    const hn_exercise *e = t->variant.exercise;
    const char *part = i >= 0 ? t->variant.part[i].id : "";
    complain(t, part, "%.300s (line %d of the file)", hn_part_without_name(part, diag->message),
             hn_exercise_line(e, i, diag->pointer));
}

/// Returns what a line of the list says behind its seed.
static const char *behind_seed(const char *line) {
    return line + strcspn(line, ",:");
}

/// The end of a number, or of a letter in quotes, that begins at `at`; `at` itself: none does.
static const char *skip_varied(const char *at) {
    if (at[0] == '"' && isalpha((unsigned char)at[1]) && at[2] == '"') {
        return at + 3;
    }
    const char *digits = at + (*at == '-');
    return isdigit((unsigned char)*digits) ? digits + strspn(digits, "0123456789.e+-") : at;
}

/// Returns whether two lines differ by their numbers and by the letters of options alone.
static bool are_alike(const char *a, const char *b) {
    while (*a && *b) {
        const char *behind_a = skip_varied(a), *behind_b = skip_varied(b);
        if ((behind_a > a) != (behind_b > b) || (behind_a == a && *a != *b)) {
            return false;
        }
        a = behind_a > a ? behind_a : a + 1;
        b = behind_b > b ? behind_b : b + 1;
    }
    return *a == *b;
}

/// Puts one line in the place of many where every variant has the same fault; where its numbers
/// differ, that of the first variant.
static void join_list(hn_exercise_report *r) {
    if (r->same && r->bad > 1 && r->bad == r->variants) {
        snprintf(r->list, sizeof r->list, r->varied ? "every seed; %s\n" : "every seed%s\n",
                 r->varied ? r->first : behind_seed(r->first));
    }
}

/// Counts a variant; a bad one stands in the list as long as its line fits.
static void end_trial(const trial *t) {
    hn_exercise_report *r = t->report;
    const char *one = behind_seed(r->first), *other = behind_seed(t->first);
    r->same = r->variants == 0 || (r->same && are_alike(one, other));
    r->varied |= r->variants > 0 && strcmp(one, other) != 0;
    r->variants++;
    r->bad += !t->good;
    if (!r->first[0]) {
        memcpy(r->first, t->first, sizeof r->first);
    }
    const size_t used = strlen(r->list), n = strlen(t->first);
    if (!t->good && used + n + 2 <= sizeof r->list) {
        snprintf(r->list + used, sizeof r->list - used, "%s\n", t->first);
    }
}

/// Notes how the right answers of a part differ from variant to variant.
static void note_answer(hn_answer_spread *s, const cJSON *answer) {
    const cJSON *m;
    if (cJSON_IsNumber(answer)) {
        const double x = answer->valuedouble;
        s->low = s->n > 0 ? fmin(s->low, x) : x;
        s->high = s->n > 0 ? fmax(s->high, x) : x;
        s->n++;
    } else if (cJSON_IsArray(answer)) {
        cJSON_ArrayForEach(m, answer) {
            note_answer(s, m);
        }
    }
}

/// Notes by how much both means of a reference differ; NaN: that was not measured.
static void note_difference(hn_answer_spread *s, double apart) {
    if (!isnan(apart)) {
        s->apart = fmax(s->apart, apart);
        s->measured++;
    }
}

/// The right answer of a part gets every point.
static hn_status try_right(trial *t, const hn_part *p) {
    hn_part_result results[HN_PART_RESULTS];
    hn_diag diag = {0};
    int n = 0;

    // the answer that the exercise itself gives
    cJSON *answer = p->kind->right(p, &diag);
    if (!answer) {
        hn_diag none = diag;
        hn_diag_set(&none, HN_ERR_INPUT, diag.pointer, NULL, "there is no right answer: %s",
                    hn_part_without_name(p->id, diag.message));
        complain_of_file(t, (int)(p - t->variant.part), &none);
        return HN_OK;
    }
    t->report->rights++;
    hn_answer_spread *spread = &t->report->spread[p - t->variant.part];
    note_answer(spread, answer);
    note_difference(spread, hn_value_worst_difference(p));

    // graded as a student's, it must pass in every entry
    const hn_status status = p->kind->grade(p, answer, results, &n, &diag);
    for (int i = 0; i < n && status == HN_OK; i++) {
        if (!results[i].right) {
            complain(t, p->id, "the reference is not accepted (%s): %s", results[i].mistake,
                     results[i].explanation);
        }
    }
    if (status != HN_OK) {
        complain(t, p->id, "%s", diag.message);
    }
    cJSON_Delete(answer);
    return status == HN_ERR_MEMORY ? status : HN_OK;
}

/// A listed mistake is named. One id may stand for several answers, and an answer that two ids
/// give is named by the first.
static hn_status try_fault(trial *t, const hn_part *p, const cJSON *answer, const char *id) {
    hn_part_result results[HN_PART_RESULTS];
    hn_diag diag = {0};
    int n = 0, named = 0, wrong = 0;

    // graded as if a student had handed it in
    t->report->faults++;
    const hn_status status = p->kind->grade(p, answer, results, &n, &diag);
    if (status != HN_OK) {
        complain(t, p->id, "%s", diag.message);
        return status == HN_ERR_MEMORY ? status : HN_OK;
    }

    // an entry may be wrong under another name, or not at all
    for (int i = 0; i < n; i++) {
        wrong += !results[i].right;
        named += !results[i].right && strcmp(results[i].mistake, id) == 0;
    }

    // the author sees the answer, and what it was taken for
    if (!named) {
        char *text = cJSON_PrintUnformatted(answer);
        complain(t, p->id, "the mistake '%s' (%.150s) is %s%s", id, text ? text : "",
                 wrong ? "named " : "taken for right", wrong ? results[0].mistake : "");
        free(text);
    }
    return HN_OK;
}

static hn_status try_faults(trial *t, const hn_part *p) {
    const char *id = "";
    hn_diag diag = {0};
    cJSON *answer;
    hn_status status = HN_OK;
    for (int i = 0; status == HN_OK && (answer = p->kind->fault(p, i, &id, &diag)) != NULL; i++) {
        if (id[0]) {
            status = try_fault(t, p, answer, id);
        }
        cJSON_Delete(answer);
    }
    return status;
}

/// Every check of an example or a scene has a listed mistake that it finds: one that nothing
/// triggers may be wrong itself.
static void try_checks(trial *t, const hn_part *p) {
    const cJSON *check, *fault;
    cJSON_ArrayForEach(check, cJSON_GetObjectItemCaseSensitive(p->node, "checks")) {
        const char *id = hn_part_text(check, "id");
        bool listed = false;
        cJSON_ArrayForEach(fault, cJSON_GetObjectItemCaseSensitive(p->node, "faults")) {
            listed |= strcmp(hn_part_text(fault, "id"), id) == 0;
        }
        if (!listed) {
            complain(t, p->id, "no listed mistake triggers the check '%s': add one to \"faults\"",
                     id);
        }
    }
}

/// A name in braces that is no number of the variant, most likely a slip of the pen. `nodes`: a
/// text, or a list of texts or of objects with a text.
static void try_text(trial *t, int part, const cJSON *nodes, const char *pointer) {
    char word[80];
    int k = 0;
    const cJSON *list = cJSON_IsArray(nodes) ? nodes->child : nodes;
    for (const cJSON *m = list; m; m = cJSON_IsArray(nodes) ? m->next : NULL, k++) {
        const char *text = cJSON_IsObject(m) ? hn_part_text(m, "text") : cJSON_GetStringValue(m);
        if (text && hn_draw_find_unknown(&t->variant.draw, text, word, sizeof word)) {
            hn_diag diag = {0};
            char where[HN_DIAG_POINTER];
            snprintf(where, sizeof where, cJSON_IsArray(nodes) ? "%s/%d" : "%s", pointer, k);
            hn_diag_set(&diag, HN_ERR_INPUT, where, NULL,
                        word[0] == '=' ? "{%s} is no formula of the numbers that are drawn"
                                       : "{%s} is no number that is drawn",
                        word);
            complain_of_file(t, part, &diag);
        }
    }
}

/// The texts that a student reads.
static void try_texts(trial *t) {
    const cJSON *root = t->variant.exercise->root;
    try_text(t, -1, cJSON_GetObjectItemCaseSensitive(root, "statement"), "/statement");
    try_text(t, -1, cJSON_GetObjectItemCaseSensitive(root, "hints"), "/hints");
    for (int i = 0; i < t->variant.n_parts; i++) {
        const cJSON *node = t->variant.part[i].node;
        try_text(t, i, cJSON_GetObjectItemCaseSensitive(node, "ask"), "/parts/ask");
        try_text(t, i, cJSON_GetObjectItemCaseSensitive(node, "options"), "/parts/options");
        try_text(t, i, cJSON_GetObjectItemCaseSensitive(node, "reasons"), "/parts/reasons");
    }
}

static hn_status try_part(trial *t, const hn_part *p) {
    hn_diag diag = {0};
    try_checks(t, p);
    if (p->kind->prove && p->kind->prove(p, &diag) != HN_OK) {
        complain_of_file(t, (int)(p - t->variant.part), &diag);
    }
    if (hn_follow_on_prove(&t->variant, (int)(p - t->variant.part), &diag) != HN_OK) {
        complain_of_file(t, (int)(p - t->variant.part), &diag);
    }
    HN_TRY(try_right(t, p));
    return try_faults(t, p);
}

/// A hash of the numbers of a variant, and of the order of its options.
static uint64_t hash_of(const hn_variant *x) {
    uint64_t hash = HN_HASH_START;
    for (int i = 0; i < x->draw.n_names; i++) {
        hash = hn_hash_double(hash, x->draw.value[0][i]);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (int i = 0; i < x->n_parts; i++) {
        x->part[i].kind->ask(&b, &x->part[i]);
    }
    hash = hn_hash_bytes(hash, hn_strbuf_text(&b), b.n);
    hn_strbuf_reset(&b);
    return hn_hash_mix(hash);
}

static int compare_hashes(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/// Returns how many hashes differ; 0 is that of a variant that could not be drawn.
static long long count_distinct(uint64_t *hashes, long long n) {
    qsort(hashes, (size_t)n, sizeof *hashes, compare_hashes);
    long long distinct = 0;
    for (long long i = 0; i < n; i++) {
        distinct += hashes[i] != 0 && (i == 0 || hashes[i] != hashes[i - 1]);
    }
    return distinct;
}

// ---- a matrix of formulas ----

/// Central differences of phi agree with the derivative at every state.
static void try_differences(trial *t, hn_exam *exam) {
    static const double STEP = 1e-5; // the error of a central difference is then about 1e-10
    const hn_exercise *e = exam->problem;
    for (int k = 0; k < e->n_rows * e->n_columns; k++) {
        const int name = hn_graph_find_symbol(exam->graph, e->by[k % e->n_columns]);
        for (int s = 0; s < exam->n_states; s++) {
            double *x = &exam->state[s][name];
            const double middle = *x;
            *x = middle + STEP;
            const double above = hn_exam_value(exam, exam->phi[k / e->n_columns], s);
            *x = middle - STEP;
            const double below = hn_exam_value(exam, exam->phi[k / e->n_columns], s);
            *x = middle;
            const double apart =
                fabs((above - below) / (2 * STEP) - exam->expected[k][s]) / (1 + exam->size[k]);
            note_difference(&t->report->spread[0], apart);
            if (!(apart <= 1e-7)) {
                complain(t, e->answer,
                         "entry %d: the derivative and a difference of phi do not "
                         "agree",
                         k + 1);
                return;
            }
        }
    }
}

/// The reference as a submission, its k-th entry turned round by its sign (k = -1: none).
static void write_reference(hn_strbuf *b, hn_exam *exam, int turned) {
    const hn_exercise *e = exam->problem;
    hn_strbuf_printf(b, "{\"%s\": [", e->answer);
    for (int k = 0; k < e->n_rows * e->n_columns; k++) {
        const int column = k % e->n_columns;
        hn_strbuf_printf(b, "%s\"%s(", column ? ", " : k ? ", [" : "[", k == turned ? "-" : "");
        hn_print(b, exam->graph, exam->reference[k], HN_PRINT_TEXT, 0);
        hn_strbuf_add(b, column == e->n_columns - 1 ? ")\"]" : ")\"");
    }
    hn_strbuf_add(b, "]}");
}

/// The reference is accepted, and a wrong sign in any entry is named.
static hn_status try_matrix(trial *t, hn_exam *exam, uint64_t seed) {
    const hn_exercise *e = exam->problem;
    hn_verdict *v = calloc(1, sizeof *v);
    hn_status status = v ? HN_OK : HN_ERR_MEMORY;
    try_differences(t, exam);
    for (int k = -1; k < e->n_rows * e->n_columns && status == HN_OK; k++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        write_reference(&b, exam, k);
        status = b.failed ? HN_ERR_MEMORY : hn_grade_json(e, hn_strbuf_text(&b), b.n, seed, v);
        const bool zero = k >= 0 && exam->size[k] <= e->absolute;
        if (k < 0) {
            t->report->rights++;
            if (status == HN_OK && v->n_right != v->n_entries) {
                complain(t, e->answer, "the reference is not accepted: %s", v->summary);
            }
        } else if (!zero) {
            t->report->faults++;
            if (status == HN_OK && strcmp(v->entry[k].mistake, "sign") != 0) {
                complain(t, v->entry[k].name, "a wrong sign is named '%s'", v->entry[k].mistake);
            }
        }
        hn_strbuf_reset(&b);
    }
    free(v);
    return status == HN_ERR_MEMORY ? status : HN_OK;
}

static hn_status try_matrix_seed(const hn_exercise *exercise, uint64_t seed, uint64_t *hash,
                                 hn_exercise_report *out) {
    trial t = {.report = out, .good = 1, .variant = {.seed = seed}};
    hn_diag diag = {0};
    hn_exam *exam = malloc(sizeof *exam);
    hn_status status = exam ? hn_exam_init(exam, exercise, seed, &diag) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        *hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, exam->state[0], sizeof exam->state[0]));
        status = try_matrix(&t, exam, seed);
    } else if (status != HN_ERR_MEMORY) {
        complain(&t, "", "%s", diag.message);
        status = HN_OK;
    }
    end_trial(&t);
    if (exam) {
        hn_exam_reset(exam);
    }
    free(exam);
    return status;
}

static hn_status try_seed(const hn_exercise *exercise, uint64_t seed, uint64_t *hash,
                          hn_exercise_report *out) {
    trial t = {.report = out, .good = 1};
    hn_diag diag = {0};
    hn_status status = hn_variant_init(&t.variant, exercise, seed, &diag);
    if (status == HN_OK) {
        *hash = hash_of(&t.variant);
        for (int k = 0; k < HN_DRAW_CONDITIONS; k++) {
            out->refused[k] += t.variant.draw.refused[k];
        }
        try_texts(&t);
        for (int i = 0; i < t.variant.n_parts && status == HN_OK; i++) {
            status = try_part(&t, &t.variant.part[i]);
        }
    } else {
        t.variant.exercise = exercise;
        complain_of_file(&t, -1, &diag);
        status = status == HN_ERR_MEMORY ? status : HN_OK;
    }
    end_trial(&t);
    hn_variant_reset(&t.variant);
    return status;
}

hn_status hn_exercise_check(const hn_exercise *exercise, uint64_t from, uint64_t to,
                            hn_exercise_report *out) {
    memset(out, 0, sizeof *out);
    const uint64_t n = to - from + 1 < MAX_SEEDS ? to - from + 1 : MAX_SEEDS;
    uint64_t *hashes = calloc(n, sizeof *hashes);
    hn_status status = hashes ? HN_OK : HN_ERR_MEMORY;
    for (uint64_t i = 0; i < n && status == HN_OK; i++) {
        status =
            (exercise->n_parts ? try_seed : try_matrix_seed)(exercise, from + i, &hashes[i], out);
    }
    join_list(out);
    out->distinct = hashes ? count_distinct(hashes, out->variants) : 0;
    free(hashes);
    return status;
}
