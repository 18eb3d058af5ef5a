// SPDX-License-Identifier: GPL-3.0-or-later
// Gragg's midpoint rule with 2, 4, 6, ... substeps, extrapolated in h^2 (Aitken and Neville); the
// column that gives most for its cost is aimed at. Only the increments over a step are
// extrapolated, so that rounding is relative to them. Source: Hairer, Norsett & Wanner 1993, sec.
// II.9.
#include "study/truth/precise_stepper.h"

#include <math.h>
#include <string.h>

enum { COLUMNS = 11, FEWEST = 4 };
#define SAFETY 0.9L
#define TARGET 0.6L // of the tolerance
#define MOST_GROWTH 4.0L
#define LEAST_SHRINK 0.1L

typedef struct extrapolation {
    const hn_precise_ode *ode;
    hn_real *table[COLUMNS];            ///< increments over the step; entry j of the last row
    hn_real *before, *now, *dy, *start; ///< increments of two substeps; rates here and at the start
    hn_real *y;
} extrapolation;

static hn_status create(const hn_precise_ode *ode, hn_arena *arena, void **ws) {
    extrapolation *s = hn_arena_get(arena, sizeof *s);
    const size_t n = (size_t)ode->n;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->ode = ode;
    for (int k = 0; k < COLUMNS; k++) {
        s->table[k] = hn_arena_reals(arena, n);
    }
    s->before = hn_arena_reals(arena, n);
    s->now = hn_arena_reals(arena, n);
    s->dy = hn_arena_reals(arena, n);
    s->start = hn_arena_reals(arena, n);
    s->y = hn_arena_reals(arena, n);
    *ws = s;
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static int substeps(int column) {
    return 2 * (column + 1);
}

/// s->now: the increment over H by n midpoint substeps.
static hn_status midpoint(extrapolation *s, hn_real t, const hn_real *y, hn_real H, int n) {
    const int size = s->ode->n;
    const hn_real h = H / n;

    // the first substep: Euler
    memset(s->before, 0, (size_t)size * sizeof *s->before);
    for (int i = 0; i < size; i++) {
        s->now[i] = h * s->start[i];
    }

    // the others: midpoint, on increments, so that y is not rounded in each
    for (int k = 1; k < n; k++) {
        for (int i = 0; i < size; i++) {
            s->y[i] = y[i] + s->now[i];
        }

        const hn_status status = s->ode->rate(s->ode->user, t + k * h, s->y, s->dy);
        if (status != HN_OK) {
            return status;
        }

        for (int i = 0; i < size; i++) {
            const hn_real next = s->before[i] + 2 * h * s->dy[i];
            s->before[i] = s->now[i];
            s->now[i] = next;
        }
    }
    return HN_OK;
}

/// Takes s->now in as row k of the table; returns the error of its last entry, in tolerances.
static hn_real extrapolate(extrapolation *s, int k) {
    hn_real error = 0;
    for (int i = 0; i < s->ode->n; i++) {
        hn_real value = s->now[i], last = 0;
        for (int j = 0; j < k; j++) { // table[j] still holds entry j of the row above
            const hn_real ratio = (hn_real)substeps(k) / substeps(k - j - 1);
            const hn_real better = value + (value - s->table[j][i]) / (ratio * ratio - 1);
            s->table[j][i] = value;
            last = better - value;
            value = better;
        }
        s->table[k][i] = value;
        error = fmaxl(error, fabsl(last) / (s->ode->tol * s->ode->scale[i]));
        error = isfinite(value) ? error : (hn_real)HUGE_VALL;
    }
    return error;
}

/// Evaluations of the first k + 1 rows.
static hn_real cost(int k) {
    hn_real sum = 1;
    for (int j = 0; j <= k; j++) {
        sum += substeps(j) - 1;
    }
    return sum;
}

/// The factor on H that makes column k just accurate enough.
static hn_real growth(hn_real error, int k) {
    const hn_real g = SAFETY * powl(TARGET / fmaxl(error, 1e-30L), 1.0L / (2 * k + 1));
    return fminl(MOST_GROWTH, fmaxl(LEAST_SHRINK, g));
}

/// One attempt. Returns the column that is accurate enough, or -1; *factor: what to do with the
/// step.
static int attempt(extrapolation *s, hn_real t, const hn_real *y, hn_real H, hn_real *factor,
                   hn_status *status) {
    hn_real best = HUGE_VALL;
    *factor = LEAST_SHRINK;
    for (int k = 0; k < COLUMNS; k++) {
        *status = midpoint(s, t, y, H, substeps(k));
        if (*status != HN_OK) {
            return -1;
        }

        // a new column of the table
        const hn_real error = extrapolate(s, k);
        if (k < FEWEST) {
            continue;
        }

        // the step that gives the least work for its length
        hn_real g = growth(error, k), work = cost(k) / g;
        if (error <= 1 && k + 1 < COLUMNS && work < best) {
            // one column more might carry a longer step at less cost for its length
            g = fminl(MOST_GROWTH, g * cost(k + 1) / cost(k));
        }
        if (work < best) {
            best = work;
            *factor = g;
        }

        if (error <= 1) {
            return k;
        }
    }

    // no column is accurate enough: repeat with a shorter step
    *factor = fminl(*factor, 0.7L);
    return -1;
}

static hn_status step(void *ws, hn_real t, hn_real *y, hn_real least, hn_real *h, hn_real *taken) {
    extrapolation *s = ws;
    hn_status status = s->ode->rate(s->ode->user, t, y, s->start);
    int refused = 0;
    while (status == HN_OK && *h >= least) {
        hn_real factor;
        const int k = attempt(s, t, y, *h, &factor, &status);
        if (k >= 0) {
            for (int i = 0; i < s->ode->n; i++) {
                y[i] += s->table[k][i];
            }
            *taken = *h;
            *h *= refused ? fminl(1, factor) : factor;
            return HN_OK;
        }
        refused = 1;
        *h *= factor;
        status = *h >= least ? HN_OK : status;
    }
    return status == HN_OK ? HN_ERR_STEP_UNDERFLOW : status;
}

static void forget(void *ws) {
    (void)ws;
}

const hn_precise_stepper hn_precise_extrapolation = {"extrapolation", create, step, forget};
