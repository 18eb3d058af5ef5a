// SPDX-License-Identifier: GPL-3.0-or-later
// An example or a counter-example: matrices or numbers with properties that are tested one by one.
//
//     "given": ["M", "Phi", "v"]           the matrices that are asked for (JSON rows)
//     "shapes": {"M": [2, 2], "v": [2, 1]} and how many rows and columns each must have
//     "numbers": ["l1", "l2"]              or numbers
//     "checks": [{"id": "symmetric", "test": "symmetric", "of": "M", "says": "..."}, ...]
//
// Tests: symmetric, definite, semidefinite, full-rank (columns), rows-independent, rows-nonzero
// (none of its rows is zero), singular, nonsingular: of a formula of matrices; at-most-zero, zero,
// nonzero: of a formula with one value; positive: of a formula of the numbers.
#include "grade/parts/part_list.h"
#include "grade/parts/world.h"

#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NUMBERS = 16 };
static const double SMALL = 1e-9; // of the largest entry: what counts as zero in given numbers

// ---- properties of a matrix ----

static double largest(const hn_matrix *m) {
    double size = 0;
    for (int i = 0; i < m->rows * m->cols; i++) {
        size = fmax(size, fabs(m->x[i]));
    }
    return size;
}

static int is_symmetric(const hn_matrix *m) {
    double worst = 0;
    for (int i = 0; i < m->rows && m->rows == m->cols; i++) {
        for (int j = 0; j < i; j++) {
            worst = fmax(worst, fabs(m->x[i * m->cols + j] - m->x[j * m->cols + i]));
        }
    }
    return m->rows == m->cols && worst <= SMALL * largest(m);
}

/// Symmetric elimination: the smallest pivot, relative to the largest entry. With complete
/// pivoting on the diagonal it is negative exactly when the matrix is not semidefinite.
static double smallest_pivot(const hn_matrix *m) {
    double a[HN_MATRIX_LARGEST * HN_MATRIX_LARGEST], least = HUGE_VAL;
    const int n = m->rows;
    const double size = fmax(largest(m), 1e-300);

    // elimination on a copy
    memcpy(a, m->x, sizeof(double) * (size_t)(n * n));
    int done[HN_MATRIX_LARGEST] = {0};

    // the largest diagonal entry that is left is the next pivot
    for (int step = 0; step < n; step++) {
        int k = -1;
        for (int i = 0; i < n; i++) {
            k = !done[i] && (k < 0 || a[i * n + i] > a[k * n + k]) ? i : k;
        }
        const double pivot = a[k * n + k] / size;
        done[k] = 1;
        least = fmin(least, pivot);

        for (int i = 0; i < n && pivot <= SMALL; i++) { // nothing may be left beside a zero pivot
            if (!done[i] && fabs(a[i * n + k]) > SMALL * size) {
                least = fmin(least, -1);
            }
        }

        // the rest, without the pivot's row and column
        for (int i = 0; i < n && pivot > SMALL; i++) {
            for (int j = 0; j < n && !done[i]; j++) {
                a[i * n + j] -= a[i * n + k] * a[k * n + j] / a[k * n + k];
            }
        }
    }
    return least;
}

static int rank_of(const hn_matrix *m) {
    double sigma[HN_MATRIX_LARGEST];
    hn_arena *arena = hn_arena_create(0);
    int rank = -1;
    if (arena && hn_singular_values(m->rows, m->cols, m->x, sigma, arena) == HN_OK) {
        rank = hn_rank_of(m->rows < m->cols ? m->rows : m->cols, sigma, SMALL);
    }
    hn_arena_free(arena);
    return rank;
}

static int is_definite(const hn_matrix *m) {
    return is_symmetric(m) && smallest_pivot(m) > SMALL;
}

static int is_semidefinite(const hn_matrix *m) {
    return is_symmetric(m) && smallest_pivot(m) >= -SMALL;
}

static int has_full_rank(const hn_matrix *m) {
    return rank_of(m) == m->cols;
}

static int has_independent_rows(const hn_matrix *m) {
    return rank_of(m) == m->rows;
}

static int is_singular(const hn_matrix *m) {
    return m->rows == m->cols && rank_of(m) < m->rows;
}

static int is_nonsingular(const hn_matrix *m) {
    return m->rows == m->cols && rank_of(m) == m->rows;
}

static int is_at_most_zero(const hn_matrix *m) {
    return m->rows == 1 && m->cols == 1 && m->x[0] <= 1e-12;
}

static int is_zero(const hn_matrix *m) {
    return largest(m) <= SMALL;
}

static int is_nonzero(const hn_matrix *m) {
    return largest(m) > SMALL;
}

/// A row is zero beside the largest entry, as a whole matrix is where all of them are.
static int has_no_zero_row(const hn_matrix *m) {
    const double size = largest(m);
    for (int i = 0; i < m->rows; i++) {
        const hn_matrix row = {.rows = 1, .cols = m->cols, .x = m->x + i * m->cols};
        if (largest(&row) <= SMALL * size) {
            return 0;
        }
    }
    return 1;
}

static const struct {
    const char *name;
    int (*holds)(const hn_matrix *m);
} TESTS[] = {
    {"symmetric", is_symmetric},
    {"definite", is_definite},
    {"semidefinite", is_semidefinite},
    {"full-rank", has_full_rank},
    {"rows-independent", has_independent_rows},
    {"singular", is_singular},
    {"nonsingular", is_nonsingular},
    {"at-most-zero", is_at_most_zero},
    {"zero", is_zero},
    {"nonzero", is_nonzero},
    {"rows-nonzero", has_no_zero_row},
};
enum { N_TESTS = sizeof TESTS / sizeof *TESTS };

// ---- reading ----

/// Whether the matrix that was read last has the shape that is asked for; else the result says so.
static int has_shape(const hn_part *p, const hn_world *w, hn_part_result *r) {
    const hn_matrix *m = &w->matrix[w->n - 1];
    const char *name = w->name[w->n - 1];
    const cJSON *shapes = cJSON_GetObjectItemCaseSensitive(p->node, "shapes");
    const cJSON *shape = cJSON_GetObjectItemCaseSensitive(shapes, name);
    const cJSON *rows = cJSON_GetArrayItem(shape, 0), *cols = cJSON_GetArrayItem(shape, 1);
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
        const cJSON *rows = cJSON_GetObjectItemCaseSensitive(given, name->valuestring);
        if (!rows) {
            hn_part_unreadable(r, "the matrix %.20s is missing", name->valuestring);
            return 0;
        }
        if (!hn_world_add(w, name->valuestring, rows, why)) {
            hn_part_unreadable(r, "%s", why);
            return 0;
        }
        if (!has_shape(p, w, r)) {
            return 0;
        }
    }
    return 1;
}

/// The numbers of an answer as names of a draw.
static hn_status read_numbers(const hn_part *p, const cJSON *given, hn_draw *d, hn_part_result *r,
                              int *good, hn_diag *diag) {
    const cJSON *name;
    cJSON *names = cJSON_CreateObject();
    *good = 1;
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(p->node, "numbers")) {
        const cJSON *x = cJSON_GetObjectItemCaseSensitive(given, name->valuestring);
        if (!cJSON_IsNumber(x) && *good) {
            hn_part_unreadable(r, "the number %.20s is missing", name->valuestring);
            *good = 0;
        }
        cJSON *source = cJSON_AddObjectToObject(names, name->valuestring);
        cJSON_AddNumberToObject(source, "value", cJSON_IsNumber(x) ? x->valuedouble : 0);
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

/// One check: 1 holds, 0 does not; fails when the exercise itself is at fault.
static hn_status run_check(const cJSON *check, hn_world *w, hn_draw *d, int *holds, hn_diag *diag) {
    const char *test = hn_part_text(check, "test"), *of = hn_part_text(check, "of");
    double x;
    if (strcmp(test, "positive") == 0) {
        HN_TRY(hn_draw_value(d, of, &x, diag));
        *holds = x > 0;
        return HN_OK;
    }
    for (int i = 0; i < N_TESTS; i++) {
        if (strcmp(TESTS[i].name, test) == 0) {
            hn_matrix m;
            const hn_status status = hn_world_eval(w, of, &m, diag);
            *holds = status == HN_OK && TESTS[i].holds(&m);
            return status == HN_ERR_INPUT || status == HN_ERR_MEMORY ? status : HN_OK;
        }
    }
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/checks", NULL, "there is no test '%.40s'", test);
}

static hn_status run_checks(const hn_part *p, hn_world *w, hn_draw *d, hn_part_result *r,
                            hn_diag *diag) {
    const cJSON *check;
    hn_part_right(r);
    cJSON_ArrayForEach(check, cJSON_GetObjectItemCaseSensitive(p->node, "checks")) {
        int holds = 0;
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
    .fields = "given shapes numbers checks answer faults",
    .ask = ask,
    .grade = grade,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // the answer of the exercise goes through the checks like any other
};
