// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_dae.h"

#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "integrators/implicit/implicit_linear.h"
#include "integrators/implicit/implicit_linear_solve.h"
#include "integrators/implicit/stages.h"
#include "integrators/implicit/turn.h"
#include "integrators/step/control.h"
#include "integrators/step/dae_base.h"
#include "linalg/dense.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define ROUNDING 1e-14 // of the scale: corrections at or below are rounding
#define NEARLY_DEPENDENT \
    1e-3 // pivot of a row below which the pose that chooses rows has to be closed first
#define CLOSED \
    1e-15 // of the length: the end of an adaptive step is closed as far as rounding allows

typedef struct implicit_dae {
    const hn_system *sys;
    hn_dae_form form;
    hn_implicit_dae_opts opts;
    int nq, nv, nc;
    double weight; // of the error estimate
    int is_driven; // a loop depends on time
    hn_stages st;
    hn_implicit_linear lin;
    hn_linear *at_stage; // R, phi, J v + phi_t
    const double *R, *phi, *speed_gap;
    hn_accel *accel;
    hn_projector *projector; // adaptive only
    double *q0, *v0;         // start of the trial
    double *q, *v, *x;       // of a stage
    double *a_start,
        *lambda_start; // at the start of the trial: consistent at first, then the last stage's
    double *last_a, *last_lambda; // stages x nv, stages x nc of the last accepted step
    double *raw;                  // nc
    double *unit;                 // nq + nv, of the absolute tolerance
    double h, last_h;             // of the trial, of the last accepted step (0: none)
    double *force;                // nv: f + J' lambda at the start of the trial
    double *pushed;               // nv: Y mu
    long long accelerations, accepted;
    char why[HN_STAGES_WHY];
} implicit_dae;

static bool wants_phi(hn_dae_form form) {
    return form == HN_FORM_INDEX3 || form == HN_FORM_GGL;
}

static bool wants_speed_gap(hn_dae_form form) {
    return form == HN_FORM_INDEX2 || form == HN_FORM_GGL;
}

// D(x) u of (1)
static void apply_D(const implicit_dae *s, const double *x, double *u) {
    for (int i = 0; i < s->nv && s->nq > s->nv; i++) {
        if (hn_system_position_of(s->sys, i) < 0) {
            hn_turn_rate(x + i, u + i);
            i += 2;
        }
    }
}

static void move_from_start(const implicit_dae *s, const double *x, double *q) {
    memcpy(q, s->q0, (size_t)s->nq * sizeof *q);
    hn_system_move(s->sys, q, x);
}

// state of a stage, or of the end when the constraint is asked for there, `weight` times the
// stage's change
static void place(implicit_dae *s, const double *u, double weight) {
    for (int i = 0; i < s->nv; i++) {
        s->x[i] = weight * u[i];
        s->v[i] = s->v0[i] + weight * u[s->nv + i];
    }
    move_from_start(s, s->x, s->q);
}

static void put_constraints(implicit_dae *s, double weight, double *r) {
    const int nc = s->nc;
    const double *first = wants_phi(s->form) ? s->phi : s->speed_gap;
    for (int i = 0; i < nc; i++) {
        r[i] = first[i] / weight;
        if (s->form == HN_FORM_GGL) {
            r[nc + i] = s->speed_gap[i] / weight;
        }
    }
}

static hn_status residual(void *self, int stage, double t, const double *u, const double *rate,
                          double *r) {
    implicit_dae *s = self;
    const int nv = s->nv, nc = s->nc;
    (void)stage;

    // derivatives and multipliers of the stage
    place(s, u, 1);
    hn_linear_run(s->at_stage, t, s->q, s->v, rate + nv, u + 2 * nv);

    // kinematics: X' - D(X) (v0 + W) - Y mu
    memcpy(r, s->v, (size_t)nv * sizeof *r);
    apply_D(s, s->x, r);
    for (int i = 0; i < nv; i++) {
        r[i] = rate[i] - r[i];
    }
    if (s->form == HN_FORM_GGL) {
        hn_implicit_linear_push(&s->lin, u + 2 * nv + nc, s->pushed);
        hn_axpy(nv, -1, s->pushed, r);
    }

    // dynamics
    memcpy(r + nv, s->R, (size_t)nv * sizeof *r);

    // constraints at the stage itself, or at the end of the step (midpoint)
    if (!s->opts.at_end) {
        put_constraints(s, 1, r + 2 * nv);
    } else {
        const double weight = s->st.col.end[0], c = s->st.col.c[0];
        place(s, u, weight);
        hn_linear_run(s->at_stage, t + (1 - c) * s->h, s->q, s->v, NULL, NULL);
        put_constraints(s, weight, r + 2 * nv);
    }
    return hn_all_finite(s->st.n, r) ? HN_OK : HN_ERR_DIVERGED;
}

static hn_status factor(void *self, int which, double re, double im) {
    implicit_dae *s = self;
    return hn_implicit_linear_factor(&s->lin, which, re, im);
}

static hn_status relinearise(void *self, double t, const double *u, const double *rate) {
    implicit_dae *s = self;
    place(s, u, 1);
    return hn_implicit_linear_at(&s->lin, t, s->q, s->v, rate + s->nv, u + 2 * s->nv);
}

static void solve(void *self, hn_parts r) {
    implicit_dae *s = self;
    hn_implicit_linear_solve(&s->lin, r);
}

static bool has_driven_loop(const hn_system *sys) {
    const hn_system_exprs exprs = hn_system_get_exprs(sys);
    const int nc = hn_system_get_info(sys).nc;
    for (int i = 0; i < nc; i++) {
        if (!hn_is_zero(exprs.phi_t[i])) {
            return true;
        }
    }
    return false;
}

// ---- life ----

static hn_status allocate(implicit_dae *s, const hn_collocation *col, hn_arena *arena) {
    const size_t nq = (size_t)s->nq, nv = (size_t)s->nv, nc = (size_t)s->nc;
    const size_t stages = (size_t)col->stages;
    const struct {
        double **to;
        size_t n;
    } arrays[] = {{&s->q0, nq},
                  {&s->v0, nv},
                  {&s->q, nq},
                  {&s->v, nv},
                  {&s->x, nv},
                  {&s->a_start, nv},
                  {&s->lambda_start, nc},
                  {&s->last_a, stages * nv},
                  {&s->force, nv},
                  {&s->pushed, nv},
                  {&s->last_lambda, stages * nc},
                  {&s->raw, nc},
                  {&s->unit, nq + nv}};

    // all from one list, so that none is forgotten
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        *arrays[i].to = hn_arena_doubles(arena, arrays[i].n);
    }
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status create_terms(implicit_dae *s, hn_arena *arena) {
    const unsigned terms = HN_LINEAR_RESIDUAL | (wants_phi(s->form) ? HN_LINEAR_PHI : 0u) |
                           (wants_speed_gap(s->form) ? HN_LINEAR_SPEED_GAP : 0u);
    const hn_accel_opts accel = {.want_lambda = 1};
    HN_TRY(hn_implicit_linear_init(&s->lin, s->sys, s->form, arena));
    HN_TRY(hn_linear_create(s->sys, terms, arena, &s->at_stage));
    HN_TRY(hn_accel_create(s->sys, &accel, arena, &s->accel));
    HN_TRY(hn_projector_create(s->sys, HN_WEIGHT_MASS, arena, &s->projector));
    s->R = hn_linear_get(s->at_stage, HN_LINEAR_RESIDUAL);
    s->phi = wants_phi(s->form) ? hn_linear_get(s->at_stage, HN_LINEAR_PHI) : NULL;
    s->speed_gap =
        wants_speed_gap(s->form) ? hn_linear_get(s->at_stage, HN_LINEAR_SPEED_GAP) : NULL;
    return HN_OK;
}

hn_status hn_implicit_dae_create(const hn_system *sys, hn_dae_form form, const hn_collocation *col,
                                 const hn_implicit_dae_opts *opts, hn_arena *arena, void **self,
                                 hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    implicit_dae *s = hn_arena_get(arena, sizeof *s);
    hn_status status = HN_ERR_MEMORY;
    HN_ASSERT(!opts->at_end || col->stages == 1);
    if (s) {
        *s = (implicit_dae){.sys = sys,
                            .form = form,
                            .opts = *opts,
                            .nq = info.nq,
                            .nv = info.nv,
                            .nc = info.nc,
                            .is_driven = has_driven_loop(sys)};
        const hn_stage_equations eq = {.self = s,
                                       .n_diff = 2 * info.nv,
                                       .n_alg = (form == HN_FORM_GGL ? 2 : 1) * info.nc,
                                       .residual = residual,
                                       .factor = factor,
                                       .relinearise = relinearise,
                                       .solve = solve};
        *self = s;
        status = allocate(s, col, arena);
        HN_THEN(status, hn_stages_init(&s->st, col, &eq, arena));
        if (status == HN_OK) {
            s->weight = opts->rtol > 0 ? hn_collocation_estimate_weight(opts->rtol) : 1;
            s->st.tol = opts->rtol > 0 ? hn_collocation_newton_share(opts->rtol) : 0;
            status = create_terms(s, arena);
        }
    }
    return status == HN_OK ? status
                           : hn_diag_set(diag, status, NULL, NULL,
                                         "the derivatives of the equations cannot be compiled: %s",
                                         hn_status_text(status));
}

void hn_implicit_dae_destroy(void *self) {
    implicit_dae *s = self;
    hn_implicit_linear_free(&s->lin);
    hn_linear_free(s->at_stage);
    hn_accel_free(s->accel);
    hn_projector_free(s->projector);
    s->at_stage = NULL;
    s->accel = NULL;
    s->projector = NULL;
}

hn_status hn_implicit_dae_start(void *self, double t, const double *y) {
    implicit_dae *s = self;
    s->h = s->last_h = 0;
    s->why[0] = '\0';
    hn_tolerance_units(s->sys, !s->opts.default_atol, y + s->nq, s->unit);
    const hn_status status =
        hn_accel_eval(s->accel, t, y, y + s->nq, 0, 0, s->a_start, s->lambda_start, NULL);
    s->accelerations++;
    if (status != HN_OK) {
        const char *refusal = hn_accel_refusal(s->accel);
        snprintf(s->why, sizeof s->why, "accelerations to begin from at t = %.6g s: %s", t,
                 refusal ? refusal : hn_status_text(status));
        return status;
    }
    memcpy(s->raw, s->lambda_start, (size_t)s->nc * sizeof *s->raw);
    return HN_OK;
}

// ---- one step ----

static hn_tolerance tolerance_of(const implicit_dae *s) {
    return (hn_tolerance){s->opts.rtol, s->opts.atol, s->unit, hn_system_angles(s->sys), s->nq};
}

static void set_scale(implicit_dae *s, double h) {
    const hn_tolerance tol = tolerance_of(s);
    const double size_q = 1 + hn_norm_max(s->nq, s->q0), size_v = 1 + hn_norm_max(s->nv, s->v0);
    double *scale = s->st.scale;
    // phi cannot be closed better than its own rounding, which stands divided by h in the speeds
    s->st.floor = s->opts.rtol > 0 ? 0 : ROUNDING + 2 * DBL_EPSILON * size_q / (h * size_v);
    for (int i = 0; i < s->nv; i++) {
        const int at = hn_system_position_of(s->sys, i);
        const int chosen = s->opts.rtol > 0;
        const double allowed =
            at >= 0 ? hn_tolerance_of(&tol, at, s->q0[at], s->q0[at]) : tol.atol + tol.rtol;
        scale[i] = chosen ? allowed / s->weight : size_q;
        scale[s->nv + i] =
            chosen ? hn_tolerance_of(&tol, s->nq + i, s->v0[i], s->v0[i]) / s->weight : size_v;
    }
}

// accelerations and multipliers of the last step's stages, continued and integrated; at first those
// of the start
static void guess_stages(implicit_dae *s, double h) {
    const hn_collocation *col = &s->st.col;
    const int stages = col->stages, nv = s->nv, nc = s->nc, n = s->st.n;

    double l[HN_IMPLICIT_STAGES], *a = s->st.rate; // stages x nv

    // accelerations and multipliers: of the last step extrapolated, or of its start
    for (int i = 0; i < stages; i++) {
        double *lambda = s->st.u + i * n + 2 * nv;
        memset(s->st.u + i * n, 0, (size_t)n * sizeof *s->st.u);
        memcpy(lambda, s->lambda_start, (size_t)nc * sizeof *lambda);
        memcpy(a + i * nv, s->a_start, (size_t)nv * sizeof *a);
        if (s->last_h > 0) {
            hn_collocation_basis(col, 1 + col->c[i] * h / s->last_h, l);
            memset(a + i * nv, 0, (size_t)nv * sizeof *a);
            for (int j = 0; j < stages; j++) {
                hn_axpy(nv, l[j], s->last_a + j * nv, a + i * nv);
            }
            for (int k = 0; k < s->lin.n_kept; k++) {
                const int row = s->lin.kept[k];
                lambda[row] = 0;
                for (int j = 0; j < stages; j++) {
                    lambda[row] += l[j] * s->last_lambda[j * nc + row];
                }
            }
        }
    }

    // velocities by the tableau
    for (int i = 0; i < stages; i++) {
        double *x = s->st.u + i * n, *w = x + nv;
        for (int j = 0; j < stages; j++) {
            hn_axpy(nv, h * col->A[i][j], a + j * nv, w);
        }
    }

    // positions by the tableau, once all velocities are known
    for (int i = 0; i < stages; i++) {
        double *x = s->st.u + i * n;
        hn_axpy(nv, h * col->c[i], s->v0, x);
        for (int j = 0; j < stages; j++) {
            hn_axpy(nv, h * col->A[i][j], s->st.u + j * n + nv, x);
        }
    }
}

static void weigh_for_error(const implicit_dae *s, double h, int part, double *out) {
    const hn_collocation *col = &s->st.col;
    memset(out, 0, (size_t)s->nv * sizeof *out);
    for (int i = 0; i < col->stages; i++) {
        hn_axpy(s->nv, col->e[i] / h, s->st.u + i * s->st.n + part * s->nv, out);
    }
}

// the estimate as displacement (nv) and change of speed (nv) into s->st.parts, from slope v and
// force at a point
static void filter_error(implicit_dae *s, const double *v, const double *force, const double *ex,
                         const double *ew) {
    const int nv = s->nv;
    double *r = s->st.parts;
    memset(r, 0, (size_t)s->st.n * sizeof *r);
    hn_linear_apply(s->lin.terms, HN_LINEAR_M, ew, r + nv);
    for (int i = 0; i < nv; i++) {
        r[i] = -(v[i] + ex[i]);
        r[nv + i] = -(r[nv + i] + force[i]);
    }
    hn_implicit_linear_solve(&s->lin, (hn_parts){1, {r, NULL}});
}

// Across the constraints, speeds of index 3 are what positions of index 2 are: their error enters
// the next step times h. Along them they are integrated like those of any other form.
static double factor_across(const implicit_dae *s, double h) {
    return s->form == HN_FORM_INDEX3 ? fmin(h, 1) : 1;
}

// The part of a change of speeds dv (nv) that the constraints allow, into `along`. Projection gives
// it but for what the loops that move from outside ask for, which is taken off. All of dv where it
// fails: the error is then not called smaller than it may be.
static void take_along(implicit_dae *s, double t, const double *dv, double *along, double *moved) {
    const size_t size = (size_t)s->nv * sizeof *dv;
    memcpy(along, dv, size);
    memset(moved, 0, size);
    if (hn_project_velocity(s->projector, t, s->q0, along, NULL) != HN_OK ||
        (s->is_driven && hn_project_velocity(s->projector, t, s->q0, moved, NULL) != HN_OK)) {
        memcpy(along, dv, size);
        return;
    }
    hn_axpy(s->nv, -1, moved, along);
}

// in terms of y
static void put_error(implicit_dae *s, double t, double h, double *err) {
    const double *r = s->st.parts, *dv = r + s->nv, across = factor_across(s, h);
    double *along = s->v;
    hn_system_kinematics(s->sys, s->q0, r, err);
    for (int i = 0; i < s->nq; i++) {
        err[i] *= s->weight;
    }
    if (across < 1) {
        take_along(s, t, dv, along, s->x);
    } else {
        memcpy(along, dv, (size_t)s->nv * sizeof *dv);
    }
    for (int i = 0; i < s->nv; i++) {
        err[s->nq + i] = s->weight * (along[i] + across * (dv[i] - along[i]));
    }
}

// see hn_collocation.e; a second pass at y0 + err where the first is above the tolerance keeps
// stiff starts from failing
static void estimate_error(implicit_dae *s, double t, double h, const double *y,
                           const double *y_new, double *err) {
    const int n = s->nq + s->nv;
    double *ex = s->st.r, *ew = s->st.r + s->nv;
    weigh_for_error(s, h, 0, ex);
    weigh_for_error(s, h, 1, ew);
    filter_error(s, s->v0, s->force, ex, ew);
    put_error(s, t, h, err);
    const hn_tolerance tol = tolerance_of(s);
    if (hn_error_norm(n, err, y, y_new, &tol) < 1) {
        return;
    }
    place(s, s->st.parts, 1);
    hn_linear_run(s->at_stage, t, s->q, s->v, NULL, s->lambda_start);
    for (int i = 0; i < s->nv; i++) {
        s->x[i] = -s->R[i];
    }
    filter_error(s, s->v, s->x, ex, ew);
    put_error(s, t, h, err);
}

// The estimate is a motion that the loops allow. If they are moved from outside it sees nothing
// of how fast: what shows that is how far the polynomial through the stages leaves them between the
// stages: what it takes to close them there counts as well.
static void add_gap_between(implicit_dae *s, double t, double h, double *err) {
    const double between = 0.85; // where that polynomial's error of interpolation is about largest
    const int nv = s->nv;
    double *r = s->st.parts, *rates = s->st.r, *dq = s->st.r + nv;
    hn_stages_dense(&s->st, between, r);
    place(s, r, 1);
    hn_linear_run(s->at_stage, t + between * h, s->q, s->v, NULL, NULL);
    memset(r, 0, (size_t)s->st.n * sizeof *r);
    put_constraints(s, 1, r + 2 * nv);
    hn_implicit_linear_solve(&s->lin, (hn_parts){1, {r, NULL}});
    memcpy(rates, r, (size_t)nv * sizeof *r);
    hn_system_kinematics(s->sys, s->q0, rates, dq);
    for (int i = 0; i < s->nq; i++) {
        err[i] = fmax(fabs(err[i]), s->weight * fabs(dq[i]));
    }
    for (int i = 0; i < nv; i++) {
        const double speed = s->weight * factor_across(s, h) * fabs(r[nv + i]);
        err[s->nq + i] = fmax(fabs(err[s->nq + i]), speed);
    }
}

// what Newton's tolerance leaves, what rows that were left out need, and what index 2 leaves open
// on request
static hn_status close_end(implicit_dae *s, double t, double *q, double *v) {
    hn_status status = HN_OK;
    const int dependent = s->lin.n_kept < s->nc;
    const int closes =
        s->form == HN_FORM_INDEX2 && hn_dae_closes(s->opts.close, s->accepted + 1, dependent);
    if (s->nc == 0 || (!(s->opts.rtol > 0) && !dependent && !closes && !s->opts.projects)) {
        return HN_OK;
    }
    if (wants_phi(s->form) || closes) {
        status = hn_project_position(s->projector, t, q, CLOSED, NULL);
    }
    if (status == HN_OK && (wants_speed_gap(s->form) || s->opts.projects)) {
        status = hn_project_velocity(s->projector, t, q, v, NULL);
    }
    if (status != HN_OK) {
        snprintf(s->why, sizeof s->why, "closing the end of the step at t = %.6g s: %s", t,
                 hn_status_text(status));
    }
    return status;
}

// Index 2 lets the gap open, and rows that depend on others do so only at a closed pose: where a
// row is in doubt the pose is closed for the choice, and for that alone.
static void choose_rows(implicit_dae *s, double t) {
    const double pivot = hn_implicit_linear_choose(&s->lin, t, s->q0, s->v0);
    if (s->form != HN_FORM_INDEX2 || pivot > NEARLY_DEPENDENT) {
        return;
    }
    memcpy(s->q, s->q0, (size_t)s->nq * sizeof *s->q);
    if (hn_project_position(s->projector, t, s->q, CLOSED, NULL) == HN_OK) {
        hn_implicit_linear_choose(&s->lin, t, s->q, s->v0);
    }
}

static hn_status begin(implicit_dae *s, double t, const double *y) {
    memcpy(s->q0, y, (size_t)s->nq * sizeof *y);
    memcpy(s->v0, y + s->nq, (size_t)s->nv * sizeof *y);
    choose_rows(s, t);
    const hn_status status =
        hn_implicit_linear_at(&s->lin, t, s->q0, s->v0, s->a_start, s->lambda_start);
    if (status != HN_OK) {
        if (s->form == HN_FORM_GGL && status != HN_ERR_DIVERGED) {
            hn_dae_tell_massless(s->sys, s->lin.diagonal, 1, t, s->why, sizeof s->why);
            return HN_ERR_MASS;
        }
        snprintf(s->why, sizeof s->why, "the equations at t = %.6g s: %s", t,
                 hn_status_text(status));
        return status;
    }
    const double *R = hn_linear_get(s->lin.terms, HN_LINEAR_RESIDUAL);
    hn_linear_apply(s->lin.terms, HN_LINEAR_M, s->a_start, s->force);
    hn_axpy(s->nv, -1, R, s->force);
    return HN_OK;
}

hn_status hn_implicit_dae_step(void *self, double t, double h, const double *y, double *y_new,
                               double *err) {
    implicit_dae *s = self;
    s->h = h;
    s->why[0] = '\0';
    HN_TRY(begin(s, t, y));

    // scale of the error norm, and stages from the last step
    set_scale(s, h);
    guess_stages(s, h);
    hn_status status = hn_stages_solve(&s->st, t, h);
    if (status != HN_OK) {
        snprintf(s->why, sizeof s->why, "%s", s->st.why);
        return status;
    }

    // the end of the step by the stages, then its constraints
    double *end = s->st.parts;
    hn_stages_end(&s->st, end);
    place(s, end, 1);
    memcpy(y_new, s->q, (size_t)s->nq * sizeof *y);
    memcpy(y_new + s->nq, s->v, (size_t)s->nv * sizeof *y);
    status = close_end(s, t + h, y_new, y_new + s->nq);

    if (status == HN_OK && err && s->opts.rtol > 0) {
        estimate_error(s, t, h, y, y_new, err);
        if (s->is_driven) {
            add_gap_between(s, t, h, err);
        }
    }
    return status;
}

void hn_implicit_dae_accepted(void *self, int changed) {
    implicit_dae *s = self;
    const int stages = s->st.col.stages, nv = s->nv, nc = s->nc;
    (void)changed; // what is carried over is a first guess and where derivatives are taken
    if (!(s->h > 0)) {
        return;
    }
    s->accepted++;
    for (int i = 0; i < stages; i++) {
        memcpy(s->last_a + i * nv, s->st.rate + (2 * i + 1) * nv, (size_t)nv * sizeof(double));
        memcpy(s->last_lambda + i * nc, s->st.u + i * s->st.n + 2 * nv,
               (size_t)nc * sizeof(double));
    }
    memcpy(s->a_start, s->last_a + (stages - 1) * nv, (size_t)nv * sizeof(double));
    memcpy(s->lambda_start, s->last_lambda + (stages - 1) * nc, (size_t)nc * sizeof(double));
    memcpy(s->raw, s->lambda_start, (size_t)nc * sizeof(double));
    s->last_h = s->h;
    s->h = 0;
}

void hn_implicit_dae_dense(void *self, double theta, double *y) {
    implicit_dae *s = self;
    double *z = s->st.parts;
    hn_stages_dense(&s->st, theta, z);
    place(s, z, 1);
    memcpy(y, s->q, (size_t)s->nq * sizeof *y);
    memcpy(y + s->nq, s->v, (size_t)s->nv * sizeof *y);
}

const double *hn_implicit_dae_raw_lambda(const void *self) {
    const implicit_dae *s = self;
    return s->raw;
}

void hn_implicit_dae_add_cost(const void *self, hn_cost *cost) {
    const implicit_dae *s = self;
    cost->evals += hn_linear_count(s->at_stage) + s->accelerations;
    cost->factorisations += s->st.factorisations;
    cost->solves += s->st.solves;
    cost->newton += s->st.iterations;
    cost->ops += (double)hn_linear_count(s->at_stage) * hn_linear_ops(s->at_stage) +
                 hn_implicit_linear_ops(&s->lin);
    if (s->projector) {
        cost->evals += hn_projector_evals(s->projector);
        cost->ops += hn_projector_ops(s->projector);
    }
}

const char *hn_implicit_dae_why(const void *self) {
    const implicit_dae *s = self;
    return s->why[0] ? s->why : NULL;
}
