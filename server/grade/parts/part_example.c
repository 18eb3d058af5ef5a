// SPDX-License-Identifier: GPL-3.0-or-later
// An example or a counter-example: matrices or numbers with properties that are tested one by one.
//
//     "given": ["M", "Phi", "v"]           the matrices that are asked for (JSON rows)
//     "shapes": {"M": [2, 2], "v": [2, 1]} and how many rows and columns each must have
//     "numbers": ["l1", "l2"]              or numbers
//     "checks": [{"id": "symmetric", "test": "symmetric", "of": "M", "says": "..."}, ...]
//
//     "unit": "m"                          of the numbers, which may have it behind them
//
// Tests: the properties of matrix_property.h, of a formula of matrices; positive: of a formula of
// the numbers.
#include "grade/parts/blank.h"
#include "grade/parts/matrix_property.h"
#include "grade/parts/part_list.h"
#include "grade/parts/unit_text.h"
#include "grade/parts/world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- reading ----

/// Returns whether the matrix that was read last has the shape that is asked for; else the result
/// says so. A list without rows is a column, or the one row that is asked for.
static int has_shape(const hn_part *p, hn_world *w, bool list, hn_part_result *r) {
    hn_matrix *m = &w->matrix[w->n - 1];
    const char *name = w->name[w->n - 1];
    const cJSON *shapes = cJSON_GetObjectItemCaseSensitive(p->node, "shapes");
    const cJSON *shape = cJSON_GetObjectItemCaseSensitive(shapes, name);
    const cJSON *rows = cJSON_GetArrayItem(shape, 0), *cols = cJSON_GetArrayItem(shape, 1);
    if (list && rows && rows->valueint == 1) {
        m->cols = m->rows;
        m->rows = 1;
    }
    if (!rows || !cols || (m->rows == rows->valueint && m->cols == cols->valueint)) {
        return 1;
    }
    hn_part_unreadable(r, "%.20s is %d x %d; asked for is a matrix of %d x %d (rows x columns)",
                       name, m->rows, m->cols, rows->valueint, cols->valueint);
    return 0;
}

/// The matrices of an answer as a world of their own; 0 after the result has said what is missing.
static int read_matrices(const hn_part *p, const cJSON *given, hn_world *w, hn_part_result *r) {
    const cJSON *name;
    char why[HN_PART_TEXT];
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(p->node, "given")) {
        const cJSON *rows = hn_part_member(given, name->valuestring);
        if (!rows) {
            hn_part_unreadable(r, "the matrix %.20s is missing", name->valuestring);
            return 0;
        }
        if (!hn_world_add(w, name->valuestring, rows, why)) {
            hn_part_unreadable(r, "%s", why);
            return 0;
        }
        if (!has_shape(p, w, !cJSON_IsArray(rows->child), r)) {
            return 0;
        }
    }
    return 1;
}

/// A number, or text with one and the unit of the part behind it; false when it is neither.
static bool read_number(const hn_part *p, const cJSON *node, double *x) {
    *x = cJSON_IsNumber(node) ? node->valuedouble : 0;
    const char *text = cJSON_GetStringValue(node);
    if (!text) {
        return cJSON_IsNumber(node);
    }
    char *end;
    hn_unit own, given;
    *x = strtod(text, &end);
    const bool bare = !end[strspn(end, " ")];
    const bool known = hn_unit_parse(hn_part_text(p->node, "unit"), &own) &&
                       hn_unit_parse(bare ? hn_part_text(p->node, "unit") : end, &given);
    *x *= known ? hn_unit_ratio(&given, &own) : 1;
    return end > text && isfinite(*x) && known && hn_unit_fits(&given, &own);
}

/// The reason why a number of an answer is not used.
static void refuse_number(const hn_part *p, const char *name, bool given, hn_part_result *r) {
    const char *unit = hn_part_text(p->node, "unit");
    if (!given) {
        hn_part_unreadable(r, "the number %.20s is missing", name);
    } else if (unit[0]) {
        hn_part_unreadable(r, "%.20s is no number in %s; write 1.2 or \"1.2 %s\"", name, unit,
                           unit);
    } else {
        hn_part_unreadable(r, "%.20s is no number; write 1.2", name);
    }
}

/// The numbers of an answer as names of a draw.
static hn_status read_numbers(const hn_part *p, const cJSON *given, hn_draw *d, hn_part_result *r,
                              int *good, hn_diag *diag) {
    const cJSON *name;
    cJSON *names = cJSON_CreateObject();
    *good = 1;
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(p->node, "numbers")) {
        const cJSON *x = hn_part_member(given, name->valuestring);
        double value;
        if (!read_number(p, x, &value) && *good) {
            refuse_number(p, name->valuestring, x != NULL, r);
            *good = 0;
        }
        cJSON *source = cJSON_AddObjectToObject(names, name->valuestring);
        cJSON_AddNumberToObject(source, "value", value);
    }
    const hn_status status = hn_draw_init(d, names, NULL, p->draw, 1, 1, diag);

    // the names in the draw are those of the exercise, which lives longer than this object
    int i = d->n_names - cJSON_GetArraySize(names);
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(p->node, "numbers")) {
        if (status == HN_OK) {
            d->name[i] = name->valuestring;
            d->unit[i++] = "";
        }
    }
    cJSON_Delete(names);
    return status;
}

// ---- checking ----

/// The same world with all numbers positive.
static hn_status make_sizes(const hn_world *w, hn_world *sizes) {
    *sizes = *w;
    for (int i = 0; i < w->n; i++) {
        const hn_matrix *m = &w->matrix[i];
        sizes->matrix[i] = hn_matrix_new(w->arena, m->rows, m->cols);
        if (!sizes->matrix[i].x) {
            return HN_ERR_MEMORY;
        }
        for (int k = 0; k < m->rows * m->cols; k++) {
            sizes->matrix[i].x[k] = fabs(m->x[k]);
        }
    }
    return HN_OK;
}

/// One check; fails when the exercise itself is at fault.
static hn_status run_check(const cJSON *check, hn_world *w, hn_draw *d, bool *holds,
                           hn_diag *diag) {
    const char *test = hn_part_text(check, "test"), *of = hn_part_text(check, "of");
    double x;
    if (strcmp(test, "positive") == 0) {
        HN_TRY(hn_draw_value(d, of, &x, diag));
        *holds = x > 0;
        return HN_OK;
    }
    hn_matrix_property *property = hn_matrix_property_find(test);
    if (!property) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/checks", NULL, "there is no test '%.40s'",
                           test);
    }

    // the matrix, and how large the terms of its entries are
    hn_world sizes;
    hn_matrix m, size;
    HN_TRY(make_sizes(w, &sizes));
    hn_status status = hn_world_eval(w, of, &m, diag);
    HN_THEN(status, hn_world_eval(&sizes, of, &size, diag));
    *holds = status == HN_OK && property(&m, &size);
    return status == HN_ERR_INPUT || status == HN_ERR_MEMORY ? status : HN_OK;
}

static hn_status run_checks(const hn_part *p, hn_world *w, hn_draw *d, hn_part_result *r,
                            hn_diag *diag) {
    const cJSON *check;
    hn_part_right(r);
    cJSON_ArrayForEach(check, cJSON_GetObjectItemCaseSensitive(p->node, "checks")) {
        bool holds = false;
        HN_TRY(run_check(check, w, d, &holds, diag));
        if (!holds) {
            hn_part_wrong(r, hn_part_text(check, "id"), hn_part_number(check, "share", 0), "%s",
                          hn_part_text(check, "says"));
            return HN_OK;
        }
    }
    return HN_OK;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    hn_world w = {.arena = hn_arena_create(0)};
    hn_draw d = {0};
    int good = 1;

    const bool handed_in = hn_part_begin(r, n, given, "any example that passes every check");
    const cJSON *names = cJSON_GetObjectItemCaseSensitive(p->node, "given");
    cJSON *wrapped = NULL;

    // the one matrix that is asked for needs no name
    if (cJSON_GetArraySize(names) == 1 && cJSON_IsArray(given)) {
        wrapped = cJSON_CreateObject();
        cJSON_AddItemReferenceToObject(wrapped, names->child->valuestring, (cJSON *)given);
        given = wrapped;
    }

    // the numbers first, then the matrices, then the checks of both
    hn_status status = w.arena ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK && handed_in && !cJSON_IsObject(given)) {
        hn_part_unreadable(r, "expected an object with the names that are asked for");
    } else if (status == HN_OK && handed_in) {
        status = read_numbers(p, given, &d, r, &good, diag);
        if (status == HN_OK && good && read_matrices(p, given, &w, r)) {
            status = run_checks(p, &w, &d, r, diag);
        }
    }

    // both are closed on every path
    cJSON_Delete(wrapped);
    hn_draw_reset(&d);
    hn_world_reset(&w);
    return status;
}

static void put_names(hn_strbuf *b, const hn_part *p, const char *key, const char *form,
                      int *count) {
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, key)) {
        hn_strbuf_printf(b, "%s\"%s\": %s", (*count)++ ? ", " : "", m->valuestring, form);
    }
}

static void ask(hn_strbuf *b, const hn_part *p) {
    int count = 0;
    hn_strbuf_add(b, "{");
    put_names(b, p, "given", "[[...], ...]", &count);
    put_names(b, p, "numbers", "1.2", &count);
    hn_strbuf_add(b, "} with numbers of your own");
}

const hn_part_kind hn_part_example = {
    .name = "example",
    .fields = "given shapes numbers unit checks answer faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_names,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // the answer of the exercise goes through the checks like any other
};
