// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/grade.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "expr/print.h"
#include "grade/exam.h"
#include "grade/mistakes.h"
#include "grade/other_variant.h"
#include "grade/parts/comma_list.h"
#include "grade/parts/list_text.h"
#include "grade/parts/read_as.h"
#include "grade/parts/spelling.h"
#include "grade/repeated_member.h"
#include "grade/rubric.h"
#include "grade/submission.h"
#include "grade/submission_text.h"
#include "grade/summary.h"
#include "grade/variant.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 16 };

// ---- one entry ----

static double own_share(const hn_exercise *p, const char *mistake) {
    for (int i = 0; i < p->n_partial; i++) {
        if (strcmp(p->partial[i].key, mistake) == 0) {
            return p->partial[i].value;
        }
    }
    return 0;
}

static double partial_share(const hn_exercise *p, const char *mistake) {
    return hn_rubric_share(p->rubric, mistake, own_share(p, mistake));
}

static void set_mistake(hn_verdict *v, hn_entry_verdict *e, const char *id) {
    e->mistake = id;
    e->points = e->max_points * partial_share(v->problem, id);
}

static const char *find_name(void *exam, const char *name) {
    return hn_exam_name(exam, name);
}

/// Parses the formula in the parser's own spelling; what that was is said where it cannot be read.
static hn_status parse_entry(hn_verdict *v, hn_exam *exam, const char *text, hn_entry_verdict *e,
                             hn_ex *given) {
    hn_diag diag = {0};
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_status status = hn_spelling_normalise(&plain, text, &diag);
    const bool spelt = status == HN_OK;
    const char *formula = hn_strbuf_text(&plain);
    HN_THEN(status, hn_exam_parse(exam, formula, given, &diag));

    if (status == HN_OK) {
        hn_read_as(text, formula, find_name, exam, e->read_as, sizeof e->read_as);
    } else if (status == HN_ERR_INPUT || status == HN_ERR_LIMIT) {
        const bool same = !spelt || strcmp(formula, text) == 0;
        set_mistake(v, e, "unreadable");
        v->n_unreadable++;
        snprintf(e->explanation, sizeof e->explanation,
                 "the formula cannot be read%s%.60s%s: %.180s%s%.110s", same ? "" : " (as ",
                 same ? "" : formula, same ? "" : ")", diag.message, diag.hint[0] ? "; " : "",
                 diag.hint);
    }
    hn_strbuf_reset(&plain);
    return status;
}

/// The formula of an entry; 0 when there is none that can be read.
static bool read_entry(hn_verdict *v, hn_exam *exam, const cJSON *node, hn_entry_verdict *e,
                       hn_ex *given, hn_status *status) {
    const char *text = cJSON_IsString(node) ? node->valuestring : "";
    char number[40];
    if (cJSON_IsNumber(node)) {
        snprintf(number, sizeof number, "%.17g", node->valuedouble);
        text = number;
    }
    snprintf(e->given, sizeof e->given, "%s", text);
    if (strspn(text, " \t\r\n") == strlen(text)) {
        set_mistake(v, e, "blank");
        snprintf(e->explanation, sizeof e->explanation, "nothing was handed in here");
        return false;
    }

    // an unreadable entry is a wrong entry, no failure of the grader
    *status = parse_entry(v, exam, text, e, given);
    if (*status == HN_ERR_INPUT || *status == HN_ERR_LIMIT) {
        *status = HN_OK;
        return false;
    }
    return *status == HN_OK;
}

/// Compares at all states; fills in the closed state where the difference is largest. Returns 1 if
/// right.
static int compare(hn_exam *exam, int index, hn_entry_verdict *e, const double *value) {
    const double *expected = exam->expected[index];
    const double allowed = hn_exam_allowed(exam, exam->size[index]);
    double worst = -1;
    for (int s = 0; s < exam->problem->n_closed; s++) {
        const double difference = isfinite(value[s]) ? fabs(value[s] - expected[s]) : HUGE_VAL;
        if (difference > allowed && difference > worst) {
            worst = difference;
            e->state = s;
            e->given_value = value[s];
            e->expected_value = expected[s];
            e->allowed = allowed;
        }
    }

    // right on closed loops only: still right, and said
    const int right = e->state < 0;
    for (int s = exam->problem->n_closed; s < exam->n_states && right; s++) {
        e->closed_only |= !(fabs(value[s] - expected[s]) <= allowed);
    }
    return right;
}

static void explain(hn_verdict *v, hn_exam *exam, hn_entry_verdict *e, hn_ex given,
                    const double *value) {
    if (!isfinite(e->given_value)) {
        set_mistake(v, e, "not-finite");
        snprintf(e->explanation, sizeof e->explanation,
                 "the formula has no finite value at some states, where the entry has");
        return;
    }
    hn_grade_mistake found = hn_grade_find_mistake(exam, e->row, e->column, given, value);
    set_mistake(v, e, found.id);
    snprintf(e->explanation, sizeof e->explanation, "%s%s%s%s%s%s", found.text,
             found.by[0] ? " (" : "", found.by, found.by[0] ? ")" : "", found.also ? "; and " : "",
             found.also ? found.also : "");
    if (found.second) {
        e->points *= partial_share(v->problem, found.second);
    }
}

/// The hash of wrong values at the states of this seed, by which copies of an entry are found.
static uint64_t hash_values(const hn_exam *exam, const double *value) {
    uint64_t hash = HN_HASH_START;
    for (int s = 0; s < exam->n_states; s++) {
        char digits[32];
        snprintf(digits, sizeof digits, "%.6e", value[s]);
        hash = hn_hash_text(hash, digits);
    }
    return hash;
}

static hn_status grade_entry(hn_verdict *v, hn_exam *exam, const cJSON *node, hn_entry_verdict *e) {
    int index = e->row * v->problem->n_columns + e->column;
    hn_ex given;
    hn_status status = HN_OK;
    double value[HN_GRADE_MAX_STATES];
    if (!read_entry(v, exam, node, e, &given, &status)) {
        return status;
    }

    // the values decide, not the form
    for (int s = 0; s < exam->n_states; s++) {
        value[s] = hn_exam_value(exam, given, s);
    }
    e->right = compare(exam, index, e, value);
    if (!e->right) {
        explain(v, exam, e, given, value);
        hn_spelling_remark_bare(e->given, e->explanation, sizeof e->explanation);
        e->likeness = strcmp(e->mistake, "other") == 0 ? hash_values(exam, value) : 0;
    } else {
        e->points = e->max_points;
    }
    if (e->closed_only) {
        snprintf(e->explanation, sizeof e->explanation,
                 "right wherever the loop is closed, though not the derivative of phi as a "
                 "formula; accepted");
    }
    return hn_graph_failed(exam->graph) ? HN_ERR_MEMORY : HN_OK;
}

// ---- the whole ----

/// 1, and ungradable, when no formula that was handed in can be read.
static bool refuse_unreadable(hn_verdict *v) {
    int handed_in = 0, first = -1;
    for (int k = v->n_entries; k-- > 0;) {
        handed_in += strcmp(v->entry[k].mistake, "blank") != 0;
        first = strcmp(v->entry[k].mistake, "unreadable") == 0 ? k : first;
    }
    if (v->n_unreadable == 0 || v->n_unreadable < handed_in) {
        return false;
    }
    hn_submission_refuse(v, v->entry[first].explanation, "none of the %d formulas can be read (%s)",
                         v->n_unreadable, v->entry[first].name);
    return true;
}

/// The whole matrix handed in transposed: each right entry earns its share.
static void mark_transposed(hn_verdict *v) {
    for (int k = 0; k < v->n_entries; k++) {
        hn_entry_verdict *e = &v->entry[k];
        if (e->right) {
            e->points = e->max_points * partial_share(v->problem, "transposed");
            e->mistake = "transposed";
            snprintf(e->explanation, sizeof e->explanation, "right, but in the transposed place");
        }
    }
    snprintf(v->summary, sizeof v->summary,
             "the matrix is transposed (%d rows of %d): one row for each equation, one column for "
             "each coordinate; %d of %d entries would be right",
             v->problem->n_columns, v->problem->n_rows, v->n_right, v->n_entries);
}

static void show_state(hn_verdict *v, const hn_exam *exam) {
    const hn_exercise *p = v->problem;
    v->shown_entry = -1;
    v->n_names = p->n_names;
    v->n_params = p->n_params;
    for (int k = v->n_entries; k-- > 0;) {
        hn_entry_verdict *e = &v->entry[k];
        if (e->state >= 0) {
            v->shown_entry = k;
            memcpy(e->at, exam->state[e->state], sizeof e->at);
        }
    }
    for (int i = 0; i < p->n_names && v->shown_entry >= 0; i++) {
        v->names[i] = p->names[i].name;
        v->values[i] = v->entry[v->shown_entry].at[i];
    }
}

static void begin_entry(hn_verdict *v, const hn_exam *exam, int k) {
    const hn_exercise *p = v->problem;
    hn_entry_verdict *e = &v->entry[k];
    *e = (hn_entry_verdict){.row = k / p->n_columns,
                            .column = k % p->n_columns,
                            .max_points = p->points,
                            .mistake = "",
                            .state = -1};
    snprintf(e->name, sizeof e->name, "%.8s%d%d", p->answer, e->row + 1, e->column + 1);
    e->n_whole = (int)strnlen(p->answer, 8);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_print(&b, exam->graph, exam->reference[k], HN_PRINT_TEXT, 0);
    snprintf(e->expected, sizeof e->expected, "%s", hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}

static hn_status grade_matrix(hn_verdict *v, hn_exam *exam, const cJSON *answer, bool transposed) {
    const hn_exercise *p = v->problem;
    v->n_entries = p->n_rows * p->n_columns;
    v->n_states = p->n_closed;

    for (int k = 0; k < v->n_entries; k++) {
        int i = k / p->n_columns, j = k % p->n_columns;
        const cJSON *node =
            cJSON_GetArrayItem(cJSON_GetArrayItem(answer, transposed ? j : i), transposed ? i : j);
        if (hn_interrupt_ask(&p->interrupt)) {
            return HN_ERR_STOPPED;
        }
        begin_entry(v, exam, k);
        HN_TRY(grade_entry(v, exam, node, &v->entry[k]));
        v->n_right += v->entry[k].right;
    }

    hn_submission_remark_read_as(v);

    // one sentence on the whole, then the points
    if (refuse_unreadable(v)) {
        return HN_OK;
    }
    hn_summary_write(v);
    if (transposed) {
        mark_transposed(v);
    }
    for (int k = 0; k < v->n_entries; k++) {
        v->score += v->entry[k].points;
    }
    show_state(v, exam);
    return HN_OK;
}

/// A reference that its second way does not confirm grades nobody: the exercise is at fault.
static hn_status prove_parts(const hn_variant *x, hn_diag *diag) {
    for (int i = 0; i < x->n_parts; i++) {
        const hn_part *p = &x->part[i];
        hn_diag why = {0};
        const hn_status status = p->kind->prove ? p->kind->prove(p, &why) : HN_OK;
        if (hn_interrupt_ask(&p->interrupt)) {
            return HN_ERR_STOPPED;
        }
        if (status != HN_OK) {
            return hn_diag_set(diag, status, "/parts", "problem --check tries every variant",
                               "the exercise is wrong in its part %.20s: %.200s", p->id,
                               hn_part_without_name(p->id, why.message));
        }
    }
    return HN_OK;
}

/// An exercise of form 2.
static hn_status grade_parts(hn_verdict *v, const cJSON *root) {
    hn_variant *x = malloc(sizeof *x);
    hn_diag diag = {0};
    hn_status status = x ? hn_variant_init(x, v->problem, v->seed, &diag) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = prove_parts(x, &diag);
    }
    if (status == HN_OK) {
        status = hn_variant_grade(x, root, v, &diag);
    }
    if (status == HN_OK && v->kind == HN_VERDICT_GRADED) {
        hn_other_variant_say(x, root, v);
        status = hn_interrupt_ask(&v->problem->interrupt) ? HN_ERR_STOPPED : HN_OK;
    }
    if (x) {
        hn_variant_reset(x);
    }
    free(x);
    if (status != HN_OK && status != HN_ERR_MEMORY &&
        status != HN_ERR_STOPPED) { // the exercise is at fault, not the student
        snprintf(v->reason, sizeof v->reason, "%.390s", diag.message);
        status = HN_ERR_INTERNAL;
    }
    return status;
}

/// Replaces texts that hold as many numbers with decimal commas as their part asks for by lists.
/// Returns how many; name: that of the first one.
static int expand_comma_lists(const hn_exercise *p, cJSON *root, char *name, size_t size) {
    int n = 0;
    for (int i = 0; i < p->n_parts && cJSON_IsObject(root); i++) {
        const char *id = p->parts[i].id;
        const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, id));
        cJSON *list = text ? hn_comma_list_read(text, hn_part_numbers_asked(&p->parts[i])) : NULL;
        if (list && cJSON_ReplaceItemInObjectCaseSensitive(root, id, list)) {
            snprintf(name, n ? 0 : size, "%s", id);
            n++;
        }
    }
    return n;
}

/// Reads matrices and lists that were pasted as one text, with a remark.
static void expand_lists(hn_verdict *v, cJSON *root) {
    char name[40], other[40], more[40] = "";
    int n_empty, n = expand_comma_lists(v->problem, root, name, sizeof name);
    const int n_others = hn_list_text_expand(root, n ? other : name, sizeof name, &n_empty);
    n += n_others;
    if (n > 1) {
        snprintf(more, sizeof more, ", and %d more likewise", n - 1);
    }
    if (n > 0) {
        hn_submission_remark(v, "the text of '%s' was read as a list%s", name, more);
    }
    if (n_empty > 0) {
        hn_submission_remark(v, "nothing stands at %d place%s of it: write each entry, or 0",
                             n_empty, n_empty == 1 ? "" : "s");
    }
}

/// `chosen`: the seed is the caller's.
static hn_status grade_tree(hn_verdict *v, cJSON *root, bool chosen) {
    expand_lists(v, root);
    if (!hn_submission_read_student(v, root, chosen)) {
        return v->kind == HN_VERDICT_UNGRADABLE ? HN_OK : HN_ERR_MEMORY;
    }
    const char *student = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, "student"));
    snprintf(v->student, sizeof v->student, "%s", student ? student : "");

    // the file's own variant where the caller leaves it open
    const uint64_t said = chosen ? 0 : hn_variant_seed_said(v->problem, root);
    v->seed = said ? said : v->seed;
    v->unnamed = chosen && hn_variant_seed_said(v->problem, root) == 0;
    if (!chosen && !hn_variant_check_names(v->problem, root, v)) {
        return HN_OK;
    }
    if (!chosen && !said && v->problem->n_parts) {
        hn_submission_remark_nobody(v);
    }
    if (v->problem->n_parts) {
        return grade_parts(v, root);
    }
    const cJSON *answer;
    int transposed;
    if (!hn_submission_read(v, root, &answer, &transposed)) {
        return HN_OK;
    }
    hn_exam *exam = malloc(sizeof *exam);
    hn_status status = exam ? hn_exam_init(exam, v->problem, v->seed, NULL) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = grade_matrix(v, exam, answer, transposed);
    } else if (status != HN_ERR_MEMORY) {
        status = HN_ERR_INTERNAL; // the exercise was sound when it was loaded
    }

    if (exam) {
        hn_exam_reset(exam);
    }
    free(exam);
    return status;
}

static void begin(hn_verdict *v, const hn_exercise *problem, uint64_t seed) {
    memset(v, 0, sizeof *v);
    v->problem = problem;
    v->seed = seed ? seed : problem->seed;
    v->max_score = hn_exercise_points(problem);
    v->shown_entry = -1;
}

/// Keeps what reproduces the verdict: the hash of the submission, and the submission if short.
static void keep_submission(hn_verdict *v, const char *text, size_t n) {
    v->submission_hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, text, n));
    if (n < sizeof v->submission) {
        memcpy(v->submission, text, n);
        v->submission[n] = 0;
    }
}

/// Refuses text that is not JSON. One that does not even begin like an object or a list is another
/// kind of file: a hint on its first character would mislead.
static void refuse_text(hn_verdict *v, const char *json, const hn_diag *diag) {
    const char *first = json + strspn(json, " \t\r\n");
    if (!*first || strchr("{[", *first)) {
        hn_submission_refuse(v, diag->hint, "the submission is not JSON: %s", diag->message);
        return;
    }
    char hint[160], begins[24] = "";
    if (*first > 0x20 && *first < 0x7F) {
        snprintf(begins, sizeof begins, ": it begins with '%c'", *first);
    }
    snprintf(hint, sizeof hint,
             "hand in a JSON file, which begins with '{'; 'holonom problem %.60s' shows the form",
             v->problem->id);
    hn_submission_refuse(v, hint, "the submission is not JSON%s", begins);
}

/// Drops members that repeat another one, with a remark; refuses objects too large to compare them.
static bool check_members(hn_verdict *v, cJSON *root) {
    const int most = hn_repeated_member_count(root);
    if (most > HN_REPEATED_MEMBER_MOST) {
        return hn_submission_refuse(v, "a submission has a member for each part",
                                    "an object has %d members; at most %d are read", most,
                                    HN_REPEATED_MEMBER_MOST);
    }
    const int dropped = hn_repeated_member_drop(root);
    if (dropped > 0) {
        hn_submission_remark(v, "fields that repeat another one with the same value: %d", dropped);
    }
    return true;
}

/// Grades text in UTF-8 after its slips of JSON are put right, with a remark.
static hn_status grade_text(hn_verdict *v, const char *text, size_t n, bool chosen) {
    hn_strbuf mended;
    hn_diag diag = {0};
    int commas, backslashes;
    hn_strbuf_init(&mended);
    hn_submission_mend(&mended, text, n, &commas, &backslashes);
    if (commas) {
        hn_submission_remark(v, "commas before a closing bracket were left out: %d", commas);
    }
    if (backslashes) {
        hn_submission_remark(
            v, "single backslashes were read as LaTeX: %d (in JSON write two, as \\\\theta)",
            backslashes);
    }

    // the text is checked before a parser sees it
    hn_status status = mended.failed ? HN_ERR_MEMORY : HN_OK;
    const char *json = hn_strbuf_text(&mended);
    if (status == HN_OK && hn_json_text_check(json, mended.n, MAX_DEPTH, &diag) != HN_OK) {
        refuse_text(v, json, &diag);
    } else if (status == HN_OK) {
        cJSON *root = cJSON_ParseWithLength(json, mended.n);
        status = root ? HN_OK : HN_ERR_MEMORY;
        if (root && check_members(v, root)) {
            status = grade_tree(v, root, chosen);
        }
        cJSON_Delete(root);
    }
    hn_strbuf_reset(&mended);
    return status;
}

hn_status hn_grade_json(const hn_exercise *problem, const char *text, size_t n, uint64_t seed,
                        hn_verdict *out) {
    HN_ASSERT(problem && out && (text || n == 0));
    begin(out, problem, seed);
    if (n > HN_GRADE_MAX_BYTES) {
        hn_submission_refuse(out, NULL, "the submission has more than the %d bytes allowed",
                             HN_GRADE_MAX_BYTES);
        return HN_OK;
    }

    // what is kept, and what its hash is of, is the text, whatever its encoding
    hn_strbuf plain;
    bool utf16;
    hn_strbuf_init(&plain);
    hn_status status = hn_submission_decode(&plain, text, n, &utf16);
    if (status == HN_ERR_INPUT) {
        hn_submission_refuse(out, "save it as UTF-8", "the submission is broken UTF-16");
        status = HN_OK;
    } else if (status == HN_OK) {
        keep_submission(out, hn_strbuf_text(&plain), plain.n);
        if (utf16) {
            hn_submission_remark(out, "the file is UTF-16; UTF-8 is the encoding of JSON");
        }
        status = grade_text(out, hn_strbuf_text(&plain), plain.n, seed != 0);
    }
    hn_strbuf_reset(&plain);
    return status;
}

/// Standard input under one of its names. Other pipes are refused: nobody may be at their end.
static bool is_stdin(const char *path) {
    return strcmp(path, "-") == 0 || strcmp(path, "/dev/stdin") == 0 ||
           strcmp(path, "/dev/fd/0") == 0 || strcmp(path, "/proc/self/fd/0") == 0;
}

static hn_status read_stdin(hn_strbuf *text, hn_diag *diag) {
    hn_diags diags = {0};
    const hn_status status = hn_file_read_stdin(HN_GRADE_MAX_BYTES, text, &diags);
    if (diags.n > 0) {
        *diag = diags.item[0];
    }
    return status;
}

hn_status hn_grade_file(const hn_exercise *problem, const char *path, uint64_t seed,
                        hn_verdict *out) {
    HN_ASSERT(problem && path && out);
    begin(out, problem, seed);
    hn_diag diag = {0};
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = is_stdin(path) ? read_stdin(&text, &diag)
                                      : hn_file_read(path, HN_GRADE_MAX_BYTES, &text, &diag);
    if (status == HN_OK) {
        status = hn_grade_json(problem, hn_strbuf_text(&text), text.n, seed, out);
    } else if (status != HN_ERR_MEMORY) {
        hn_submission_refuse(out, diag.hint, "%s", diag.message);
        status = HN_OK;
    }
    hn_strbuf_reset(&text);
    return status;
}
