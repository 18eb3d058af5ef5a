// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/exercise.h"

#include "base/file.h"
#include "base/paragraphs.h"
#include "grade/exercise_shelf.h"
#include "grade/exercise_text.h"
#include "grade/grade.h"
#include "grade/variant_text.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = HN_GRADE_MAX_ENTRIES };

typedef struct field {
    char name[32];
    const cJSON *part; ///< of the document; NULL: an entry of a matrix
    char answer[HN_TUI_ANSWER];
} field;

struct hn_tui_exercise {
    hn_exercise *exercise; ///< owned
    cJSON *document;       ///< owned: what the exercise says of itself
    char matrix[32];       ///< name of the matrix that is asked for; "": there are parts
    int n_columns;
    int n_fields, n_hints;
    hn_strbuf notation; ///< how formulas are typed
    field fields[FIELDS];
    hn_verdict *verdict; ///< owned
    bool checked;
};

static const char *text_of(const cJSON *object, const char *name) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
    return text ? text : "";
}

// ---- making ----

static void list_parts(hn_tui_exercise *x, const cJSON *parts) {
    const cJSON *part;
    cJSON_ArrayForEach(part, parts) {
        if (x->n_fields < FIELDS) {
            field *f = &x->fields[x->n_fields++];
            snprintf(f->name, sizeof f->name, "%s", text_of(part, "id"));
            f->part = part;
        }
    }
}

/// The matrix that is asked for, as the shape of the submission has it: {"J": [["...", ...], ...]}.
static void list_entries(hn_tui_exercise *x) {
    cJSON *shape = cJSON_Parse(text_of(x->document, "submission"));
    const cJSON *rows = shape ? shape->child : NULL, *row, *entry;
    int i = 0;
    snprintf(x->matrix, sizeof x->matrix, "%.8s", rows && rows->string ? rows->string : "");
    cJSON_ArrayForEach(row, rows) {
        int k = 0;
        i++;
        x->n_columns = cJSON_GetArraySize(row);
        cJSON_ArrayForEach(entry, row) {
            if (x->n_fields < FIELDS) {
                snprintf(x->fields[x->n_fields++].name, sizeof x->fields->name, "%.8s%d%d",
                         x->matrix, i, ++k);
            }
        }
    }
    cJSON_Delete(shape);
}

static hn_status make(hn_tui_exercise *x, const hn_library *library, const char *id,
                      hn_diags *diags) {
    HN_TRY(hn_shelf_exercise_load(library, id, &x->exercise, diags));
    hn_variant variant = {0};
    hn_diag diag = {0};
    hn_strbuf b;
    hn_status status = HN_OK;
    hn_strbuf_init(&b);
    if (x->exercise->n_parts > 0) {
        status = hn_variant_init(&variant, x->exercise, 0, &diag);
        if (status == HN_OK) {
            hn_variant_json(&b, &variant);
            hn_variant_notation(&x->notation, &variant);
        } else {
            status = hn_diags_add(diags, status, NULL, diag.hint, "%s", diag.message);
        }
        hn_variant_reset(&variant);
    } else {
        hn_exercise_json(&b, x->exercise, 0, NULL);
    }
    x->document = cJSON_Parse(hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
    list_parts(x, cJSON_GetObjectItem(x->document, "parts"));
    if (x->n_fields == 0) {
        list_entries(x);
    }
    x->verdict = calloc(1, sizeof *x->verdict);
    return status != HN_OK || (x->document && x->verdict) ? status : HN_ERR_MEMORY;
}

hn_status hn_tui_exercise_create(const hn_library *library, const char *id, hn_tui_exercise **out,
                                 hn_diags *diags) {
    hn_tui_exercise *x = calloc(1, sizeof *x);
    const hn_status status = x ? make(x, library, id, diags) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        hn_tui_exercise_free(x);
        x = NULL;
    }
    if (status == HN_ERR_MEMORY && diags->n == 0) {
        hn_diags_add(diags, status, NULL, NULL, "out of memory");
    }
    *out = x;
    return status;
}

void hn_tui_exercise_free(hn_tui_exercise *x) {
    if (x) {
        hn_exercise_free(x->exercise);
        cJSON_Delete(x->document);
        hn_strbuf_reset(&x->notation);
        free(x->verdict);
        free(x);
    }
}

// ---- fields ----

const char *hn_tui_exercise_id(const hn_tui_exercise *x) {
    return hn_exercise_id(x->exercise);
}

int hn_tui_exercise_n_fields(const hn_tui_exercise *x) {
    return x->n_fields;
}

const char *hn_tui_exercise_field(const hn_tui_exercise *x, int i) {
    return x->fields[i].name;
}

const char *hn_tui_exercise_answer(const hn_tui_exercise *x, int i) {
    return x->fields[i].answer;
}

void hn_tui_exercise_set_answer(hn_tui_exercise *x, int i, const char *text) {
    snprintf(x->fields[i].answer, sizeof x->fields[i].answer, "%s", text + strspn(text, " "));
    x->checked = false;
}

int hn_tui_exercise_n_hints(const hn_tui_exercise *x) {
    return x->exercise->n_hints;
}

bool hn_tui_exercise_show_hint(hn_tui_exercise *x) {
    const bool more = x->n_hints < x->exercise->n_hints;
    x->n_hints += more;
    return more;
}

const hn_verdict *hn_tui_exercise_verdict(const hn_tui_exercise *x) {
    return x->checked ? x->verdict : NULL;
}

// ---- the check ----

static bool is_choice(const field *f) {
    return strcmp(text_of(f->part, "kind"), "choice") == 0;
}

static bool has_reasons(const field *f) {
    return is_choice(f) && strstr(text_of(f->part, "answer_form"), "because");
}

/// A choice and its reason, as "a b" or "a, b".
static cJSON *read_choice(const char *text) {
    cJSON *both = cJSON_CreateObject();
    char letters[2][2] = {"", ""};
    int n = 0;
    for (; *text && n < 2; text++) {
        if (isalpha((unsigned char)*text)) {
            letters[n++][0] = *text;
        }
    }
    cJSON_AddStringToObject(both, "choice", letters[0]);
    cJSON_AddStringToObject(both, "reason", letters[1]);
    return both;
}

/// Returns whether a number of the value is beyond the largest one: written again it would be null.
static bool has_infinite(const cJSON *value) {
    bool has = cJSON_IsNumber(value) && !isfinite(value->valuedouble);
    const cJSON *child;
    cJSON_ArrayForEach(child, value) {
        has = has || has_infinite(child);
    }
    return has;
}

/// Typed text as a value: JSON where it begins as JSON does and is JSON, else the text itself, as
/// the grader reads it.
static cJSON *read_value(const char *text) {
    const bool like_json = strchr("[{\"+-.", text[0]) || isdigit((unsigned char)text[0]);
    cJSON *value = like_json ? cJSON_ParseWithOpts(text, NULL, true) : NULL;
    if (has_infinite(value)) {
        cJSON_Delete(value);
        value = NULL;
    }
    return value ? value : cJSON_CreateString(text);
}

/// The answer of a field, owned, in *out; NULL where nothing was typed.
static hn_status read_answer(const field *f, cJSON **out, hn_diag *diag) {
    *out = NULL;
    if (f->answer[0] == '@') {
        hn_strbuf text;
        hn_strbuf_init(&text);
        const hn_status status = hn_file_read(f->answer + 1, HN_GRADE_MAX_BYTES, &text, diag);
        *out = status == HN_OK ? read_value(hn_strbuf_text(&text)) : NULL;
        hn_strbuf_reset(&text);
        return status;
    }
    if (f->answer[0]) {
        *out = has_reasons(f) ? read_choice(f->answer) : read_value(f->answer);
    }
    return HN_OK;
}

/// The entries of a matrix, row by row; what was not typed is an empty formula.
static cJSON *matrix_of(const hn_tui_exercise *x) {
    cJSON *rows = cJSON_CreateArray(), *row = NULL;
    for (int i = 0; i < x->n_fields; i++) {
        if (i % x->n_columns == 0) {
            row = cJSON_CreateArray();
            cJSON_AddItemToArray(rows, row);
        }
        cJSON_AddItemToArray(row, cJSON_CreateString(x->fields[i].answer));
    }
    return rows;
}

/// Returns whether an entry of the verdict belongs to a field: "b", "b.2".
static bool is_of(const hn_entry_verdict *e, const field *f) {
    const size_t n = strlen(f->name);
    return strncmp(e->name, f->name, n) == 0 && (e->name[n] == '\0' || e->name[n] == '.');
}

/// Grades the answer of one field, or of all (`only` -1), as `holonom grade` does.
static hn_status grade(const hn_tui_exercise *x, int only, hn_verdict *out, hn_diag *diag) {
    cJSON *submission = cJSON_CreateObject();
    hn_status status = HN_OK;
    if (x->matrix[0]) {
        cJSON_AddItemToObject(submission, x->matrix, matrix_of(x));
    }
    for (int i = 0; i < x->n_fields && !x->matrix[0] && status == HN_OK; i++) {
        if (only >= 0 && i != only) {
            continue;
        }
        cJSON *answer;
        status = read_answer(&x->fields[i], &answer, diag);
        if (answer) {
            cJSON_AddItemToObject(submission, x->fields[i].name, answer);
        }
    }

    char *text = cJSON_PrintUnformatted(submission);
    if (status == HN_OK && !text) {
        status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (status == HN_OK) {
        status = hn_grade_json(x->exercise, text, strlen(text), 0, out);
    }
    cJSON_free(text);
    cJSON_Delete(submission);
    return status;
}

hn_status hn_tui_exercise_check(hn_tui_exercise *x, hn_diag *diag) {
    const hn_status status = grade(x, -1, x->verdict, diag);
    x->checked = status == HN_OK;
    return status;
}

bool hn_tui_exercise_is_unreadable(const hn_tui_exercise *x, int i, char why[HN_GRADE_TEXT]) {
    hn_verdict *v = calloc(1, sizeof *v);
    hn_diag diag = {0};
    why[0] = '\0';
    if (v && x->fields[i].answer[0] && grade(x, i, v, &diag) == HN_OK) {
        for (int k = 0; k < v->n_entries && !why[0]; k++) {
            const hn_entry_verdict *e = &v->entry[k];
            if (is_of(e, &x->fields[i]) && strcmp(e->mistake, "unreadable") == 0) {
                snprintf(why, HN_GRADE_TEXT, "%s", e->explanation);
            }
        }
    }
    free(v);
    return why[0] != '\0';
}

// ---- what there is to read ----

static int count_lines(const hn_strbuf *b) {
    int n = 0;
    for (const char *c = hn_strbuf_text(b); *c; c++) {
        n += *c == '\n';
    }
    return n;
}

/// Adds a text with one word left out wherever it stands.
static void add_without(hn_strbuf *b, const char *text, const char *word) {
    const size_t n = strlen(word);
    for (const char *at = strstr(text, word); at; at = strstr(text, word)) {
        hn_strbuf_add_n(b, text, (size_t)(at - text));
        text = at + n;
    }
    hn_strbuf_add(b, text);
}

/// Writes how an answer is typed: quotes belong to files of answers.
static void add_form(hn_strbuf *b, const field *f) {
    const char *form = text_of(f->part, "answer_form");
    hn_strbuf_add(b, "  answer: ");
    if (has_reasons(f)) {
        hn_strbuf_printf(b, "a letter, a blank, the letter of the reason%s",
                         form + strcspn(form, "\n"));
    } else if (is_choice(f)) {
        hn_strbuf_printf(b, "a letter%s", form + strcspn(form, "\n"));
    } else {
        add_without(b, form, " in quotes");
    }
    hn_strbuf_add(b, "\n");
    const char *figure = text_of(cJSON_GetObjectItem(f->part, "figure"), "text");
    hn_strbuf_printf(b, "%s%s", figure[0] ? "\n" : "", figure);
}

/// The points that a field earns, of so many.
static double points_of(const hn_verdict *v, const field *f, double *most) {
    double points = 0;
    *most = 0;
    for (int i = 0; i < v->n_entries; i++) {
        if (is_of(&v->entry[i], f)) {
            points += v->entry[i].points;
            *most += v->entry[i].max_points;
        }
    }
    return points;
}

void hn_tui_exercise_summary(const hn_tui_exercise *x, char out[HN_GRADE_TEXT]) {
    const hn_verdict *v = x->verdict;
    int right = 0, n = 0;
    char partly[HN_GRADE_TEXT / 2] = "";
    for (int i = 0; i < x->n_fields; i++) {
        double most;
        const double points = points_of(v, &x->fields[i], &most);
        right += points >= most;
        if (points > 0 && points < most && n < (int)sizeof partly) {
            n += snprintf(partly + n, sizeof partly - (size_t)n,
                          "; %s is partly right: %g of %g point%s", x->fields[i].name, points, most,
                          most == 1 ? "" : "s");
        }
    }
    if (x->matrix[0] || right == x->n_fields || (v->n_entries == x->n_fields && !partly[0])) {
        snprintf(out, HN_GRADE_TEXT, "%s", v->summary);
    } else {
        snprintf(out, HN_GRADE_TEXT, "%d of %d parts are right%s", right, x->n_fields, partly);
    }
}

/// "right, 2 points", or what is wrong.
static void add_result(hn_strbuf *b, const hn_verdict *v, const field *f) {
    double most;
    const double points = points_of(v, f, &most);
    hn_strbuf_printf(b, "    %s%g of %g point%s\n", points >= most ? "right, " : "", points, most,
                     most == 1 ? "" : "s");
    for (int i = 0; i < v->n_entries; i++) {
        if (is_of(&v->entry[i], f)) {
            hn_verdict_entry_text(b, v, &v->entry[i], "    ");
        }
    }
}

static void add_field(hn_strbuf *b, const hn_tui_exercise *x, const field *f, bool chosen,
                      int *line) {
    if (f->part) {
        const double points = cJSON_GetNumberValue(cJSON_GetObjectItem(f->part, "points"));
        hn_strbuf_printf(b, "%s) [%g point%s] ", f->name, points, points == 1 ? "" : "s");
        hn_paragraphs_join(b, text_of(f->part, "ask"));
        hn_strbuf_add(b, "\n");
        add_form(b, f);
    }
    *line = count_lines(b);
    hn_strbuf_printf(b, "%s %s = %s\n", chosen ? ">" : " ", f->name,
                     f->answer[0] ? f->answer
                     : chosen     ? "... (Enter types)"
                                  : "...");
    if (x->checked && x->verdict->kind == HN_VERDICT_GRADED) {
        add_result(b, x->verdict, f);
    }
    hn_strbuf_add(b, f->part ? "\n" : "");
}

/// The names that formulas of a matrix may have.
static void add_names(hn_strbuf *b, const hn_tui_exercise *x) {
    const cJSON *name;
    hn_strbuf_add(b, "\nformulas of");
    cJSON_ArrayForEach(name, cJSON_GetObjectItem(x->document, "names")) {
        hn_strbuf_printf(b, " %s", cJSON_IsString(name) ? name->valuestring : "");
    }
    hn_strbuf_add(b, "; sin(th1), a*b, a^2, pi\n\n");
}

static void add_hints(hn_strbuf *b, const hn_tui_exercise *x) {
    hn_variant variant = {0};
    hn_diag diag = {0};
    if (x->n_hints == 0 || hn_variant_init(&variant, x->exercise, 0, &diag) != HN_OK) {
        return;
    }
    for (int i = 1; i <= x->n_hints; i++) {
        hn_strbuf_printf(b, "hint %d of %d: ", i, x->exercise->n_hints);
        hn_variant_hint(b, &variant, i);
        hn_strbuf_add(b, "\n");
    }
    hn_variant_reset(&variant);
}

/// Writes what each answer is worth, where they differ, as "2 of 5 answers" are not 2 points then,
/// or where a part has several of them.
static void add_worth(hn_strbuf *b, const hn_tui_exercise *x) {
    const hn_verdict *v = x->verdict;
    const bool plain = v->max_score == v->n_entries && v->n_entries == x->n_fields;
    if (plain || v->score >= v->max_score) {
        return;
    }
    hn_strbuf_printf(b, "%d answers are checked, worth", v->n_entries);
    for (int i = 0; i < v->n_entries; i++) {
        hn_strbuf_printf(b, "%s %s %g", i > 0 ? "," : "", v->entry[i].name, v->entry[i].max_points);
    }
    hn_strbuf_add(b, " points; one that is partly right earns a part of them\n");
}

/// The verdict on the whole, or what keys there are for it.
static void add_end(hn_strbuf *b, const hn_tui_exercise *x) {
    const hn_verdict *v = x->verdict;
    if (x->checked && v->kind == HN_VERDICT_GRADED) {
        char summary[HN_GRADE_TEXT];
        hn_tui_exercise_summary(x, summary);
        hn_strbuf_printf(b, "%g of %g points: %s\n%s%s", v->score, v->max_score, summary, v->note,
                         v->note[0] ? "\n" : "");
        add_worth(b, x);
    } else if (x->checked) {
        hn_strbuf_printf(b, "not graded: %s%s%s\n", v->reason, v->hint[0] ? "; " : "", v->hint);
    } else {
        hn_strbuf_add(b, "c checks the answers; @FILE answers with what a file says\n");
    }
    if (x->n_hints < x->exercise->n_hints) {
        hn_strbuf_printf(b, "h shows %s (%d of %d shown)\n", x->n_hints ? "another hint" : "a hint",
                         x->n_hints, x->exercise->n_hints);
    }
}

void hn_tui_exercise_text(const hn_tui_exercise *x, int chosen, hn_strbuf *b, int *first, int *line,
                          int *last) {
    hn_strbuf_printf(b, "Exercise %s: %s (%g points)\n\n", hn_exercise_id(x->exercise),
                     hn_exercise_title(x->exercise), hn_exercise_points(x->exercise));
    hn_paragraphs_join(b, text_of(x->document, "statement"));
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < x->n_fields; i++) {
        const int begin = count_lines(b);
        int answer;
        add_field(b, x, &x->fields[i], i == chosen, &answer);
        if (i == chosen) {
            *first = begin;
            *line = answer;
            *last = count_lines(b);
        }
    }
    if (x->matrix[0]) {
        add_names(b, x);
    }
    hn_strbuf_add(b, hn_strbuf_text(&x->notation));
    add_hints(b, x);
    add_end(b, x);
}
