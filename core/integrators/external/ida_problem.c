// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/ida_problem.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/flops.h"
#include "integrators/step/control.h"
#include "linalg/dense.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// a row of J shorter than this beside the others, once they are taken out of it, depends on
// them
#define ROW_RANK 1e-10
// of the independence of the best rows: with less, rows are chosen anew. Each choice hands on the
// gap of the rows left out, up to its inverse times as large; with 0.1 a Bennett loop tears in 2 s
#define WORSE_ROWS 0.6

static bool has_mu(const hn_ida_problem *p) {
    return p->form == HN_FORM_GGL;
}

static bool is_stabilised(const hn_ida_problem *p) {
    return p->form == HN_FORM_STABILISED;
}

static unsigned terms_of(hn_dae_form form) {
    const unsigned always = HN_TERM_M | HN_TERM_F | HN_TERM_J;
    static const unsigned constraints[HN_FORM_COUNT] = {
        [HN_FORM_INDEX1] = HN_TERM_GAMMA | HN_TERM_PHI_T,
        [HN_FORM_STABILISED] = HN_TERM_GAMMA | HN_TERM_PHI_T | HN_TERM_PHI,
        [HN_FORM_INDEX2] = HN_TERM_PHI_T,
        [HN_FORM_INDEX3] = HN_TERM_PHI,
        [HN_FORM_GGL] = HN_TERM_PHI_T | HN_TERM_PHI,
    };
    return always | constraints[form];
}

static hn_status create_memory(hn_ida_problem *p, hn_arena *arena) {
    const size_t nv = (size_t)p->nv, nc = (size_t)p->nc;
    p->a = hn_arena_doubles(arena, nv);
    p->lambda = hn_arena_doubles(arena, nc);
    p->work = hn_arena_doubles(arena, nv > nc ? nv : nc);
    p->slope = hn_arena_doubles(arena, 3 * ((size_t)p->nq + nv));
    p->unit = hn_arena_doubles(arena, nv);
    p->kept = hn_arena_ints(arena, nc);
    p->place = hn_arena_ints(arena, nc);
    if (hn_arena_failed(arena) || !hn_qr_init(&p->qr, arena, p->nv, p->nc)) {
        return HN_ERR_MEMORY;
    }
    hn_coordinate_units(p->sys, p->unit);
    const hn_accel_opts opts = {.baumgarte = is_stabilised(p), .want_lambda = 1};
    HN_TRY(hn_eval_create(p->sys, terms_of(p->form), arena, &p->eval));
    p->n_M = hn_eval_pattern(p->eval, HN_TERM_M, &p->M_row, &p->M_col);
    p->n_J = hn_eval_pattern(p->eval, HN_TERM_J, &p->J_row, &p->J_col);
    return hn_accel_create(p->sys, &opts, arena, &p->accel);
}

hn_status hn_ida_problem_init(hn_ida_problem *p, const hn_system *sys, hn_dae_form form,
                              const double *form_options, hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    *p = (hn_ida_problem){.sys = sys, .form = form, .nq = info.nq, .nv = info.nv, .nc = info.nc};
    if (is_stabilised(p) && form_options[HN_STABILISED_RULE] == HN_BAUMGARTE_AUTO) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "rule=given with alpha and beta",
                           "rule=auto needs an integrator of the ordinary differential equation, "
                           "whose steps it follows; ida needs alpha and beta as numbers");
    }
    if (is_stabilised(p)) {
        p->alpha = form_options[HN_STABILISED_ALPHA];
        p->beta = form_options[HN_STABILISED_BETA];
    }
    if (has_mu(p) && p->nq != p->nv) {
        return hn_diag_set(
            diag, HN_ERR_UNSUPPORTED, NULL, "index2@ida solves it",
            "ida solves ggl only where every coordinate has its own velocity; the orientation of a "
            "spherical or free joint has four coordinates and three velocities");
    }
    const hn_status status = create_memory(p, arena);
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
}

void hn_ida_problem_free(hn_ida_problem *p) {
    hn_eval_free(p->eval);
    hn_accel_free(p->accel);
}

int hn_ida_problem_room(const hn_ida_problem *p) {
    return p->nq + p->nv + (has_mu(p) ? 2 : 1) * p->nc;
}

// row k of the matrix that is to be factored: a row of J in units of the coordinates
static void put_row(hn_ida_problem *p, int k, const double *row) {
    for (int j = 0; j < p->nv; j++) {
        p->qr.a[(size_t)k * (size_t)p->nv + (size_t)j] = row[j] * p->unit[j];
    }
}

static void put_rows(hn_ida_problem *p, const double *J) {
    for (int row = 0; row < p->nc; row++) {
        put_row(p, row, J + (size_t)row * (size_t)p->nv);
    }
}

static void in_units(const hn_ida_problem *p, double *x) {
    for (int j = 0; j < p->nv; j++) {
        x[j] *= p->unit[j];
    }
}

// The first columns of the pivoted QR of J' are rows that span all of them; J' lambda = b with
// those alone.
static void keep_independent_rows(hn_ida_problem *p, const double *J) {
    put_rows(p, J);
    hn_qr_factor(&p->qr, p->nv, p->nc, ROW_RANK);
    if (p->most_kept > 0 && p->qr.rank > p->most_kept) {
        p->qr.rank = p->most_kept; // R of the first columns is that of the whole
    }
    p->n_kept = 0;
    for (int row = 0; row < p->nc; row++) {
        p->place[row] = -1;
        for (int k = 0; k < p->qr.rank; k++) {
            if (p->qr.perm[k] == row) {
                p->place[row] = p->n_kept;
                p->kept[p->n_kept++] = row;
            }
        }
    }
    p->n = p->nq + p->nv + (has_mu(p) ? 2 : 1) * p->n_kept;
}

bool hn_ida_problem_rows_hold(hn_ida_problem *p, double t, const double *state) {
    if (p->n_kept == p->nc || p->n_kept == 0) {
        return true;
    }
    hn_eval_run(p->eval, t, state, state + p->nq);
    const double *J = hn_eval_get(p->eval, HN_TERM_J);
    const size_t nv = (size_t)p->nv;

    // the same number of rows, the best ones
    put_rows(p, J);
    hn_qr_factor(&p->qr, p->nv, p->nc, ROW_RANK);
    if (p->qr.rank < p->n_kept) {
        return true; // a singular pose: there is no better choice
    }
    p->qr.rank = p->n_kept;
    const double best = hn_qr_pivot_ratio(&p->qr);

    // those that are kept
    for (int k = 0; k < p->n_kept; k++) {
        put_row(p, k, J + (size_t)p->kept[k] * nv);
    }
    hn_qr_factor(&p->qr, p->nv, p->n_kept, ROW_RANK);
    return p->qr.rank == p->n_kept && hn_qr_pivot_ratio(&p->qr) > WORSE_ROWS * best;
}

// lambda of the kept rows from M a - f = J' lambda; needs the factors of keep_independent_rows()
static void solve_multipliers(hn_ida_problem *p) {
    const double *M = hn_eval_get(p->eval, HN_TERM_M), *f = hn_eval_get(p->eval, HN_TERM_F);
    hn_mat_vec(p->nv, p->nv, M, p->a, p->work);
    hn_axpy(p->nv, -1, f, p->work);
    in_units(p, p->work);
    hn_qr_apply_qt(&p->qr, p->work);
    hn_qr_solve_r(&p->qr, p->work);
    memset(p->lambda, 0, (size_t)p->nc * sizeof *p->lambda);
    for (int k = 0; k < p->qr.rank; k++) {
        p->lambda[p->qr.perm[k]] = p->work[k];
    }
}

// Rows that are new hold to the tolerance only. At index 2 they would make velocities jump in the
// first step, and at index 1 the loop would open from then on as fast as they are violated.
static void close_velocity(hn_ida_problem *p, double *v) {
    const double *J = hn_eval_get(p->eval, HN_TERM_J), *phi_t = hn_eval_get(p->eval, HN_TERM_PHI_T);
    hn_mat_vec(p->nc, p->nv, J, v, p->lambda);
    hn_axpy(p->nc, 1, phi_t, p->lambda);
    hn_qr_least_norm(&p->qr, p->lambda, p->work);
    in_units(p, p->work);
    hn_axpy(p->nv, -1, p->work, v);
}

hn_status hn_ida_problem_start(hn_ida_problem *p, double t, const double *state, double *y,
                               double *ydot) {
    const size_t room = (size_t)hn_ida_problem_room(p);
    const double *q = y, *v = y + p->nq;
    hn_accel_info info = {0};
    memset(y, 0, room * sizeof *y);
    memset(ydot, 0, room * sizeof *ydot);
    memcpy(y, state, (size_t)(p->nq + p->nv) * sizeof *y);
    hn_eval_run(p->eval, t, q, v);
    keep_independent_rows(p, hn_eval_get(p->eval, HN_TERM_J));
    const bool has_free_positions = p->form != HN_FORM_GGL && p->form != HN_FORM_INDEX3;
    if (p->most_kept > 0 && has_free_positions) {
        close_velocity(p, y + p->nq);
        hn_eval_run(p->eval, t, q, v);
    }
    HN_TRY(hn_accel_eval(p->accel, t, q, v, p->alpha, p->beta, p->a, p->lambda, &info));
    if (p->n_kept < p->nc) {
        solve_multipliers(p);
    }
    hn_system_kinematics(p->sys, q, v, ydot);
    memcpy(ydot + p->nq, p->a, (size_t)p->nv * sizeof *ydot);
    for (int k = 0; k < p->n_kept; k++) {
        y[p->nq + p->nv + k] = p->lambda[p->kept[k]];
    }
    return HN_OK;
}

static hn_status slope(void *self, double t, const double *y, double *ydot) {
    hn_ida_problem *p = self;
    hn_accel_info info = {0};
    hn_system_kinematics(p->sys, y, y + p->nq, ydot);
    return hn_accel_eval(p->accel, t, y, y + p->nq, p->alpha, p->beta, ydot + p->nq, p->lambda,
                         &info);
}

// [s] The velocity of a first step is a difference of positions over h. Below this step their
// rounding alone is more than the tolerance of the velocity, and the error test turns down noise.
static double least_first_step(const hn_ida_problem *p, const double *state, double rtol,
                               double atol, const double *unit) {
    static const double ROUNDING = 4 * DBL_EPSILON; // of two positions and of what is solved for
    // at index 3 velocities are differences of positions, and the corrector has to find them to a
    // share of the tolerance
    const double exact = p->form == HN_FORM_INDEX3 ? 30 : 1;
    const double *v = state + p->nq;
    double least = 0;
    for (int i = 0; i < p->nv; i++) {
        const int at = hn_system_position_of(p->sys, i);
        if (at >= 0) {
            const double tolerance = atol * unit[p->nq + i] + rtol * fabs(v[i]);
            least = fmax(least, exact * ROUNDING * fabs(state[at]) / tolerance);
        }
    }
    return least;
}

hn_status hn_ida_problem_first_step(hn_ida_problem *p, double t, const double *state, double rtol,
                                    double atol, const double *unit, double hmax, double *h) {
    enum { ERROR_POWER = 2 }; // of h in the error of a step of order 1
    const size_t n = (size_t)(p->nq + p->nv);
    const hn_ode ode = {.n_pos = p->nq,
                        .n_vel = p->nv,
                        .self = p,
                        .rhs = slope,
                        .unit = unit,
                        .is_angle = hn_system_angles(p->sys)};
    HN_TRY(hn_first_step(&ode, t, state, ERROR_POWER, rtol, atol, hmax, p->slope, p->slope + n,
                         p->slope + 2 * n, h));
    *h = fmin(fmax(*h, least_first_step(p, state, rtol, atol, unit)), hmax);
    return HN_OK;
}

void hn_ida_problem_units(const hn_ida_problem *p, const double *v, bool is_chosen, double *unit) {
    const double *M = is_chosen ? NULL : hn_eval_get(p->eval, HN_TERM_M);
    const hn_force_units of = hn_tolerance_forces(p->sys, M, v);
    for (int k = 0; k < p->n_kept; k++) {
        unit[k] = hn_system_row_is_length(p->sys, p->kept[k]) ? of.force : of.moment;
        if (has_mu(p)) {
            unit[p->n_kept + k] = unit[k] / of.rate; // an impulse
        }
    }
}

// r -= J' x over the kept rows
static void subtract_reaction(const hn_ida_problem *p, const double *J, const double *x,
                              double *r) {
    for (int e = 0; e < p->n_J; e++) {
        const int row = p->J_row[e], col = p->J_col[e];
        if (p->place[row] >= 0) {
            r[col] -= x[p->place[row]] * J[(size_t)row * (size_t)p->nv + (size_t)col];
        }
    }
}

// r (nv) = M x
static void multiply_mass(const hn_ida_problem *p, const double *x, double *r) {
    const double *M = hn_eval_get(p->eval, HN_TERM_M);
    memset(r, 0, (size_t)p->nv * sizeof *r);
    for (int e = 0; e < p->n_M; e++) {
        const int i = p->M_row[e], k = p->M_col[e];
        const double m = M[(size_t)i * (size_t)p->nv + (size_t)k];
        r[i] += m * x[k];
        r[k] += i != k ? m * x[i] : 0;
    }
}

// r += k J x over the kept rows
static void add_rows(const hn_ida_problem *p, double k, const double *x, double *r) {
    const double *J = hn_eval_get(p->eval, HN_TERM_J);
    for (int e = 0; e < p->n_J; e++) {
        const int row = p->J_row[e], col = p->J_col[e];
        if (p->place[row] >= 0) {
            r[p->place[row]] += k * J[(size_t)row * (size_t)p->nv + (size_t)col] * x[col];
        }
    }
}

// eq. (1)
static void put_kinematics(hn_ida_problem *p, const double *y, const double *ydot, double *r) {
    const double *v = y + p->nq;
    if (!has_mu(p)) {
        hn_system_kinematics(p->sys, y, v, r);
        for (int i = 0; i < p->nq; i++) {
            r[i] = ydot[i] - r[i];
        }
        return;
    }
    for (int i = 0; i < p->nv; i++) {
        p->work[i] = ydot[i] - v[i];
    }
    multiply_mass(p, p->work, r);
    subtract_reaction(p, hn_eval_get(p->eval, HN_TERM_J), v + p->nv + p->n_kept, r);
}

// r += k (J v + phi_t) over the kept rows
static void add_speed_gap(const hn_ida_problem *p, double k, const double *v, double *r) {
    const double *phi_t = hn_eval_get(p->eval, HN_TERM_PHI_T);
    add_rows(p, k, v, r);
    for (int i = 0; i < p->n_kept; i++) {
        r[i] += k * phi_t[p->kept[i]];
    }
}

static void add_kept(const hn_ida_problem *p, double k, hn_term term, double *r) {
    const double *x = hn_eval_get(p->eval, term);
    for (int i = 0; i < p->n_kept; i++) {
        r[i] += k * x[p->kept[i]];
    }
}

// eq. (3)
static void put_constraints(const hn_ida_problem *p, const double *v, const double *a, double *r) {
    memset(r, 0, (size_t)((has_mu(p) ? 2 : 1) * p->n_kept) * sizeof *r);
    if (p->form == HN_FORM_INDEX3) {
        add_kept(p, 1, HN_TERM_PHI, r);
    } else if (p->form == HN_FORM_INDEX1 || is_stabilised(p)) {
        add_rows(p, 1, a, r);
        add_kept(p, 1, HN_TERM_GAMMA, r);
    } else {
        add_speed_gap(p, 1, v, r);
    }
    if (is_stabilised(p)) {
        add_speed_gap(p, 2 * p->alpha, v, r);
        add_kept(p, p->beta * p->beta, HN_TERM_PHI, r);
    }
    if (has_mu(p)) {
        add_kept(p, 1, HN_TERM_PHI, r + p->n_kept);
    }
}

void hn_ida_problem_residual(hn_ida_problem *p, double t, const double *y, const double *ydot,
                             double *r) {
    const double *v = y + p->nq, *a = ydot + p->nq, *lambda = v + p->nv;
    double *const dynamics = r + p->nq;
    hn_eval_run(p->eval, t, y, v);
    p->residuals++;
    put_kinematics(p, y, ydot, r);
    multiply_mass(p, a, dynamics);
    hn_axpy(p->nv, -1, hn_eval_get(p->eval, HN_TERM_F), dynamics);
    subtract_reaction(p, hn_eval_get(p->eval, HN_TERM_J), lambda, dynamics);
    put_constraints(p, v, a, dynamics + p->nv);
}

void hn_ida_problem_lambda(const hn_ida_problem *p, const double *y, double *lambda) {
    memset(lambda, 0, (size_t)p->nc * sizeof *lambda);
    for (int k = 0; k < p->n_kept; k++) {
        lambda[p->kept[k]] = y[p->nq + p->nv + k];
    }
}

double hn_ida_problem_ops(const hn_ida_problem *p) {
    const double mass = 4.0 * p->n_M, rows = 2.0 * p->n_J;
    return hn_eval_info(p->eval).ops + (has_mu(p) ? 2 : 1) * (mass + rows) +
           (is_stabilised(p) ? 2 : 1) * rows;
}
