// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_QR_H
#define HN_LINALG_QR_H
// Householder QR with column pivoting that stops where the columns left over are negligible:
//
//     A P = Q [R11 R12; 0 0],   R11 (rank x rank) upper triangular                          (1)
//
// A is held column by column: column k of A is a + k * m. For a constraint Jacobian J (nc x nv,
// row-major) that makes the array of J itself the matrix A = J' (nv x nc): its rows are A's
// columns.
// Source: Businger & Golub 1965; Golub & Van Loan 2013, section 5.4; norm downdating as in Drmac &
// Bujanovic 2008.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

/// One factorisation and its scratch. Plain data: read rank, perm, and R as a[column * m + row] for
/// row <= column.
typedef struct hn_qr {
    int m_max, n_max;
    int m, n;
    int rank; ///< columns that count
    /// largest norm among the columns left over, relative to |R_00|; 0 if none is left
    double dropped;
    double *a;    ///< in: A; out: R above, Householder vectors below the diagonal
    double *tau;  ///< n: H_k = I - tau_k v_k v_k'
    int *perm;    ///< n: column k of A P is column perm[k] of A
    double *norm; ///< 2 n scratch
    double *work; ///< max(m, n) scratch
    int *at;      ///< m scratch
} hn_qr;

/// Memory for up to m x n from the arena; returns false when memory is out.
HN_MUST_CHECK bool hn_qr_init(hn_qr *qr, hn_arena *arena, int m_max, int n_max);

/// Factors qr->a, filled by the caller as m x n. Columns whose remaining norm is at most rank_tol *
/// |R_00| are dropped.
void hn_qr_factor(hn_qr *qr, int m, int n, double rank_tol);
/// The rows below k where Householder vector k is not zero, rising; *rows until the next call.
/// Returns how many. A vector has few of the rows of a large mechanism.
int hn_qr_reflector(const hn_qr *qr, int k, const int **rows);
/// Returns whether it pays to go over such a list of n of the rows below k, in place of all of
/// them.
bool hn_qr_is_sparse(const hn_qr *qr, int k, int n);
/// x <- Q' x and x <- Q x, x (m).
void hn_qr_apply_qt(const hn_qr *qr, double *x);
void hn_qr_apply_q(const hn_qr *qr, double *x);
/// x <- R11^-1 x and x <- R11^-T x, x (rank).
void hn_qr_solve_r(const hn_qr *qr, double *x);
void hn_qr_solve_rt(const hn_qr *qr, double *x);
/// |R_kk| of the last kept column relative to |R_00|; 1 when rank is 0.
double hn_qr_pivot_ratio(const hn_qr *qr);
/// The solution x (m) of least norm of A' x = b, b (n), for the rows of A' that were kept; the
/// dropped ones follow when b is consistent.
void hn_qr_least_norm(hn_qr *qr, const double *b, double *x);
/// Removes from x (m) its part in range(A): x <- x - Q1 Q1' x. Returns the length of what was
/// removed.
double hn_qr_remove_range(const hn_qr *qr, double *x);
/// Smallest and largest singular value of [R11 R12]'s kept block R11 by (inverse) power iteration,
/// to about six digits when the extreme values stand apart, and to the spread of a cluster
/// otherwise. Both 0 when rank is 0.
void hn_qr_sigma(const hn_qr *qr, double *sigma_min, double *sigma_max);

#endif
