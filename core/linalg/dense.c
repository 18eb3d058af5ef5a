// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/dense.h"

#include <math.h>

double hn_norm_max(int n, const double *x) {
    double max = 0;
    for (int i = 0; i < n; i++) {
        double size = fabs(x[i]);
        if (isnan(size)) {
            return size;
        }
        max = size > max ? size : max;
    }
    return max;
}

double hn_norm2(int n, const double *x) {
    double max = hn_norm_max(n, x);
    if (max == 0 || !isfinite(max)) {
        return max;
    }
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double part = x[i] / max;
        sum += part * part;
    }
    return max * sqrt(sum);
}

bool hn_all_finite(int n, const double *x) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) {
            return 0;
        }
    }
    return 1;
}

void hn_mat_vec(int rows, int cols, const double *A, const double *x, double *y) {
    for (int i = 0; i < rows; i++) {
        y[i] = hn_dot(cols, A + (size_t)i * cols, x);
    }
}

void hn_mat_t_vec(int rows, int cols, const double *A, const double *x, double *y) {
    for (int j = 0; j < cols; j++) {
        y[j] = 0;
    }
    for (int i = 0; i < rows; i++) {
        hn_axpy(cols, x[i], A + (size_t)i * cols, y);
    }
}

double hn_quad_sym(int n, const double *A, const double *x, const double *y) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double *row = A + (size_t)i * n;
        for (int j = 0; j < i; j++) {
            sum += row[j] * (x[i] * y[j] + x[j] * y[i]);
        }
        sum += row[i] * x[i] * y[i];
    }
    return sum;
}

void hn_mirror_lower(int n, double *A) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            A[(size_t)j * n + i] = A[(size_t)i * n + j];
        }
    }
}

hn_status hn_cholesky(int n, double *A, int lda, double tol) {
    for (int i = 0; i < n; i++) {
        double *row = A + (size_t)i * lda;
        for (int j = 0; j < i; j++) {
            const double *other = A + (size_t)j * lda;
            row[j] = (row[j] - hn_dot(j, row, other)) / other[j];
        }

        double pivot = row[i] - hn_dot(i, row, row);
        if (pivot < -tol) {
            return HN_ERR_NOT_SPD;
        }
        if (!(pivot > tol)) {
            return HN_ERR_SINGULAR;
        }
        row[i] = sqrt(pivot);
    }
    return HN_OK;
}

void hn_lower_solve(int n, const double *L, int lda, double *x) {
    for (int i = 0; i < n; i++) {
        const double *row = L + (size_t)i * lda;
        x[i] = (x[i] - hn_dot(i, row, x)) / row[i];
    }
}

void hn_lower_t_solve(int n, const double *L, int lda, double *x) {
    for (int i = n - 1; i >= 0; i--) {
        const double *row = L + (size_t)i * lda;
        x[i] /= row[i];
        hn_axpy(i, -x[i], row, x);
    }
}

void hn_cholesky_solve(int n, const double *L, int lda, double *x) {
    hn_lower_solve(n, L, lda, x);
    hn_lower_t_solve(n, L, lda, x);
}

void hn_sum2_add(hn_sum2 *s, double x) {
    // Knuth's two-sum: hi + x = sum + error exactly
    double sum = s->hi + x;
    double shadow = sum - s->hi;
    double error = (s->hi - (sum - shadow)) + (x - shadow);
    s->hi = sum;
    s->lo += error;
}

/// x = high + low with 26 bits each (Veltkamp), so that products of the halves are exact.
static void split(double x, double *high, double *low) {
    double c = 134217729.0 * x; // 2^27 + 1
    *high = c - (c - x);
    *low = x - *high;
}

void hn_sum2_add_product(hn_sum2 *s, double x, double y) {
    double product = x * y;
    if (product == 0) {
        return;
    }

    // Dekker's two-product: x y = product + error exactly, short of overflow
    double xh, xl, yh, yl;
    split(x, &xh, &xl);
    split(y, &yh, &yl);
    double error = xl * yl - (((product - xh * yh) - xl * yh) - xh * yl);
    hn_sum2_add(s, product);
    s->lo += error;
}

double hn_sum2_value(const hn_sum2 *s) {
    return s->hi + s->lo;
}
