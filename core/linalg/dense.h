// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_DENSE_H
#define HN_LINALG_DENSE_H
// Small dense kernels. Matrices are row-major; nothing here allocates, and every sum runs in one
// fixed order, so the same input gives the same bits.

#include "base/status.h"

#include <stdbool.h>

/// x' y, both of n entries. For the handful of entries that most calls have, a call would cost more
/// than the sum.
static inline double hn_dot(int n, const double *x, const double *y) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}
double hn_norm2(int n, const double *x);    ///< Euclidean, safe against overflow of the squares
double hn_norm_max(int n, const double *x); ///< max |x_i|; 0 for n = 0
bool hn_all_finite(int n, const double *x); ///< true when no entry is NaN or infinite

/// y += s x
static inline void hn_axpy(int n, double s, const double *x, double *y) {
    for (int i = 0; i < n; i++) {
        y[i] += s * x[i];
    }
}
/// y = A x, A (rows x cols)
void hn_mat_vec(int rows, int cols, const double *A, const double *x, double *y);
/// y = A' x, A (rows x cols), x (rows), y (cols)
void hn_mat_t_vec(int rows, int cols, const double *A, const double *x, double *y);
/// x' A y of a symmetric A (n x n); lower triangle read.
double hn_quad_sym(int n, const double *A, const double *x, const double *y);
/// Copies the lower triangle of A onto its upper one.
void hn_mirror_lower(int n, double *A);

/// Cholesky A = L L' in place: the lower triangle is read and replaced by L, the upper one is left
/// alone. `lda` is the distance between rows. A pivot not above `tol` fails with HN_ERR_SINGULAR,
/// one below -tol with HN_ERR_NOT_SPD (A is then spoiled); tol is absolute: scale the matrix first.
HN_MUST_CHECK hn_status hn_cholesky(int n, double *A, int lda, double tol);
/// x <- A^-1 x with L from hn_cholesky().
void hn_cholesky_solve(int n, const double *L, int lda, double *x);
/// x <- L^-1 x and x <- L^-T x.
void hn_lower_solve(int n, const double *L, int lda, double *x);
void hn_lower_t_solve(int n, const double *L, int lda, double *x);

/// A sum kept to twice the working precision: value = hi + lo. Start from {0, 0}.
/// Source: Ogita, Rump & Oishi 2005, Accurate sum and dot product, algorithm 5.3.
typedef struct hn_sum2 {
    double hi, lo;
} hn_sum2;
void hn_sum2_add(hn_sum2 *s, double x);
void hn_sum2_add_product(hn_sum2 *s, double x, double y);
double hn_sum2_value(const hn_sum2 *s);

#endif
