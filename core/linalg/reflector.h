// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_REFLECTOR_H
#define HN_LINALG_REFLECTOR_H
// T <- H T H for a symmetric matrix T (nv x nv, row-major) and one reflector H = I - tau u u' of a
// QR factorisation, by the symmetric form of rank two. u is zero above entry k, 1 at it, and
// below[i] at i > k. Nothing allocates.
// Source: Golub & Van Loan 2013, section 8.3.1.

/// v and p (nv) are scratch.
void hn_reflect_both_sides(int nv, int k, double tau, const double *below, double *T,
                           double *restrict v, double *restrict p);
/// The same where u has few entries that are not zero: 1 at k, and those at the n `rows`. Other
/// rows are not touched.
void hn_reflect_listed(int nv, int k, double tau, const double *below, int n, const int *rows,
                       double *T, double *v, double *p);
#endif
