// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/svd.h"

#include "linalg/dense.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

hn_status hn_singular_values(int rows, int cols, const double *A, double *sigma, hn_arena *arena) {
    size_t n_in = (size_t)rows * (size_t)cols;
    if (!hn_all_finite((int)n_in, A)) {
        return HN_ERR_DIVERGED;
    }
    // GSL wants at least as many rows as columns; A and A' share their singular values
    int flip = rows < cols;
    size_t m = (size_t)(flip ? cols : rows), n = (size_t)(flip ? rows : cols);
    if (n == 0) {
        return HN_OK;
    }
    double *U = hn_arena_doubles(arena, m * n), *V = hn_arena_doubles(arena, n * n);
    double *s = hn_arena_doubles(arena, n), *work = hn_arena_doubles(arena, n);
    if (!U || !V || !s || !work) {
        return HN_ERR_MEMORY;
    }
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j < n; j++) {
            U[i * n + j] = flip ? A[j * m + i] : A[i * n + j];
        }
    }

    gsl_matrix_view u = gsl_matrix_view_array(U, m, n), v = gsl_matrix_view_array(V, n, n);
    gsl_vector_view values = gsl_vector_view_array(s, n), scratch = gsl_vector_view_array(work, n);
    if (gsl_linalg_SV_decomp(&u.matrix, &v.matrix, &values.vector, &scratch.vector) != 0) {
        return HN_ERR_NO_CONVERGENCE;
    }
    for (size_t k = 0; k < n; k++) {
        sigma[k] = s[k];
    }
    return HN_OK;
}

int hn_rank_of(int n, const double *sigma, double tol) {
    int rank = 0;
    while (rank < n && sigma[rank] > tol * sigma[0]) {
        rank++;
    }
    return rank;
}

double hn_condition_of(int n, const double *sigma) {
    if (n == 0) {
        return 1;
    }
    return sigma[n - 1] > 0 ? sigma[0] / sigma[n - 1] : HUGE_VAL;
}
