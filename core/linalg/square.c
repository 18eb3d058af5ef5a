// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/square.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

bool hn_square_init(hn_square *s, hn_arena *arena, int n_max) {
    const size_t n = (size_t)n_max;
    *s = (hn_square){.n_max = n_max};
    s->lu = hn_arena_doubles(arena, n * n);
    s->row = hn_arena_doubles(arena, n);
    s->col = hn_arena_doubles(arena, n);
    s->perm = hn_arena_ints(arena, n);
    s->work = hn_arena_doubles(arena, n);
    return s->lu && s->row && s->col && s->perm && s->work;
}

// the power of two that brings `size` into [1/2, 1): scaling by it rounds nothing
static double unit_scale(double size) {
    int exponent = 0;
    if (!(size > 0)) {
        return 1;
    }
    (void)frexp(size, &exponent);
    return ldexp(1, -exponent);
}

static void equilibrate(hn_square *s) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        double *row = s->lu + (size_t)i * n;
        s->row[i] = unit_scale(hn_norm_max(n, row));
        for (int j = 0; j < n; j++) {
            row[j] *= s->row[i];
        }
    }
    for (int j = 0; j < n; j++) {
        double size = 0;
        for (int i = 0; i < n; i++) {
            size = fmax(size, fabs(s->lu[(size_t)i * n + j]));
        }
        s->col[j] = unit_scale(size);
        for (int i = 0; i < n; i++) {
            s->lu[(size_t)i * n + j] *= s->col[j];
        }
    }
}

static int find_pivot(const hn_square *s, int k) {
    const int n = s->n;
    int best = k;
    for (int i = k + 1; i < n; i++) {
        if (fabs(s->lu[(size_t)i * n + k]) > fabs(s->lu[(size_t)best * n + k])) {
            best = i;
        }
    }
    return best;
}

static void swap_rows(hn_square *s, int a, int b) {
    if (a == b) {
        return;
    }
    double *x = s->lu + (size_t)a * s->n, *y = s->lu + (size_t)b * s->n;
    for (int j = 0; j < s->n; j++) {
        const double keep = x[j];
        x[j] = y[j];
        y[j] = keep;
    }
    const int keep = s->perm[a];
    s->perm[a] = s->perm[b];
    s->perm[b] = keep;
}

static void eliminate(hn_square *s, int k) {
    const int n = s->n;
    const double *pivot = s->lu + (size_t)k * n;
    for (int i = k + 1; i < n; i++) {
        double *row = s->lu + (size_t)i * n;
        if (row[k] == 0) {
            continue;
        }
        row[k] /= pivot[k];
        for (int j = k + 1; j < n; j++) {
            row[j] -= row[k] * pivot[j];
        }
    }
}

/// Returns whether pivot k is what cancellation left over: small against the products that it is a
/// sum of. A pivot that is small because all its terms are is as accurate as any other; where
/// masses are small and lengths are not, the Newton matrix of a sound mechanism has such pivots.
static bool is_cancelled(const hn_square *s, int k) {
    const size_t n = (size_t)s->n;
    double size = 0;
    for (int j = 0; j < k; j++) {
        size += fabs(s->lu[(size_t)k * n + (size_t)j] * s->lu[(size_t)j * n + (size_t)k]);
    }
    const double pivot = fabs(s->lu[(size_t)k * n + (size_t)k]);
    return !(pivot > HN_SQUARE_SINGULAR * size) || pivot == 0;
}

hn_status hn_square_factor(hn_square *s, int n) {
    HN_ASSERT(n >= 0 && n <= s->n_max);
    s->n = n;
    s->pivot_ratio = n > 0 ? 0 : 1;
    if (!hn_all_finite(n * n, s->lu)) {
        return HN_ERR_DIVERGED;
    }

    equilibrate(s);
    double smallest = HUGE_VAL, largest = 0;
    for (int k = 0; k < n; k++) {
        s->perm[k] = k;
    }

    // column by column; the ratio of pivots decides whether A is singular
    for (int k = 0; k < n; k++) {
        swap_rows(s, k, find_pivot(s, k));
        const double size = fabs(s->lu[(size_t)k * n + k]);
        const double least = fmin(smallest, size), most = fmax(largest, size);
        if (most > 0 && least / most < HN_SQUARE_SINGULAR && !is_cancelled(s, k)) {
            eliminate(s, k);
            continue;
        }
        smallest = least;
        largest = most;
        s->pivot_ratio = largest > 0 ? smallest / largest : 0;
        if (s->pivot_ratio < HN_SQUARE_SINGULAR) {
            return HN_ERR_SINGULAR;
        }
        eliminate(s, k);
    }
    return HN_OK;
}

void hn_square_solve(const hn_square *s, double *x) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        const int from = s->perm[i];
        s->work[i] = s->row[from] * x[from] - hn_dot(i, s->lu + (size_t)i * n, s->work);
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = s->lu + (size_t)i * n;
        s->work[i] = (s->work[i] - hn_dot(n - i - 1, row + i + 1, s->work + i + 1)) / row[i];
    }
    for (int i = 0; i < n; i++) {
        x[i] = s->col[i] * s->work[i];
    }
}
