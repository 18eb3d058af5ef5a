// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/bunch_kaufman.h"

#include <math.h>

static const double ALPHA = 0.6403882032022076; // (1 + sqrt 17) / 8

static double *at(double *A, int n, int i, int j) {
    return A + (size_t)i * (size_t)n + (size_t)j;
}

static double entry(const double *A, int n, int i, int j) {
    return A[(size_t)i * (size_t)n + (size_t)j];
}

static void exchange(double *x, double *y) {
    const double keep = *x;
    *x = *y;
    *y = keep;
}

// rows and columns k and p of what is left from `first` on; L so far stays, the solve exchanges as
// it goes
static void swap(double *A, int n, int first, int k, int p) {
    for (int j = first; j < n && k != p; j++) {
        exchange(at(A, n, k, j), at(A, n, p, j));
    }
    for (int i = first; i < n && k != p; i++) {
        exchange(at(A, n, i, k), at(A, n, i, p));
    }
}

// the largest entry of column j below row `from`, row j left out; *where its row
static double largest_off(const double *A, int n, int j, int from, int *where) {
    double largest = 0;
    *where = from;
    for (int i = from; i < n; i++) {
        if (i != j && fabs(entry(A, n, i, j)) > largest) {
            largest = fabs(entry(A, n, i, j));
            *where = i;
        }
    }
    return largest;
}

// 1: one unknown, *p becomes pivot k; 2: two unknowns, *p becomes number k + 1
static int choose(const double *A, int n, int k, int *p) {
    int r, unused;
    const double pivot = fabs(entry(A, n, k, k)), lambda = largest_off(A, n, k, k + 1, &r);
    *p = k;
    if (pivot >= ALPHA * lambda || k == n - 1) {
        return 1;
    }
    const double sigma = largest_off(A, n, r, k, &unused);
    if (pivot * sigma >= ALPHA * lambda * lambda) {
        return 1;
    }
    *p = r;
    return fabs(entry(A, n, r, r)) >= ALPHA * sigma ? 1 : 2;
}

static void eliminate_one(double *A, int n, int k) {
    const double d = entry(A, n, k, k);
    for (int i = k + 1; i < n; i++) {
        const double l = entry(A, n, i, k) / d;
        for (int j = k + 1; j <= i && l != 0; j++) {
            *at(A, n, i, j) -= l * entry(A, n, j, k);
            *at(A, n, j, i) = entry(A, n, i, j);
        }
    }
    for (int i = k + 1; i < n; i++) {
        *at(A, n, i, k) /= d;
        *at(A, n, k, i) = entry(A, n, i, k);
    }
}

static void eliminate_two(double *A, int n, int k) {
    const double a = entry(A, n, k, k), b = entry(A, n, k + 1, k), c = entry(A, n, k + 1, k + 1);
    const double det = a * c - b * b;
    for (int i = k + 2; i < n; i++) {
        const double x = entry(A, n, i, k), y = entry(A, n, i, k + 1);
        const double l1 = (c * x - b * y) / det, l2 = (a * y - b * x) / det;
        for (int j = k + 2; j <= i; j++) {
            // columns k and k + 1 of the rows above i hold L already; their old values stand
            // mirrored in rows k and k + 1
            *at(A, n, i, j) -= l1 * entry(A, n, k, j) + l2 * entry(A, n, k + 1, j);
            *at(A, n, j, i) = entry(A, n, i, j);
        }
        *at(A, n, i, k) = l1;
        *at(A, n, i, k + 1) = l2;
    }
    for (int i = k + 2; i < n; i++) {
        *at(A, n, k, i) = entry(A, n, i, k);
        *at(A, n, k + 1, i) = entry(A, n, i, k + 1);
    }
}

hn_status hn_bunch_kaufman(int n, double *A, int *pivot, double tol, int *negative) {
    int below = 0;
    for (int k = 0; k < n;) {
        int p, r;
        const double off = largest_off(A, n, k, k + 1, &r);
        if (!(fmax(fabs(entry(A, n, k, k)), off) > tol)) {
            return HN_ERR_SINGULAR;
        }

        // a block of one or two rows
        const int size = choose(A, n, k, &p);
        swap(A, n, k, k + size - 1, p);
        if (size == 1) {
            pivot[k] = p;
            below += entry(A, n, k, k) < 0;
            eliminate_one(A, n, k);
        } else {
            pivot[k] = pivot[k + 1] = -p - 1;
            below++; // such a block has one eigenvalue of each sign
            eliminate_two(A, n, k);
        }
        k += size;
    }

    if (negative) {
        *negative = below;
    }
    return HN_OK;
}

void hn_bunch_kaufman_solve(int n, const double *A, const int *pivot, double *x) {
    // L y = P b
    for (int k = 0; k < n; k += pivot[k] < 0 ? 2 : 1) {
        const int two = pivot[k] < 0;
        exchange(&x[k + two], &x[two ? -pivot[k] - 1 : pivot[k]]);
        for (int i = k + 1 + two; i < n; i++) {
            x[i] -= entry(A, n, i, k) * x[k] + (two ? entry(A, n, i, k + 1) * x[k + 1] : 0);
        }
    }

    // D z = y, blocks of two by Cramer's rule
    for (int k = 0; k < n; k += pivot[k] < 0 ? 2 : 1) {
        if (pivot[k] >= 0) {
            x[k] /= entry(A, n, k, k);
            continue;
        }
        const double a = entry(A, n, k, k), b = entry(A, n, k + 1, k),
                     c = entry(A, n, k + 1, k + 1), det = a * c - b * b;
        const double x1 = (c * x[k] - b * x[k + 1]) / det, x2 = (a * x[k + 1] - b * x[k]) / det;
        x[k] = x1;
        x[k + 1] = x2;
    }

    // L' P x = z
    for (int k = n - 1; k >= 0;) {
        const int two = pivot[k] < 0, first = k - two;
        for (int i = k + 1; i < n; i++) {
            x[k] -= entry(A, n, i, k) * x[i];
            x[first] -= two ? entry(A, n, i, first) * x[i] : 0;
        }
        exchange(&x[k], &x[two ? -pivot[k] - 1 : pivot[k]]);
        k = first - 1;
    }
}
