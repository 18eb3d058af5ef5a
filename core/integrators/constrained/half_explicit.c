// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/constrained/half_explicit.h"

#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "integrators/step/dae_base.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

#define CLOSED 1e-15 // of the length: as far as rounding allows

static const double hem3_A[] = {
    0,       0,    0,    // stage 1
    1.0 / 3, 0,    0,    // stage 2
    -1,      2,    0,    // stage 3
    0,       0.75, 0.25, // b
};
const hn_half_explicit hn_half_explicit_hem3 = {3, 3, hem3_A};

#define ROOT6 2.449489742783178098197284074705891
static const double hem4_A[] = {
    0,
    0,
    0,
    0,
    0, // stage 1
    0.3,
    0,
    0,
    0,
    0,
    (1 + ROOT6) / 30,
    (11 - 4 * ROOT6) / 30,
    0,
    0,
    0,
    (-79 - 31 * ROOT6) / 150,
    (-1 - 4 * ROOT6) / 30,
    (24 + 11 * ROOT6) / 25,
    0,
    0,
    (14 + 5 * ROOT6) / 6,
    (-8 + 7 * ROOT6) / 6,
    (-9 - 7 * ROOT6) / 4,
    (9 - ROOT6) / 4,
    0,
    0,
    0,
    (16 - ROOT6) / 36,
    (16 + ROOT6) / 36,
    1.0 / 9,
};
const hn_half_explicit hn_half_explicit_hem4 = {5, 4, hem4_A};

static const double rk4_A[] = {
    0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6,
};
const hn_half_explicit hn_half_explicit_rk4 = {4, 3, rk4_A};

typedef struct half_explicit {
    hn_dae_base base; // first
    const hn_half_explicit *scheme;
    int doubled, close;
    long long accepted;
    hn_projector *projector; // NULL with HN_CLOSE_NEVER
    hn_newton_matrix *matrix;
    double *Q, *V;          // nq, nv: the stage
    double *qdot;           // stages x nq
    double *k;              // stages x nv
    double *J_here;         // nc x nv
    double *x;              // nv + nc
    double *raw, *raw_next; // nc: multipliers of the last stage, kept and of the trial
    double *middle, *whole; // nq + nv each, doubled only
} half_explicit;

hn_status hn_half_explicit_create(const hn_half_explicit *scheme, int doubled, int close,
                                  const hn_system *sys, hn_arena *arena, void **self,
                                  hn_diag *diag) {
    half_explicit *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    hn_status status = hn_dae_base_init(&s->base, sys, arena, diag);
    if (status != HN_OK) {
        return status;
    }
    s->close = close;
    if (close != HN_CLOSE_NEVER) {
        status = hn_projector_create(sys, HN_WEIGHT_MASS, arena, &s->projector);
    }
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, "index2:close=-1 needs none", "the projection: %s",
                           hn_status_text(status));
    }
    const size_t nq = (size_t)s->base.nq, nv = (size_t)s->base.nv, nc = (size_t)s->base.nc;
    s->scheme = scheme;
    s->doubled = doubled;
    s->Q = hn_arena_doubles(arena, nq);
    s->V = hn_arena_doubles(arena, nv);
    s->qdot = hn_arena_doubles(arena, nq * (size_t)scheme->stages);
    s->k = hn_arena_doubles(arena, nv * (size_t)scheme->stages);
    s->J_here = hn_arena_doubles(arena, nv * nc);
    s->x = hn_arena_doubles(arena, nv + nc);
    s->raw = hn_arena_doubles(arena, nc);
    s->raw_next = hn_arena_doubles(arena, nc);
    s->middle = hn_arena_doubles(arena, nq + nv);
    s->whole = hn_arena_doubles(arena, nq + nv);
    s->matrix = hn_dae_matrix_create(&s->base, arena, (int)(nv + nc), 1, 2, 0);
    if (!s->matrix || hn_arena_failed(arena)) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return HN_OK;
}

void hn_half_explicit_destroy(void *self) {
    half_explicit *s = self;
    hn_newton_matrix_free(s->matrix);
    hn_projector_free(s->projector);
    s->matrix = NULL;
    s->projector = NULL;
    hn_dae_base_destroy(&s->base);
}

hn_status hn_half_explicit_start(void *self, double t, const double *y) {
    half_explicit *s = self;
    double *a = s->x; // not kept: the scheme needs no accelerations to begin with
    return hn_dae_accelerate(&s->base, t, y, y + s->base.nq, a, s->raw);
}

// the row's sum of stages so far, out (n) = from + h sum_j a_j x_j
static void combine(int n, double h, const double *row, int used, const double *from,
                    const double *x, double *out) {
    memcpy(out, from, (size_t)n * sizeof *out);
    for (int j = 0; j < used; j++) {
        if (row[j] != 0) {
            hn_axpy(n, h * row[j], x + (size_t)j * n, out);
        }
    }
}

// [M J_here'; J_next 0] with the chosen rows
static void fill_matrix(half_explicit *s) {
    const hn_dae_base *b = &s->base;
    hn_newton_matrix_begin(s->matrix, b->nv + b->nr);
    hn_dae_put_mass(b, s->matrix, 1, 0, 0);
    hn_dae_put_columns(b, s->matrix, s->J_here, 1, 0, b->nv);
    hn_dae_put_rows(b, s->matrix, b->J, 1, b->nv, 0);
}

// equation (2): k_i, with V_(i+1) without its own share, h a_(i+1,i) k_i, in s->V
static hn_status solve_stage(half_explicit *s, int i, double step) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv;
    fill_matrix(s);
    const hn_status status = hn_newton_matrix_factor(s->matrix);
    b->cost.factorisations++;
    b->cost.solves++;
    if (status != HN_OK) {
        return status;
    }

    // the right side: forces, and the velocity violation that the step has to remove
    memcpy(s->x, b->f, (size_t)nv * sizeof *s->x);
    hn_dae_speed_gap(b, s->V, s->x + nv);
    for (int k = 0; k < b->nr; k++) {
        s->x[nv + k] /= -step;
    }
    hn_newton_matrix_solve(s->matrix, s->x);

    // slopes of this stage, and its multipliers with the sign of (1)
    memcpy(s->k + (size_t)i * nv, s->x, (size_t)nv * sizeof *s->x);
    memset(s->raw_next, 0, (size_t)b->nc * sizeof *s->raw_next);
    for (int k = 0; k < b->nr; k++) {
        s->raw_next[b->rows[k]] = -s->x[nv + k];
    }
    return HN_OK;
}

static double abscissa(const hn_half_explicit *scheme, int i) {
    double c = 0;
    for (int j = 0; j < i; j++) {
        c += scheme->A[i * scheme->stages + j];
    }
    return c;
}

// one step from y to y_new
static hn_status advance(half_explicit *s, double t, double h, const double *y, double *y_new) {
    hn_dae_base *b = &s->base;
    const int nq = b->nq, nv = b->nv, stages = s->scheme->stages;
    const double *q = y, *v = y + nq;

    // the first stage is the start itself
    memcpy(s->Q, q, (size_t)nq * sizeof *q);
    memcpy(s->V, v, (size_t)nv * sizeof *v);
    hn_dae_loops(b, t, s->Q);
    hn_dae_choose_rows(b);

    // a stage: forces at its own state, velocities of the next stage closed
    for (int i = 0; i < stages; i++) {
        const double *row = s->scheme->A + (size_t)(i + 1) * stages;
        const double t_next = t + h * (i + 1 < stages ? abscissa(s->scheme, i + 1) : 1);
        hn_dae_dynamics(b, t + h * abscissa(s->scheme, i), s->Q, s->V);
        hn_dae_copy_rows(b, s->J_here);
        hn_system_kinematics(b->sys, s->Q, s->V, s->qdot + (size_t)i * nq);
        combine(nq, h, row, i + 1, q, s->qdot, s->Q);
        combine(nv, h, row, i, v, s->k, s->V);
        hn_dae_loops(b, t_next, s->Q);
        const hn_status status = solve_stage(s, i, h * row[i]);
        if (status != HN_OK) {
            return hn_dae_fail(b, status, t_next, "a stage of the step");
        }
        hn_axpy(nv, h * row[i], s->k + (size_t)i * nv, s->V);
    }

    memcpy(y_new, s->Q, (size_t)nq * sizeof *q);
    memcpy(y_new + nq, s->V, (size_t)nv * sizeof *v);
    (void)hn_system_normalise(b->sys, y_new);
    return HN_OK;
}

// by step doubling
static hn_status advance_doubled(half_explicit *s, double t, double h, const double *y,
                                 double *y_new, double *err) {
    const int n = s->base.nq + s->base.nv;
    hn_status status = advance(s, t, h, y, s->whole);
    HN_THEN(status, advance(s, t, h / 2, y, s->middle));
    HN_THEN(status, advance(s, t + h / 2, h / 2, s->middle, y_new));
    const double gain = ldexp(1, s->scheme->order) - 1;
    for (int i = 0; status == HN_OK && i < n; i++) {
        err[i] = (y_new[i] - s->whole[i]) / gain;
    }
    return status;
}

static hn_status close_end(half_explicit *s, double t, double *y) {
    hn_status status = hn_project_position(s->projector, t, y, CLOSED, NULL);
    HN_THEN(status, hn_project_velocity(s->projector, t, y, y + s->base.nq, NULL));
    return status == HN_OK ? HN_OK
                           : hn_dae_fail(&s->base, status, t, "closing the end of the step");
}

hn_status hn_half_explicit_step(void *self, double t, double h, const double *y, double *y_new,
                                double *err) {
    half_explicit *s = self;
    const hn_status status =
        s->doubled ? advance_doubled(s, t, h, y, y_new, err) : advance(s, t, h, y, y_new);
    const int dependent = s->base.nr < s->base.nc;
    return status == HN_OK && hn_dae_closes(s->close, s->accepted + 1, dependent)
               ? close_end(s, t + h, y_new)
               : status;
}

void hn_half_explicit_accepted(void *self, int changed) {
    half_explicit *s = self;
    (void)changed; // no state but the multipliers is carried over
    double *const raw = s->raw;
    s->raw = s->raw_next;
    s->raw_next = raw;
    s->accepted++;
}

const double *hn_half_explicit_raw_lambda(const void *self) {
    const half_explicit *s = self;
    return s->raw;
}

void hn_half_explicit_add_cost(const void *self, hn_cost *cost) {
    const half_explicit *s = self;
    hn_dae_base_add_cost(&s->base, cost);
    cost->ops += hn_newton_matrix_ops(s->matrix);
    if (s->projector) {
        cost->evals += hn_projector_evals(s->projector);
        cost->ops += hn_projector_ops(s->projector);
    }
}

const char *hn_half_explicit_why(const void *self) {
    const half_explicit *s = self;
    return hn_dae_base_why(&s->base);
}
