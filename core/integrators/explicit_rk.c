#include "integrators/explicit_rk.h"

#include <string.h>

enum { MAX_STAGES = 16, DENSE_TERMS = 5 };

typedef struct explicit_rk {
    const hn_tableau *tab;
    int n;
    double *k[MAX_STAGES];
    double *stage; // n
    double *y0;    // n, start of the last step
    double *y1;    // n, its end
    double *dense[DENSE_TERMS];
    double h;
    int has_first; // k[0] belongs to the point the next step starts from
} explicit_rk;

void *hn_explicit_rk_create(const hn_tableau *tableau, int n, hn_arena *arena) {
    HN_ASSERT(tableau->stages <= MAX_STAGES && n >= 0);
    explicit_rk *rk = hn_arena_get(arena, sizeof *rk);
    if (!rk) {
        return NULL;
    }
    rk->tab = tableau;
    rk->n = n;
    for (int i = 0; i < tableau->stages; i++) {
        rk->k[i] = hn_arena_doubles(arena, (size_t)n);
    }
    rk->stage = hn_arena_doubles(arena, (size_t)n);
    for (int i = 0; tableau->d && i < DENSE_TERMS; i++) {
        rk->dense[i] = hn_arena_doubles(arena, (size_t)n);
    }
    if (tableau->d) {
        rk->y0 = hn_arena_doubles(arena, (size_t)n);
        rk->y1 = hn_arena_doubles(arena, (size_t)n);
    }
    return hn_arena_failed(arena) ? NULL : rk;
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
    combine(rk, tab->A + i * tab->stages, i, y, h, rk->stage);
    return ode->rhs(ode->self, t + tab->c[i] * h, rk->stage, rk->k[i]);
}

hn_status hn_explicit_rk_step(void *self, const hn_ode *ode, double t, double h, const double *y,
                              double *y_new, double *err) {
    explicit_rk *rk = self;
    const hn_tableau *tab = rk->tab;
    if (!rk->has_first) {
        const hn_status status = ode->rhs(ode->self, t, y, rk->k[0]);
        if (status != HN_OK) {
            return status;
        }
        rk->has_first = 1;
    }
    for (int i = 1; i < tab->stages; i++) {
        const hn_status status = eval_stage(rk, ode, i, t, h, y);
        if (status != HN_OK) {
            return status;
        }
    }
    // the last stage of a FSAL method was evaluated at y1 itself: take that very point
    if (tab->fsal) {
        memcpy(y_new, rk->stage, (size_t)rk->n * sizeof *y_new);
    } else {
        combine(rk, tab->b, tab->stages, y, h, y_new);
    }
    if (err && tab->e) {
        combine(rk, tab->e, tab->stages, NULL, h, err);
    }
    if (tab->d) {
        memcpy(rk->y0, y, (size_t)rk->n * sizeof *y);
        memcpy(rk->y1, y_new, (size_t)rk->n * sizeof *y);
    }
    rk->h = h;
    return HN_OK;
}

// Hairer, Norsett & Wanner 1993, section II.6: coefficients of the interpolant in nested form
static void make_dense(explicit_rk *rk) {
    const double h = rk->h, *first = rk->k[0], *last = rk->k[rk->tab->stages - 1];
    for (int j = 0; j < rk->n; j++) {
        const double diff = rk->y1[j] - rk->y0[j], slope = h * first[j] - diff;
        rk->dense[0][j] = rk->y0[j];
        rk->dense[1][j] = diff;
        rk->dense[2][j] = slope;
        rk->dense[3][j] = diff - h * last[j] - slope;
    }
    combine(rk, rk->tab->d, rk->tab->stages, NULL, h, rk->dense[4]);
}

void hn_explicit_rk_accepted(void *self, int changed) {
    explicit_rk *rk = self;
    // nothing has been stepped since the last call: only the first stage can be stale
    if (rk->tab->d && rk->has_first && rk->h != 0) {
        make_dense(rk);
    }
    const int keep = rk->tab->fsal && !changed && rk->has_first && rk->h != 0;
    if (keep) {
        double *const last = rk->k[rk->tab->stages - 1];
        rk->k[rk->tab->stages - 1] = rk->k[0];
        rk->k[0] = last;
    }
    rk->has_first = keep;
    rk->h = 0;
}

void hn_explicit_rk_dense(void *self, double theta, double *y) {
    const explicit_rk *rk = self;
    const double rest = 1 - theta;
    for (int j = 0; j < rk->n; j++) {
        const double inner = rk->dense[3][j] + rest * rk->dense[4][j];
        const double middle = rk->dense[2][j] + theta * inner;
        y[j] = rk->dense[0][j] + theta * (rk->dense[1][j] + rest * middle);
    }
}
