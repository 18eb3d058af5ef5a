// SPDX-License-Identifier: GPL-3.0-or-later
// A basis of the null space of a Jacobian, as formulas: any basis is right. J N = 0 and the rank of
// N are tested at random states.
#include "grade/parts/blank.h"
#include "grade/parts/part_list.h"
#include "grade/parts/read_as.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/spelling.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { STATES = 8, MAX_SIZE = 8, MAX_ORDERED = 5 };
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

/// Returns whether N is a basis once the factor between degrees and radians of its angles is
/// taken away.
static bool is_in_degrees(hn_draw *d, const table *J, const table *N) {
    static const double FACTORS[] = {57.29577951308232, 0.017453292519943295};
    hn_graph *g = d->graph;
    int names[HN_DRAW_NAMES], n = 0;
    for (int i = 0; i < d->n_names; i++) {
        names[n] = i;
        n += hn_draw_is_angle(d, i);
    }
    for (size_t k = 0; k < sizeof FACTORS / sizeof *FACTORS; k++) {
        hn_ex with[HN_DRAW_NAMES];
        table turned = *N;
        for (int i = 0; i < n; i++) {
            with[i] = hn_scale(FACTORS[k], hn_graph_symbol_expr(g, names[i]));
        }
        for (int i = 0; i < N->rows; i++) {
            hn_substitute(g, N->e[i], N->cols, names, with, n, turned.e[i]);
        }
        if (worst_residual(d, J, &turned, 0) <= ALLOWED) {
            return true;
        }
    }
    return false;
}

/// Finds the order of rows in which N is a basis: row i of it is row order[i] of N. False: none.
static bool find_order(hn_draw *d, const table *J, const table *N, int place, int order[MAX_SIZE]) {
    for (int row = 0; row < N->rows && place < N->rows; row++) {
        bool free = true;
        for (int i = 0; i < place; i++) {
            free &= order[i] != row;
        }
        order[place] = row;
        if (free && find_order(d, J, N, place + 1, order)) {
            return true;
        }
    }
    if (place < N->rows) {
        return false;
    }
    table moved = *N;
    for (int i = 0; i < N->rows; i++) {
        memcpy(moved.e[i], N->e[order[i]], sizeof moved.e[i]);
    }
    return worst_residual(d, J, &moved, 0) <= ALLOWED;
}

/// Returns whether J N is 0 in one state once row i of N is replaced by what fits the other rows.
static bool others_fit(hn_draw *d, const table *J, const table *N, int i, int state) {
    double j[MAX_SIZE * MAX_SIZE], n[MAX_SIZE * MAX_SIZE], size_j = 0, size_n = 0, rest = 0;
    evaluate(d, J, state, j);
    evaluate(d, N, state, n);
    for (int c = 0; c < N->cols; c++) {
        double sum[MAX_SIZE] = {0}, along = 0, square = 0;
        for (int k = 0; k < J->rows; k++) {
            for (int m = 0; m < J->cols; m++) {
                sum[k] += m == i ? 0 : j[k * J->cols + m] * n[m * N->cols + c];
                size_j = fmax(size_j, fabs(j[k * J->cols + m]));
                size_n = fmax(size_n, fabs(n[m * N->cols + c]));
            }
            along -= sum[k] * j[k * J->cols + i];
            square += j[k * J->cols + i] * j[k * J->cols + i];
        }
        for (int k = 0; k < J->rows && square > 0; k++) {
            rest = fmax(rest, fabs(sum[k] + along / square * j[k * J->cols + i]));
        }
    }
    return rest <= ALLOWED * size_j * size_n;
}

/// The one row that does not fit the others, as their J N can be made 0 by it alone; -1: none, or
/// more than one.
static int find_misfit(hn_draw *d, const table *J, const table *N) {
    int found = -1;
    for (int i = 0; i < N->rows; i++) {
        bool fits = true;
        for (int s = 0; s < d->n_states && fits; s++) {
            fits = others_fit(d, J, N, i, s);
        }
        if (fits && found >= 0) {
            return -1;
        }
        found = fits ? i : found;
    }
    return found;
}

/// The row of J N that is farthest from 0 over the states, from 1.
static int find_worst_row(hn_draw *d, const table *J, const table *N) {
    double worst = -1;
    int row = 0;
    for (int i = 0; i < J->rows; i++) {
        table one = {.rows = 1, .cols = J->cols};
        memcpy(one.e[0], J->e[i], sizeof one.e[0]);
        const double x = worst_residual(d, &one, N, 0);
        row = x > worst ? i + 1 : row;
        worst = fmax(worst, x);
    }
    return row;
}

/// Names what keeps N from the null space.
static void explain(hn_draw *d, const table *J, const table *N, hn_part_result *out) {
    int order[MAX_SIZE];
    const int turned = find_sign(d, J, N), misfit = find_misfit(d, J, N);
    const double worst = worst_residual(d, J, N, 0);
    if (turned >= 0) {
        hn_part_wrong(out, "sign", 0.5, "J N is not 0; with the sign of row %d turned it is",
                      turned + 1);
    } else if (is_in_degrees(d, J, N)) {
        hn_part_wrong(out, "degrees", 0.5, "sine and cosine were taken of degrees");
    } else if (N->rows <= MAX_ORDERED && find_order(d, J, N, 0, order)) {
        hn_part_wrong(out, "order", 0.5,
                      "the rows stand in another order: row %d belongs to the first coordinate",
                      order[0] + 1);
    } else if (misfit >= 0) {
        hn_part_wrong(out, "one-row", 0.25,
                      "J N is not 0, but with another row %d of N it would be: that row is wrong",
                      misfit + 1);
    } else if (!isfinite(worst)) {
        hn_part_wrong(out, "not-null", 0, "N has no finite value at some configurations");
    } else {
        hn_part_wrong(out, "not-null", 0,
                      "J N must be 0; the product of row %d of J with your N is farthest from it",
                      find_worst_row(d, J, N));
    }
}

static void judge(hn_draw *d, const table *J, const table *N, int r, hn_part_result *out) {
    // the shape, or that of the transpose
    if (N->rows != J->cols || N->cols != r) {
        const int transposed = N->cols == J->cols && N->rows == r;
        hn_part_wrong(out, transposed ? "transposed" : "shape", transposed ? 0.5 : 0,
                      "N needs %d rows (one for each coordinate) and %d column%s (one for each "
                      "degree of freedom); yours is %d x %d",
                      J->cols, r, r == 1 ? "" : "s", N->rows, N->cols);
        return;
    }

    if (worst_residual(d, J, N, 0) > ALLOWED) {
        explain(d, J, N, out);
        return;
    }

    // independent columns in every state
    for (int s = 0; s < d->n_states; s++) {
        const int rank = rank_of(d, N, s);
        if (rank < r) {
            hn_part_wrong(out, "rank", rank > 0 ? 0.25 : 0,
                          "J N = 0, but N has rank %d and needs %d: %s", rank, r,
                          rank == 0 ? "all its entries are 0 at some configuration"
                                    : "its columns depend on each other");
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
    .blank = hn_blank_texts,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // grading multiplies J N and computes the rank
};
