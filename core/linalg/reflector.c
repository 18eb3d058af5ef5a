// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/reflector.h"

#include "linalg/dense.h"

#include <string.h>

/// p = tau T v, v zero above k: four rows at a time, whose sums do not wait for each other.
static void times_reflector(int nv, const double *T, int k, double tau, const double *v,
                            double *p) {
    enum { TOGETHER = 4 };
    int i = 0;
    for (; i + TOGETHER <= nv; i += TOGETHER) {
        const double *row = T + (size_t)i * nv;
        double sum[TOGETHER] = {0};
        for (int j = k; j < nv; j++) {
            sum[0] += row[j] * v[j];
            sum[1] += row[(size_t)nv + j] * v[j];
            sum[2] += row[2 * (size_t)nv + j] * v[j];
            sum[3] += row[3 * (size_t)nv + j] * v[j];
        }
        for (int m = 0; m < TOGETHER; m++) {
            p[i + m] = tau * sum[m];
        }
    }
    for (; i < nv; i++) {
        p[i] = tau * hn_dot(nv - k, T + (size_t)i * nv + k, v + k);
    }
}

void hn_reflect_both_sides(int nv, int k, double tau, const double *below, double *T,
                           double *restrict v, double *restrict p) {
    memset(v, 0, (size_t)nv * sizeof *v);
    memcpy(v + k, below + k, (size_t)(nv - k) * sizeof *v);
    v[k] = 1;
    times_reflector(nv, T, k, tau, v, p);
    hn_axpy(nv, -0.5 * tau * hn_dot(nv, p, v), v, p);

    // above k v is zero, so rows there change from column k on
    for (int i = 0; i < nv; i++) {
        double *restrict row = T + (size_t)i * nv;
        const double vi = v[i], pi = p[i];
        for (int j = i < k ? k : 0; j < nv; j++) {
            row[j] -= vi * p[j] + pi * v[j];
        }
    }
}

void hn_reflect_listed(int nv, int k, double tau, const double *below, int n, const int *rows,
                       double *T, double *v, double *p) {
    memset(v, 0, (size_t)nv * sizeof *v);
    v[k] = 1;
    for (int m = 0; m < n; m++) {
        v[rows[m]] = below[rows[m]];
    }

    // p = tau T v, less its part along v
    for (int i = 0; i < nv; i++) {
        const double *row = T + (size_t)i * nv;
        double sum = row[k];
        for (int m = 0; m < n; m++) {
            sum += row[rows[m]] * v[rows[m]];
        }
        p[i] = tau * sum;
    }
    double along = p[k];
    for (int m = 0; m < n; m++) {
        along += p[rows[m]] * v[rows[m]];
    }
    p[k] += -0.5 * tau * along;
    for (int m = 0; m < n; m++) {
        p[rows[m]] += -0.5 * tau * along * v[rows[m]];
    }

    // T <- T - v p' - p v': whole rows where v is not zero, columns of v elsewhere
    for (int i = 0; i < nv; i++) {
        double *row = T + (size_t)i * nv;
        for (int j = 0; v[i] != 0 && j < nv; j++) {
            row[j] -= v[i] * p[j] + p[i] * v[j];
        }
        if (v[i] == 0 && p[i] != 0) {
            row[k] -= p[i];
            for (int m = 0; m < n; m++) {
                row[rows[m]] -= p[i] * v[rows[m]];
            }
        }
    }
}
