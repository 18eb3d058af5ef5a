// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/curtis_reid.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// alternating minimisation converges linearly; powers of two need no more than this
enum { SWEEPS = 40 };
#define SETTLED 0.1 // change of an exponent in a sweep

// log2 of the size of entry k; false: the entry is 0
static bool read_size(int parts, const double *values, size_t k, double *size) {
    const double re = values[k * (size_t)parts], im = parts == 2 ? values[k * 2 + 1] : 0;
    const double magnitude = parts == 2 ? hypot(re, im) : fabs(re);
    *size = magnitude > 0 ? log2(magnitude) : 0;
    return magnitude > 0;
}

// new exponents of the rows (by_row) or columns for the other ones as they are; the largest change
static double sweep(int n, int parts, const int *start, const int *row, const double *values,
                    bool by_row, double *own, const double *other, double *sum, int *count) {
    memset(sum, 0, (size_t)n * sizeof *sum);
    memset(count, 0, (size_t)n * sizeof *count);

    // residuals of (1), collected for each row or column
    for (int j = 0; j < n; j++) {
        const int from = start ? start[j] : 0, to = start ? start[j + 1] : n;
        for (int k = from; k < to; k++) {
            const int i = start ? row[k] : k;
            const size_t at = start ? (size_t)k : (size_t)i * (size_t)n + (size_t)j;
            double size;
            if (read_size(parts, values, at, &size)) {
                sum[by_row ? i : j] -= size + other[by_row ? j : i];
                count[by_row ? i : j]++;
            }
        }
    }

    // their mean is the best exponent
    double change = 0;
    for (int i = 0; i < n; i++) {
        const double best = count[i] > 0 ? sum[i] / count[i] : 0;
        change = fmax(change, fabs(best - own[i]));
        own[i] = best;
    }
    return change;
}

void hn_curtis_reid(int n, int parts, const int *start, const int *row, const double *values,
                    double *r, double *c, double *work_sum, int *work_count) {
    memset(r, 0, (size_t)n * sizeof *r);
    memset(c, 0, (size_t)n * sizeof *c);
    for (int k = 0; k < SWEEPS; k++) {
        const double rows = sweep(n, parts, start, row, values, true, r, c, work_sum, work_count);
        const double columns =
            sweep(n, parts, start, row, values, false, c, r, work_sum, work_count);
        if (fmax(rows, columns) < SETTLED) {
            break;
        }
    }
    for (int i = 0; i < n; i++) {
        r[i] = rint(r[i]);
        c[i] = rint(c[i]);
    }
}
