// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/tangent_space.h"

#include "dynamics/compile/coordinates.h"
#include "formulations/ground/flops.h"
#include "formulations/ground/unit_scales.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NEWTON = 25 };
#define RANK_TOL 1e-10  // of the largest pivot of W^1/2 J'
#define PIVOT_TOL 1e-13 // J Y0 is singular to rounding
// smallest pivot of J Y0, of the one at the base: the tangent space has turned by a right angle
#define TURNED 1e-3

static bool init_memory(hn_tspace *ts, hn_arena *arena) {
    const size_t nq = (size_t)ts->nq, nv = (size_t)ts->nv, nc = (size_t)ts->nc;
    const int ok = hn_qr_init(&ts->base_qr, arena, ts->nv, ts->nc) &&
                   hn_qr_init(&ts->jy, arena, ts->nc, ts->nv);

    // the base
    ts->q0 = hn_arena_doubles(arena, nq);
    ts->q = hn_arena_doubles(arena, nq);
    ts->scale = hn_arena_doubles(arena, nv);
    ts->new_scale = hn_arena_doubles(arena, nv);
    ts->N0 = hn_arena_doubles(arena, nv * nv);
    ts->Y0 = hn_arena_doubles(arena, nv * nv);

    // where the bases were last taken
    ts->N = hn_arena_doubles(arena, nv * nv);
    ts->s = hn_arena_doubles(arena, nv);
    ts->JN = hn_arena_doubles(arena, nc * nv);
    ts->X = hn_arena_doubles(arena, nv * nv);

    // scratch
    ts->b = hn_arena_doubles(arena, nv + nc);
    ts->x = hn_arena_doubles(arena, nv + nc);
    ts->c = hn_arena_doubles(arena, nv);
    ts->force = hn_arena_doubles(arena, nv);
    ts->MN = hn_arena_doubles(arena, nv * nv);
    ts->A = hn_arena_doubles(arena, nv * nv);
    return ok && !hn_arena_failed(arena);
}

hn_status hn_tspace_init(hn_tspace *ts, const hn_system *sys, hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    memset(ts, 0, sizeof *ts);
    ts->sys = sys;
    ts->nq = info.nq;
    ts->nv = info.nv;
    ts->nc = info.nc;
    ts->rank = ts->r = -1;
    ts->length = hn_system_length(sys);

    // evaluators
    hn_status status =
        hn_eval_create(sys, HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J, arena, &ts->loop);
    HN_THEN(status, hn_eval_create(sys, HN_TERM_M | HN_TERM_F | HN_TERM_GAMMA, arena, &ts->full));
    HN_THEN(status, hn_eval_create(sys, HN_TERM_M, arena, &ts->mass));

    // patterns and memory
    if (status == HN_OK) {
        ts->M_at.nv = ts->nv;
        ts->M_at.n = hn_eval_pattern(ts->full, HN_TERM_M, &ts->M_at.row, &ts->M_at.col);
        ts->n_J = hn_eval_pattern(ts->loop, HN_TERM_J, &ts->J_row, &ts->J_col);
        status = init_memory(ts, arena) ? HN_OK : HN_ERR_MEMORY;
    }
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
}

void hn_tspace_destroy(hn_tspace *ts) {
    hn_eval_free(ts->loop);
    hn_eval_free(ts->full);
    hn_eval_free(ts->mass);
    ts->loop = ts->full = ts->mass = NULL;
}

static hn_status fail(hn_tspace *ts, hn_status status, double t, const char *what) {
    snprintf(ts->why, sizeof ts->why, "at t = %.6g s: %s", t, what);
    return status;
}

static double smallest_pivot(const hn_qr *qr) {
    double smallest = HUGE_VAL;
    for (int k = 0; k < qr->rank; k++) {
        smallest = fmin(smallest, fabs(qr->a[k * qr->m + k]));
    }
    return smallest;
}

// ---- the base ----

static void measure(hn_tspace *ts, double t, const double *q) {
    hn_eval_run(ts->mass, t, q, NULL);
    hn_unit_scales(ts->sys, hn_eval_get(ts->mass, HN_TERM_M), ts->nv + 1, ts->new_scale);
}

// QR of W^1/2 J' at (t, q)
static void factor_rows(hn_tspace *ts, double t, const double *q) {
    const size_t nv = (size_t)ts->nv;
    hn_eval_run(ts->loop, t, q, NULL);
    const double *J = hn_eval_get(ts->loop, HN_TERM_J);
    memset(ts->base_qr.a, 0, nv * (size_t)ts->nc * sizeof(double));
    for (int e = 0; e < ts->n_J; e++) {
        const size_t i = (size_t)ts->J_row[e], j = (size_t)ts->J_col[e];
        ts->base_qr.a[i * nv + j] = J[i * nv + j] * ts->new_scale[j];
    }
    hn_qr_factor(&ts->base_qr, ts->nv, ts->nc, RANK_TOL);
    ts->cost.factorisations++;
    ts->cost.ops += hn_flops_qr(ts->nv, ts->nc);
}

// columns from .. from + n of W^1/2 Q into B (nv x n)
static void take_columns(hn_tspace *ts, int from, int n, double *B) {
    const int nv = ts->nv;
    double *e = ts->b;
    for (int k = 0; k < n; k++) {
        memset(e, 0, (size_t)nv * sizeof *e);
        e[from + k] = 1;
        hn_qr_apply_q(&ts->base_qr, e);
        for (int i = 0; i < nv; i++) {
            B[i * n + k] = ts->scale[i] * e[i];
        }
    }
    ts->cost.ops += 4.0 * nv * ts->rank * n;
}

// N0 = N L^-T with L L' = N' W^-1 N, which differs from I by the square of the angle turned through
// since the last base
static bool carry_basis(hn_tspace *ts) {
    const int nv = ts->nv, r = ts->r;
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < r; j++) {
            ts->MN[i * r + j] = ts->N[i * r + j] / (ts->scale[i] * ts->scale[i]);
        }
    }
    hn_mass_project(nv, r, ts->N, ts->MN, ts->A);
    ts->cost.ops += 2.0 * nv * r * r;
    if (hn_cholesky(r, ts->A, r, 0) != HN_OK) {
        return false;
    }
    memcpy(ts->N0, ts->N, (size_t)nv * (size_t)r * sizeof(double));
    for (int i = 0; i < nv; i++) {
        hn_lower_solve(r, ts->A, r, ts->N0 + i * r);
    }
    return true;
}

bool hn_tspace_base_is_at(const hn_tspace *ts, double t, const double *q) {
    return ts->has_base && ts->t0 == t && memcmp(ts->q0, q, (size_t)ts->nq * sizeof *q) == 0;
}

static bool is_at(const hn_tspace *ts, double t, const double *q) {
    return ts->valid && ts->t == t && memcmp(ts->q, q, (size_t)ts->nq * sizeof *q) == 0;
}

hn_status hn_tspace_set_base(hn_tspace *ts, double t, const double *q, hn_tspace_basis basis) {
    if (!hn_all_finite(ts->nq, q)) {
        return fail(ts, HN_ERR_DIVERGED, t, "the state is not finite");
    }
    const int carried = basis == HN_TSPACE_CARRIED && is_at(ts, t, q);

    // directions across the constraints: QR of W^1/2 J'
    measure(ts, t, q);
    factor_rows(ts, t, q);
    if (ts->rank >= 0 && ts->base_qr.rank != ts->rank) {
        return fail(ts, HN_ERR_CHART, t,
                    "the number of degrees of freedom changed: the configuration is singular");
    }

    ts->rank = ts->base_qr.rank;
    ts->r = ts->nv - ts->rank;

    // N0 is carried from the last base or taken from the factor
    memcpy(ts->scale, ts->new_scale, (size_t)ts->nv * sizeof(double));
    take_columns(ts, 0, ts->rank, ts->Y0);
    if (!carried || !carry_basis(ts)) {
        take_columns(ts, ts->rank, ts->r, ts->N0);
    }

    // the base, and its pivot as a measure for steps from here
    memmove(ts->q0, q, (size_t)ts->nq * sizeof *q);
    ts->t0 = t;
    ts->has_base = 1;
    ts->valid = 0;
    ts->pivot0 = 0;
    const hn_status status = hn_tspace_locate(ts, t, ts->q0);
    ts->pivot0 = smallest_pivot(&ts->jy);
    return status;
}

// ---- a place near it ----

static void eval_loop(hn_tspace *ts, double t) {
    hn_eval_run(ts->loop, t, ts->q, NULL);
    ts->gap = hn_norm2(ts->nc, hn_eval_get(ts->loop, HN_TERM_PHI));
    ts->t = t;
}

static hn_status factor(hn_tspace *ts) {
    const int nc = ts->nc, nv = ts->nv, rank = ts->rank;
    const double *J = hn_eval_get(ts->loop, HN_TERM_J);
    memset(ts->jy.a, 0, (size_t)nc * (size_t)rank * sizeof(double));
    for (int e = 0; e < ts->n_J; e++) {
        const int i = ts->J_row[e], j = ts->J_col[e];
        const double x = J[(size_t)i * (size_t)nv + (size_t)j];
        for (int k = 0; k < rank; k++) {
            ts->jy.a[k * nc + i] += x * ts->Y0[j * rank + k];
        }
    }
    hn_qr_factor(&ts->jy, nc, rank, PIVOT_TOL);
    ts->cost.factorisations++;
    ts->cost.ops += hn_flops_qr(nc, rank) + 2.0 * ts->n_J * rank;
    if (ts->jy.rank == rank && (rank == 0 || smallest_pivot(&ts->jy) > TURNED * ts->pivot0)) {
        return HN_OK;
    }
    return fail(ts, HN_ERR_CHART, ts->t,
                "the directions of free motion changed within the step: the configuration is "
                "singular, or the step is too long");
}

// x (rank) <- (J Y0)^-1 b, b (nc) spoiled
static void solve(hn_tspace *ts, double *b, double *x) {
    hn_qr_apply_qt(&ts->jy, b);
    hn_qr_solve_r(&ts->jy, b);
    for (int k = 0; k < ts->rank; k++) {
        x[ts->jy.perm[k]] = b[k];
    }
    ts->cost.solves++;
    ts->cost.ops += hn_flops_qr_solve(ts->nc, ts->rank);
}

// y (nv) <- -Y0 (J Y0)^-1 rhs
static void pull_back(hn_tspace *ts, const double *rhs, double *y) {
    memset(y, 0, (size_t)ts->nv * sizeof *y);
    if (ts->nc == 0 || hn_norm_max(ts->nc, rhs) == 0) {
        return;
    }
    memcpy(ts->b, rhs, (size_t)ts->nc * sizeof *rhs);
    solve(ts, ts->b, ts->x);
    for (int i = 0; i < ts->nv; i++) {
        y[i] = -hn_dot(ts->rank, ts->Y0 + i * ts->rank, ts->x);
    }
    ts->cost.ops += 2.0 * ts->nv * ts->rank;
}

static void make_basis(hn_tspace *ts) {
    const int nv = ts->nv, nc = ts->nc, rank = ts->rank, r = ts->r;
    const double *J = hn_eval_get(ts->loop, HN_TERM_J);

    // X = (J Y0)^-1 J N0
    memset(ts->JN, 0, (size_t)nc * (size_t)r * sizeof(double));
    for (int e = 0; e < ts->n_J; e++) {
        const size_t i = (size_t)ts->J_row[e], j = (size_t)ts->J_col[e];
        hn_axpy(r, J[i * (size_t)nv + j], ts->N0 + j * (size_t)r, ts->JN + i * (size_t)r);
    }
    for (int j = 0; j < r; j++) {
        for (int i = 0; i < nc; i++) {
            ts->b[i] = ts->JN[i * r + j];
        }
        solve(ts, ts->b, ts->x);
        for (int k = 0; k < rank; k++) {
            ts->X[k * r + j] = ts->x[k];
        }
    }

    // N = N0 - Y0 X
    memcpy(ts->N, ts->N0, (size_t)nv * (size_t)r * sizeof(double));
    for (int i = 0; i < nv; i++) {
        for (int k = 0; k < rank; k++) {
            hn_axpy(r, -ts->Y0[i * rank + k], ts->X + k * r, ts->N + i * r);
        }
    }

    ts->cost.ops += 2.0 * ts->n_J * r + hn_flops_product(nv, rank, r);
    pull_back(ts, hn_eval_get(ts->loop, HN_TERM_PHI_T), ts->s);
}

hn_status hn_tspace_locate(hn_tspace *ts, double t, const double *q) {
    if (is_at(ts, t, q)) {
        return HN_OK;
    }
    ts->valid = 0;
    memcpy(ts->q, q, (size_t)ts->nq * sizeof *q);
    if (!hn_all_finite(ts->nq, q)) {
        return fail(ts, HN_ERR_DIVERGED, t, "the state is not finite");
    }
    eval_loop(ts, t);
    HN_TRY(factor(ts));
    make_basis(ts);
    ts->valid = 1;
    return HN_OK;
}

hn_status hn_tspace_close(hn_tspace *ts, double t, const double *from, double *delta, double *q,
                          double tol) {
    double last = HUGE_VAL;
    ts->valid = 0;
    for (int turn = 0; turn < MAX_NEWTON; turn++) {
        // the position moved by the present displacement
        memcpy(ts->q, from, (size_t)ts->nq * sizeof *q);
        hn_system_move(ts->sys, ts->q, delta);
        eval_loop(ts, t);
        if (!isfinite(ts->gap)) {
            return fail(ts, HN_ERR_DIVERGED, t, "the loop gap is not finite");
        }
        const hn_status status = factor(ts);
        if (status != HN_OK) {
            return status;
        }

        // a gap that stopped falling at rounding level is as closed as it gets
        const int at_floor = ts->gap <= 1e-11 * ts->length && ts->gap >= 0.5 * last;
        if (ts->gap <= tol * ts->length || at_floor) {
            make_basis(ts);
            memcpy(q, ts->q, (size_t)ts->nq * sizeof *q);
            ts->valid = 1;
            return HN_OK;
        }

        // Newton's step across the constraints
        last = ts->gap;
        pull_back(ts, hn_eval_get(ts->loop, HN_TERM_PHI), ts->c);
        hn_axpy(ts->nv, 1, ts->c, delta);
        ts->cost.newton++;
    }
    return fail(ts, HN_ERR_CHART, t,
                "the loops cannot be closed near the end of the step: the step is too long");
}

// ---- speeds and accelerations ----

void hn_tspace_speeds(const hn_tspace *ts, const double *u, double *v) {
    for (int i = 0; i < ts->nv; i++) {
        v[i] = ts->s[i] + hn_dot(ts->r, ts->N + i * ts->r, u);
    }
}

void hn_tspace_coordinates(const hn_tspace *ts, const double *v, double *u) {
    memset(u, 0, (size_t)ts->r * sizeof *u);
    for (int i = 0; i < ts->nv; i++) {
        hn_axpy(ts->r, v[i] / (ts->scale[i] * ts->scale[i]), ts->N0 + i * ts->r, u);
    }
}

hn_status hn_tspace_accel(hn_tspace *ts, const double *v, double *u_dot) {
    const int nv = ts->nv, r = ts->r;
    HN_ASSERT(ts->valid);

    // force left after the rate of the basis: N' (f - M c)
    hn_eval_run(ts->full, ts->t, ts->q, v);
    const double *M = hn_eval_get(ts->full, HN_TERM_M), *f = hn_eval_get(ts->full, HN_TERM_F);
    pull_back(ts, hn_eval_get(ts->full, HN_TERM_GAMMA), ts->c);
    hn_mass_multiply(&ts->M_at, M, ts->c, 1, ts->force);
    for (int i = 0; i < nv; i++) {
        ts->force[i] = f[i] - ts->force[i];
    }

    // N' M N u' = N' (f - M c)
    hn_mass_multiply(&ts->M_at, M, ts->N, r, ts->MN);
    hn_mass_project(nv, r, ts->N, ts->MN, ts->A);
    hn_mat_t_vec(nv, r, ts->N, ts->force, u_dot);

    // the reduced mass matrix must be positive
    double largest = 0;
    for (int i = 0; i < r; i++) {
        largest = fmax(largest, fabs(ts->A[i * r + i]));
    }
    ts->cost.factorisations++;
    ts->cost.ops += hn_mass_project_ops(&ts->M_at, r) + 4.0 * ts->M_at.n +
                    hn_flops_product(r, nv, 1) + hn_flops_cholesky(r) + hn_flops_cholesky_solve(r);
    const hn_status status = hn_cholesky(r, ts->A, r, 1e-14 * largest);
    if (status != HN_OK || !isfinite(largest)) {
        return fail(ts, isfinite(largest) ? status : HN_ERR_DIVERGED, ts->t,
                    "the reduced mass matrix is not positive definite");
    }
    hn_cholesky_solve(r, ts->A, r, u_dot);
    return hn_all_finite(r, u_dot)
               ? HN_OK
               : fail(ts, HN_ERR_DIVERGED, ts->t, "the acceleration is not finite");
}

void hn_tspace_add_cost(const hn_tspace *ts, hn_cost *cost) {
    hn_cost_add(cost, &ts->cost);
    const hn_eval *const evals[] = {ts->loop, ts->full, ts->mass};
    for (int i = 0; i < 3; i++) {
        cost->ops += (double)hn_eval_count(evals[i]) * hn_eval_info(evals[i]).ops;
    }
}
