// SPDX-License-Identifier: GPL-3.0-or-later
// A basis of the null space of a Jacobian, as formulas: any basis is right. J N = 0 and the rank of
// N are tested at random states.
#include "grade/parts/part_list.h"
#include "grade/parts/read_as.h"

#include "grade/parts/spelling.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STATES = 8, MAX_SIZE = 8 };
static const double ALLOWED = 1e-6; // of the sizes of J and N: constants with seven digits pass

/// Rows of formulas.
typedef struct table {
    int rows, cols;
    hn_ex e[MAX_SIZE][MAX_SIZE];
} table;

static const char *find_name(void *draw, const char *name) {
    return hn_draw_answer_name(draw, name);
}

/// One entry, as the student or the exercise wrote it. `read_as` (may be NULL) says how it was read
/// where its spelling is another one.
static hn_status read_entry(hn_draw *d, const cJSON *node, hn_ex *e, char read_as[HN_PART_READ_AS],
                            hn_diag *diag) {
    char number[40];
    const char *text = cJSON_GetStringValue(node);
    if (cJSON_IsNumber(node)) {
        snprintf(number, sizeof number, "%.17g", node->valuedouble);
        text = number;
    }
    if (!text) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "an entry is no formula in quotes");
    }
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_status status = hn_spelling_normalise(&plain, text, diag);
    HN_THEN(status, hn_draw_parse(d, hn_strbuf_text(&plain), e, diag));
    if (status == HN_OK && read_as && !read_as[0]) {
        hn_read_as(text, hn_strbuf_text(&plain), find_name, d, read_as, HN_PART_READ_AS);
    }
    hn_strbuf_reset(&plain);
    return status;
}

/// Rows of formulas; a plain list is one column. `read_as`: of the first entry in another spelling.
static hn_status read_table(hn_draw *d, const cJSON *node, table *t, char read_as[HN_PART_READ_AS],
                            hn_diag *diag) {
    const cJSON *row;
    *t = (table){0};
    cJSON_ArrayForEach(row, node) {
        const int cols = cJSON_IsArray(row) ? cJSON_GetArraySize(row) : 1;
        if (t->rows == MAX_SIZE || cols > MAX_SIZE || cols < 1 || (t->rows && cols != t->cols)) {
            return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                               "expected rows of one length, at most %d of them", MAX_SIZE);
        }
        t->cols = cols;
        for (int j = 0; j < cols; j++) {
            const cJSON *entry = cJSON_IsArray(row) ? cJSON_GetArrayItem(row, j) : row;
            HN_TRY(read_entry(d, entry, &t->e[t->rows][j], read_as, diag));
        }
        t->rows++;
    }
    return t->rows ? HN_OK : hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "expected a list of rows");
}

static void evaluate(hn_draw *d, const table *t, int state, double *x) {
    for (int i = 0; i < t->rows; i++) {
        for (int j = 0; j < t->cols; j++) {
            x[i * t->cols + j] = hn_draw_eval(d, t->e[i][j], state);
        }
    }
}

/// max |J N| over max |J| max |N|; `transposed`: N has its rows and columns exchanged.
static double residual(hn_draw *d, const table *J, const table *N, int state, int transposed) {
    double j[MAX_SIZE * MAX_SIZE], n[MAX_SIZE * MAX_SIZE], worst = 0, size_j = 0, size_n = 0;
    const int cols = transposed ? N->rows : N->cols;
    evaluate(d, J, state, j);
    evaluate(d, N, state, n);
    for (int i = 0; i < J->rows; i++) {
        for (int k = 0; k < cols; k++) {
            double sum = 0;
            for (int m = 0; m < J->cols; m++) {
                const double entry = transposed ? n[k * N->cols + m] : n[m * N->cols + k];
                sum += j[i * J->cols + m] * entry;
                size_j = fmax(size_j, fabs(j[i * J->cols + m]));
                size_n = fmax(size_n, fabs(entry));
            }
            worst = fmax(worst, fabs(sum));
        }
    }
    return size_j * size_n > 0 ? worst / (size_j * size_n) : isfinite(worst) ? 0 : HUGE_VAL;
}

static int rank_of(hn_draw *d, const table *N, int state) {
    double x[MAX_SIZE * MAX_SIZE], sigma[MAX_SIZE];
    evaluate(d, N, state, x);
    hn_arena *arena = hn_arena_create(0);
    const int n = N->rows < N->cols ? N->rows : N->cols;
    int rank = -1;
    if (arena && hn_singular_values(N->rows, N->cols, x, sigma, arena) == HN_OK) {
        rank = hn_rank_of(n, sigma, 1e-9);
    }
    hn_arena_free(arena);
    return rank;
}

static double worst_residual(hn_draw *d, const table *J, const table *N, int transposed) {
    double worst = 0;
    for (int s = 0; s < d->n_states; s++) {
        const double x = residual(d, J, N, s, transposed);
        worst = isfinite(x) ? fmax(worst, x) : HUGE_VAL;
    }
    return worst;
}

/// A row whose sign, turned, would make J N = 0; -1 if there is none.
static int find_sign(hn_draw *d, const table *J, const table *N) {
    for (int i = 0; i < N->rows; i++) {
        table turned = *N;
        for (int j = 0; j < N->cols; j++) {
            turned.e[i][j].c = -turned.e[i][j].c;
        }
        if (worst_residual(d, J, &turned, 0) <= ALLOWED) {
            return i;
        }
    }
    return -1;
}

static void judge(hn_draw *d, const table *J, const table *N, int r, hn_part_result *out) {
    // the shape, or that of the transpose
    if (N->rows != J->cols || N->cols != r) {
        const int transposed = N->cols == J->cols && N->rows == r;
        hn_part_wrong(out, transposed ? "transposed" : "shape", transposed ? 0.5 : 0,
                      "N needs %d rows (one for each coordinate) and %d columns (one for each "
                      "degree of freedom); given: %d x %d",
                      J->cols, r, N->rows, N->cols);
        return;
    }

    // in the null space, perhaps but for the sign of one row
    if (worst_residual(d, J, N, 0) > ALLOWED) {
        const int i = find_sign(d, J, N);
        if (i >= 0) {
            hn_part_wrong(out, "sign", 0.5, "J N is not 0; with the sign of row %d turned it is",
                          i + 1);
        } else {
            hn_part_wrong(out, "not-null", 0, "J N is not 0 (%.2g of the sizes of J and N)",
                          worst_residual(d, J, N, 0));
        }
        return;
    }

    // independent columns in every state
    for (int s = 0; s < d->n_states; s++) {
        const int rank = rank_of(d, N, s);
        if (rank < r) {
            hn_part_wrong(out, "rank", rank > 0 ? 0.25 : 0,
                          "J N = 0, but the columns are dependent: rank %d, %d are needed", rank,
                          r);
            return;
        }
    }
    hn_part_right(out);
}

static hn_status open_draw(const hn_part *p, hn_draw *d, table *J, hn_diag *diag) {
    HN_TRY(hn_draw_init(d, cJSON_GetObjectItemCaseSensitive(p->node, "states"),
                        cJSON_GetObjectItemCaseSensitive(p->node, "conditions"), p->draw, STATES,
                        p->seed ^ 0xba5e, diag));
    return read_table(d, cJSON_GetObjectItemCaseSensitive(p->node, "jacobian"), J, NULL, diag);
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    hn_draw d;
    table J, N;
    hn_diag why = {0};

    const bool handed_in = hn_part_begin(r, n, given, "any N with J N = 0 and full rank");

    // judged only when it can be read
    hn_status status = open_draw(p, &d, &J, diag);
    if (status == HN_OK && handed_in) {
        const hn_status read = read_table(&d, given, &N, r->read_as, &why);
        if (read == HN_OK) {
            const int wanted = (int)hn_part_number(p->node, "freedoms", J.cols - J.rows);
            judge(&d, &J, &N, wanted, r);
        } else {
            hn_part_unreadable(r, "%s%s%.80s", why.message, why.hint[0] ? "; " : "", why.hint);
            status = read == HN_ERR_MEMORY ? read : status;
        }
    }

    // the draw is closed on every path
    hn_draw_reset(&d);
    return status;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *m;
    hn_strbuf_add(b, "rows of formulas in quotes, [[\"...\", ...], ...]; names:");
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, "states")) {
        hn_strbuf_printf(b, " %s", m->string);
    }
}

const hn_part_kind hn_part_basis = {
    .name = "basis",
    .fields = "states conditions jacobian freedoms answer faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // grading multiplies J N and computes the rank
};
