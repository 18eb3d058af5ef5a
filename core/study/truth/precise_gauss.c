// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss collocation. The rates at the stages are iterated to rounding; their expansion in Legendre
// polynomials tells the error of the step, and its continuation starts the next. Source: Hairer,
// Norsett & Wanner 1993, sec. II.7; Hairer, Lubich & Wanner 2006, sec. VIII.6.
#include "study/truth/precise_stepper.h"

#include <math.h>
#include <string.h>

enum { STAGES = 10, MAX_ROUNDS = 60 };
#define SAFETY 0.8L
#define MOST_GROWTH 2.0L
#define LEAST_SHRINK 0.2L
#define SETTLED 0.01L      // tolerances: change of a stage, times the scale
#define NEARLY 100.0L      // tolerances: below it a change that no longer shrinks is rounding
#define LONGEST_CARRY 1.5L // the expansion is continued over steps up to this much longer

typedef struct gauss {
    const hn_precise_ode *ode;
    hn_real c[STAGES], w[STAGES], a[STAGES][STAGES];
    hn_real legendre[STAGES][STAGES + 1]; ///< P_k at each stage
    hn_real *rate[STAGES];                ///< f at the stages
    hn_real *expansion[STAGES];           ///< coefficient of P_k over the step
    hn_real *y, *dy;
    hn_real last; ///< length of the step that the expansion is of, 0: none
} gauss;

/// P_0 .. P_n at x.
static void legendre(int n, hn_real x, hn_real *P) {
    P[0] = 1;
    P[1] = x;
    for (int k = 1; k < n; k++) {
        P[k + 1] = ((2 * k + 1) * x * P[k] - k * P[k - 1]) / (k + 1);
    }
}

/// Nodes and weights on (0, 1); the matrix by integrating the Lagrange polynomials' expansions.
static void make_tableau(gauss *s) {
    const int n = STAGES;

    // nodes: zeros of the Legendre polynomial by Newton, from the asymptotic approximation
    for (int i = 0; i < n; i++) {
        hn_real P[STAGES + 1], x = -cosl(acosl(-1) * (i + 0.75L) / (n + 0.5L)), slope = 1;
        for (int k = 0; k < 12; k++) {
            legendre(n, x, P);
            slope = n * (x * P[n] - P[n - 1]) / (x * x - 1);
            x -= P[n] / slope;
        }
        legendre(n, x, s->legendre[i]);
        s->c[i] = (1 + x) / 2;
        s->w[i] = 1 / ((1 - x * x) * slope * slope);
    }

    // matrix: integrals of the Lagrange polynomials, by their Legendre expansions
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            hn_real sum = s->c[i];
            for (int k = 1; k < n; k++) {
                const hn_real *P = s->legendre[i];
                sum += (P[k + 1] - P[k - 1]) / 2 * s->legendre[j][k];
            }
            s->a[i][j] = s->w[j] * sum;
        }
    }
}

static hn_status create(const hn_precise_ode *ode, hn_arena *arena, void **ws) {
    gauss *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->ode = ode;
    for (int k = 0; k < STAGES; k++) {
        s->rate[k] = hn_arena_reals(arena, (size_t)ode->n);
        s->expansion[k] = hn_arena_reals(arena, (size_t)ode->n);
    }
    s->y = hn_arena_reals(arena, (size_t)ode->n);
    s->dy = hn_arena_reals(arena, (size_t)ode->n);
    make_tableau(s);
    *ws = s;
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

/// First guesses: the expansion of the step before, continued, or the rate here.
static hn_status guess(gauss *s, hn_real t, const hn_real *y, hn_real h) {
    const int n = s->ode->n;
    if (!(s->last > 0 && h <= LONGEST_CARRY * s->last)) {
        const hn_status status = s->ode->rate(s->ode->user, t, y, s->dy);
        for (int i = 0; i < STAGES && status == HN_OK; i++) {
            memcpy(s->rate[i], s->dy, (size_t)n * sizeof *s->dy);
        }
        return status;
    }
    for (int i = 0; i < STAGES; i++) {
        hn_real P[STAGES];
        legendre(STAGES - 1, 1 + 2 * s->c[i] * h / s->last, P);
        memset(s->rate[i], 0, (size_t)n * sizeof *s->rate[i]);
        for (int k = 0; k < STAGES; k++) {
            for (int m = 0; m < n; m++) {
                s->rate[i][m] += P[k] * s->expansion[k][m];
            }
        }
    }
    return HN_OK;
}

/// Every stage once; the largest change of h f, in scales.
static hn_status iterate(gauss *s, hn_real t, const hn_real *y, hn_real h, hn_real *change) {
    const int n = s->ode->n;

    *change = 0;
    for (int i = 0; i < STAGES; i++) {
        // the state at the stage, with the latest rates of all stages
        for (int m = 0; m < n; m++) {
            hn_real sum = 0;
            for (int j = 0; j < STAGES; j++) {
                sum += s->a[i][j] * s->rate[j][m];
            }
            s->y[m] = y[m] + h * sum;
        }

        const hn_status status = s->ode->rate(s->ode->user, t + s->c[i] * h, s->y, s->dy);
        if (status != HN_OK) {
            return status;
        }

        // the change of its rate, in scales
        for (int m = 0; m < n; m++) {
            const hn_real moved = h * fabsl(s->dy[m] - s->rate[i][m]) / s->ode->scale[m];
            *change = moved > *change || isnan(moved) ? moved : *change;
            s->rate[i][m] = s->dy[m];
        }
    }
    return isfinite(*change) ? HN_OK : HN_ERR_DIVERGED;
}

static hn_status solve(gauss *s, hn_real t, const hn_real *y, hn_real h) {
    const hn_real tol = s->ode->tol;
    hn_real before = HUGE_VALL, change;
    hn_status status = guess(s, t, y, h);
    for (int k = 0; status == HN_OK; k++) {
        status = iterate(s, t, y, h, &change);
        if (status != HN_OK || change <= SETTLED * tol ||
            (change <= NEARLY * tol && change > before / 2)) {
            return status;
        }
        if (k >= MAX_ROUNDS || (k > 4 && change > before)) {
            return HN_ERR_NO_CONVERGENCE;
        }
        before = change;
    }
    return status;
}

/// Fills the expansion; returns the error of the step in tolerances. The coefficients c_k of f fall
/// off like rho^-k where it is smooth, and what Gauss quadrature misses like rho^-2n: about h
/// c_n-1^2 / max c. At a kink they fall off slowly, and so does this.
static hn_real expand(gauss *s, hn_real h) {
    const int n = s->ode->n;
    hn_real size[STAGES] = {0}, most = 0;
    for (int k = 0; k < STAGES; k++) {
        for (int m = 0; m < n; m++) {
            hn_real sum = 0;
            for (int j = 0; j < STAGES; j++) {
                sum += s->w[j] * s->legendre[j][k] * s->rate[j][m];
            }
            s->expansion[k][m] = (2 * k + 1) * sum;
            size[k] = fmaxl(size[k], fabsl(s->expansion[k][m]) / s->ode->scale[m]);
        }
        most = fmaxl(most, size[k]);
    }
    const hn_real end = fmaxl(size[STAGES - 1], size[STAGES - 2]);
    return most > 0 ? h * end * end / most / s->ode->tol : 0;
}

static hn_status step(void *ws, hn_real t, hn_real *y, hn_real least, hn_real *h, hn_real *taken) {
    gauss *s = ws;
    hn_status status = HN_ERR_STEP_UNDERFLOW;
    int refused = 0;

    while (*h >= least) {
        // stages; half the step where the iteration fails
        status = solve(s, t, y, *h);
        if (status != HN_OK) {
            *h /= 2;
            s->last = 0;
            refused = 1;
            continue;
        }

        // the step size that the error allows
        const hn_real error = expand(s, *h);
        hn_real factor = SAFETY * powl(fmaxl(error, 1e-30L), -1.0L / (2 * STAGES - 2));
        factor = fminl(refused ? 1 : MOST_GROWTH, fmaxl(LEAST_SHRINK, factor));
        s->last = *h;
        *h *= factor;

        // accept, or try again
        if (error <= 1) {
            for (int m = 0; m < s->ode->n; m++) {
                y[m] += s->last * s->expansion[0][m];
            }
            *taken = s->last;
            return HN_OK;
        }

        s->last = 0;
        refused = 1;
        status = HN_ERR_STEP_UNDERFLOW;
    }
    return status;
}

static void forget(void *ws) {
    gauss *s = ws;
    s->last = 0;
}

const hn_precise_stepper hn_precise_gauss = {"gauss10", create, step, forget};
