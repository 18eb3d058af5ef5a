// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/block_lu.h"

#include "base/status.h"
#include "expr/construct.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Judgements of pivots of one row, the smaller the better: numbers by the fill that they make,
/// then entries alone in their row or column, then any others.
enum { LONE = HN_BLOCK_LU_MOST * HN_BLOCK_LU_MOST, ANY = 2 * LONE };
static const double THRESHOLD = 0.1;  // of the largest entry of the column
static const double VANISHED = 1e-13; // of the largest entry of the matrix

// ---- the order ----

/// The matrix while its order is chosen: entries that are not identically zero, those that are
/// numbers, and values.
typedef struct plan {
    hn_block_lu *lu;
    int n, done;
    bool used[HN_BLOCK_LU_MOST][HN_BLOCK_LU_MOST], number[HN_BLOCK_LU_MOST][HN_BLOCK_LU_MOST];
    double value[HN_BLOCK_LU_MOST][HN_BLOCK_LU_MOST];
    bool row_done[HN_BLOCK_LU_MOST], col_done[HN_BLOCK_LU_MOST];
    double largest; ///< entry at the start
} plan;

static bool is_open(const plan *p, int i, int j) {
    return !p->row_done[i] && !p->col_done[j] && p->used[i][j];
}

static int count_row(const plan *p, int i) {
    int n = 0;
    for (int j = 0; j < p->n; j++) {
        n += is_open(p, i, j);
    }
    return n;
}

static int count_col(const plan *p, int j) {
    int n = 0;
    for (int i = 0; i < p->n; i++) {
        n += is_open(p, i, j);
    }
    return n;
}

/// Returns whether entry (i, j) is large enough for a pivot.
static bool is_large(const plan *p, int i, int j) {
    double most = 0;
    for (int k = 0; k < p->n; k++) {
        most = is_open(p, k, j) ? fmax(most, fabs(p->value[k][j])) : most;
    }
    return fabs(p->value[i][j]) >= THRESHOLD * most && most > VANISHED * p->largest;
}

/// Judges entry (i, j) as a pivot; -1: it is none.
static int judge_single(const plan *p, int i, int j) {
    const int row = count_row(p, i), col = count_col(p, j), fill = (row - 1) * (col - 1);
    if (!(fabs(p->value[i][j]) > VANISHED * p->largest)) {
        return -1;
    }
    if (row == 1 || col == 1) {
        return p->number[i][j] ? fill : LONE + fill;
    }
    return !is_large(p, i, j) ? -1 : p->number[i][j] ? fill : ANY + fill;
}

/// The best single pivot; returns its judgement, -1: none.
static int find_single(const plan *p, int *row, int *col) {
    int best = -1;
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->n; j++) {
            const int rank = is_open(p, i, j) ? judge_single(p, i, j) : -1;
            if (rank >= 0 && (best < 0 || rank < best)) {
                best = rank;
                *row = i;
                *col = j;
            }
        }
    }
    return best;
}

/// Returns whether the open entries of two rows lie in the same two columns; `turned`: rows for
/// columns.
static bool are_pair(const plan *p, int a, int b, bool turned, int out[2]) {
    int n = 0;
    for (int k = 0; k < p->n; k++) {
        const bool at_a = turned ? is_open(p, k, a) : is_open(p, a, k);
        const bool at_b = turned ? is_open(p, k, b) : is_open(p, b, k);
        if ((at_a || at_b) && n == 2) {
            return false;
        }
        if (at_a || at_b) {
            out[n++] = k;
        }
    }
    return n == 2;
}

/// Two rows with the same two columns, or two columns with the same two rows.
static bool find_pair(const plan *p, int row[2], int col[2]) {
    for (int turned = 0; turned <= 1; turned++) {
        const bool *done = turned ? p->col_done : p->row_done;
        for (int a = 0; a < p->n; a++) {
            for (int b = a + 1; b < p->n && !done[a]; b++) {
                int *own = turned ? col : row, *other = turned ? row : col;
                own[0] = a;
                own[1] = b;
                if (!done[b] && are_pair(p, a, b, turned, other)) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// Row m less its multiple of the pivot row: values, and which entries are used.
static void eliminate(plan *p, int i, int j, int m) {
    if (p->row_done[m] || m == i || !p->used[m][j]) {
        return;
    }
    const double factor = p->value[m][j] / p->value[i][j];
    for (int c = 0; c < p->n; c++) {
        if (!p->col_done[c] && c != j && p->used[i][c]) {
            p->value[m][c] -= factor * p->value[i][c];
            p->used[m][c] = true;
            p->number[m][c] = false;
        }
    }
}

static void take(plan *p, int i, int j) {
    for (int m = 0; m < p->n; m++) {
        eliminate(p, i, j, m);
    }
    p->row_done[i] = p->col_done[j] = true;
    p->lu->row[p->done] = i;
    p->lu->col[p->done++] = j;
}

/// Takes two rows and columns as one pivot; the larger of the first column's entries leads, which
/// matters for the values alone.
static bool take_pair(plan *p, const int row[2], const int col[2]) {
    const double a = p->value[row[0]][col[0]], b = p->value[row[0]][col[1]];
    const double c = p->value[row[1]][col[0]], d = p->value[row[1]][col[1]];
    const int first = fabs(a) >= fabs(c) ? 0 : 1;
    if (!(fabs(a * d - b * c) > VANISHED * p->largest * p->largest)) {
        return false;
    }
    take(p, row[first], col[0]);
    take(p, row[1 - first], col[1]);
    p->lu->size[p->lu->n_blocks++] = 2;
    return true;
}

static bool take_next(plan *p) {
    int i = 0, j = 0, row[2], col[2];
    const int single = find_single(p, &i, &j);
    if ((single < 0 || single >= ANY) && find_pair(p, row, col)) {
        return take_pair(p, row, col);
    }
    if (single < 0) {
        return false;
    }
    take(p, i, j);
    p->lu->size[p->lu->n_blocks++] = 1;
    return true;
}

static int sign_of(int n, const int *order) {
    int sign = 1;
    for (int i = 0; i < n; i++) {
        for (int k = i + 1; k < n; k++) {
            sign = order[k] < order[i] ? -sign : sign;
        }
    }
    return sign;
}

bool hn_block_lu_plan(hn_block_lu *lu, int n, const hn_ex *A, const double *value) {
    plan p = {.lu = lu, .n = n};
    HN_ASSERT(n <= HN_BLOCK_LU_MOST);
    *lu = (hn_block_lu){.n = n};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            p.value[i][j] = value[i * n + j];
            p.used[i][j] = !hn_is_zero(A[i * n + j]);
            p.number[i][j] = hn_is_number(A[i * n + j], NULL);
            p.largest = fmax(p.largest, fabs(p.value[i][j]));
        }
    }
    while (p.done < n) {
        if (!take_next(&p)) {
            return false;
        }
    }
    lu->sign = sign_of(n, lu->row) * sign_of(n, lu->col);
    return true;
}

void hn_block_lu_plan_in_order(hn_block_lu *lu, int n) {
    HN_ASSERT(n <= HN_BLOCK_LU_MOST);
    *lu = (hn_block_lu){.n = n, .n_blocks = n, .sign = 1};
    for (int k = 0; k < n; k++) {
        lu->row[k] = lu->col[k] = k;
        lu->size[k] = 1;
    }
}

// ---- elimination ----

typedef struct work {
    hn_graph *g;
    const hn_block_lu *lu;
    hn_ex *A, *B;
    int m;
    hn_ex inverse[HN_BLOCK_LU_MOST][2][2]; ///< of each block
} work;

static hn_ex *at(const work *w, int i, int j) {
    return &w->A[i * w->lu->n + j];
}

/// *sum -= a b
static void subtract(hn_graph *g, hn_ex *sum, hn_ex a, hn_ex b) {
    *sum = hn_sub(g, *sum, hn_mul(g, a, b));
}

/// The inverse of block b, which starts at position k. Returns its pivot.
static hn_ex invert(work *w, int b, int k) {
    hn_graph *g = w->g;
    const int *row = w->lu->row + k, *col = w->lu->col + k;
    hn_ex(*out)[2] = w->inverse[b];
    if (w->lu->size[b] == 1) {
        const hn_ex pivot = *at(w, row[0], col[0]);
        out[0][0] = hn_div(g, hn_num(1), pivot);
        return pivot;
    }

    // the inverse of two rows by their determinant
    const hn_ex a = *at(w, row[0], col[0]), c = *at(w, row[0], col[1]);
    const hn_ex d = *at(w, row[1], col[0]), e = *at(w, row[1], col[1]);
    const hn_ex det = hn_sub(g, hn_mul(g, a, e), hn_mul(g, c, d));
    const hn_ex over = hn_div(g, hn_num(1), det);
    out[0][0] = hn_mul(g, e, over);
    out[0][1] = hn_neg(hn_mul(g, c, over));
    out[1][0] = hn_neg(hn_mul(g, d, over));
    out[1][1] = hn_mul(g, a, over);
    return det;
}

/// Takes block b, which starts at position k, out of the rows after it.
static void forward(work *w, int b, int k) {
    hn_graph *g = w->g;
    const hn_block_lu *lu = w->lu;
    const int size = lu->size[b];
    for (int next = k + size; next < lu->n; next++) {
        const int i = lu->row[next];
        for (int s = 0; s < size; s++) {
            // the multiple of row s of the block
            hn_ex factor = hn_num(0);
            for (int r = 0; r < size; r++) {
                const hn_ex part = hn_mul(g, *at(w, i, lu->col[k + r]), w->inverse[b][r][s]);
                factor = hn_add(g, factor, part);
            }
            const int from = lu->row[k + s];
            for (int c = k + size; c < lu->n; c++) {
                subtract(g, at(w, i, lu->col[c]), factor, *at(w, from, lu->col[c]));
            }
            for (int c = 0; c < w->m; c++) {
                subtract(g, &w->B[i * w->m + c], factor, w->B[from * w->m + c]);
            }
        }
    }
}

/// The unknowns of block b, which starts at position k, from those of the blocks after it.
static void back(work *w, int b, int k, hn_ex *x) {
    hn_graph *g = w->g;
    const hn_block_lu *lu = w->lu;
    const int size = lu->size[b];
    for (int c = 0; c < w->m; c++) {
        hn_ex rest[2];
        for (int s = 0; s < size; s++) {
            const int i = lu->row[k + s];
            rest[s] = w->B[i * w->m + c];
            for (int later = k + size; later < lu->n; later++) {
                subtract(g, &rest[s], *at(w, i, lu->col[later]), x[lu->col[later] * w->m + c]);
            }
        }
        for (int r = 0; r < size; r++) {
            hn_ex sum = hn_num(0);
            for (int s = 0; s < size; s++) {
                sum = hn_add(g, sum, hn_mul(g, w->inverse[b][r][s], rest[s]));
            }
            x[lu->col[k + r] * w->m + c] = sum;
        }
    }
}

void hn_block_lu_solve(hn_graph *g, hn_block_lu *lu, hn_ex *A, hn_ex *B, int m, hn_ex *x) {
    work w = {.g = g, .lu = lu, .A = A, .B = B, .m = m};
    int k = 0;
    for (int b = 0; b < lu->n_blocks; k += lu->size[b++]) {
        lu->pivot[b] = invert(&w, b, k);
        forward(&w, b, k);
    }
    for (int b = lu->n_blocks - 1; b >= 0; b--) {
        k -= lu->size[b];
        back(&w, b, k, x);
    }
}
