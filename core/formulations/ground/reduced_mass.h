// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_REDUCED_MASS_H
#define HN_FORMULATIONS_REDUCED_MASS_H
// The mass left on the free motion, N' M N, with M taken entry by entry.

/// The lower triangle of M (nv x nv row-major) as the entries that are not identically zero.
typedef struct hn_mass_entries {
    int nv, n;
    const int *row, *col;
} hn_mass_entries;

/// y = M x, x and y (nv x r) row-major.
void hn_mass_multiply(const hn_mass_entries *at, const double *M, const double *x, int r,
                      double *y);
/// Lower triangle of A (r x r) = N' y, N and y (nv x r); each entry summed from the first row of N
/// to the last.
void hn_mass_project(int nv, int r, const double *N, const double *y, double *A);
/// N' M N by these two, in arithmetic operations.
double hn_mass_project_ops(const hn_mass_entries *at, int r);

#endif
