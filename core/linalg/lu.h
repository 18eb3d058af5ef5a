// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_LU_H
#define HN_LINALG_LU_H
// LU factors with row exchanges, real and complex, for the matrices of Newton's method: neither
// symmetric nor definite. Rows are brought to length 1 (largest entry) before pivots are compared,
// so that units of rows do not decide. Nothing allocates.
// Source: Golub & Van Loan 2013, sections 3.4 and 3.5.

#include "base/status.h"

/// A complex number as two neighbours in an array.
typedef struct hn_complex {
    double re, im;
} hn_complex;

/// 1 / (re + i im)
hn_complex hn_complex_reciprocal(double re, double im);

/// A = P L U in place, A (n x n) row-major; pivot (n) receives the exchanges, scale (n) is scratch.
/// Fails with HN_ERR_SINGULAR when a pivot is not above 1e-14 of its row, HN_ERR_DIVERGED when an
/// entry is not finite; A is then spoiled.
HN_MUST_CHECK hn_status hn_lu_factor(int n, double *A, int *pivot, double *scale);
/// x <- A^-1 x
void hn_lu_solve(int n, const double *A, const int *pivot, double *x);

/// The same two for complex matrices.
HN_MUST_CHECK hn_status hn_lu_factor_complex(int n, hn_complex *A, int *pivot, double *scale);
void hn_lu_solve_complex(int n, const hn_complex *A, const int *pivot, hn_complex *x);

#endif
