// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_FLOPS_H
#define HN_FORMULATIONS_FLOPS_H
// Arithmetic operations (additions and multiplications count one each) of the dense linear algebra
// that methods do in addition to their tapes. Leading terms as in Golub & Van Loan 2013: exact
// enough to compare methods, and free of timing noise.

double hn_flops_qr(int m, int n);       ///< Householder QR with pivoting, m x n
double hn_flops_qr_solve(int m, int n); ///< Q' b and R^-1
/// L L' of an n x n matrix, and one solution with it.
double hn_flops_cholesky(int n);
double hn_flops_cholesky_solve(int n);
double hn_flops_product(int m, int k, int n); ///< (m x k) (k x n)
/// The dense rank-revealing solve of linalg/saddle.h with one refinement.
double hn_flops_saddle(int nv, int nc);

#endif
