// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/reduced_mass.h"

#include "formulations/ground/flops.h"
#include "linalg/dense.h"

#include <string.h>

void hn_mass_multiply(const hn_mass_entries *at, const double *M, const double *x, int r,
                      double *y) {
    const size_t nv = (size_t)at->nv;
    memset(y, 0, nv * (size_t)r * sizeof *y);
    for (int k = 0; k < at->n; k++) {
        const size_t i = (size_t)at->row[k], j = (size_t)at->col[k];
        const double m = M[i * nv + j];
        hn_axpy(r, m, x + j * (size_t)r, y + i * (size_t)r);
        if (i != j) {
            hn_axpy(r, m, x + i * (size_t)r, y + j * (size_t)r);
        }
    }
}

void hn_mass_project(int nv, int r, const double *N, const double *y, double *A) {
    memset(A, 0, (size_t)r * (size_t)r * sizeof *A);
    // row by row of N, so that both arrays are read in order
    for (int k = 0; k < nv; k++) {
        for (int i = 0; i < r; i++) {
            hn_axpy(i + 1, N[k * r + i], y + k * r, A + i * r);
        }
    }
}

double hn_mass_project_ops(const hn_mass_entries *at, int r) {
    return 4.0 * at->n * r + hn_flops_product(r, at->nv, r) / 2;
}
