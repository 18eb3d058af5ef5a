// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/sparse_lu.h"

#include "linalg/dense.h"
#include "linalg/least_heap.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double THRESHOLD = 0.1; // of the largest entry of a column: what may be its pivot

struct hn_sparse_lu {
    int n_max, entries_max;
    int n, n_entries, ordered;
    // the entries of A by row of P A Q: a_entry[a_start[k] ..] are numbers of entries
    int *row, *col, *a_start, *a_entry;
    int *p, *q;           // pivot k is A(p[k], q[k])
    int *row_at, *col_at; // the inverse
    // pattern and values, row by row in pivot order, columns as pivot numbers in rising order
    int *l_start, *l_col, *u_start, *u_col;
    double *l, *u, *diag;
    double *work;
    // while an order is chosen
    double *full; // n x n, zero between two choices, as is what says where it is in use
    char *filled;
    int *row_count, *col_count;
    int *row_head, *col_head; // first node of each row and column, -1: none
    int *node_next, *node_at, n_nodes;
    hn_least_heap columns; // not eliminated yet, by their entries
    int sign;
    double refactor_ops, last_ops;
    // a full matrix of two rows, that of one loop in a plane: its entries in pivot order
    bool is_pair;
    int pair[4];
};

hn_sparse_lu *hn_sparse_lu_create(hn_arena *arena, int n_max, int entries_max) {
    hn_sparse_lu *lu = hn_arena_get(arena, sizeof *lu);
    if (!lu) {
        return NULL;
    }

    // full storage of the factors' pattern: the pattern is not known yet
    const size_t n = (size_t)n_max, m = (size_t)entries_max, half = n * (n + 1) / 2;
    *lu = (hn_sparse_lu){.n_max = n_max, .entries_max = entries_max};
    int **of_n[] = {&lu->a_start,   &lu->p,        &lu->q,       &lu->row_at,
                    &lu->col_at,    &lu->l_start,  &lu->u_start, &lu->row_count,
                    &lu->col_count, &lu->row_head, &lu->col_head};
    for (size_t i = 0; i < sizeof of_n / sizeof *of_n; i++) {
        *of_n[i] = hn_arena_ints(arena, n + 1);
    }

    lu->row = hn_arena_ints(arena, m);
    lu->col = hn_arena_ints(arena, m);
    lu->a_entry = hn_arena_ints(arena, m);
    lu->l_col = hn_arena_ints(arena, half);
    lu->u_col = hn_arena_ints(arena, half);
    lu->l = hn_arena_doubles(arena, half);
    lu->u = hn_arena_doubles(arena, half);
    lu->diag = hn_arena_doubles(arena, n);
    lu->work = hn_arena_doubles(arena, n);
    lu->full = hn_arena_doubles(arena, n * n);
    lu->filled = hn_arena_get(arena, n * n + 1);
    lu->node_next = hn_arena_ints(arena, 2 * n * n);
    lu->node_at = hn_arena_ints(arena, 2 * n * n);
    const bool has_heap = hn_least_heap_init(&lu->columns, arena, n_max);
    return has_heap && !hn_arena_failed(arena) ? lu : NULL;
}

void hn_sparse_lu_set_pattern(hn_sparse_lu *lu, int n, int n_entries, const int *row,
                              const int *col) {
    HN_ASSERT(n <= lu->n_max && n_entries <= lu->entries_max);
    lu->n = n;
    lu->n_entries = n_entries;
    lu->ordered = 0;
    lu->is_pair = false;
    memcpy(lu->row, row, (size_t)n_entries * sizeof *row);
    memcpy(lu->col, col, (size_t)n_entries * sizeof *col);
}

// ---- choosing the order ----

static void join(hn_sparse_lu *lu, int *head, int at) {
    const int node = lu->n_nodes++;
    lu->node_next[node] = *head;
    lu->node_at[node] = at;
    *head = node;
}

// entry (i, j) is in use from now on
static void use_entry(hn_sparse_lu *lu, int i, int j) {
    lu->filled[(size_t)i * (size_t)lu->n + (size_t)j] = 1;
    join(lu, &lu->row_head[i], j);
    join(lu, &lu->col_head[j], i);
    lu->row_count[i]++;
    lu->col_count[j]++;
}

// the matrix, its entries also as lists of rows and of columns
static void spread(hn_sparse_lu *lu, const double *values) {
    const size_t n = (size_t)lu->n;
    memset(lu->row_count, 0, n * sizeof *lu->row_count);
    memset(lu->col_count, 0, n * sizeof *lu->col_count);
    lu->n_nodes = 0;
    for (int i = 0; i < lu->n; i++) {
        lu->row_at[i] = lu->col_at[i] = -1; // not eliminated yet
        lu->row_head[i] = lu->col_head[i] = -1;
    }
    for (int k = 0; k < lu->n_entries; k++) {
        lu->full[(size_t)lu->row[k] * n + (size_t)lu->col[k]] = values[k];
        use_entry(lu, lu->row[k], lu->col[k]);
    }
    for (int j = 0; j < lu->n; j++) {
        hn_least_heap_set(&lu->columns, j, lu->col_count[j]);
    }
}

// zero again for the next time
static void clear(hn_sparse_lu *lu) {
    for (int i = 0; i < lu->n; i++) {
        for (int e = lu->row_head[i]; e >= 0; e = lu->node_next[e]) {
            const size_t at = (size_t)i * (size_t)lu->n + (size_t)lu->node_at[e];
            lu->full[at] = 0;
            lu->filled[at] = 0;
        }
        hn_least_heap_remove(&lu->columns, i);
    }
}

// the row of column j that may be its pivot and fills least; -1 when the column has vanished
static int choose_row(const hn_sparse_lu *lu, int j) {
    const size_t n = (size_t)lu->n, col = (size_t)j;
    double largest = 0, best_size = 0;
    int best = -1;
    for (int e = lu->col_head[j]; e >= 0; e = lu->node_next[e]) {
        const int i = lu->node_at[e];
        if (lu->row_at[i] < 0) {
            largest = fmax(largest, fabs(lu->full[(size_t)i * n + col]));
        }
    }

    // of those not much smaller the sparsest row, of these the largest, of these the first
    for (int e = lu->col_head[j]; e >= 0 && largest > 0; e = lu->node_next[e]) {
        const int i = lu->node_at[e];
        const double size = fabs(lu->full[(size_t)i * n + col]);
        if (lu->row_at[i] >= 0 || size < THRESHOLD * largest) {
            continue;
        }
        const int fewer = best < 0 ? -1 : lu->row_count[i] - lu->row_count[best];
        if (fewer < 0 || (fewer == 0 && (size > best_size || (!(size < best_size) && i < best)))) {
            best = i;
            best_size = size;
        }
    }
    return best;
}

// subtracts the pivot's part from row i, which gains the entries it did not have
static void eliminate_row(hn_sparse_lu *lu, int i, int p, int q) {
    const size_t n = (size_t)lu->n;
    double *row = lu->full + (size_t)i * n;
    const double *pivot_row = lu->full + (size_t)p * n;
    const double factor = row[q] / pivot_row[q];
    for (int e = lu->row_head[p]; e >= 0; e = lu->node_next[e]) {
        const int j = lu->node_at[e];
        if (lu->col_at[j] >= 0) {
            continue;
        }
        row[j] -= factor * pivot_row[j];
        if (!lu->filled[(size_t)i * n + (size_t)j]) {
            use_entry(lu, i, j);
        }
    }
    lu->row_count[i]--; // its entry in the pivot's column
}

static bool eliminate(hn_sparse_lu *lu, int k) {
    const int q = hn_least_heap_top(&lu->columns), p = choose_row(lu, q);
    if (p < 0) {
        return false;
    }
    lu->p[k] = p;
    lu->q[k] = q;
    lu->row_at[p] = k;
    lu->col_at[q] = k;
    hn_least_heap_remove(&lu->columns, q);
    for (int e = lu->row_head[p]; e >= 0; e = lu->node_next[e]) {
        lu->col_count[lu->node_at[e]]--;
    }
    for (int e = lu->col_head[q]; e >= 0; e = lu->node_next[e]) {
        if (lu->row_at[lu->node_at[e]] < 0) {
            eliminate_row(lu, lu->node_at[e], p, q);
        }
    }
    for (int e = lu->row_head[p]; e >= 0; e = lu->node_next[e]) {
        const int j = lu->node_at[e];
        if (lu->col_at[j] < 0) {
            hn_least_heap_set(&lu->columns, j, lu->col_count[j]);
        }
    }
    return true;
}

// room for the rows of L and U, which stand one after the other
static void count_pattern(hn_sparse_lu *lu) {
    const int n = lu->n;
    int n_l = 0, n_u = 0;
    for (int k = 0; k < n; k++) {
        lu->l_start[k] = n_l;
        lu->u_start[k] = n_u;
        for (int e = lu->row_head[lu->p[k]]; e >= 0; e = lu->node_next[e]) {
            const int m = lu->col_at[lu->node_at[e]];
            n_l += m < k;
            n_u += m > k;
        }
    }
    lu->l_start[n] = n_l;
    lu->u_start[n] = n_u;
}

// left of the pivot L, right of it U: column after column, so that the columns of each row rise
static void list_pattern(hn_sparse_lu *lu) {
    const int n = lu->n;
    int *next_l = lu->row_count, *next_u = lu->col_count; // free by now
    count_pattern(lu);
    memcpy(next_l, lu->l_start, (size_t)n * sizeof *next_l);
    memcpy(next_u, lu->u_start, (size_t)n * sizeof *next_u);
    for (int m = 0; m < n; m++) {
        for (int e = lu->col_head[lu->q[m]]; e >= 0; e = lu->node_next[e]) {
            const int k = lu->row_at[lu->node_at[e]];
            if (m < k) {
                lu->l_col[next_l[k]++] = m;
            } else if (m > k) {
                lu->u_col[next_u[k]++] = m;
            }
        }
    }

    lu->refactor_ops = 0;
    for (int i = 0; i < lu->l_start[n]; i++) {
        const int m = lu->l_col[i];
        lu->refactor_ops += 1 + 2.0 * (lu->u_start[m + 1] - lu->u_start[m]);
    }
}

static void list_entries(hn_sparse_lu *lu) {
    const int n = lu->n;
    int *next = lu->row_count; // free by now
    memset(next, 0, (size_t)n * sizeof *next);
    for (int e = 0; e < lu->n_entries; e++) {
        next[lu->row_at[lu->row[e]]]++;
    }
    lu->a_start[0] = 0;
    for (int k = 0; k < n; k++) {
        lu->a_start[k + 1] = lu->a_start[k] + next[k];
        next[k] = lu->a_start[k];
    }
    for (int e = 0; e < lu->n_entries; e++) {
        lu->a_entry[next[lu->row_at[lu->row[e]]]++] = e;
    }
}

// takes the places of the four entries of a full matrix of two rows
static void find_pair(hn_sparse_lu *lu) {
    lu->is_pair = lu->n == 2 && lu->n_entries == 4; // no place is given twice
    for (int e = 0; e < 4 && lu->is_pair; e++) {
        lu->pair[2 * lu->row_at[lu->row[e]] + lu->col_at[lu->col[e]]] = e;
    }
}

// parity of a permutation, from the lengths of its cycles; `seen` is scratch
static int parity(int n, const int *perm, int *seen) {
    int sign = 1;
    memset(seen, 0, (size_t)n * sizeof *seen);
    for (int i = 0; i < n; i++) {
        for (int j = i, first = 1; !seen[j]; j = perm[j], first = 0) {
            seen[j] = 1;
            sign = first ? sign : -sign;
        }
    }
    return sign;
}

static bool choose_order(hn_sparse_lu *lu, const double *values) {
    bool regular = true;
    lu->ordered = 0;
    spread(lu, values);
    for (int k = 0; k < lu->n && regular; k++) {
        regular = eliminate(lu, k);
    }
    if (regular) {
        list_pattern(lu);
    }
    clear(lu);
    if (!regular) {
        return false;
    }
    list_entries(lu);
    find_pair(lu);
    lu->sign = parity(lu->n, lu->p, lu->col_count) * parity(lu->n, lu->q, lu->col_count);
    lu->ordered = 1;
    return true;
}

// ---- factoring and solving ----

// row k of L and U; the largest entry of L
static double factor_row(hn_sparse_lu *lu, int k, const double *values) {
    double *w = lu->work, growth = 0;

    // the row of A in the work array, zero where it fills in
    for (int i = lu->l_start[k]; i < lu->l_start[k + 1]; i++) {
        w[lu->l_col[i]] = 0;
    }
    for (int i = lu->u_start[k]; i < lu->u_start[k + 1]; i++) {
        w[lu->u_col[i]] = 0;
    }
    w[k] = 0;
    for (int i = lu->a_start[k]; i < lu->a_start[k + 1]; i++) {
        const int e = lu->a_entry[i];
        w[lu->col_at[lu->col[e]]] = values[e];
    }

    // rows above it, in order
    for (int i = lu->l_start[k]; i < lu->l_start[k + 1]; i++) {
        const int m = lu->l_col[i];
        const double factor = w[m] / lu->diag[m];
        lu->l[i] = factor;
        growth = fmax(growth, fabs(factor));
        for (int j = lu->u_start[m]; j < lu->u_start[m + 1]; j++) {
            w[lu->u_col[j]] -= factor * lu->u[j];
        }
    }

    for (int i = lu->u_start[k]; i < lu->u_start[k + 1]; i++) {
        lu->u[i] = w[lu->u_col[i]];
    }
    lu->diag[k] = w[k];
    return growth;
}

static bool may_be_pivot(double value) {
    return value != 0 && isfinite(value);
}

// the same operations as row by row, without looking for their places
static bool factor_pair(hn_sparse_lu *lu, const double *values) {
    const double first = values[lu->pair[0]], right = values[lu->pair[1]];
    const double factor = values[lu->pair[2]] / first;
    const double second = values[lu->pair[3]] - factor * right;
    lu->diag[0] = first;
    lu->diag[1] = second;
    lu->l[0] = factor;
    lu->u[0] = right;
    return may_be_pivot(first) && may_be_pivot(second) && fabs(factor) <= HN_SPARSE_LU_GROWTH;
}

static void solve_pair(const hn_sparse_lu *lu, const double *b, double *x) {
    const double y = b[lu->p[0]], rest = b[lu->p[1]] - lu->l[0] * y;
    const double second = rest / lu->diag[1];
    x[lu->q[0]] = (y - lu->u[0] * second) / lu->diag[0];
    x[lu->q[1]] = second;
}

// 0 when the order does not serve these values
static bool factor_in_order(hn_sparse_lu *lu, const double *values) {
    lu->last_ops += lu->refactor_ops;
    if (lu->is_pair) {
        return factor_pair(lu, values);
    }
    for (int k = 0; k < lu->n; k++) {
        const double growth = factor_row(lu, k, values);
        if (!(growth <= HN_SPARSE_LU_GROWTH) || !may_be_pivot(lu->diag[k])) {
            return false;
        }
    }
    return true;
}

hn_status hn_sparse_lu_factor(hn_sparse_lu *lu, const double *values) {
    lu->last_ops = 0;
    if (!hn_all_finite(lu->n_entries, values)) {
        return HN_ERR_DIVERGED;
    }
    if (lu->ordered && factor_in_order(lu, values)) {
        return HN_OK;
    }
    if (!choose_order(lu, values)) {
        return HN_ERR_SINGULAR;
    }
    lu->last_ops += lu->refactor_ops;
    return factor_in_order(lu, values) ? HN_OK : HN_ERR_SINGULAR;
}

void hn_sparse_lu_solve(const hn_sparse_lu *lu, const double *b, double *x) {
    double *y = lu->work;
    if (lu->is_pair) {
        solve_pair(lu, b, x);
        return;
    }
    for (int k = 0; k < lu->n; k++) {
        double sum = b[lu->p[k]];
        for (int i = lu->l_start[k]; i < lu->l_start[k + 1]; i++) {
            sum -= lu->l[i] * y[lu->l_col[i]];
        }
        y[k] = sum;
    }
    for (int k = lu->n - 1; k >= 0; k--) {
        double sum = y[k];
        for (int i = lu->u_start[k]; i < lu->u_start[k + 1]; i++) {
            sum -= lu->u[i] * y[lu->u_col[i]];
        }
        y[k] = sum / lu->diag[k];
    }
    for (int k = 0; k < lu->n; k++) {
        x[lu->q[k]] = y[k];
    }
}

double hn_sparse_lu_smallest_pivot(const hn_sparse_lu *lu) {
    double smallest = HUGE_VAL;
    for (int k = 0; k < lu->n; k++) {
        smallest = fmin(smallest, fabs(lu->diag[k]));
    }
    return smallest;
}

double hn_sparse_lu_log_volume(const hn_sparse_lu *lu) {
    double sum = 0;
    for (int k = 0; k < lu->n; k++) {
        sum += log(fabs(lu->diag[k]));
    }
    return sum;
}

int hn_sparse_lu_sign(const hn_sparse_lu *lu) {
    int sign = lu->sign;
    for (int k = 0; k < lu->n; k++) {
        sign = lu->diag[k] < 0 ? -sign : sign;
    }
    return sign;
}

int hn_sparse_lu_nnz(const hn_sparse_lu *lu) {
    return lu->l_start[lu->n] + lu->u_start[lu->n] + lu->n;
}

double hn_sparse_lu_factor_ops(const hn_sparse_lu *lu) {
    return lu->last_ops;
}

double hn_sparse_lu_solve_ops(const hn_sparse_lu *lu) {
    return 2.0 * (lu->l_start[lu->n] + lu->u_start[lu->n]) + lu->n;
}
