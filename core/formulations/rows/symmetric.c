// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/accel_ode.h"
#include "formulations/ground/flops.h"
#include "formulations/ground/formulation.h"
#include "formulations/ground/unit_scales.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// With N = M^-1 J' for positions and speeds alike, and Psi one step of the integrator on the
// index-1 equations,
//
//  q^ = q0 + N0 mu, v^ = v0 + N0 nu; (q*, v*) = Psi(q^, v^); q1 = q* + N1 mu, v1 = v* + N1 nu (1)
//  phi(q1) = 0,  J1 v1 + phi_t = 0                                                         (2)
//
// The same mu and nu push off the manifold and back on: with a symmetric Psi the whole step is
// symmetric, which the usual projection is not, and the energy of a motion that runs back on its
// way stays bounded. That of a crank that turns one way round need not: there it grows like t h^p.
// mu and nu by Broyden's method from 2 S0, S = J M^-1 J'; each turn costs a step of Psi. Source:
// Hairer 2000; Hairer, Lubich & Wanner 2006, section V.4.1; Faou, Hairer & Pham 2004 (energy);
// Kelley 1995, section 7.3 (Broyden's method from its steps alone).

enum { MAX_TURNS = 40, KEPT_TURNS = 10 };
static const double ROUNDING = 4 * DBL_EPSILON; // of coordinates and speeds: as far as (2) is met
static const double COARSE = 1e3;               // times that, where it gets no better
// a direction in which J is weaker cannot be trusted to close anything, and a row that is short at
// this pose is mostly rounding if stretched: pushed along either, the step starts somewhere else
static const double RANK_TOL = 1e-7;
static const double ROW_FLOOR = 0.05;
static const double LEAST_PIVOT = 0.1; // of Broyden's method: a smaller one would take a leap

typedef struct symmetric {
    hn_accel_ode ode; // first
    hn_eval *terms;   // M, J, phi, phi_t
    const double *M, *J, *phi, *phi_t;
    hn_saddle_ws *saddle;
    double length;
    double *mu, *nu, *rate, *x;                  // nc
    double *steps[KEPT_TURNS + 1];               // 2 nc: of (mu, h nu), in the last turns
    double *N0_mu, *N0_nu, *N1_mu, *push, *zero; // nv
    double *L, *L0, *J0; // nv x nv, nv x nv, nc x nv: factors of M here and at the start, J there
    double *unit;        // nv: see unit_scales.h
    double *start, *q1;  // nq + nv; nq
} symmetric;

static hn_status fail_memory(hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)options;
    symmetric *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return fail_memory(diag);
    }
    *self = s;
    hn_status status = hn_accel_ode_init(&s->ode, sys, 0, HN_SOLVER_AUTO, arena, diag);
    if (status != HN_OK) {
        return status;
    }

    // terms of (2)
    status =
        hn_eval_create(sys, HN_TERM_M | HN_TERM_J | HN_TERM_PHI | HN_TERM_PHI_T, arena, &s->terms);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "the projection cannot be set up: %s",
                           hn_status_text(status));
    }

    // scratch
    const size_t nv = (size_t)s->ode.base.nv, nc = (size_t)s->ode.base.nc;
    double **of_nv[] = {&s->N0_mu, &s->N0_nu, &s->N1_mu, &s->push, &s->zero};
    double **of_nc[] = {&s->mu, &s->nu, &s->rate, &s->x};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, nv);
    }
    for (size_t i = 0; i < sizeof of_nc / sizeof *of_nc; i++) {
        *of_nc[i] = hn_arena_doubles(arena, nc);
    }

    for (int i = 0; i <= KEPT_TURNS; i++) {
        s->steps[i] = hn_arena_doubles(arena, 2 * nc);
    }

    // factors, and copies of the start of the step
    s->L = hn_arena_doubles(arena, nv * nv);
    s->L0 = hn_arena_doubles(arena, nv * nv);
    s->J0 = hn_arena_doubles(arena, nc * nv);
    s->unit = hn_arena_doubles(arena, nv);
    s->q1 = hn_arena_doubles(arena, (size_t)s->ode.base.nq);
    s->start = hn_arena_doubles(arena, (size_t)s->ode.base.nq + nv);
    s->saddle = hn_saddle_ws_create(arena, (int)nv, (int)nc);
    s->length = hn_system_length(sys);

    s->M = hn_eval_get(s->terms, HN_TERM_M);
    s->J = hn_eval_get(s->terms, HN_TERM_J);
    s->phi = hn_eval_get(s->terms, HN_TERM_PHI);
    s->phi_t = hn_eval_get(s->terms, HN_TERM_PHI_T);
    return s->saddle && !hn_arena_failed(arena) ? HN_OK : fail_memory(diag);
}

static void destroy(void *self) {
    symmetric *s = self;
    hn_eval_free(s->terms);
    s->terms = NULL;
    hn_accel_ode_destroy(self);
}

/// The first speed that moves no mass, -1: none.
static int find_massless(const symmetric *s) {
    const double massless = 1e-14; // of the largest mass, as in the dense solves
    const int nv = s->ode.base.nv;
    double heaviest = 0;
    for (int i = 0; i < nv; i++) {
        heaviest = fmax(heaviest, s->M[(size_t)i * (size_t)nv + (size_t)i]);
    }
    for (int i = 0; i < nv; i++) {
        if (!(s->M[(size_t)i * (size_t)nv + (size_t)i] > massless * heaviest)) {
            return i;
        }
    }
    return -1;
}

static hn_status tell(symmetric *s, hn_status status, double t) {
    const hn_system *sys = s->ode.base.sys;
    const int no_mass = status == HN_ERR_NO_CONVERGENCE ? -1 : find_massless(s);
    const char *reason = hn_status_text(status);

    // M^-1 does not exist: name the coordinate without mass
    if (no_mass >= 0) {
        const char *name =
            no_mass < hn_system_get_info(sys).n_user
                ? hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, no_mass)].name
                : "a speed";
        snprintf(s->ode.base.why, sizeof s->ode.base.why,
                 "the symmetric projection at t = %.6g s needs the inverse of M, which does not "
                 "exist: %s moves no mass; projection and index3 can be used",
                 t, name);
        return HN_ERR_MASS;
    }

    // otherwise the reason by status
    if (status == HN_ERR_NO_CONVERGENCE) {
        reason = "it does not converge: the step is too long for it, or the configuration is "
                 "nearly singular";
    } else if (status == HN_ERR_SINGULAR || status == HN_ERR_NOT_SPD) {
        reason = "the equations have no unique answer here: closure rows depend on each other";
    }
    snprintf(s->ode.base.why, sizeof s->ode.base.why, "the symmetric projection at t = %.6g s: %s",
             t, reason);
    return status;
}

// out (nv) = M^-1 J' mu with M = L L'
static void push_along(const symmetric *s, const double *L, const double *J, const double *mu,
                       double *out) {
    const int nv = s->ode.base.nv;
    memset(out, 0, (size_t)nv * sizeof *out);
    for (int k = 0; k < s->ode.base.nc; k++) {
        hn_axpy(nv, mu[k], J + (size_t)k * nv, out);
    }
    hn_cholesky_solve(nv, L, nv, out);
}

static hn_status look(symmetric *s, double t, const double *q) {
    const size_t nv = (size_t)s->ode.base.nv;
    hn_eval_run(s->terms, t, q, NULL);
    memcpy(s->L, s->M, nv * nv * sizeof *s->L);
    s->ode.base.cost.factorisations++;
    s->ode.base.cost.ops += hn_eval_info(s->terms).ops + hn_flops_cholesky((int)nv);
    return hn_cholesky((int)nv, s->L, (int)nv, 0);
}

static void move(const symmetric *s, double *y, const double *dq, const double *dv) {
    hn_system_move(s->ode.base.sys, y, dq);
    hn_axpy(s->ode.base.nv, 1, dv, y + s->ode.base.nq);
}

// largest coordinate and velocity, in radians and lengths of the mechanism
static double largest_position(const symmetric *s, const double *q) {
    double largest = 0;
    for (int i = 0; i < s->ode.base.nv; i++) {
        const int at = hn_system_position_of(s->ode.base.sys, i);
        largest = at >= 0 ? fmax(largest, fabs(q[at]) / s->unit[i]) : fmax(largest, 1);
    }
    return largest;
}

static double largest_velocity(const symmetric *s, const double *v) {
    double largest = 0;
    for (int i = 0; i < s->ode.base.nv; i++) {
        largest = fmax(largest, fabs(v[i]) / s->unit[i]);
    }
    return largest;
}

// the last line of (1), with N1 at the point that the last turn found; then (2)'s residuals as
// fractions of rounding
static hn_status land(symmetric *s, double t1, double *y, double *q1, double *worst) {
    const int nq = s->ode.base.nq, nv = s->ode.base.nv, nc = s->ode.base.nc;
    HN_TRY(look(s, t1, q1));
    push_along(s, s->L, s->J, s->mu, s->N1_mu);
    push_along(s, s->L, s->J, s->nu, s->push);
    move(s, y, s->N1_mu, s->push);
    memcpy(q1, y, (size_t)nq * sizeof *q1);
    hn_eval_run(s->terms, t1, y, NULL);

    // an angle of many turns is known to fewer digits, and so are the rows of J that depend on it
    const double largest = largest_position(s, y), fastest = largest_velocity(s, y + nq);
    const double unit_q = ROUNDING * (1 + largest) * s->length;
    const double unit_v = 2 * ROUNDING * s->length * fmax(1, largest) * fastest + DBL_MIN;
    *worst = 0;
    for (int k = 0; k < nc; k++) {
        s->rate[k] = hn_dot(nv, s->J + (size_t)k * nv, y + nq) + s->phi_t[k];
        *worst = fmax(*worst, fmax(fabs(s->phi[k]) / unit_q, fabs(s->rate[k]) / unit_v));
    }
    return isfinite(*worst) ? HN_OK : HN_ERR_NO_CONVERGENCE;
}

// z (2 nc) = -((2 S0)^-1 phi, h (2 S0)^-1 (J v + phi_t))
static hn_status correct_simply(symmetric *s, double h, double *z) {
    const int nc = s->ode.base.nc;
    const double *residual[] = {s->phi, s->rate};
    const double factor[] = {0.5, 0.5 * h};
    memset(z, 0, 2 * (size_t)nc * sizeof *z);
    for (int i = 0; i < 2; i++) {
        // K [a; -x] = [0; -r] has x = -S0^-1 r; a is not wanted
        HN_TRY(hn_saddle_apply(s->zero, residual[i], s->push, s->x, NULL, s->saddle));
        hn_axpy(nc, factor[i], s->x, z + i * nc);
        s->ode.base.cost.solves++;
    }
    return HN_OK;
}

// The next correction of (mu, nu): that by S0, with what the *n steps before it have taught. If
// as many are kept as there is room for, the next begins anew.
static hn_status correct(symmetric *s, double h, int *n) {
    const int nc = s->ode.base.nc, size = 2 * nc;
    *n = *n > KEPT_TURNS ? 0 : *n;
    double *z = s->steps[*n];
    HN_TRY(correct_simply(s, h, z));

    for (int j = 0; j < *n; j++) {
        const double *step = s->steps[j];
        const double square = hn_dot(size, step, step), along = hn_dot(size, step, z);
        if (j + 1 < *n) {
            hn_axpy(size, along / square, s->steps[j + 1], z);
        } else if (fabs(1 - along / square) > LEAST_PIVOT) {
            hn_axpy(size, 1 / (1 - along / square) - 1, z, z);
        }
    }

    // a step of nothing teaches nothing
    *n = hn_dot(size, z, z) > 0 ? *n + 1 : 0;
    hn_axpy(nc, 1, z, s->mu);
    hn_axpy(nc, 1 / h, z + nc, s->nu);
    s->ode.base.cost.newton++;
    return HN_OK;
}

// one turn of (1) with the present mu and nu
static hn_status turn(symmetric *s, const hn_step_call *base, double t, double h, const double *y,
                      double *y_new, double *q1, double *worst, double *err) {
    memcpy(y_new, y, (size_t)(s->ode.base.nq + s->ode.base.nv) * sizeof *y);
    memcpy(s->start, y, (size_t)(s->ode.base.nq + s->ode.base.nv) * sizeof *y);
    move(s, s->start, s->N0_mu, s->N0_nu);
    HN_TRY(hn_step_call_make(base, t, h, s->start, y_new, err));
    return land(s, t + h, y_new, q1, worst);
}

// N0, S0 and no push to begin with
static hn_status begin(symmetric *s, double t, const double *y) {
    const int nv = s->ode.base.nv, nc = s->ode.base.nc;
    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.rank_tol = RANK_TOL;
    opts.row_floor = ROW_FLOOR;
    opts.residual_tol = HUGE_VAL;
    HN_TRY(look(s, t, y));
    memcpy(s->L0, s->L, (size_t)nv * nv * sizeof *s->L);
    memcpy(s->J0, s->J, (size_t)nc * nv * sizeof *s->J);
    hn_unit_scales(s->ode.base.sys, s->M, nv + 1, s->unit);
    memset(s->mu, 0, (size_t)nc * sizeof *s->mu);
    memset(s->nu, 0, (size_t)nc * sizeof *s->nu);
    memset(s->N0_mu, 0, (size_t)nv * sizeof *s->N0_mu);
    memset(s->N0_nu, 0, (size_t)nv * sizeof *s->N0_nu);
    return hn_saddle_factor(nv, nc, s->M, s->J, NULL, &opts, s->saddle);
}

// what the noise of the integrator's own iteration leaves of (2), taken off at the end alone
static hn_status polish(symmetric *s, double *y) {
    HN_TRY(hn_saddle_apply(s->zero, s->phi, s->N1_mu, s->x, NULL, s->saddle));
    HN_TRY(hn_saddle_apply(s->zero, s->rate, s->push, s->x, NULL, s->saddle));
    move(s, y, s->N1_mu, s->push);
    return HN_OK;
}

static hn_status around_step(void *self, const hn_step_call *base, double t, double h,
                             const double *y, double *y_new, double *err) {
    symmetric *s = self;
    double worst = HUGE_VAL, last;
    int n = 0;
    if (s->ode.base.nc == 0) {
        return hn_step_call_make(base, t, h, y, y_new, err);
    }

    // push, step, push, until (2) is met
    hn_status status = begin(s, t, y);
    memcpy(s->q1, y, (size_t)s->ode.base.nq * sizeof *y);
    for (int i = 0; i < MAX_TURNS && status == HN_OK; i++) {
        last = worst;
        status = turn(s, base, t, h, y, y_new, s->q1, &worst, err);
        if (status == HN_OK && (worst <= 1 || (worst > last / 2 && worst <= COARSE))) {
            s->ode.base.cost.projections++;
            return worst > 1 ? polish(s, y_new) : HN_OK;
        }
        if (status == HN_OK) {
            status = correct(s, h, &n);
            push_along(s, s->L0, s->J0, s->mu, s->N0_mu);
            push_along(s, s->L0, s->J0, s->nu, s->N0_nu);
        }
    }
    return tell(s, status == HN_OK ? HN_ERR_NO_CONVERGENCE : status, t);
}

// what the integrator kept belongs to the point before it was pushed
static hn_status after_step(void *self, double t, double *y, int *changed) {
    const symmetric *s = self;
    (void)t;
    (void)hn_system_normalise(s->ode.base.sys, y);
    *changed = s->ode.base.nc > 0;
    return HN_OK;
}

const hn_formulation hn_formulation_symmetric_projection = {
    .name = "symmetric-projection",
    .title = "symmetric projection",
    .short_name = "symm. proj.",
    .rule = "Push the state off the closed loops before the step and back on after it by "
            "the same amount. The step is then symmetric in time, and the energy error "
            "of a swing stays bounded.",
    .drift = "none: gap and velocity violation at rounding level; with a symmetric "
             "integrator the energy error of a swing stays bounded, that of a crank that keeps "
             "turning grows slowly",
    .when = "long conservative runs with midpoint or Gauss methods",
    .when_not = "short runs (each step costs several of the integrator's); massless links; "
                "steps chosen by an error estimate",
    .source = "Hairer 2000; Hairer, Lubich & Wanner 2006, V.4.1; Faou, Hairer & Pham 2004",
    .needs = "M f phi J gamma",
    .order_note = "the integrator's in q, v and recomputed lambda",
    .limits = "the energy error stays bounded with symmetric integrators only, and for motions "
              "that run back on their way: along a crank that turns one way round it grows like "
              "t h^p",
    .index = 1,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_NEEDS_MASS_INVERSE,
    .create = create,
    .destroy = destroy,
    .ode = hn_accel_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .around_step = around_step,
    .after_step = after_step,
    .add_cost = hn_accel_ode_add_cost,
    .why = hn_state_ode_why,
};
