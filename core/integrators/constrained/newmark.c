// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/constrained/newmark.h"

#include "dynamics/compile/coordinates.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double KEEP_FACTOR_BELOW = 0.05; // contraction with which an old matrix goes on

static bool is_extended(const hn_newmark *s) {
    return s->stabilised && s->base.sparse;
}

static hn_status create_matrix(hn_newmark *s, hn_arena *arena) {
    const int nv = s->base.nv, nc = s->base.nc;
    int n = nv + nc, puts = hn_linear_entries(s->matrices, HN_LINEAR_M) +
                            hn_linear_entries(s->matrices, HN_LINEAR_C) +
                            hn_linear_entries(s->matrices, HN_LINEAR_K);
    if (s->stabilised) {
        n = is_extended(s) ? 2 * n : n + nc;
        puts += hn_linear_entries(s->matrices, HN_LINEAR_V) +
                hn_linear_entries(s->matrices, HN_LINEAR_M) +
                hn_linear_entries(s->matrices, HN_LINEAR_C);
    }
    s->matrix =
        hn_dae_matrix_create(&s->base, arena, n, s->stabilised, s->stabilised ? 4 : 2, puts);
    return s->matrix ? HN_OK : HN_ERR_MEMORY;
}

static hn_status allocate(hn_newmark *s, hn_arena *arena) {
    const size_t nv = (size_t)s->base.nv, nc = (size_t)s->base.nc;
    double **of_nv[] = {&s->a0, &s->past, &s->carry, &s->a1, &s->e, &s->D, &s->v1, &s->pushed};
    double **of_nc[] = {&s->guess, &s->lambda, &s->eta, &s->scaled};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, nv);
    }
    for (size_t i = 0; i < sizeof of_nc / sizeof *of_nc; i++) {
        *of_nc[i] = hn_arena_doubles(arena, nc);
    }
    if (s->stabilised && !is_extended(s)) {
        s->P = hn_arena_doubles(arena, nc * nv);
        s->factor = hn_arena_doubles(arena, nv * nv);
    }
    s->x = hn_arena_doubles(arena, 2 * (nv + nc));
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : create_matrix(s, arena);
}

void hn_newmark_carried_init(hn_newmark_carried *c, hn_arena *arena, size_t nv, size_t nc) {
    c->a = hn_arena_doubles(arena, nv);
    c->e = hn_arena_doubles(arena, nv);
    c->lambda = hn_arena_doubles(arena, nc);
}

hn_status hn_newmark_init(hn_newmark *s, const hn_system *sys, bool stabilised, hn_arena *arena,
                          hn_diag *diag) {
    const unsigned rest = HN_LINEAR_RESIDUAL | HN_LINEAR_PHI | HN_LINEAR_SPEED_GAP;
    const unsigned matrices =
        HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | (stabilised ? HN_LINEAR_V : 0);
    HN_TRY(hn_dae_base_init(&s->base, sys, arena, diag));
    s->stabilised = stabilised;
    hn_status status = hn_linear_create(sys, rest, arena, &s->rest);
    HN_THEN(status, hn_linear_create(sys, matrices, arena, &s->matrices));
    HN_THEN(status, allocate(s, arena));
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL,
                                         "the linearised equations cannot be set up: %s",
                                         hn_status_text(status));
}

void hn_newmark_destroy(hn_newmark *s) {
    hn_newton_matrix_free(s->matrix);
    s->matrix = NULL;
    hn_linear_free(s->rest);
    hn_linear_free(s->matrices);
    s->rest = s->matrices = NULL;
    hn_dae_base_destroy(&s->base);
}

// P = M0^-1 J0' on the chosen rows, a row of nv for each
static hn_status prepare_stabiliser(hn_newmark *s) {
    const hn_dae_base *b = &s->base;
    const size_t nv = (size_t)b->nv;
    memcpy(s->factor, b->M, nv * nv * sizeof *s->factor);
    const hn_status status = hn_cholesky(b->nv, s->factor, b->nv, 0);
    for (int k = 0; k < b->nr && status == HN_OK; k++) {
        double *row = s->P + (size_t)k * nv;
        memcpy(row, b->J + (size_t)b->rows[k] * nv, nv * sizeof *row);
        hn_cholesky_solve(b->nv, s->factor, b->nv, row);
    }
    return status;
}

// M0^-1 J0' eta where it is no unknown of its own
static void push(hn_newmark *s) {
    const int nv = s->base.nv;
    memset(s->pushed, 0, (size_t)nv * sizeof *s->pushed);
    for (int k = 0; k < s->base.nr; k++) {
        hn_axpy(nv, s->eta[k], s->P + (size_t)k * nv, s->pushed);
    }
    s->base.cost.ops += 2.0 * nv * s->base.nr;
}

// (1), (2) and e from D and eta; q1 and v1
static void move_state(hn_newmark *s, double h, const double *y, double *q1) {
    const hn_dae_base *b = &s->base;
    const double *v0 = y + b->nq, scale = s->beta * h * h;
    if (s->stabilised && !is_extended(s)) {
        push(s);
    }
    for (int i = 0; i < b->nv; i++) {
        double left = s->D[i] - h * v0[i] - h * h * (0.5 - s->beta) * s->a0[i];
        left -= s->stabilised ? s->pushed[i] : 0;
        s->a1[i] = left / scale;
        s->v1[i] = v0[i] + h * ((1 - s->gamma) * s->a0[i] + s->gamma * s->a1[i]);
        s->e[i] = s->weight * s->a1[i] + s->past[i];
    }
    memcpy(q1, y, (size_t)b->nq * sizeof *q1);
    hn_system_move(b->sys, q1, s->D);
    memset(s->lambda, 0, (size_t)b->nc * sizeof *s->lambda);
    for (int k = 0; k < b->nr; k++) {
        s->lambda[b->rows[k]] = s->scaled[k] / scale;
    }
}

// x = minus what (3) and (4) leave, scaled as the matrix is
static void find_residual(hn_newmark *s, double t1, double h, const double *q1) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv, nr = b->nr, last = nv + nr + (is_extended(s) ? nv : 0);
    memset(s->x, 0, 2 * (size_t)(nv + nr) * sizeof *s->x);
    hn_linear_run(s->rest, t1, q1, s->v1, s->e, s->lambda);
    b->cost.evals++;
    const double *R = hn_linear_get(s->rest, HN_LINEAR_RESIDUAL);
    const double *phi = hn_linear_get(s->rest, HN_LINEAR_PHI);
    const double *gap = hn_linear_get(s->rest, HN_LINEAR_SPEED_GAP);
    for (int i = 0; i < nv; i++) {
        s->x[i] = -s->beta * h * h * (R[i] + s->carry[i]);
    }
    for (int k = 0; k < nr; k++) {
        s->x[nv + k] = -phi[b->rows[k]];
        if (s->stabilised) {
            s->x[last + k] = phi[b->rows[k]] - s->beta * h / s->gamma * gap[b->rows[k]];
        }
    }
}

// w times a term with its first entry at (row, col); of J and V the chosen rows
static void put_term(hn_newmark *s, hn_linear_term term, double w, int row, int col) {
    const hn_dae_base *b = &s->base;
    const int of_rows = term == HN_LINEAR_J || term == HN_LINEAR_V;
    const double *values = hn_linear_get(s->matrices, term);
    const int *rows, *cols, n = hn_linear_pattern(s->matrices, term, &rows, &cols);
    for (int k = 0; k < n; k++) {
        const int i = of_rows ? b->place[rows[k]] : rows[k];
        if (i >= 0) {
            hn_newton_matrix_put(s->matrix, row + i, col + cols[k],
                                 w * values[(size_t)rows[k] * b->nv + cols[k]], 0);
        }
    }
}

// Columns D, beta h^2 lambda, eta:
//
//     A0 + beta h^2 K          -J'    -A0 P          A0 = weight M + gamma h C
//     J                         0      0
//     (beta h / gamma) V        0     -J P           the row of speeds less the row of positions
//
// and of large mechanisms, with p = P eta between them,
//
//     A0 + beta h^2 K          -J'    -A0    .
//     J                         .      .     .
//     .                         .      M0   -J0'
//     (beta h / gamma) V        .     -J     .
static void put_motion(hn_newmark *s, double h) {
    const int nv = s->base.nv;
    put_term(s, HN_LINEAR_M, s->weight, 0, 0);
    put_term(s, HN_LINEAR_C, s->gamma * h, 0, 0);
    put_term(s, HN_LINEAR_K, s->beta * h * h, 0, 0);
    const double *J = hn_linear_get(s->matrices, HN_LINEAR_J);
    hn_dae_put_columns(&s->base, s->matrix, J, -1, 0, nv);
    hn_dae_put_rows(&s->base, s->matrix, J, 1, nv, 0);
}

static void put_extended(hn_newmark *s, double h) {
    const hn_dae_base *b = &s->base;
    const int nv = b->nv, n = nv + b->nr;
    const double *J = hn_linear_get(s->matrices, HN_LINEAR_J);
    put_term(s, HN_LINEAR_M, -s->weight, 0, n);
    put_term(s, HN_LINEAR_C, -s->gamma * h, 0, n);
    hn_dae_put_mass(b, s->matrix, 1, n, n);
    hn_dae_put_columns(b, s->matrix, b->J, -1, n, n + nv);
    put_term(s, HN_LINEAR_V, s->beta * h / s->gamma, n + nv, 0);
    hn_dae_put_rows(b, s->matrix, J, -1, n + nv, n);
}

static void put_stabiliser(hn_newmark *s, double h) {
    const hn_dae_base *b = &s->base;
    const int nv = b->nv, nr = b->nr;
    const double *J = hn_linear_get(s->matrices, HN_LINEAR_J);
    const double *M = hn_linear_get(s->matrices, HN_LINEAR_M);
    const double *C = hn_linear_get(s->matrices, HN_LINEAR_C);

    // the derivative of the equilibrium with respect to velocities
    for (int i = 0; i < nv * nv; i++) {
        s->factor[i] = s->weight * M[i] + s->gamma * h * C[i];
    }

    // columns of eta: the push M0^-1 J0' eta moves positions and velocities
    put_term(s, HN_LINEAR_V, s->beta * h / s->gamma, nv + nr, 0);
    for (int k = 0; k < nr; k++) {
        const double *P = s->P + (size_t)k * nv;
        for (int i = 0; i < nv; i++) {
            hn_newton_matrix_put(s->matrix, i, nv + nr + k,
                                 -hn_dot(nv, s->factor + (size_t)i * nv, P), 0);
        }
        for (int i = 0; i < nr; i++) {
            hn_newton_matrix_put(s->matrix, nv + nr + i, nv + nr + k,
                                 -hn_dot(nv, J + (size_t)b->rows[i] * nv, P), 0);
        }
    }
    s->base.cost.ops += 2.0 * nr * nv * (nv + nr);
}

static hn_status factor_newton(hn_newmark *s, double t1, double h, const double *q1) {
    hn_dae_base *b = &s->base;
    const int n = b->nv + b->nr;
    hn_linear_run(s->matrices, t1, q1, s->v1, s->e, s->lambda);
    hn_newton_matrix_begin(s->matrix, is_extended(s) ? 2 * n : n + (s->stabilised ? b->nr : 0));
    put_motion(s, h);
    if (is_extended(s)) {
        put_extended(s, h);
    } else if (s->stabilised) {
        put_stabiliser(s, h);
    }
    b->cost.factorisations++;
    return hn_newton_matrix_factor(s->matrix);
}

static void correct(hn_newmark *s) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv, nr = b->nr;
    hn_newton_matrix_solve(s->matrix, s->x);
    hn_axpy(nv, 1, s->x, s->D);
    hn_axpy(nr, 1, s->x + nv, s->scaled);
    if (is_extended(s)) {
        hn_axpy(nv, 1, s->x + nv + nr, s->pushed);
    } else if (s->stabilised) {
        hn_axpy(nr, 1, s->x + nv + nr, s->eta);
    }
    b->cost.newton++;
    b->cost.solves++;
}

static hn_status iterate(hn_newmark *s, double t, double h, const double *y, double *q1) {
    hn_newton newton = {0};
    for (;;) {
        move_state(s, h, y, q1);
        find_residual(s, t + h, h, q1);

        // a new factor only where the old one no longer contracts
        if (newton.iterations == 0 || newton.contraction > KEEP_FACTOR_BELOW) {
            const hn_status status = factor_newton(s, t + h, h, q1);
            if (status != HN_OK) {
                return status;
            }
        }

        // D, eta and the multipliers move together
        correct(s);
        const hn_newton_verdict verdict =
            hn_newton_look(&newton, hn_dae_newton_size(&s->base, s->x, s->D, y));
        if (verdict == HN_NEWTON_DIVERGES) {
            return HN_ERR_NO_CONVERGENCE;
        }
        if (verdict == HN_NEWTON_DONE) {
            move_state(s, h, y, q1);
            return HN_OK;
        }
    }
}

hn_status hn_newmark_step(hn_newmark *s, double t, double h, const double *y, double *y_new) {
    hn_dae_base *b = &s->base;
    const double *v0 = y + b->nq;
    hn_dae_dynamics(b, t, y, v0);
    hn_dae_loops(b, t, y);
    hn_dae_choose_rows(b);
    memset(s->pushed, 0, (size_t)b->nv * sizeof *s->pushed);
    if (s->stabilised && !is_extended(s) && prepare_stabiliser(s) != HN_OK) {
        hn_dae_tell_massless(b->sys, b->M, b->nv + 1, t, b->why, sizeof b->why);
        return HN_ERR_MASS;
    }

    // predictor: constant acceleration, and the multipliers of the last step
    for (int i = 0; i < b->nv; i++) {
        s->D[i] = h * v0[i] + h * h / 2 * s->a0[i];
    }
    for (int k = 0; k < b->nr; k++) {
        s->scaled[k] = s->beta * h * h * s->guess[b->rows[k]];
        s->eta[k] = 0;
    }

    // corrector
    const hn_status status = iterate(s, t, h, y, y_new);
    memcpy(y_new + b->nq, s->v1, (size_t)b->nv * sizeof *y_new);
    return status == HN_OK ? HN_OK : hn_dae_fail(b, status, t + h, "the step");
}

void hn_newmark_add_cost(const void *self, hn_cost *cost) {
    const hn_newmark *s = self;
    hn_dae_base_add_cost(&s->base, cost);
    cost->ops += (double)hn_linear_count(s->rest) * hn_linear_ops(s->rest) +
                 (double)hn_linear_count(s->matrices) * hn_linear_ops(s->matrices) +
                 hn_newton_matrix_ops(s->matrix);
}

const char *hn_newmark_why(const void *self) {
    const hn_newmark *s = self;
    return hn_dae_base_why(&s->base);
}
