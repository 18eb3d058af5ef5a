// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise_text.h"

#include "base/hash.h"
#include "base/paragraphs.h"
#include "grade/exam.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Pivots of J J' below this share of its largest diagonal: the rows of J depend on each other.
static const double SINGULAR = 1e-9;

/// The shape of a submission with dots for the formulas. seed 0: the exercise's own.
static void submission_form(hn_strbuf *b, const hn_exercise *p, uint64_t seed,
                            const char *student) {
    hn_strbuf_add(b, "{");
    if (student) {
        hn_strbuf name;
        hn_strbuf_init(&name);
        hn_json_string(&name, student);
        hn_strbuf_printf(b, "\"student\": %s, ", hn_strbuf_text(&name));
        b->failed |= name.failed;
        hn_strbuf_reset(&name);
    } else if (seed) {
        hn_strbuf_printf(b, "\"seed\": %llu, ", (unsigned long long)seed);
    }
    hn_strbuf_printf(b, "\"%s\": [", p->answer);
    for (int i = 0; i < p->n_rows; i++) {
        hn_strbuf_add(b, i ? ", [" : "[");
        for (int j = 0; j < p->n_columns; j++) {
            hn_strbuf_printf(b, "%s\"...\"", j ? ", " : "");
        }
        hn_strbuf_add(b, "]");
    }
    hn_strbuf_add(b, "]}");
}

/// The numbers of a variant.
typedef struct numbers {
    double value[HN_GRADE_MAX_NAMES];      ///< of a state that closes the loop; [m], [rad]
    double velocity[HN_GRADE_MAX_COLUMNS]; ///< J velocity = 0 there; a random one, projected
} numbers;

/// Projects `v` on the null space of the n x m matrix J, rows of J: v - J' (J J')^-1 J v.
static hn_status project(int n, int m, double J[HN_GRADE_MAX_ROWS][HN_GRADE_MAX_COLUMNS],
                         double *v) {
    double S[HN_GRADE_MAX_ROWS * HN_GRADE_MAX_ROWS], r[HN_GRADE_MAX_ROWS];
    double largest = 0;
    for (int i = 0; i < n; i++) {
        r[i] = 0;
        for (int j = 0; j < m; j++) {
            r[i] += J[i][j] * v[j];
        }
        for (int k = 0; k < n; k++) {
            S[i * n + k] = 0;
            for (int j = 0; j < m; j++) {
                S[i * n + k] += J[i][j] * J[k][j];
            }
        }
        largest = fmax(largest, S[i * n + i]);
    }
    HN_TRY(hn_cholesky(n, S, n, SINGULAR * largest));
    hn_cholesky_solve(n, S, n, r);
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < n; i++) {
            v[j] -= J[i][j] * r[i];
        }
    }
    return HN_OK;
}

/// Draws a state that is not among those at which answers are compared.
static hn_status draw_numbers(const hn_exercise *p, uint64_t seed, numbers *out) {
    double J[HN_GRADE_MAX_ROWS][HN_GRADE_MAX_COLUMNS];
    hn_exam *exam = malloc(sizeof *exam);
    const uint64_t own = hn_hash_mix((seed ? seed : p->seed) ^ 0x7a1e);
    hn_status status = exam ? hn_exam_init(exam, p, own, NULL) : HN_ERR_MEMORY;
    for (int k = 0; status == HN_OK && k < p->n_rows * p->n_columns; k++) {
        J[k / p->n_columns][k % p->n_columns] = exam->expected[k][0];
    }
    for (int j = 0; status == HN_OK && j < p->n_columns; j++) {
        out->velocity[j] = 2 * hn_draw_random(own, (uint64_t)j) - 1;
    }
    if (status == HN_OK) {
        memcpy(out->value, exam->state[0], sizeof out->value);
        status = project(p->n_rows, p->n_columns, J, out->velocity);
    }
    if (exam) {
        hn_exam_reset(exam);
    }
    free(exam);
    return status;
}

/// The numbers of the variant, to six digits; nothing where the rows of J depend on each other.
static void put_numbers(hn_strbuf *b, const hn_exercise *p, uint64_t seed) {
    numbers own;
    const hn_status status = draw_numbers(p, seed, &own);
    b->failed |= status == HN_ERR_MEMORY;
    if (status != HN_OK) {
        return;
    }
    hn_strbuf_add(b, "\nYour numbers, in m and rad, to try your formulas on: with");
    for (int i = 0; i < p->n_names; i++) {
        hn_strbuf_printf(b, "%s %s = %.6f", i ? "," : "", p->names[i].name, own.value[i]);
    }
    hn_strbuf_printf(b, " the loop is closed, and %s v = 0 to six digits for v = (", p->answer);
    for (int j = 0; j < p->n_columns; j++) {
        hn_strbuf_printf(b, "%s%.6f", j ? ", " : "", own.velocity[j]);
    }
    hn_strbuf_add(b, ").\n");
}

void hn_exercise_text(hn_strbuf *b, const hn_exercise *p, uint64_t seed, const char *student) {
    hn_strbuf_printf(b, "Exercise %s: %s (lesson %s, %s; %g points; seed %llu)\n\n", p->id,
                     p->title, p->lesson, p->section, hn_exercise_points(p),
                     (unsigned long long)(seed ? seed : p->seed));
    hn_paragraphs_join(b, p->statement);
    hn_strbuf_add(b, "\n");
    put_numbers(b, p, seed);
    hn_strbuf_add(b, "\nHand in a JSON file:\n  ");
    submission_form(b, p, seed, student);
    hn_strbuf_add(b, "\nEach entry is a formula in quotes; names:");
    for (int i = 0; i < p->n_names; i++) {
        hn_strbuf_printf(b, "%s %s", i ? "," : "", p->names[i].name);
    }
    hn_strbuf_printf(b,
                     "; angles in radians; * for products, ^ for powers, sin(..), cos(..), pi.\n%g "
                     "point%s for each entry; compared at %d random states.\n",
                     p->points, p->points == 1 ? "" : "s", p->n_closed);
    hn_exercise_put_drawn(b, p, "Other variants have other numbers: ", ".\n");
}

/// The same numbers as members.
static void put_number_members(hn_strbuf *b, const hn_exercise *p, uint64_t seed) {
    numbers own;
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)(seed ? seed : p->seed));
    hn_json_put_string(b, "seed", text);
    const hn_status status = draw_numbers(p, seed, &own);
    b->failed |= status == HN_ERR_MEMORY;
    if (status != HN_OK) {
        return;
    }
    hn_json_key(b, "numbers");
    hn_json_object(b);
    for (int i = 0; i < p->n_names; i++) {
        hn_json_put_number(b, p->names[i].name, own.value[i]);
    }
    hn_json_end_object(b);
    hn_json_key(b, "velocity");
    hn_json_object(b);
    for (int j = 0; j < p->n_columns; j++) {
        hn_json_put_number(b, p->by[j], own.velocity[j]);
    }
    hn_json_end_object(b);
}

/// The entries that are asked for, and the names in them.
static void put_question(hn_strbuf *b, const hn_exercise *p) {
    char name[32];
    hn_json_key(b, "entries");
    hn_json_array(b);
    for (int i = 0; i < p->n_rows * p->n_columns; i++) {
        snprintf(name, sizeof name, "%.8s%d%d", p->answer, i / p->n_columns + 1,
                 i % p->n_columns + 1);
        hn_json_object(b);
        hn_json_put_string(b, "name", name);
        hn_json_put_number(b, "points", p->points);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);

    // the names that formulas may use, and the equations
    hn_json_key(b, "names");
    hn_json_array(b);
    for (int i = 0; i < p->n_names; i++) {
        hn_json_string(b, p->names[i].name);
    }
    hn_json_end_array(b);
    hn_json_key(b, "phi");
    hn_json_strings(b, p->phi, (size_t)p->n_rows);
}

void hn_exercise_put_ranges(hn_strbuf *b, const hn_exercise *p) {
    const cJSON *m;
    hn_json_key(b, "ranges");
    hn_json_object(b);
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->root, "draw")) {
        const bool hidden = hn_exercise_is_hidden(p, m->string);
        char *text = hidden ? NULL : cJSON_PrintUnformatted(m);
        if (text) {
            hn_json_key(b, m->string);
            hn_json_raw(b, text);
        }
        b->failed |= !text && !hidden;
        cJSON_free(text);
    }
    for (int i = 0; !p->n_parts && i < p->n_names; i++) {
        const hn_grade_name *name = &p->names[i];
        hn_json_key(b, name->name);
        hn_json_object(b);
        if (name->formula) {
            hn_json_put_string(b, "formula", name->formula);
        } else {
            hn_json_key(b, "range");
            hn_json_array(b);
            hn_json_number(b, name->low);
            hn_json_number(b, name->high);
            hn_json_end_array(b);
        }
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
}

/// "6, 8 or 10"
static void put_choices(hn_strbuf *b, const cJSON *list) {
    const cJSON *m;
    cJSON_ArrayForEach(m, list) {
        hn_strbuf_printf(b, "%s%g",
                         m == list->child ? ""
                         : m->next        ? ", "
                                          : " or ",
                         cJSON_GetNumberValue(m));
    }
}

void hn_exercise_put_drawn(hn_strbuf *b, const hn_exercise *p, const char *head, const char *tail) {
    const char *between = head;
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->root, "draw")) {
        const cJSON *range = cJSON_GetObjectItemCaseSensitive(m, "range");
        const cJSON *choose = cJSON_GetObjectItemCaseSensitive(m, "choose");
        const char *unit = hn_part_text(m, "unit");
        if (hn_exercise_is_hidden(p, m->string) || (!range && !choose)) {
            continue;
        }
        hn_strbuf_printf(b, "%s%s ", between, m->string);
        between = "; ";
        if (range) {
            hn_strbuf_printf(b, "%g to %g", cJSON_GetNumberValue(cJSON_GetArrayItem(range, 0)),
                             cJSON_GetNumberValue(cJSON_GetArrayItem(range, 1)));
        } else {
            put_choices(b, choose);
        }
        hn_strbuf_printf(b, "%s%s", unit[0] ? " " : "", unit);
    }
    for (int i = 0; !p->n_parts && i < p->n_names; i++) {
        const hn_grade_name *name = &p->names[i];
        if (!name->formula) {
            hn_strbuf_printf(b, "%s%s %g to %g %s", between, name->name, name->low, name->high,
                             i < p->n_params ? "m" : "rad");
            between = "; ";
        }
    }
    hn_strbuf_add(b, between == head ? "" : tail);
}

void hn_exercise_put_names(hn_strbuf *b, const hn_exercise *p) {
    hn_json_put_string(b, "id", p->id);
    hn_json_put_string(b, "title", p->title);
    hn_json_put_string(b, "lesson", p->lesson);
    hn_json_put_string(b, "section", p->section);
    hn_json_put_string(b, "scene", p->scene);
}

void hn_exercise_json(hn_strbuf *b, const hn_exercise *p, uint64_t seed, const char *student) {
    char hash[17];
    hn_hash_hex(p->hash, hash);
    hn_json_object(b);
    hn_exercise_put_names(b, p);
    hn_json_put_string(b, "statement", p->statement);
    hn_json_put_number(b, "points", hn_exercise_points(p));
    hn_json_put_string(b, "hash", hash);
    put_question(b, p);
    put_number_members(b, p, seed);
    hn_exercise_put_ranges(b, p);

    // how answers are compared, and the shape of a submission
    hn_json_key(b, "tolerance");
    hn_json_object(b);
    hn_json_put_number(b, "relative", p->relative);
    hn_json_put_number(b, "absolute", p->absolute);
    hn_json_put_string(b, "why", p->why);
    hn_json_end_object(b);
    hn_strbuf form;
    hn_strbuf_init(&form);
    submission_form(&form, p, seed, student);
    hn_json_put_string(b, "submission", hn_strbuf_text(&form));
    b->failed |= form.failed;
    hn_strbuf_reset(&form);
    hn_json_end_object(b);
}
