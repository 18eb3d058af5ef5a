// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/explicit_rk.h"

#include "integrators/step/compensated.h"

#include <math.h>
#include <string.h>

enum { MAX_STAGES = 16, HERMITE_TERMS = 4, MAX_DENSE_TERMS = 8 };

typedef struct explicit_rk {
    const hn_tableau *tab;
    int n;
    double *k[MAX_STAGES];
    double *stage; // n
    double *y0;    // n, start of the last step
    double *y1;    // n, its end
    double *dense[MAX_DENSE_TERMS];
    double *near;          // n: what the stiff stage was evaluated at
    double near_h, rate_h; // of the step it belongs to; |h lambda| found from it
    double t, h;
    hn_compensated sum;
    int has_first; // k[0] belongs to the point the next step starts from
    int has_last;  // the slope at y1 is known
    int has_near;  // the stiff stage of an accepted step waits for the slope at its end
} explicit_rk;

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
    return hn_compensated_init(&rk->sum, n, arena) && !hn_arena_failed(arena) ? rk : NULL;
}

void hn_explicit_rk_configure(void *self, const double *options) {
    explicit_rk *rk = self;
    hn_compensated_switch(&rk->sum, options[HN_FIXED_STEP_SUM] != 0);
}

// out = base + h sum_{i < n_terms} w_i k_i
static void combine(const explicit_rk *rk, const double *w, int n_terms, const double *base,
                    double h, double *out) {
    for (int j = 0; j < rk->n; j++) {
        double sum = 0;
        for (int i = 0; i < n_terms; i++) {
            if (w[i] != 0) {
                sum += w[i] * rk->k[i][j];
            }
        }
        out[j] = (base ? base[j] : 0) + h * sum;
    }
}

static hn_status eval_stage(explicit_rk *rk, const hn_ode *ode, int i, double t, double h,
                            const double *y) {
    const hn_tableau *tab = rk->tab;
    combine(rk, tab->A + i * (tab->stages + tab->extra), i, y, h, rk->stage);
    return ode->rhs(ode->self, t + tab->c[i] * h, rk->stage, rk->k[i]);
}

// eq. (2), and (3) where there are two; the scratch is free once all stages are known
static void estimate_error(explicit_rk *rk, double h, double *err) {
    const hn_tableau *tab = rk->tab;
    combine(rk, tab->e, tab->stages, NULL, h, err);
    if (!tab->e2) {
        return;
    }
    combine(rk, tab->e2, tab->stages, NULL, h, rk->stage);
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
        combine(rk, tab->b, tab->stages, NULL, h, rk->stage);
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
    const int all = tab->stages + tab->extra;
    for (int j = 0; j < rk->n; j++) {
        const double diff = rk->y1[j] - rk->y0[j], slope = h * first[j] - diff;
        rk->dense[0][j] = rk->y0[j];
        rk->dense[1][j] = diff;
        rk->dense[2][j] = slope;
        rk->dense[3][j] = diff - h * last[j] - slope;
    }
    for (int r = 0; r < tab->dense_rows; r++) {
        combine(rk, tab->d + r * all, all, NULL, h, rk->dense[HERMITE_TERMS + r]);
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
