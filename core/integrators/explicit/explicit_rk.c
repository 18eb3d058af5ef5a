// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"

#include "integrators/step/compensated.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_STAGES = 16, HERMITE_TERMS = 4, MAX_DENSE_TERMS = 8 };

/// One row of a tableau without its zeros: sum of w[m] times slope number at[m].
typedef struct weights {
    int n, at[MAX_STAGES];
    double w[MAX_STAGES];
} weights;

typedef struct explicit_rk {
    const hn_tableau *tab;
    int n;
    double *k[MAX_STAGES];
    weights stage_of[MAX_STAGES], b, e, e2, *dense_of; // the tableau's rows
    double *stage;                                     // n
    double *y0;                                        // n, start of the last step
    double *y1;                                        // n, its end
    double *dense[MAX_DENSE_TERMS];
    double *near;          // n: what the stiff stage was evaluated at
    double near_h, rate_h; // of the step it belongs to; |h lambda| found from it
    double t, h;
    hn_compensated sum;
    int has_first; // k[0] belongs to the point the next step starts from
    int has_last;  // the slope at y1 is known
    int has_near;  // the stiff stage of an accepted step waits for the slope at its end
} explicit_rk;

static weights list_weights(const double *row, int n) {
    weights out = {0};
    for (int i = 0; row && i < n; i++) {
        if (row[i] != 0) {
            out.at[out.n] = i;
            out.w[out.n++] = row[i];
        }
    }
    return out;
}

/// The rows of the tableau, once.
static bool list_rows(explicit_rk *rk, hn_arena *arena) {
    const hn_tableau *tab = rk->tab;
    const int all = tab->stages + tab->extra;
    for (int i = 0; i < all; i++) {
        rk->stage_of[i] = list_weights(tab->A + (size_t)i * (size_t)all, i);
    }
    rk->b = list_weights(tab->b, tab->stages);
    rk->e = list_weights(tab->e, tab->stages);
    rk->e2 = list_weights(tab->e2, tab->stages);

    rk->dense_of = hn_arena_get(arena, ((size_t)tab->dense_rows + 1) * sizeof *rk->dense_of);
    for (int r = 0; rk->dense_of && tab->d && r < tab->dense_rows; r++) {
        rk->dense_of[r] = list_weights(tab->d + r * all, all);
    }
    return rk->dense_of != NULL;
}

void *hn_explicit_rk_create(const hn_tableau *tableau, int n, hn_arena *arena) {
    HN_ASSERT(tableau->stages + tableau->extra <= MAX_STAGES && n >= 0);
    HN_ASSERT(HERMITE_TERMS + tableau->dense_rows <= MAX_DENSE_TERMS);
    explicit_rk *rk = hn_arena_get(arena, sizeof *rk);
    if (!rk) {
        return NULL;
    }
    rk->tab = tableau;
    rk->n = n;

    // one slope per stage, and the scratch of the stages
    for (int i = 0; i < tableau->stages + tableau->extra; i++) {
        rk->k[i] = hn_arena_doubles(arena, (size_t)n);
    }
    rk->stage = hn_arena_doubles(arena, (size_t)n);
    rk->near = tableau->stiff_stage ? hn_arena_doubles(arena, (size_t)n) : NULL;

    // coefficients of the dense output, and the ends of the step that they belong to
    for (int i = 0; tableau->d && i < HERMITE_TERMS + tableau->dense_rows; i++) {
        rk->dense[i] = hn_arena_doubles(arena, (size_t)n);
    }
    if (tableau->d) {
        rk->y0 = hn_arena_doubles(arena, (size_t)n);
        rk->y1 = hn_arena_doubles(arena, (size_t)n);
    }
    const bool made = hn_compensated_init(&rk->sum, n, arena) && list_rows(rk, arena);
    return made && !hn_arena_failed(arena) ? rk : NULL;
}

void hn_explicit_rk_configure(void *self, const double *options) {
    explicit_rk *rk = self;
    hn_compensated_switch(&rk->sum, options[HN_FIXED_STEP_SUM] != 0);
}

/// Two entries, wherever they stand.
typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));

static pair *two(double *x) {
    return (pair *)x;
}

static pair get_two(const double *x) {
    return *(const pair *)x;
}

// out = base + h w k of one slope, as in every stage of the classical method
static void combine_one(const explicit_rk *rk, const weights *w, const double *base, double h,
                        double *out) {
    const double *const k = rk->k[w->at[0]], weight = w->w[0];
    const int n = rk->n;
    int j = 0;
    for (; j + 1 < n; j += 2) {
        *two(out + j) = get_two(base + j) + h * (0 + weight * get_two(k + j));
    }
    for (; j < n; j++) {
        out[j] = base[j] + h * (0 + weight * k[j]);
    }
}

// out = h sum_m w_m k_m of four slopes, as at the end of a step of the classical method
static void combine_four(const explicit_rk *rk, const weights *w, double h, double *out) {
    const double *const a = rk->k[w->at[0]], *const b = rk->k[w->at[1]], *const c = rk->k[w->at[2]],
                        *const d = rk->k[w->at[3]];
    const double of_a = w->w[0], of_b = w->w[1], of_c = w->w[2], of_d = w->w[3];
    const int n = rk->n;
    int j = 0;
    for (; j + 1 < n; j += 2) {
        *two(out + j) = 0 + h * (0 + of_a * get_two(a + j) + of_b * get_two(b + j) +
                                 of_c * get_two(c + j) + of_d * get_two(d + j));
    }
    for (; j < n; j++) {
        out[j] = 0 + h * (0 + of_a * a[j] + of_b * b[j] + of_c * c[j] + of_d * d[j]);
    }
}

// out = base + h sum_m w_m k_m, the terms of each entry added in their order
static void combine(const explicit_rk *rk, const weights *w, const double *base, double h,
                    double *out) {
    const int n = rk->n;

    if (w->n == 1 && base) {
        combine_one(rk, w, base, h, out);
        return;
    }
    if (w->n == 4 && !base) {
        combine_four(rk, w, h, out);
        return;
    }

    // entries in pairs: their sums do not wait for each other
    int j = 0;
    for (; j + 1 < n; j += 2) {
        double sum[2] = {0, 0};
        for (int m = 0; m < w->n; m++) {
            const double *k = rk->k[w->at[m]] + j, weight = w->w[m];
            sum[0] += weight * k[0];
            sum[1] += weight * k[1];
        }
        out[j] = (base ? base[j] : 0) + h * sum[0];
        out[j + 1] = (base ? base[j + 1] : 0) + h * sum[1];
    }
    for (; j < n; j++) {
        double sum = 0;
        for (int m = 0; m < w->n; m++) {
            sum += w->w[m] * rk->k[w->at[m]][j];
        }
        out[j] = (base ? base[j] : 0) + h * sum;
    }
}

static hn_status eval_stage(explicit_rk *rk, const hn_ode *ode, int i, double t, double h,
                            const double *y) {
    combine(rk, &rk->stage_of[i], y, h, rk->stage);
    return ode->rhs(ode->self, t + rk->tab->c[i] * h, rk->stage, rk->k[i]);
}

// eq. (2), and (3) where there are two; the scratch is free once all stages are known
static void estimate_error(explicit_rk *rk, double h, double *err) {
    const hn_tableau *tab = rk->tab;
    combine(rk, &rk->e, NULL, h, err);
    if (!tab->e2) {
        return;
    }
    combine(rk, &rk->e2, NULL, h, rk->stage);
    for (int j = 0; j < rk->n; j++) {
        const double size = hypot(err[j], 0.1 * rk->stage[j]);
        err[j] = size > 0 ? err[j] * (fabs(err[j]) / size) : err[j];
    }
}

// the stage that holds F(t + h, y1), if the method has one
static int last_stage(const hn_tableau *tab) {
    return tab->fsal ? tab->stages - 1 : tab->stages;
}

// |h lambda| from two slopes at the end of the last step: Hairer & Wanner 1996, eq. (IV.2.13)
static void compare_slopes(explicit_rk *rk, const double *y) {
    const double *slope = rk->k[rk->tab->stiff_stage];
    double apart = 0, distance = 0;
    for (int j = 0; j < rk->n; j++) {
        const double d = rk->k[0][j] - slope[j], e = y[j] - rk->near[j];
        apart += d * d;
        distance += e * e;
    }
    rk->rate_h = distance > 0 ? rk->near_h * sqrt(apart / distance) : 0;
    rk->has_near = 0;
}

double hn_explicit_rk_stiffness(const void *self) {
    const explicit_rk *rk = self;
    return rk->rate_h;
}

hn_status hn_explicit_rk_step(void *self, const hn_ode *ode, double t, double h, const double *y,
                              double *y_new, double *err) {
    explicit_rk *rk = self;
    const hn_tableau *tab = rk->tab;

    // the first slope may be left from the last step or from a trial
    if (!rk->has_first) {
        const hn_status status = ode->rhs(ode->self, t, y, rk->k[0]);
        if (status != HN_OK) {
            return status;
        }
        rk->has_first = 1;
    }
    if (rk->has_near) {
        compare_slopes(rk, y);
    }

    // the other stages
    for (int i = 1; i < tab->stages; i++) {
        const hn_status status = eval_stage(rk, ode, i, t, h, y);
        if (status != HN_OK) {
            return status;
        }
        if (tab->stiff_stage == i) {
            memcpy(rk->near, rk->stage, (size_t)rk->n * sizeof *rk->near);
        }
    }

    // the last stage of a FSAL method was evaluated at y1 itself: take that very point
    if (tab->fsal) {
        memcpy(y_new, rk->stage, (size_t)rk->n * sizeof *y_new);
    } else {
        combine(rk, &rk->b, NULL, h, rk->stage);
        hn_compensated_add(&rk->sum, 0, rk->n, y, rk->stage, y_new);
    }

    // error estimate and ends of the step for the dense output
    if (err && tab->e) {
        estimate_error(rk, h, err);
    }
    if (tab->d) {
        memcpy(rk->y0, y, (size_t)rk->n * sizeof *y);
        memcpy(rk->y1, y_new, (size_t)rk->n * sizeof *y);
    }
    rk->t = t;
    rk->h = h;
    rk->has_last = tab->fsal;
    return HN_OK;
}

hn_status hn_explicit_rk_finish(void *self, const hn_ode *ode) {
    explicit_rk *rk = self;
    const hn_tableau *tab = rk->tab;
    hn_status status = ode->rhs(ode->self, rk->t + rk->h, rk->y1, rk->k[tab->stages]);
    for (int i = tab->stages + 1; status == HN_OK && i < tab->stages + tab->extra; i++) {
        status = eval_stage(rk, ode, i, rk->t, rk->h, rk->y0);
    }
    rk->has_last = status == HN_OK;
    return status;
}

// Hairer, Norsett & Wanner 1993, section II.6: coefficients of the interpolant in nested form
static void make_dense(explicit_rk *rk) {
    const hn_tableau *tab = rk->tab;
    const double h = rk->h, *first = rk->k[0], *last = rk->k[last_stage(tab)];
    for (int j = 0; j < rk->n; j++) {
        const double diff = rk->y1[j] - rk->y0[j], slope = h * first[j] - diff;
        rk->dense[0][j] = rk->y0[j];
        rk->dense[1][j] = diff;
        rk->dense[2][j] = slope;
        rk->dense[3][j] = diff - h * last[j] - slope;
    }
    for (int r = 0; r < tab->dense_rows; r++) {
        combine(rk, &rk->dense_of[r], NULL, h, rk->dense[HERMITE_TERMS + r]);
    }
}

void hn_explicit_rk_accepted(void *self, int changed) {
    explicit_rk *rk = self;
    // nothing has been stepped since the last call: only the first stage can be stale
    const int has_last = rk->has_last && rk->has_first && rk->h != 0;
    if (rk->tab->d && has_last) {
        make_dense(rk);
    }
    const int keep = has_last && !changed;
    if (keep) {
        const int last = last_stage(rk->tab);
        double *const k = rk->k[last];
        rk->k[last] = rk->k[0];
        rk->k[0] = k;
    }
    hn_compensated_accepted(&rk->sum, changed);
    rk->has_near = rk->near && rk->h != 0;
    rk->near_h = rk->h;
    rk->has_first = keep;
    rk->has_last = 0;
    rk->h = 0;
}

void hn_explicit_rk_dense(void *self, double theta, double *y) {
    const explicit_rk *rk = self;
    const double factor[2] = {theta, 1 - theta};
    const int last = HERMITE_TERMS + rk->tab->dense_rows - 1;
    // y0 + theta (d1 + (1 - theta) (d2 + theta (d3 + (1 - theta) (d4 + ...))))
    for (int j = 0; j < rk->n; j++) {
        double sum = rk->dense[last][j];
        for (int i = last - 1; i >= 0; i--) {
            sum = rk->dense[i][j] + factor[i % 2] * sum;
        }
        y[j] = sum;
    }
}
