// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/rows.h"

#include <math.h>

/// Puts entry `at` in column `col` in its place among those that row i has so far.
static void insert(hn_closure_rows *rows, int i, int end, int col, int at) {
    int k = end;
    for (; k > rows->first[i] && rows->col[k - 1] > col; k--) {
        rows->col[k] = rows->col[k - 1];
        rows->at[k] = rows->at[k - 1];
    }
    rows->col[k] = col;
    rows->at[k] = at;
}

hn_status hn_closure_rows_create(const hn_eval *eval, int nc, hn_arena *arena,
                                 hn_closure_rows *rows) {
    const int *row, *col, n = hn_eval_pattern(eval, HN_TERM_J, &row, &col);
    *rows = (hn_closure_rows){.n = nc,
                              .J = hn_eval_list(eval, HN_TERM_J),
                              .first = hn_arena_ints(arena, (size_t)nc + 1),
                              .col = hn_arena_ints(arena, (size_t)n),
                              .at = hn_arena_ints(arena, (size_t)n)};
    int *filled = hn_arena_ints(arena, (size_t)nc + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // room for each row, then its columns in order
    for (int k = 0; k < n; k++) {
        rows->first[row[k] + 1]++;
    }
    for (int i = 0; i < nc; i++) {
        rows->first[i + 1] += rows->first[i];
        filled[i] = rows->first[i];
    }
    for (int k = 0; k < n; k++) {
        insert(rows, row[k], filled[row[k]]++, col[k], k);
    }
    return HN_OK;
}

double hn_closure_rows_length(const hn_closure_rows *rows, int i) {
    const int first = rows->first[i], end = rows->first[i + 1];
    double most = 0, sum = 0;
    for (int k = first; k < end; k++) {
        const double size = fabs(rows->J[rows->at[k]]);
        if (isnan(size)) {
            return size;
        }
        most = size > most ? size : most;
    }
    if (most == 0 || !isfinite(most)) {
        return most;
    }
    for (int k = first; k < end; k++) {
        const double part = rows->J[rows->at[k]] / most;
        sum += part * part;
    }
    return most * sqrt(sum);
}

double hn_closure_rows_largest(const hn_closure_rows *rows, int i, const double *x) {
    double most = 0;
    for (int k = rows->first[i]; k < rows->first[i + 1]; k++) {
        const double size = fabs(rows->J[rows->at[k]] * x[rows->col[k]]);
        most = size > most ? size : most;
    }
    return most;
}
