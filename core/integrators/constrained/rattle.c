// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "integrators/step/ball_step.h"
#include "integrators/step/dae_base.h"
#include "integrators/step/lagrange_terms.h"
#include "integrators/step/options.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// With D = q1 - q0, w = D / h and the momentum p = M v, one step is
//
//     M w - p0 - h/2 F - h/2 J0' lambda = 0,   phi(q1) = 0                                    (1)
//     p1 = p0 + h/2 (F + F1) + h/2 J0' lambda + J1' mu,   J1 M1^-1 p1 + phi_t = 0             (2)
//
// Constant M: F = L_q at q0, F1 = L_q at q1, and (1) is linear but for phi: RATTLE as published.
// M(q): M and F = F1 = L_q are taken at ((q0 + q1) / 2, w): the midpoint discrete Lagrangian. Its
// Newton matrix for D is M / h + (B - B') / 2 with B = (M w)_q; the curvature of L itself, of the
// order h, is left out. Balls: their part of D is a turn; the midpoint discrete Lagrangian on the
// group adds to (1) and (2) what ball_step.h says. Both are symplectic on the constraint manifold
// and symmetric, of order 2; lambda belongs to one side of q0, so alone it is of order 1.
//
// Sums of many small increments: q and p are carried with the rounding of each sum, so that 1e7
// steps lose nothing to it.
//
// Forces that depend on speed (Q_v of lagrange_terms.h) spoil symplecticity and have no place in
// (1). On request they act in half-steps before and after, with q held: Strang splitting, order 2.
// Sources: Andersen 1983; Leimkuhler & Skeel 1994; Marsden & West 2001; Hairer, Lubich & Wanner
// 2006, sections VII.1 and VIII.5; Bou-Rabee & Marsden 2009, Hamilton-Pontryagin integrators on Lie
// groups.

enum { OPT_STEP, OPT_SPEED_FORCES, N_OPTIONS };
enum { REFUSE, SPLIT };

static const double HALF_TURN = 3.141592653589793; // [rad]

// what is carried from step to step
typedef struct carried {
    double *q_low, *p, *p_low; // nv: rounding of q, the momentum and its rounding
    double *raw;               // nc
} carried;

typedef struct rattle {
    hn_dae_base base; // first
    hn_lagrange *terms;
    hn_ball_step balls;
    int split, constant, fresh; // constant: M, and no balls; fresh: `now` has to be taken from y
    hn_newton_matrix *matrix;
    carried now, next;
    double *J0;           // nc x nv
    double *D, *w;        // nv: q1 - q0; D / h
    double *middle;       // nq: q0 moved by D / 2
    double *force, *pull; // nv: h/2 F; h/2 J0' lambda
    double *leave;        // nv: what balls add to M w in (1)
    double *x;            // nv + nc
    double *lambda;       // nc: h^2/2 lambda on the chosen rows
    double *v, *kick;     // nv
} rattle;

static void carried_init(carried *c, hn_arena *arena, size_t nv, size_t nc) {
    c->q_low = hn_arena_doubles(arena, nv);
    c->p = hn_arena_doubles(arena, nv);
    c->p_low = hn_arena_doubles(arena, nv);
    c->raw = hn_arena_doubles(arena, nc);
}

static hn_status allocate(rattle *s, hn_arena *arena) {
    const size_t nv = (size_t)s->base.nv, nc = (size_t)s->base.nc;
    double **of_nv[] = {&s->D, &s->force, &s->pull, &s->leave, &s->w, &s->v, &s->kick};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, nv);
    }
    s->middle = hn_arena_doubles(arena, (size_t)s->base.nq);
    s->J0 = hn_arena_doubles(arena, nc * nv);
    s->x = hn_arena_doubles(arena, nv + nc);
    s->lambda = hn_arena_doubles(arena, nc);
    const int *rows, *cols, turning = hn_lagrange_pattern(s->terms, &rows, &cols);
    s->matrix = hn_dae_matrix_create(&s->base, arena, (int)(nv + nc), 1, 2,
                                     (s->balls.n > 0 ? 5 : 3) * turning + 6 * s->balls.n);
    carried_init(&s->now, arena, nv, nc);
    carried_init(&s->next, arena, nv, nc);
    return s->matrix && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

static hn_status create(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag) {
    HN_TRY(hn_dae_instance(form, form_options, "rattle", sizeof(rattle), arena, self, diag));
    rattle *s = *self;
    HN_TRY(hn_dae_base_init(&s->base, sys, arena, diag));

    // the terms of the Lagrangian and the geometry of the balls
    hn_status status = hn_lagrange_create(sys, arena, &s->terms);
    HN_THEN(status, hn_ball_step_init(&s->balls, sys, arena));
    HN_THEN(status, allocate(s, arena));
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "rattle cannot be set up: %s",
                           hn_status_text(status));
    }

    // a constant mass matrix needs no middle point; dampers are not variational
    s->constant = hn_lagrange_mass_is_constant(s->terms) && s->balls.n == 0;
    s->split = hn_lagrange_has_dissipation(s->terms);
    if (s->split && (int)options[OPT_SPEED_FORCES] == REFUSE) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "rattle:speed-forces=split",
                           "a force depends on velocities (a damper, friction, a formula in v): "
                           "rattle can apply it only in separate half-steps");
    }
    return HN_OK;
}

static void destroy(void *self) {
    rattle *s = self;
    hn_newton_matrix_free(s->matrix);
    s->matrix = NULL;
    hn_lagrange_free(s->terms);
    hn_dae_base_destroy(&s->base);
}

static hn_status start(void *self, double t, const double *y) {
    rattle *s = self;
    s->fresh = 1;
    return hn_dae_accelerate(&s->base, t, y, y + s->base.nq, s->v, s->now.raw);
}

// [. sign J_left'; J .] with the chosen rows
static void border(rattle *s, const double *J_left, double sign) {
    const hn_dae_base *b = &s->base;
    hn_dae_put_columns(b, s->matrix, J_left, sign, 0, b->nv);
    hn_dae_put_rows(b, s->matrix, b->J, 1, b->nv, 0);
}

static hn_status factor(rattle *s) {
    s->base.cost.factorisations++;
    return hn_newton_matrix_factor(s->matrix);
}

static void solve(rattle *s) {
    s->base.cost.solves++;
    hn_newton_matrix_solve(s->matrix, s->x);
}

// x = (v, -mu) such that M v = p + J' mu and J v = -moving phi_t, at the terms last evaluated
static hn_status speeds_from(rattle *s, const double *p, double moving) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv;
    hn_newton_matrix_begin(s->matrix, nv + b->nr);
    hn_dae_put_mass(b, s->matrix, 1, 0, 0);
    border(s, b->J, 1);
    HN_TRY(factor(s));
    memcpy(s->x, p, (size_t)nv * sizeof *p);
    for (int k = 0; k < b->nr; k++) {
        s->x[nv + k] = -moving * b->phi_t[b->rows[k]];
    }
    solve(s);
    return HN_OK;
}

// v after a time h of M v' = Q_v + J' lambda, J v' = 0 with q held, by Heun's method, at the terms
// last evaluated
static hn_status damp(rattle *s, double t, double h, const double *q, double *v) {
    const int nv = s->base.nv;
    HN_TRY(speeds_from(s, hn_lagrange_dissipation(s->terms, t, q, v), 0));
    for (int i = 0; i < nv; i++) {
        s->kick[i] = s->x[i];
        s->w[i] = v[i] + h * s->x[i];
    }
    HN_TRY(speeds_from(s, hn_lagrange_dissipation(s->terms, t, q, s->w), 0));
    for (int i = 0; i < nv; i++) {
        v[i] += h / 2 * (s->kick[i] + s->x[i]);
    }
    return HN_OK;
}

// momentum M w, and force, pull and leave of (1), at the present D and lambda
static const double *discrete_forces(rattle *s, double t, double h, const double *q) {
    const int nv = s->base.nv;
    const double *momentum, *force;
    for (int i = 0; i < nv; i++) {
        s->w[i] = s->D[i] / 2;
        s->leave[i] = 0;
    }

    // the middle of the step and the mean velocity across it
    memcpy(s->middle, q, (size_t)s->base.nq * sizeof *q);
    hn_system_move(s->base.sys, s->middle, s->w);
    for (int i = 0; i < nv; i++) {
        s->w[i] = s->D[i] / h;
    }
    if (s->constant) {
        hn_lagrange_forces(s->terms, t, q, s->w, &momentum, &force);
    } else {
        hn_lagrange_forces(s->terms, t + h / 2, s->middle, s->w, &momentum, &force);
    }

    // impulses of the forces, and of the multipliers at the start
    for (int i = 0; i < nv; i++) {
        s->force[i] = h / 2 * force[i];
        s->pull[i] = 0;
    }
    hn_dae_add_rows(&s->base, s->J0, 1 / h, s->lambda, s->pull);
    hn_ball_step_leave(&s->balls, h, s->D, momentum, force, s->leave);
    return momentum;
}

// x = (-h times the first of (1), -phi(q1)); returns M w
static const double *residual(rattle *s, double t, double h, const double *q, const double *q1) {
    hn_dae_base *b = &s->base;
    const double *momentum = discrete_forces(s, t, h, q);
    for (int i = 0; i < b->nv; i++) {
        s->x[i] = -h * (momentum[i] - s->next.p[i] + s->leave[i] - s->force[i] - s->pull[i]);
    }
    hn_dae_loops(b, t + h, q1);
    for (int k = 0; k < b->nr; k++) {
        s->x[b->nv + k] = -b->phi[b->rows[k]];
    }
    return momentum;
}

static hn_status factor_newton(rattle *s, double t, double h, const double *momentum) {
    const int nv = s->base.nv;
    const double *M, *B;
    const int *rows, *cols, n = hn_lagrange_pattern(s->terms, &rows, &cols);
    hn_lagrange_matrices(s->terms, t + h / 2, s->middle, s->w, &M, &B);
    hn_newton_matrix_begin(s->matrix, nv + s->base.nr);
    for (int k = 0; k < n; k++) {
        const int i = rows[k], j = cols[k];
        const size_t at = (size_t)i * nv + j;
        hn_newton_matrix_put(s->matrix, i, j, M[at] + h / 2 * B[at], 0);
        hn_newton_matrix_put(s->matrix, j, i, -h / 2 * B[at], 0);
    }
    hn_ball_step_put(&s->balls, h, s->D, momentum, M, n, rows, cols, s->matrix);
    border(s, s->J0, -1);
    return factor(s);
}

// from half a turn on the poses of the ends do not tell which way round it was; at a whole one (1)
// is singular
static hn_status look_at_turns(rattle *s, double t) {
    const double angle = hn_ball_step_angle(&s->balls, s->D);
    if (!(angle > HALF_TURN)) {
        return HN_OK;
    }
    snprintf(s->base.why, sizeof s->base.why,
             "a ball turns by %.3g rad in the step from t = %.6g s: take steps of less than half a "
             "turn",
             angle, t);
    return HN_ERR_NO_CONVERGENCE;
}

// equation (1): D, of which a first guess is there, and lambda
static hn_status find_position(rattle *s, double t, double h, const double *q, double *q1) {
    enum { KEEP_FACTOR_FROM = 2 };
    hn_dae_base *b = &s->base;
    hn_newton newton = {0};
    memset(s->lambda, 0, (size_t)b->nc * sizeof *s->lambda);
    for (;;) {
        // the position that the present displacement leads to
        for (int i = 0; i < b->nv; i++) {
            s->kick[i] = s->D[i] + s->next.q_low[i];
        }
        memcpy(q1, q, (size_t)b->nq * sizeof *q1);
        hn_system_move(b->sys, q1, s->kick);
        const double *momentum = residual(s, t, h, q, q1);

        // two factors at first, then only where contraction is slow
        if (newton.iterations < KEEP_FACTOR_FROM || newton.contraction > 0.05) {
            const hn_status status = factor_newton(s, t, h, momentum);
            if (status != HN_OK) {
                return status;
            }
        }

        // the correction of displacement and multipliers
        solve(s);
        b->cost.newton++;
        hn_axpy(b->nv, 1, s->x, s->D);
        hn_axpy(b->nr, 1, s->x + b->nv, s->lambda);
        const double size = hn_dae_newton_size(b, s->x, s->D, q);
        const hn_newton_verdict verdict = hn_newton_look(&newton, size);
        if (verdict != HN_NEWTON_GO_ON) {
            return verdict == HN_NEWTON_DONE ? HN_OK : HN_ERR_NO_CONVERGENCE;
        }
    }
}

// equation (2): next.p and v1 at the closed q1
static hn_status find_speeds(rattle *s, double t, double h, const double *q, const double *q1,
                             double *v1) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv;
    const double *momentum = discrete_forces(s, t, h, q); // at the D and lambda found
    hn_ball_step_turn(&s->balls, s->D, momentum, s->pull);
    hn_axpy(nv, 1, s->force, s->pull);
    if (s->constant) {
        const double *force;
        hn_lagrange_forces(s->terms, t + h, q1, s->w, &momentum, &force);
        hn_axpy(nv, h / 2, force, s->pull);
    } else {
        hn_axpy(nv, 1, s->force, s->pull);
    }

    // momentum at the end, and the velocity that meets the constraints with it
    hn_dae_dynamics(b, t + h, q1, s->w);
    hn_dae_loops(b, t + h, q1);
    for (int i = 0; i < nv; i++) {
        s->kick[i] = s->next.p[i] + (s->pull[i] + s->next.p_low[i]);
    }
    HN_TRY(speeds_from(s, s->kick, 1));
    memcpy(v1, s->x, (size_t)nv * sizeof *v1);

    // the impulse of the velocity multipliers completes the momentum
    hn_dae_add_rows(b, b->J, -1, s->x + nv, s->pull);
    hn_add_kept(nv, s->next.p, s->next.p_low, s->pull);
    hn_dae_spread_rows(b, s->x + nv, s->next.raw);
    for (int i = 0; i < b->nc; i++) {
        s->next.raw[i] *= -2 / h;
    }
    return HN_OK;
}

// terms at the start of the step, and the copy of what is carried that this trial works on
static hn_status begin(rattle *s, double t, double h, const double *y) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv;
    const size_t size = (size_t)nv * sizeof *y;
    memcpy(s->v, y + b->nq, size);
    hn_dae_dynamics(b, t, y, s->v);
    hn_dae_loops(b, t, y);
    hn_dae_choose_rows(b);
    hn_dae_copy_rows(b, s->J0);

    // dampers act in a half-step of their own
    if (s->split) {
        const hn_status status = damp(s, t, h / 2, y, s->v);
        if (status != HN_OK) {
            return status;
        }
    }

    // momenta are carried with their rounding; they are rebuilt from v where v is not theirs
    memcpy(s->next.q_low, s->now.q_low, size);
    memcpy(s->next.p, s->now.p, size);
    memcpy(s->next.p_low, s->now.p_low, size);
    if (s->fresh) {
        memset(s->next.q_low, 0, size);
    }
    if (s->fresh || s->split) {
        hn_dae_mass_times(b, s->v, s->next.p);
        memset(s->next.p_low, 0, size);
    }
    return HN_OK;
}

static hn_status step(void *self, double t, double h, const double *y, double *y_new, double *err) {
    (void)err;
    rattle *s = self;
    hn_dae_base *b = &s->base;
    double *q1 = y_new, *v1 = y_new + b->nq;
    hn_status status = begin(s, t, h, y);
    if (status != HN_OK) {
        return hn_dae_fail(b, status, t, "the damping half-step");
    }

    // positions: a guess along v, then the discrete equations of motion
    for (int i = 0; i < b->nv; i++) {
        s->D[i] = h * s->v[i];
    }
    HN_TRY(look_at_turns(s, t));
    status = find_position(s, t, h, y, q1);
    if (status != HN_OK) {
        return hn_dae_fail(b, status, t, "the positions of the step");
    }
    HN_TRY(look_at_turns(s, t));

    // positions again, with the rounding of the sum kept
    memcpy(q1, y, (size_t)b->nq * sizeof *q1);
    hn_ball_step_move(&s->balls, q1, s->next.q_low, s->D, s->kick);

    // velocities at the end
    status = find_speeds(s, t, h, y, q1, v1);
    if (status == HN_OK && s->split) {
        status = damp(s, t + h, h / 2, q1, v1);
    }
    return status == HN_OK ? HN_OK : hn_dae_fail(b, status, t + h, "the velocities of the step");
}

static void accepted(void *self, int changed) {
    rattle *s = self;
    const carried spare = s->now;
    s->now = s->next;
    s->next = spare;
    s->fresh = changed;
}

static const double *raw_lambda(const void *self) {
    const rattle *s = self;
    return s->now.raw;
}

static void add_cost(const void *self, hn_cost *cost) {
    const rattle *s = self;
    hn_dae_base_add_cost(&s->base, cost);
    cost->ops += hn_lagrange_ops(s->terms) + hn_newton_matrix_ops(s->matrix);
}

static const char *why(const void *self) {
    const rattle *s = self;
    return hn_dae_base_why(&s->base);
}

static const hn_dae_stepper dae = {
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .on_accepted = accepted,
    .raw_lambda = raw_lambda,
    .add_cost = add_cost,
    .why = why,
};

static const char *const speed_forces[] = {"refuse", "split"};

const hn_stepper hn_stepper_rattle = {
    .name = "rattle",
    .title = "RATTLE",
    .about = "A symplectic method: loops stay closed to rounding, and the energy error stays "
             "bounded for millions of steps. Fixed steps only. Dampers need speed-forces=split. A "
             "ball joint may turn by less than half a turn in a step.",
    .source = "Andersen 1983; Leimkuhler & Skeel 1994; Marsden & West 2001; for balls Bou-Rabee & "
              "Marsden 2009",
    .order = 2,
    .stages = 1,
    .real_limit = 2,
    .imag_limit = 2,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_STEP] = HN_OPTION_STEP,
            [OPT_SPEED_FORCES] =
                {.key = "speed-forces",
                 .max = 1,
                 .about = "dampers and other velocity-dependent forces: refused, or applied in "
                          "half-steps of their own (split)",
                 .choices = speed_forces,
                 .n_choices = 2},
        },
    .forms = 1u << HN_FORM_INDEX3,
    .dae = &dae,
};
