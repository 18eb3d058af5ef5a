// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_ode.h"

#include "integrators/implicit/stages.h"
#include "integrators/step/control.h"
#include "linalg/dense.h"
#include "linalg/lu.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define ROUNDING 1e-14 // of the scale: corrections at or below are rounding

typedef struct implicit_ode {
    hn_stages nw;
    hn_arena *arena;
    const hn_ode *ode; // during a step
    int n;
    double rtol, atol, weight;                   // weight: of the error estimate
    double *y0, *slope0, *stage, *base, *column; // n
    double *jacobian, *real,
        *scale; // n x n, n x n, n; with those below NULL where the formulation solves
    hn_complex *complex_matrix, *packed;
    int *pivot[2];
    double *guess;     // stages x n: Z of the last accepted step
    double h, guess_h; // of the trial, of the last accepted step (0: none)
} implicit_ode;

// R = Z' - F(t, y0 + Z)
static hn_status residual(void *self, int stage, double t, const double *u, const double *rate,
                          double *r) {
    implicit_ode *s = self;
    (void)stage;
    for (int i = 0; i < s->n; i++) {
        s->stage[i] = s->y0[i] + u[i];
    }
    const hn_status status = s->ode->rhs(s->ode->self, t, s->stage, r);
    for (int i = 0; status == HN_OK && i < s->n; i++) {
        r[i] = rate[i] - r[i];
    }
    return status;
}

static hn_status factor(void *self, int which, double re, double im) {
    implicit_ode *s = self;
    const int n = s->n;

    // by the structure of the equations where they offer it
    if (s->ode->newton) {
        return s->ode->newton->factor(s->ode->self, which, re, im);
    }

    // one real system
    if (which == 0) {
        for (int i = 0; i < n * n; i++) {
            s->real[i] = -s->jacobian[i];
        }
        for (int i = 0; i < n; i++) {
            s->real[i * n + i] += re;
        }
        return hn_lu_factor(n, s->real, s->pivot[0], s->scale);
    }

    // one complex system
    for (int i = 0; i < n * n; i++) {
        s->complex_matrix[i] = (hn_complex){-s->jacobian[i], 0};
    }
    for (int i = 0; i < n; i++) {
        s->complex_matrix[i * n + i].re += re;
        s->complex_matrix[i * n + i].im += im;
    }
    return hn_lu_factor_complex(n, s->complex_matrix, s->pivot[1], s->scale);
}

static void solve(void *self, hn_parts r) {
    implicit_ode *s = self;

    // by the structure of the equations; signs are those of (s - J)
    if (s->ode->newton) {
        for (int part = 0; part < r.n; part++) {
            for (int i = 0; i < s->n; i++) {
                r.at[part][i] = -r.at[part][i];
            }
        }
        s->ode->newton->solve(s->ode->self, r.n, r.at);
        return;
    }

    if (r.n == 1) {
        for (int i = 0; i < s->n; i++) {
            r.at[0][i] = -r.at[0][i];
        }
        hn_lu_solve(s->n, s->real, s->pivot[0], r.at[0]);
        return;
    }
    for (int i = 0; i < s->n; i++) {
        s->packed[i] = (hn_complex){-r.at[0][i], -r.at[1][i]};
    }
    hn_lu_solve_complex(s->n, s->complex_matrix, s->pivot[1], s->packed);
    for (int i = 0; i < s->n; i++) {
        r.at[0][i] = s->packed[i].re;
        r.at[1][i] = s->packed[i].im;
    }
}

// columns of dF/dy at y by one-sided differences from `base`, its F
static hn_status differences(implicit_ode *s, const hn_ode *ode, double t, double *y,
                             const double *base) {
    const int n = s->n;
    double *column = s->column;
    for (int j = 0; j < n; j++) {
        const double keep = y[j], step = sqrt(DBL_EPSILON) * fmax(1e-3, fabs(keep));
        y[j] = keep + step;
        const double exact = y[j] - keep;
        const hn_status status = ode->rhs(ode->self, t, y, column);
        y[j] = keep;
        if (status != HN_OK) {
            return status;
        }
        for (int i = 0; i < n; i++) {
            s->jacobian[i * n + j] = (column[i] - base[i]) / exact;
        }
    }
    return HN_OK;
}

static hn_status find_jacobian(implicit_ode *s, double t, double *y, const double *base) {
    if (s->ode->newton) {
        return s->ode->newton->at(s->ode->self, t, y);
    }
    return s->ode->jacobian ? s->ode->jacobian(s->ode->self, t, y, s->jacobian)
                            : differences(s, s->ode, t, y, base);
}

static hn_status relinearise(void *self, double t, const double *u, const double *rate) {
    implicit_ode *s = self;
    (void)rate;
    hn_status status = HN_OK;
    for (int i = 0; i < s->n; i++) {
        s->stage[i] = s->y0[i] + u[i];
    }
    if (!s->ode->newton && !s->ode->jacobian) {
        status = s->ode->rhs(s->ode->self, t, s->stage, s->base);
    }
    return status == HN_OK ? find_jacobian(s, t, s->stage, s->base) : status;
}

// full matrices, for formulations that do not solve themselves: they are large, and most do
static hn_status allocate_full(implicit_ode *s) {
    const size_t w = (size_t)s->n;
    if (s->jacobian) {
        return HN_OK;
    }
    s->real = hn_arena_doubles(s->arena, w * w);
    s->scale = hn_arena_doubles(s->arena, w);
    s->complex_matrix = hn_arena_get(s->arena, (w * w + 1) * sizeof *s->complex_matrix);
    s->packed = hn_arena_get(s->arena, (w + 1) * sizeof *s->packed);
    s->pivot[0] = hn_arena_ints(s->arena, w);
    s->pivot[1] = hn_arena_ints(s->arena, w);
    s->jacobian = hn_arena_doubles(s->arena, w * w);
    return hn_arena_failed(s->arena) ? HN_ERR_MEMORY : HN_OK;
}

void *hn_implicit_ode_create(const hn_collocation *col, int n, hn_arena *arena) {
    const size_t w = (size_t)n;
    implicit_ode *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return NULL;
    }

    // the equations of the stages, as stages.h sees them
    *s = (implicit_ode){.n = n, .arena = arena};
    const hn_stage_equations eq = {.self = s,
                                   .n_diff = n,
                                   .residual = residual,
                                   .factor = factor,
                                   .solve = solve,
                                   .relinearise = relinearise};

    // room for states, slopes and the guess
    s->y0 = hn_arena_doubles(arena, w);
    s->slope0 = hn_arena_doubles(arena, w);
    s->stage = hn_arena_doubles(arena, w);
    s->base = hn_arena_doubles(arena, w);
    s->column = hn_arena_doubles(arena, w);
    s->guess = hn_arena_doubles(arena, (size_t)col->stages * w);
    const hn_status status = hn_stages_init(&s->nw, col, &eq, arena);
    return status == HN_OK && !hn_arena_failed(arena) ? s : NULL;
}

void hn_implicit_ode_set_tolerance(void *self, double rtol, double atol) {
    implicit_ode *s = self;
    s->rtol = rtol;
    s->atol = atol > 0 ? atol : rtol;
    s->weight = rtol > 0 ? hn_collocation_estimate_weight(rtol) : 1;
    s->nw.tol = rtol > 0 ? hn_collocation_newton_share(rtol) : 0;
}

hn_status hn_implicit_ode_prepare(void *self, const hn_ode *ode) {
    const hn_status status = ode->newton ? HN_OK : allocate_full(self);
    return status == HN_OK && ode->prepare ? ode->prepare(ode->self) : status;
}

static void set_scale(implicit_ode *s, const hn_ode *ode) {
    const double size_pos = 1 + hn_norm_max(ode->n_pos, s->y0);
    const double size_vel = 1 + hn_norm_max(ode->n_vel, s->y0 + ode->n_pos);
    const hn_tolerance tol = hn_tolerance_for(ode, s->rtol, s->atol);
    for (int i = 0; i < s->n; i++) {
        s->nw.scale[i] = s->rtol > 0      ? hn_tolerance_of(&tol, i, s->y0[i], s->y0[i]) / s->weight
                         : i < ode->n_pos ? size_pos
                                          : size_vel;
    }
}

// the polynomial through the last step's stages, continued; at first the tangent
static void guess_stages(implicit_ode *s, double h) {
    const hn_collocation *col = &s->nw.col;
    const int stages = col->stages, n = s->n;
    double w[HN_IMPLICIT_STAGES];
    for (int i = 0; i < stages; i++) {
        double *z = s->nw.u + i * n;
        if (s->guess_h <= 0) {
            for (int k = 0; k < n; k++) {
                z[k] = col->c[i] * h * s->slope0[k];
            }
            continue;
        }
        hn_collocation_dense(col, 1 + col->c[i] * h / s->guess_h, w);
        for (int k = 0; k < n; k++) {
            z[k] = 0;
            for (int j = 0; j < stages; j++) {
                z[k] += (w[j] - col->end[j]) * s->guess[j * n + k];
            }
        }
    }
}

// see hn_collocation.e; a second pass at y0 + err where the first is above the tolerance keeps
// stiff starts from failing
static hn_status estimate_error(implicit_ode *s, double t, double h, const double *y_new,
                                double *err) {
    const hn_collocation *col = &s->nw.col;
    const int n = s->n;
    double *const weighted = s->nw.parts;
    const hn_tolerance tol = hn_tolerance_for(s->ode, s->rtol, s->atol);

    // the embedded weights give the difference of two slopes
    for (int k = 0; k < n; k++) {
        weighted[k] = 0;
        for (int i = 0; i < col->stages; i++) {
            weighted[k] += col->e[i] * s->nw.u[i * n + k] / h;
        }
    }

    // filtered by (s - J)^-1; a second pass where the first refuses the step
    const double *slope = s->slope0;
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < n; k++) {
            err[k] = -(slope[k] + weighted[k]);
        }

        solve(s, (hn_parts){1, {err, NULL}});
        for (int k = 0; k < n; k++) {
            err[k] *= s->weight;
        }
        if (pass == 1 || hn_error_norm(n, err, s->y0, y_new, &tol) < 1) {
            return HN_OK;
        }
        for (int k = 0; k < n; k++) {
            s->stage[k] = s->y0[k] + err[k] / s->weight;
        }
        const hn_status status = s->ode->rhs(s->ode->self, t, s->stage, s->nw.r);
        if (status != HN_OK) {
            return HN_OK; // the first estimate stands: the step is refused
        }
        slope = s->nw.r;
    }
    return HN_OK;
}

hn_status hn_implicit_ode_step(void *self, const hn_ode *ode, double t, double h, const double *y,
                               double *y_new, double *err) {
    implicit_ode *s = self;
    s->ode = ode;
    s->h = 0;
    s->nw.why[0] = '\0';
    memcpy(s->y0, y, (size_t)s->n * sizeof *y);
    HN_TRY(ode->newton ? HN_OK : allocate_full(s));
    HN_TRY(ode->rhs(ode->self, t, y, s->slope0));
    HN_TRY(find_jacobian(s, t, s->y0, s->slope0));
    set_scale(s, ode);
    s->nw.floor = s->rtol > 0 ? 0 : ROUNDING;
    guess_stages(s, h);
    HN_TRY(hn_stages_solve(&s->nw, t, h));
    hn_stages_end(&s->nw, y_new);
    hn_axpy(s->n, 1, y, y_new);
    s->h = h;
    return err && s->nw.col.has_error && s->rtol > 0 ? estimate_error(s, t, h, y_new, err) : HN_OK;
}

void hn_implicit_ode_accepted(void *self, int changed) {
    implicit_ode *s = self;
    const int keep = s->h > 0 && !changed;
    if (keep) {
        memcpy(s->guess, s->nw.u, (size_t)(s->nw.col.stages * s->n) * sizeof *s->guess);
    }
    s->guess_h = keep ? s->h : 0;
    s->h = 0;
}

void hn_implicit_ode_dense(void *self, double theta, double *y) {
    implicit_ode *s = self;
    hn_stages_dense(&s->nw, theta, y);
    hn_axpy(s->n, 1, s->y0, y);
}

void hn_implicit_ode_add_cost(const void *self, hn_cost *cost) {
    const implicit_ode *s = self;
    const double n = s->n;
    const double per_factor = 2.0 / 3 * n * n * n, per_solve = 2 * n * n;
    const int blocks = s->nw.col.n_real + s->nw.col.n_pairs;
    // a complex multiplication and addition are eight operations against two
    const double weight = (s->nw.col.n_real + 4.0 * s->nw.col.n_pairs) / blocks;
    cost->factorisations += s->nw.factorisations;
    cost->solves += s->nw.solves;
    cost->newton += s->nw.iterations;
    if (!s->jacobian) {
        return; // the formulation counts what it solves
    }
    cost->ops +=
        weight * ((double)s->nw.factorisations * per_factor + (double)s->nw.solves * per_solve);
}

const char *hn_implicit_ode_why(const void *self) {
    const implicit_ode *s = self;
    return s->nw.why[0] ? s->nw.why : NULL;
}
