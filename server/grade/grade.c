// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/grade.h"

#include "base/file.h"
#include "base/json_text.h"
#include "expr/print.h"
#include "grade/exercise.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 16 };

// ---- reading the submission ----

static int refuse(hn_verdict *v, const char *hint, const char *format, ...) HN_PRINTF(3, 4);

/// Makes the verdict ungradable; returns 0, so that `return refuse(...)` reads well.
static int refuse(hn_verdict *v, const char *hint, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(v->reason, sizeof v->reason, format, args);
    va_end(args);
    snprintf(v->hint, sizeof v->hint, "%s", hint ? hint : "");
    v->kind = HN_VERDICT_UNGRADABLE;
    return 0;
}

static const char *kind_of(const cJSON *node) {
    return cJSON_IsNumber(node)   ? "a number"
           : cJSON_IsString(node) ? "a text"
           : cJSON_IsArray(node)  ? "a list"
           : cJSON_IsObject(node) ? "an object"
           : cJSON_IsNull(node)   ? "null"
                                  : "true or false";
}

/// Fields that were not read are told, a near miss of the answer's name is suggested, another
/// problem's file is refused.
static int check_fields(hn_verdict *v, const cJSON *root) {
    const hn_exercise *p = v->problem;
    const char *fields[] = {p->answer, "problem", "student", "seed", "comment"};
    for (const cJSON *m = root->child; m; m = m->next) {
        int known = 0;
        for (int i = 0; i < 5; i++) {
            known |= strcmp(m->string, fields[i]) == 0;
        }
        if (!known && !v->note[0]) {
            snprintf(v->note, sizeof v->note, "the field '%.60s' was not read", m->string);
        }
    }
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(root, "problem");
    if (cJSON_IsString(id) && strcmp(id->valuestring, p->id) != 0) {
        return refuse(v, NULL, "the submission says it answers problem '%.40s', this is '%s'",
                      id->valuestring, p->id);
    }
    if (!cJSON_GetObjectItemCaseSensitive(root, p->answer)) {
        const char *found = root->child ? root->child->string : NULL;
        const char *near = found ? hn_nearest_name(found, fields, 1) : NULL;
        char hint[HN_GRADE_TEXT];
        if (near) {
            snprintf(hint, sizeof hint, "rename '%.60s' to '%s'", found, near);
        } else {
            snprintf(hint, sizeof hint, "as in {\"%s\": [[\"...\", ...], ...]}", p->answer);
        }
        return refuse(v, hint, "the field '%s' is missing%s", p->answer,
                      found ? "" : ": the object is empty");
    }
    return 1;
}

/// Rows and columns of the answer; a matrix of the transposed shape is let through.
static int check_shape(hn_verdict *v, const cJSON *answer, int *transposed) {
    const hn_exercise *p = v->problem;
    int rows = cJSON_GetArraySize(answer), columns = -1;
    if (!cJSON_IsArray(answer)) {
        return refuse(v, NULL, "'%s' is %s, expected a list of %d rows", p->answer, kind_of(answer),
                      p->n_rows);
    }
    int i = 0;
    for (const cJSON *row = answer->child; row; row = row->next, i++) {
        if (!cJSON_IsArray(row)) {
            return refuse(v, NULL, "row %d of '%s' is %s, expected a list of %d formulas", i + 1,
                          p->answer, kind_of(row), p->n_columns);
        }
        int n = cJSON_GetArraySize(row);
        if (columns >= 0 && n != columns) {
            return refuse(v, NULL, "row %d of '%s' has %d entries, the rows before have %d", i + 1,
                          p->answer, n, columns);
        }
        columns = n;
    }
    *transposed = rows == p->n_columns && columns == p->n_rows && rows != columns;
    if (!*transposed && (rows != p->n_rows || columns != p->n_columns)) {
        return refuse(v, "one row for each equation, one column for each coordinate",
                      "'%s' has %d rows of %d entries, expected %d rows of %d", p->answer, rows,
                      columns < 0 ? 0 : columns, p->n_rows, p->n_columns);
    }
    for (const cJSON *row = answer->child; row; row = row->next) {
        for (const cJSON *m = row->child; m; m = m->next) {
            if (!cJSON_IsString(m) && !cJSON_IsNumber(m) && !cJSON_IsNull(m)) {
                return refuse(v, "write each entry as a text in quotes",
                              "an entry of '%s' is %s, expected a formula in quotes", p->answer,
                              kind_of(m));
            }
        }
    }
    return 1;
}

// ---- one entry ----

static double partial_share(const hn_exercise *p, const char *mistake) {
    for (int i = 0; i < p->n_partial; i++) {
        if (strcmp(p->partial[i].key, mistake) == 0) {
            return p->partial[i].value;
        }
    }
    return 0;
}

static void set_mistake(hn_verdict *v, hn_entry_verdict *e, const char *id) {
    e->mistake = id;
    e->points = e->max_points * partial_share(v->problem, id);
}

/// The formula of an entry; 0 when there is none that can be read.
static int read_entry(hn_verdict *v, hn_exam *exam, const cJSON *node, hn_entry_verdict *e,
                      hn_ex *given, hn_status *status) {
    hn_diag diag = {0};
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
        return 0;
    }
    *status = hn_exam_parse(exam, text, given, &diag);
    if (*status == HN_ERR_INPUT || *status == HN_ERR_LIMIT) {
        *status = HN_OK;
        set_mistake(v, e, "unreadable");
        snprintf(e->explanation, sizeof e->explanation,
                 "the formula cannot be read: %.240s%s%.110s", diag.message,
                 diag.hint[0] ? "; " : "", diag.hint);
        return 0;
    }
    return *status == HN_OK;
}

/// Compares at all states; fills in the closed state where the difference is largest. Returns 1 if
/// right.
static int compare(hn_exam *exam, int index, hn_entry_verdict *e, const double *value) {
    const double *expected = exam->expected[index];
    double worst = -1;
    int wrong = 0;
    for (int s = 0; s < exam->problem->n_closed; s++) {
        double difference = fabs(value[s] - expected[s]);
        if (difference <= hn_exam_allowed(exam, expected[s])) {
            continue;
        }
        wrong = 1;
        if (!isfinite(value[s]) || difference > worst) {
            worst = isfinite(value[s]) ? difference : HUGE_VAL;
            e->state = s;
            e->given_value = value[s];
            e->expected_value = expected[s];
            e->allowed = hn_exam_allowed(exam, expected[s]);
        }
    }
    for (int s = exam->problem->n_closed; s < exam->n_states && !wrong; s++) {
        e->closed_only |= !(fabs(value[s] - expected[s]) <= hn_exam_allowed(exam, expected[s]));
    }
    return !wrong;
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
    snprintf(e->explanation, sizeof e->explanation, "%s%s%s%s", found.text, found.by[0] ? " (" : "",
             found.by, found.by[0] ? ")" : "");
}

static hn_status grade_entry(hn_verdict *v, hn_exam *exam, const cJSON *node, hn_entry_verdict *e) {
    int index = e->row * v->problem->n_columns + e->column;
    hn_ex given;
    hn_status status = HN_OK;
    double value[HN_GRADE_MAX_STATES];
    if (!read_entry(v, exam, node, e, &given, &status)) {
        return status;
    }
    for (int s = 0; s < exam->n_states; s++) {
        value[s] = hn_exam_value(exam, given, s);
    }
    e->right = compare(exam, index, e, value);
    if (e->right) {
        e->points = e->max_points;
        if (e->closed_only) {
            snprintf(e->explanation, sizeof e->explanation,
                     "right wherever the loop is closed, though not the derivative of phi as a "
                     "formula; accepted");
        }
    } else {
        explain(v, exam, e, given, value);
    }
    return hn_graph_failed(exam->graph) ? HN_ERR_MEMORY : HN_OK;
}

// ---- the whole ----

/// 1 if column j is wrong by its sign in every row.
static int column_has_sign(const hn_verdict *v, int j) {
    int n = v->problem->n_columns, all = 1;
    for (int i = 0; i < v->problem->n_rows; i++) {
        all &= strcmp(v->entry[i * n + j].mistake, "sign") == 0;
    }
    return all;
}

static void summarise(hn_verdict *v) {
    const hn_exercise *p = v->problem;
    int wrong = v->n_entries - v->n_right, columns = 0;
    const char *common = NULL;
    char list[64] = "";
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        if (!e->right) {
            common = !common ? e->mistake : strcmp(common, e->mistake) == 0 ? common : "";
        }
    }
    for (int j = 0; j < p->n_columns; j++) {
        if (column_has_sign(v, j)) {
            snprintf(list + strlen(list), sizeof list - strlen(list), "%s%d", columns++ ? ", " : "",
                     j + 1);
        }
    }
    if (wrong == 0) {
        snprintf(v->summary, sizeof v->summary, "all %d entries are right", v->n_entries);
    } else if (columns > 0 && columns * p->n_rows == wrong && columns < p->n_columns) {
        snprintf(v->summary, sizeof v->summary,
                 "column%s %s: wrong sign in every row, so look at the side on which these links "
                 "stand in the loop equation",
                 columns > 1 ? "s" : "", list);
    } else if (wrong > 1 && common[0] && strcmp(common, "other") != 0) {
        snprintf(v->summary, sizeof v->summary,
                 "%d of %d entries are right; the other %d share one mistake: %s", v->n_right,
                 v->n_entries, wrong, common);
    } else {
        snprintf(v->summary, sizeof v->summary, "%d of %d entries are right", v->n_right,
                 v->n_entries);
    }
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
        v->shown_entry = v->entry[k].state >= 0 ? k : v->shown_entry;
    }
    for (int i = 0; i < p->n_names && v->shown_entry >= 0; i++) {
        v->names[i] = p->names[i].name;
        v->values[i] = exam->state[v->entry[v->shown_entry].state][i];
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
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_print(&b, exam->graph, exam->reference[k], HN_PRINT_TEXT, 0);
    snprintf(e->expected, sizeof e->expected, "%s", hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}

static hn_status grade_matrix(hn_verdict *v, hn_exam *exam, const cJSON *answer, int transposed) {
    const hn_exercise *p = v->problem;
    v->n_entries = p->n_rows * p->n_columns;
    v->n_states = p->n_closed;
    for (int k = 0; k < v->n_entries; k++) {
        int i = k / p->n_columns, j = k % p->n_columns;
        const cJSON *node =
            cJSON_GetArrayItem(cJSON_GetArrayItem(answer, transposed ? j : i), transposed ? i : j);
        begin_entry(v, exam, k);
        hn_status status = grade_entry(v, exam, node, &v->entry[k]);
        if (status != HN_OK) {
            return status;
        }
        v->n_right += v->entry[k].right;
    }
    summarise(v);
    if (transposed) {
        mark_transposed(v);
    }
    for (int k = 0; k < v->n_entries; k++) {
        v->score += v->entry[k].points;
    }
    show_state(v, exam);
    return HN_OK;
}

static hn_status grade_tree(hn_verdict *v, const cJSON *root) {
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(root, v->problem->answer);
    int transposed = 0;
    if (!cJSON_IsObject(root)) {
        refuse(v, "as in {\"J\": [[\"...\", ...], ...]}",
               "the submission is %s, expected an object", kind_of(root));
        return HN_OK;
    }
    if (!check_fields(v, root) || !check_shape(v, answer, &transposed)) {
        return HN_OK;
    }
    hn_exam *exam = malloc(sizeof *exam);
    hn_status status = exam ? hn_exam_init(exam, v->problem, v->seed, NULL) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = grade_matrix(v, exam, answer, transposed);
    } else if (status != HN_ERR_MEMORY) {
        status = HN_ERR_INTERNAL; // the problem was sound when it was loaded
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

hn_status hn_grade_json(const hn_exercise *problem, const char *text, size_t n, uint64_t seed,
                        hn_verdict *out) {
    HN_ASSERT(problem && out && (text || n == 0));
    begin(out, problem, seed);
    hn_diag diag = {0};
    if (n > HN_GRADE_MAX_BYTES) {
        refuse(out, NULL, "the submission has more than the %d bytes allowed", HN_GRADE_MAX_BYTES);
        return HN_OK;
    }
    if (hn_json_text_check(text, n, MAX_DEPTH, &diag) != HN_OK) {
        refuse(out, diag.hint, "the submission is not JSON: %s", diag.message);
        return HN_OK;
    }
    cJSON *root = cJSON_ParseWithLength(text, n);
    hn_status status = root ? grade_tree(out, root) : HN_ERR_MEMORY;
    cJSON_Delete(root);
    return status;
}

hn_status hn_grade_file(const hn_exercise *problem, const char *path, uint64_t seed,
                        hn_verdict *out) {
    HN_ASSERT(problem && path && out);
    begin(out, problem, seed);
    hn_strbuf text;
    hn_diag diag;
    hn_strbuf_init(&text);
    hn_status status = hn_file_read(path, HN_GRADE_MAX_BYTES, &text, &diag);
    if (status == HN_OK) {
        status = hn_grade_json(problem, hn_strbuf_text(&text), text.n, seed, out);
    } else if (status != HN_ERR_MEMORY) { // the submission is at fault, not the program
        refuse(out, diag.hint, "%s", diag.message);
        status = HN_OK;
    }
    hn_strbuf_reset(&text);
    return status;
}
