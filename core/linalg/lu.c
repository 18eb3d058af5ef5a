// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/lu.h"

#include <math.h>
#include <stdbool.h>

#define PIVOT_MIN 1e-14 // of a row's largest entry

hn_complex hn_complex_reciprocal(double re, double im) {
    const double size = re * re + im * im;
    return (hn_complex){re / size, -im / size};
}

static void swap_rows(int n, double *a, double *b) {
    for (int j = 0; j < n; j++) {
        const double keep = a[j];
        a[j] = b[j];
        b[j] = keep;
    }
}

// 1 / largest entry of each row
static hn_status find_scale(int n, const double *A, int width, double *scale) {
    for (int i = 0; i < n; i++) {
        double largest = 0;
        for (int j = 0; j < width; j++) {
            const double size = fabs(A[(size_t)i * (size_t)width + (size_t)j]);
            if (!isfinite(size)) {
                return HN_ERR_DIVERGED;
            }
            largest = size > largest ? size : largest;
        }
        if (largest == 0) {
            return HN_ERR_SINGULAR;
        }
        scale[i] = 1 / largest;
    }
    return HN_OK;
}

static void swap_scale(double *scale, int i, int k) {
    const double keep = scale[i];
    scale[i] = scale[k];
    scale[k] = keep;
}

/// Returns whether a pivot is what cancellation left over of the products that it is a sum of
/// (square.c says why small pivots alone are no fault). Row k of A holds its factors, column k
/// their partners.
static bool is_cancelled(int k, size_t w, const double *A, int row) {
    double size = 0;
    for (int j = 0; j < k; j++) {
        size += fabs(A[(size_t)row * w + (size_t)j] * A[(size_t)j * w + (size_t)k]);
    }
    const double pivot = fabs(A[(size_t)row * w + (size_t)k]);
    return !(pivot > PIVOT_MIN * size) || pivot == 0;
}

hn_status hn_lu_factor(int n, double *A, int *pivot, double *scale) {
    const size_t w = (size_t)n;
    const hn_status status = find_scale(n, A, n, scale);
    for (int k = 0; status == HN_OK && k < n; k++) {
        // the largest entry of the column, rows scaled
        int best = k;
        double most = 0;
        for (int i = k; i < n; i++) {
            const double size = fabs(A[(size_t)i * w + (size_t)k]) * scale[i];
            if (size > most) {
                most = size;
                best = i;
            }
        }
        if (!(most > PIVOT_MIN) && is_cancelled(k, w, A, best)) {
            return HN_ERR_SINGULAR;
        }
        pivot[k] = best;
        double *row = A + (size_t)k * w;
        if (best != k) {
            swap_rows(n, row, A + (size_t)best * w);
            swap_scale(scale, k, best);
        }

        // eliminate below it
        for (int i = k + 1; i < n; i++) {
            double *other = A + (size_t)i * w;
            if (other[k] == 0) {
                continue;
            }
            const double factor = other[k] /= row[k];
            for (int j = k + 1; j < n; j++) {
                other[j] -= factor * row[j];
            }
        }
    }
    return status;
}

void hn_lu_solve(int n, const double *A, const int *pivot, double *x) {
    const size_t w = (size_t)n;
    for (int k = 0; k < n; k++) {
        const double keep = x[k];
        x[k] = x[pivot[k]];
        x[pivot[k]] = keep;
    }
    for (int i = 1; i < n; i++) {
        const double *row = A + (size_t)i * w;
        for (int j = 0; j < i; j++) {
            x[i] -= row[j] * x[j];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = A + (size_t)i * w;
        for (int j = i + 1; j < n; j++) {
            x[i] -= row[j] * x[j];
        }
        x[i] /= row[i];
    }
}

// ---- complex: the same by parts ----

static double size_of(hn_complex a) {
    return fabs(a.re) + fabs(a.im);
}

// Smith 1962: no overflow of squares
static hn_complex quotient(hn_complex a, hn_complex b) {
    if (fabs(b.re) >= fabs(b.im)) {
        const double r = b.im / b.re, d = b.re + b.im * r;
        return (hn_complex){(a.re + a.im * r) / d, (a.im - a.re * r) / d};
    }
    const double r = b.re / b.im, d = b.re * r + b.im;
    return (hn_complex){(a.re * r + a.im) / d, (a.im * r - a.re) / d};
}

static void subtract_product(hn_complex *x, hn_complex a, hn_complex b) {
    x->re -= a.re * b.re - a.im * b.im;
    x->im -= a.re * b.im + a.im * b.re;
}

static bool is_cancelled_complex(int k, size_t w, const hn_complex *A, int row) {
    double size = 0;
    for (int j = 0; j < k; j++) {
        size += size_of(A[(size_t)row * w + (size_t)j]) * size_of(A[(size_t)j * w + (size_t)k]);
    }
    const double pivot = size_of(A[(size_t)row * w + (size_t)k]);
    return !(pivot > PIVOT_MIN * size) || pivot == 0;
}

hn_status hn_lu_factor_complex(int n, hn_complex *A, int *pivot, double *scale) {
    const size_t w = (size_t)n;
    const hn_status status = find_scale(n, &A[0].re, 2 * n, scale);
    for (int k = 0; status == HN_OK && k < n; k++) {
        // the largest entry of the column, rows scaled
        int best = k;
        double most = 0;
        for (int i = k; i < n; i++) {
            const double size = size_of(A[(size_t)i * w + (size_t)k]) * scale[i];
            if (size > most) {
                most = size;
                best = i;
            }
        }
        if (!(most > PIVOT_MIN) && is_cancelled_complex(k, w, A, best)) {
            return HN_ERR_SINGULAR;
        }
        pivot[k] = best;
        hn_complex *row = A + (size_t)k * w;
        if (best != k) {
            swap_rows(2 * n, &row->re, &A[(size_t)best * w].re);
            swap_scale(scale, k, best);
        }

        // eliminate below it
        for (int i = k + 1; i < n; i++) {
            hn_complex *other = A + (size_t)i * w;
            if (other[k].re == 0 && other[k].im == 0) {
                continue;
            }
            other[k] = quotient(other[k], row[k]);
            for (int j = k + 1; j < n; j++) {
                subtract_product(&other[j], other[k], row[j]);
            }
        }
    }
    return status;
}

void hn_lu_solve_complex(int n, const hn_complex *A, const int *pivot, hn_complex *x) {
    const size_t w = (size_t)n;
    for (int k = 0; k < n; k++) {
        const hn_complex keep = x[k];
        x[k] = x[pivot[k]];
        x[pivot[k]] = keep;
    }
    for (int i = 1; i < n; i++) {
        for (int j = 0; j < i; j++) {
            subtract_product(&x[i], A[(size_t)i * w + (size_t)j], x[j]);
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) {
            subtract_product(&x[i], A[(size_t)i * w + (size_t)j], x[j]);
        }
        x[i] = quotient(x[i], A[(size_t)i * w + (size_t)i]);
    }
}
