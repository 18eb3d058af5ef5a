// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/flops.h"

double hn_flops_qr(int m, int n) {
    const double a = m > n ? m : n, b = m > n ? n : m;
    return 2 * a * b * b - 2 * b * b * b / 3;
}

double hn_flops_qr_solve(int m, int n) {
    const double k = m < n ? m : n;
    return 4.0 * m * k - 2 * k * k + k * k;
}

double hn_flops_cholesky(int n) {
    const double k = n;
    return k * k * k / 3 + k * k / 2;
}

double hn_flops_cholesky_solve(int n) {
    return 2.0 * n * n;
}

double hn_flops_product(int m, int k, int n) {
    return 2.0 * m * k * n;
}

double hn_flops_saddle(int nv, int nc) {
    const double n = nv, c = nc, residual = 2 * (n * n + 2 * n * c);
    return 2 * n * c * c + 4 * n * n * c + n * n * n / 3 + 2 * residual;
}
