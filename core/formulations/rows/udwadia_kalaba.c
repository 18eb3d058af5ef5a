// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/pivot_noise.h"
#include "formulations/ground/dense_ode.h"
#include "formulations/ground/flops.h"
#include "formulations/ground/formulation.h"
#include "linalg/dense.h"
#include "linalg/qr.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// M = L L',   a = a_u + L^-T (J L^-T)^+ (-gamma - J a_u),   M a_u = f
// (1)
//
// The pseudo-inverse by complete orthogonal decomposition: L^-1 J' P = Q [R; 0] with pivoting, rows
// of J scaled to unit length in that metric, then R' z = P' b in least squares where rows were
// dropped, and x = Q z. Rows that depend on others need no care; contradicting ones are met in the
// least-squares sense. If the loops stand open, rows that depend on others on the closed set
// part by about the gap: the tolerance that decides the rank grows with it
// (dynamics/evaluate/pivot_noise.h).
//
// If M is singular there is no a_u; then, with J^+ J the projector on the rows of J (Udwadia &
// Phohomsiri 2006),
//
//     [(I - J^+ J) M; J] a = [(I - J^+ J) f; -gamma]   in least squares                       (2)
//
// which has one solution when no direction is both massless and free.

#define RANK_TOL 1e-10
#define MASS_TOL 1e-13 // of a Cholesky pivot of M with unit diagonal
#define STACK_TOL 1e-12

typedef struct udwadia_kalaba {
    hn_dense_ode ode;            // first: see dense_ode.h
    double *L, *scale;           // nv x nv, nv: D M D = L L' with unit diagonal
    hn_qr rows;                  // nv x nc: the constraint's directions
    hn_qr kept;                  // nc x min(nv, nc): R', when rows were dropped
    hn_qr stack;                 // (nv + nc) x nv: eq. (2)
    double *row_scale, *b, *x;   // nc, nc, max(nv, nc)
    double *stack_scale, *right; // nv, nv + nc
    double *size;                // nc
    double rank_tol;             // at this state
    double mass_scale;           // 1 / largest diagonal entry of M, in eq. (2)
} udwadia_kalaba;

// ---- eq. (1) ----

// L and the scale; 0 where M is singular
static bool factor_mass(udwadia_kalaba *u) {
    const int nv = u->ode.base.nv;
    for (int i = 0; i < nv; i++) {
        const double m = u->ode.M[(size_t)i * nv + i];
        if (!(m > 0)) {
            return false;
        }
        u->scale[i] = 1 / sqrt(m);
    }
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j <= i; j++) {
            u->L[(size_t)i * nv + j] = u->ode.M[(size_t)i * nv + j] * u->scale[i] * u->scale[j];
        }
    }
    u->ode.base.cost.factorisations++;
    u->ode.base.cost.ops += hn_flops_cholesky(nv);
    return hn_cholesky(nv, u->L, nv, MASS_TOL) == HN_OK;
}

// scales the columns of u->rows to unit length and factors them; short ones only as far as they are
// more than blur
static void factor_rows(udwadia_kalaba *u) {
    const int nv = u->ode.base.nv, nc = u->ode.base.nc;
    double longest = 0;
    for (int k = 0; k < nc; k++) {
        u->size[k] = hn_norm2(nv, u->rows.a + (size_t)k * nv);
        longest = fmax(longest, u->size[k]);
    }
    const double least = u->rank_tol > RANK_TOL ? HN_PIVOT_NOISE_ROW_FLOOR * longest : 0;
    for (int k = 0; k < nc; k++) {
        double *column = u->rows.a + (size_t)k * nv;
        const double size = fmax(u->size[k], least);
        u->row_scale[k] = size > 0 ? 1 / size : 0;
        for (int j = 0; j < nv; j++) {
            column[j] *= u->row_scale[k];
        }
    }
    hn_qr_factor(&u->rows, nv, nc, u->rank_tol);
    u->ode.base.cost.factorisations++;
    u->ode.base.cost.ops += hn_flops_qr(nv, nc);
}

// x (nv) = (A')^+ b with A in u->rows
static void apply_pseudo_inverse(udwadia_kalaba *u, const double *b, double *x) {
    hn_qr *rows = &u->rows, *kept = &u->kept;
    const int nc = u->ode.base.nc, rank = rows->rank;
    u->ode.base.cost.ops += hn_flops_qr_solve(u->ode.base.nv, rank);
    if (rank == nc) {
        hn_qr_least_norm(rows, b, x);
        return;
    }

    // rows were dropped: R' z = P' b in least squares
    for (int i = 0; i < rank; i++) {
        for (int k = 0; k < nc; k++) {
            kept->a[(size_t)i * nc + k] = k >= i ? rows->a[(size_t)k * rows->m + i] : 0;
        }
    }
    hn_qr_factor(kept, nc, rank, 0);
    for (int k = 0; k < nc; k++) {
        u->right[k] = b[rows->perm[k]];
    }
    hn_qr_apply_qt(kept, u->right);
    hn_qr_solve_r(kept, u->right);

    // x = Q z
    memset(x, 0, (size_t)u->ode.base.nv * sizeof *x);
    for (int i = 0; i < kept->rank; i++) {
        x[kept->perm[i]] = u->right[i];
    }
    hn_qr_apply_q(rows, x);
    u->ode.base.cost.ops += hn_flops_qr(nc, rank) + hn_flops_qr_solve(nc, rank);
}

static void correct_free_motion(udwadia_kalaba *u, double *a) {
    const int nv = u->ode.base.nv, nc = u->ode.base.nc;

    // the free acceleration M^-1 f
    for (int i = 0; i < nv; i++) {
        a[i] = u->scale[i] * u->ode.f[i];
    }
    hn_cholesky_solve(nv, u->L, nv, a);
    for (int i = 0; i < nv; i++) {
        a[i] *= u->scale[i];
    }

    // L^-1 J', factored
    for (int k = 0; k < nc; k++) {
        for (int j = 0; j < nv; j++) {
            u->rows.a[(size_t)k * nv + j] = u->scale[j] * u->ode.J[(size_t)k * nv + j];
        }
        hn_lower_solve(nv, u->L, nv, u->rows.a + (size_t)k * nv);
    }
    factor_rows(u);

    // the correction that meets the constraints
    for (int k = 0; k < nc; k++) {
        u->b[k] = -u->row_scale[k] * (u->ode.gamma[k] + hn_dot(nv, u->ode.J + (size_t)k * nv, a));
    }
    apply_pseudo_inverse(u, u->b, u->x);
    hn_lower_t_solve(nv, u->L, nv, u->x);
    for (int i = 0; i < nv; i++) {
        a[i] += u->scale[i] * u->x[i];
    }

    u->ode.base.cost.solves++;
    u->ode.base.cost.ops +=
        hn_flops_cholesky_solve(nv) * (1.5 + 0.5 * nc) + 2 * hn_flops_product(nc, nv, 1);
}

// ---- eq. (2) ----

// columns of [(I - J^+ J) M; J] into u->stack at unit length; the index of an empty one, or -1
static int fill_stack(udwadia_kalaba *u) {
    const int nv = u->ode.base.nv, nc = u->ode.base.nc;

    // masses in units of the largest
    double heaviest = 0;
    for (int i = 0; i < nv; i++) {
        heaviest = fmax(heaviest, u->ode.M[(size_t)i * nv + i]);
    }
    u->mass_scale = heaviest > 0 ? 1 / heaviest : 1;

    // J^+ by the factor of J
    memcpy(u->rows.a, u->ode.J, (size_t)nv * (size_t)nc * sizeof *u->rows.a);
    factor_rows(u);

    // columns of (2) at unit length
    for (int j = 0; j < nv; j++) {
        double *column = u->stack.a + (size_t)j * (nv + nc);
        for (int i = 0; i < nv; i++) {
            const int row = i >= j ? i : j, other = i >= j ? j : i;
            column[i] = u->mass_scale * u->ode.M[(size_t)row * nv + other];
        }
        hn_qr_remove_range(&u->rows, column);
        for (int k = 0; k < nc; k++) {
            column[nv + k] = u->row_scale[k] * u->ode.J[(size_t)k * nv + j];
        }
        const double size = hn_norm2(nv + nc, column);
        if (!(size > 0)) {
            return j;
        }
        u->stack_scale[j] = 1 / size;
        for (int i = 0; i < nv + nc; i++) {
            column[i] *= u->stack_scale[j];
        }
    }
    return -1;
}

static hn_status no_mass(udwadia_kalaba *u, int coordinate, double t) {
    snprintf(u->ode.base.why, sizeof u->ode.base.why,
             "at t = %.6g s %s can move without moving a mass, and no constraint prevents it", t,
             hn_dense_ode_name(&u->ode, coordinate));
    return HN_ERR_SINGULAR;
}

static hn_status solve_stack(udwadia_kalaba *u, double t, double *a) {
    const int nv = u->ode.base.nv, nc = u->ode.base.nc, empty = fill_stack(u);
    if (empty >= 0) {
        return no_mass(u, empty, t);
    }

    // right side of (2)
    for (int i = 0; i < nv; i++) {
        u->right[i] = u->mass_scale * u->ode.f[i];
    }
    hn_qr_remove_range(&u->rows, u->right);
    for (int k = 0; k < nc; k++) {
        u->right[nv + k] = -u->row_scale[k] * u->ode.gamma[k];
    }

    // least squares, which must have one solution
    hn_qr_factor(&u->stack, nv + nc, nv, STACK_TOL);
    if (u->stack.rank < nv) {
        return no_mass(u, u->stack.perm[u->stack.rank], t);
    }

    hn_qr_apply_qt(&u->stack, u->right);
    hn_qr_solve_r(&u->stack, u->right);
    for (int i = 0; i < nv; i++) {
        const int j = u->stack.perm[i];
        a[j] = u->stack_scale[j] * u->right[i];
    }

    u->ode.base.cost.fallbacks++;
    u->ode.base.cost.factorisations++;
    u->ode.base.cost.solves++;
    u->ode.base.cost.ops += hn_flops_qr(nv + nc, nv) + hn_flops_qr_solve(nv + nc, nv) +
                            (nv + 1) * hn_flops_qr_solve(nv, nc) * 2;
    return HN_OK;
}

static hn_status accelerate(void *self, double t, const double *v, double *a) {
    udwadia_kalaba *u = self;
    u->rank_tol = fmax(RANK_TOL, hn_dense_ode_blur(&u->ode, v, u->b, u->size));
    if (!factor_mass(u)) {
        return solve_stack(u, t, a);
    }
    correct_free_motion(u, a);
    return HN_OK;
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)options;
    udwadia_kalaba *u = hn_arena_get(arena, sizeof *u);
    if (!u) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = u;
    u->ode.accelerate = accelerate;
    HN_TRY(hn_dense_ode_init(&u->ode, sys, 1, arena, diag));

    const int nv = u->ode.base.nv, nc = u->ode.base.nc, small = nv < nc ? nv : nc, big = nv + nc;
    // factors, scales and the right sides of (1) and (2)
    u->L = hn_arena_doubles(arena, (size_t)nv * (size_t)nv);
    u->scale = hn_arena_doubles(arena, (size_t)nv);
    u->row_scale = hn_arena_doubles(arena, (size_t)nc);
    u->b = hn_arena_doubles(arena, (size_t)nc);
    u->size = hn_arena_doubles(arena, (size_t)nc);
    u->x = hn_arena_doubles(arena, (size_t)big);
    u->stack_scale = hn_arena_doubles(arena, (size_t)nv);
    u->right = hn_arena_doubles(arena, (size_t)big);

    if (!hn_qr_init(&u->rows, arena, nv, nc) || !hn_qr_init(&u->kept, arena, nc, small) ||
        !hn_qr_init(&u->stack, arena, big, nv) || hn_arena_failed(arena)) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return HN_OK;
}

const hn_formulation hn_formulation_udwadia_kalaba = {
    .name = "udwadia-kalaba",
    .title = "Udwadia-Kalaba",
    .short_name = "Udwadia-Kalaba",
    .rule = "Let every body move as if free, then add the smallest correction, measured by "
            "the mass matrix, that meets the constraints: one formula with a "
            "pseudo-inverse, no multipliers.",
    .drift = "as index-1: the velocity violation grows like h^p t, the gap like h^p t^2",
    .when = "redundant constraints, a start at a singular configuration, massless links",
    .when_not = "long runs (nothing closes the gap); large mechanisms (dense, cost grows with "
                "the cube of the size); near a singular configuration, where the rank "
                "tolerance decides",
    .source = "Udwadia & Kalaba 1992; Udwadia & Phohomsiri 2006",
    .needs = "M f phi J gamma",
    .index = 1,
    .traits = HN_TRAIT_NEEDS_MASS_INVERSE,
    .create = create,
    .destroy = hn_dense_ode_destroy,
    .ode = hn_dense_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .add_cost = hn_dense_ode_add_cost,
    .why = hn_state_ode_why,
};
