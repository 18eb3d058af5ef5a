// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/project.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/system_impl.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "dynamics/evaluate/row_groups.h"
#include "expr/construct.h"
#include "expr/tape.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_ITERATIONS = 8, MAX_VELOCITY_ITERATIONS = 5 };
// Position: a frozen factor that contracts less than this is made again. The reason is not time
// (0.1 would do): a frozen J shifts the landing point along the constraints by about this fraction
// of the move, and a run accumulates that bias.
static const double FROZEN_CONTRACTION = 1e-4;
static const double CONTRACTION = 0.1; // velocity: the problem is linear, only convergence counts
// a factor made this close (in any coordinate) is worth trying for the velocities
static const double NEAR = 1e-2;
// a step this small that gains nothing meets the rounding of phi itself, which grows with the
// extent of the mechanism
static const double STEP_ROUNDING = 1e-12;
static const double LOST_RANK_GAP = 1e-6; // lengths: what may stay open where J has lost rank
// of max unit_i |v_i| sqrt(nc), see find_speed_units: how far velocities are closed, and what will
// do where they close no further
static const double VELOCITY_TOL = 2e-16;
static const double VELOCITY_ROUNDING = 4e-15;
// The same where rows depend on each other. Such rows agree on the velocities no better than the
// positions are closed, which is to 1e-12 lengths where rounding allows no more: several turns of
// an angle, or a row that is a large multiple of another.
static const double DEPENDENT_ROUNDING = 1e-12;
// A direction in which J is weaker than this cannot be trusted to close anything: phi is quadratic
// there, and a step phi / sigma would be larger than the range in which J means something.
static const double PROJECTOR_RANK_TOL = 1e-7;
// and a dependent row that is short at this pose is not stretched: its direction would be rounding
static const double PROJECTOR_ROW_FLOOR = 0.05;

struct hn_projector {
    const hn_system *sys;
    hn_weight weight;
    int nq, nv, nc;
    double length;

    hn_tape *phi_tape, *gap_tape; // (q, v, t) -> phi; -> J v + phi_t
    double *in, *phi_work, *gap_work;
    hn_factor *factor;
    hn_eval *terms; // entries of M and J for the dense solve
    hn_saddle_ws *saddle;
    double *W, *J; // of the dense solve, filled where it is used: M or the identity, and J
    double *zero;  // nv

    int have_factor, dense, rank;
    double weakest; // of the factor: the smallest pivot of J that was kept against the largest
    double factor_t, *factor_q;

    double *speed_unit; // nv: what a velocity of 1 may do to J v

    double *gap, *step, *multiplier; // nc, nv, nc
    double *best, *impulse, *closed; // nv; nc: sums over a velocity projection

    long long evals, factorisations, fallbacks;
    double ops;
};

// ---- creation ----

/// Tapes of phi and of J v + phi_t, row by row over what is not zero.
static hn_status compile_tapes(hn_projector *p, hn_arena *arena) {
    hn_system_exprs ex = hn_system_get_exprs(p->sys);
    hn_graph *g = hn_system_graph(p->sys);
    int n_in = p->nq + p->nv + 1;
    int *symbols = hn_arena_ints(arena, (size_t)n_in);
    hn_ex *rows = hn_arena_get(arena, (size_t)p->nc * sizeof *rows);
    hn_ex *terms = hn_arena_get(arena, ((size_t)p->nv + 1) * sizeof *terms);
    if (!symbols || !rows || !terms) {
        return HN_ERR_MEMORY;
    }

    // inputs: q, v, t
    memcpy(symbols, ex.q_symbols, (size_t)p->nq * sizeof *symbols);
    memcpy(symbols + p->nq, ex.v_symbols, (size_t)p->nv * sizeof *symbols);
    symbols[n_in - 1] = ex.t_symbol;

    // rows of J v + phi_t
    for (int i = 0, at = 0; i < p->nc; i++) {
        int n = 0;
        terms[n++] = ex.phi_t[i];
        for (; at < p->sys->J.n && p->sys->J.at[at].row == i; at++) {
            const hn_entry *J = &p->sys->J.at[at];
            terms[n++] = hn_mul(g, J->e, hn_graph_symbol_expr(g, ex.v_symbols[J->col]));
        }
        rows[i] = hn_sum(g, terms, n);
    }
    HN_TRY(hn_graph_status(g));
    HN_TRY(hn_tape_compile(g, ex.phi, p->nc, symbols, n_in, &p->phi_tape));
    return hn_tape_compile(g, rows, p->nc, symbols, n_in, &p->gap_tape);
}

static hn_status create_solvers(hn_projector *p, hn_arena *arena) {
    int mass = p->weight == HN_WEIGHT_MASS;
    HN_TRY(hn_factor_create(p->sys, mass ? HN_FACTOR_MASS : HN_FACTOR_IDENTITY, arena, &p->factor));
    HN_TRY(
        hn_eval_create_listed(p->sys, mass ? HN_TERM_M | HN_TERM_J : HN_TERM_J, arena, &p->terms));
    p->J = hn_arena_doubles(arena, (size_t)p->nc * p->nv);
    p->W = hn_arena_doubles(arena, (size_t)p->nv * p->nv);
    p->saddle = hn_saddle_ws_create(arena, p->nv, p->nc);
    return p->saddle && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

/// Finds how much a velocity of 1 can change a row, at most. If all rows are lengths, an angular
/// velocity counts by the length, so that nothing depends on the size of the mechanism. Rows of a
/// scene of formulas have no unit; the length of such a scene is the arm by which angles move them,
/// so the same holds there.
static void find_speed_units(hn_projector *p) {
    const hn_scene *scene = hn_system_scene(p->sys);
    int only_lengths = 1;
    for (int i = 0; i < p->nc; i++) {
        only_lengths &= hn_system_row_is_length(p->sys, i);
    }
    for (int i = 0; i < p->nv; i++) {
        const hn_unit_kind kind = scene->coordinates[hn_system_user_coordinate(p->sys, i)].kind;
        p->speed_unit[i] = 1 + p->length;
        if (scene->is_lagrangian && kind == HN_ANGLE) {
            p->speed_unit[i] = p->length;
        } else if (only_lengths && kind != HN_OTHER) {
            p->speed_unit[i] = kind == HN_ANGLE ? p->length : 1;
        }
    }
}

static double size_of_speeds(const hn_projector *p, const double *v) {
    double most = 0;
    for (int i = 0; i < p->nv; i++) {
        most = fmax(most, p->speed_unit[i] * fabs(v[i]));
    }
    return most * sqrt(p->nc);
}

static hn_status create_parts(hn_projector *p, hn_arena *arena) {
    HN_TRY(compile_tapes(p, arena));
    HN_TRY(create_solvers(p, arena));

    // room for a state, and for what a projection goes through
    size_t nv = (size_t)p->nv, nc = (size_t)p->nc, nq = (size_t)p->nq;
    p->in = hn_arena_doubles(arena, nq + nv + 1);
    p->phi_work = hn_arena_doubles(arena, hn_tape_work_size(p->phi_tape));
    p->gap_work = hn_arena_doubles(arena, hn_tape_work_size(p->gap_tape));
    p->zero = hn_arena_doubles(arena, nv);
    p->factor_q = hn_arena_doubles(arena, nq);
    p->step = hn_arena_doubles(arena, nv);
    p->speed_unit = hn_arena_doubles(arena, nv);
    p->best = hn_arena_doubles(arena, nq > nv ? nq : nv);
    p->gap = hn_arena_doubles(arena, nc);
    p->multiplier = hn_arena_doubles(arena, nc);
    p->impulse = hn_arena_doubles(arena, nc);
    p->closed = hn_arena_doubles(arena, nc);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    find_speed_units(p);
    hn_tape_prepare(p->phi_tape, p->phi_work);
    hn_tape_prepare(p->gap_tape, p->gap_work);
    return HN_OK;
}

hn_status hn_projector_create(const hn_system *sys, hn_weight weight, hn_arena *arena,
                              hn_projector **out) {
    hn_system_info info = hn_system_get_info(sys);
    hn_projector *p = hn_arena_get(arena, sizeof *p);
    if (!p) {
        return HN_ERR_MEMORY;
    }
    *p = (hn_projector){.sys = sys,
                        .weight = weight,
                        .nq = info.nq,
                        .nv = info.nv,
                        .nc = info.nc,
                        .length = hn_system_length(sys)};
    hn_status status = create_parts(p, arena);
    if (status != HN_OK) {
        hn_projector_free(p);
        return status;
    }
    *out = p;
    return HN_OK;
}

void hn_projector_free(hn_projector *p) {
    if (p) {
        hn_tape_free(p->phi_tape);
        hn_tape_free(p->gap_tape);
        hn_factor_free(p->factor);
        hn_eval_free(p->terms);
        p->phi_tape = p->gap_tape = NULL;
        p->factor = NULL;
        p->terms = NULL;
    }
}

// ---- the two ways to solve K [x; -y] = [0; -gap] ----

/// Operations of one dense factorisation and of one solve with it and its refinement, to leading
/// order (linalg/saddle.h).
static double dense_factor_ops(const hn_projector *p) {
    double nv = p->nv, nc = p->nc;
    return 2 * nv * nc * nc + 4 * nv * nv * nc + nv * nv * nv / 3;
}

static double dense_solve_ops(const hn_projector *p) {
    double nv = p->nv, nc = p->nc;
    return 4 * nv * nv + 8 * nv * nc;
}

static hn_status factor_dense(hn_projector *p, double t, const double *q) {
    hn_saddle_opts opts = hn_saddle_opts_default();
    const int row_lost = hn_factor_row_ratio(p->factor) < HN_ROW_GUARD;
    opts.rank_tol = row_lost ? HN_ROW_RANK_TOL : PROJECTOR_RANK_TOL;
    opts.row_floor = row_lost ? 1 : PROJECTOR_ROW_FLOOR;
    opts.residual_tol = HUGE_VAL; // rows that cannot all be met are met as well as can be
    hn_eval_run(p->terms, t, q, p->zero);
    hn_eval_spread(p->terms, HN_TERM_J, p->J);
    if (p->weight == HN_WEIGHT_MASS) {
        hn_eval_spread(p->terms, HN_TERM_M, p->W);
    }
    for (int i = 0; i < p->nv && p->weight != HN_WEIGHT_MASS; i++) {
        p->W[(size_t)i * p->nv + i] = 1;
    }
    hn_saddle_info info = {0};
    hn_status status = hn_saddle_factor(p->nv, p->nc, p->W, p->J, &info, &opts, p->saddle);
    p->ops += hn_eval_info(p->terms).ops + dense_factor_ops(p);
    p->fallbacks++;
    p->dense = 1;
    p->rank = info.rank;
    p->weakest = info.pivot_ratio;
    return status;
}

/// `force_dense`: the sparse factor was tried and did not contract.
static hn_status make_factor(hn_projector *p, double t, const double *q, bool force_dense) {
    p->evals++;
    p->factorisations++;
    p->have_factor = 0;

    // the sparse factor, unless a row has all but vanished
    hn_status status = HN_ERR_SINGULAR;
    if (!force_dense) {
        status = hn_factor_update(p->factor, t, q, NULL);
        p->ops += hn_factor_get_info(p->factor).update_ops;
        if (status == HN_OK && hn_factor_row_ratio(p->factor) < HN_ROW_GUARD) {
            status = HN_ERR_SINGULAR; // a row that has all but vanished closes nothing
        }
        p->dense = 0;
        p->rank = p->nc;
        p->weakest = 1;
    }

    // else the dense one, which finds the rank
    if (status == HN_ERR_SINGULAR) {
        status = factor_dense(p, t, q);
    }

    if (status == HN_OK) {
        p->have_factor = 1;
        p->factor_t = t;
        memcpy(p->factor_q, q, (size_t)p->nq * sizeof *q);
    }
    return status;
}

/// step and multiplier such that J step = -gap.
static hn_status solve(hn_projector *p) {
    if (!p->dense) {
        for (int i = 0; i < p->nc; i++) {
            p->gap[i] = -p->gap[i];
        }
        hn_factor_solve(p->factor, NULL, p->gap, p->step, p->multiplier);
        p->ops += hn_factor_get_info(p->factor).solve_ops;
        return hn_all_finite(p->nv, p->step) ? HN_OK : HN_ERR_DIVERGED;
    }
    p->ops += dense_solve_ops(p);
    return hn_saddle_apply(p->zero, p->gap, p->step, p->multiplier, NULL, p->saddle);
}

// ---- position ----

static double eval_phi(hn_projector *p, double t, const double *q) {
    memcpy(p->in, q, (size_t)p->nq * sizeof *q);
    p->in[p->nq + p->nv] = t;
    hn_tape_eval(p->phi_tape, p->in, p->gap, p->phi_work);
    p->evals++;
    p->ops += hn_tape_get_info(p->phi_tape).ops + 2.0 * p->nc;
    return hn_norm2(p->nc, p->gap);
}

/// One step of the position iteration with the present factor, made at q when there is none.
static hn_status step_position(hn_projector *p, double t, double *q) {
    if (!p->have_factor) {
        HN_TRY(make_factor(p, t, q, 0));
    }
    HN_TRY(solve(p));
    hn_system_move(p->sys, q, p->step);
    p->ops += p->nq;
    return HN_OK;
}

/// Iterates from q in place until the gap is at most tol, or below `rounding` and no longer
/// shrinking, or what is left belongs to a lost direction.
static hn_status close_gap(hn_projector *p, double t, double *q, double tol, double rounding,
                           hn_project_info *info) {
    double gap = eval_phi(p, t, q);
    *info = (hn_project_info){.iterations = 1, .gap_before = gap, .gap = gap, .rank = p->nc};
    p->have_factor = 0;

    // a frozen factor serves while it contracts well
    while (gap > tol && isfinite(gap)) {
        if (info->iterations >= MAX_ITERATIONS) {
            return gap <= rounding ? HN_OK : HN_ERR_NO_CONVERGENCE;
        }

        int fresh = !p->have_factor;
        HN_TRY(step_position(p, t, q));
        double before = gap;
        gap = eval_phi(p, t, q);
        info->iterations++;
        info->rank = p->rank;

        // rounding: the better of the two last poses
        int nothing_moves =
            hn_norm_max(p->nv, p->step) <= STEP_ROUNDING * (1 + hn_norm_max(p->nq, q));
        if ((before <= rounding || nothing_moves) && gap > 0.5 * before) {
            if (gap > before) {
                for (int i = 0; i < p->nv; i++) {
                    p->step[i] = -p->step[i];
                }
                hn_system_move(p->sys, q, p->step);
            }
            info->gap = fmin(gap, before);
            return HN_OK;
        }

        info->gap = gap;

        // what is left belongs to a direction that J has lost
        if (fresh && p->dense && p->rank < p->nc && gap > fmax(rounding, 0.5 * before)) {
            int small = gap <= LOST_RANK_GAP * p->length && gap <= info->gap_before;
            return small ? HN_OK : HN_ERR_NO_CONVERGENCE;
        }

        // a factor that contracts too little is made again
        if (gap > rounding && gap > FROZEN_CONTRACTION * before) {
            p->have_factor = 0;
        }
    }
    return isfinite(gap) ? HN_OK : HN_ERR_DIVERGED;
}

hn_status hn_project_position(hn_projector *p, double t, double *q, double tol,
                              hn_project_info *info) {
    hn_project_info local;
    info = info ? info : &local;
    *info = (hn_project_info){.rank = p->nc};
    if (!hn_all_finite(p->nq, q)) {
        return HN_ERR_DIVERGED;
    }
    if (p->nc == 0) {
        return HN_OK;
    }
    double rounding = 4 * DBL_EPSILON * (1 + hn_norm_max(p->nq, q)) * p->length;
    memcpy(p->best, q, (size_t)p->nq * sizeof *q);
    hn_status status = close_gap(p, t, q, tol * p->length, rounding, info);
    if (status != HN_OK) {
        memcpy(q, p->best, (size_t)p->nq * sizeof *q);
    }
    return status;
}

// ---- velocity ----

static double eval_velocity_gap(hn_projector *p, double t, const double *q, const double *v) {
    memcpy(p->in, q, (size_t)p->nq * sizeof *q);
    memcpy(p->in + p->nq, v, (size_t)p->nv * sizeof *v);
    p->in[p->nq + p->nv] = t;
    hn_tape_eval(p->gap_tape, p->in, p->gap, p->gap_work);
    p->evals++;
    p->ops += hn_tape_get_info(p->gap_tape).ops + 2.0 * p->nc;
    return hn_norm2(p->nc, p->gap);
}

static bool factor_is_near(const hn_projector *p, double t, const double *q) {
    if (!p->have_factor || p->factor_t != t) {
        return false;
    }
    for (int i = 0; i < p->nq; i++) {
        if (fabs(q[i] - p->factor_q[i]) > NEAR) {
            return false;
        }
    }
    return true;
}

/// One correction of v; the sums for the energy follow. 1/2 dv' M dv = 1/2 (J dv)' y, as M dv = J'
/// y.
static hn_status correct_velocity(hn_projector *p, double *v) {
    HN_TRY(solve(p));
    hn_axpy(p->nv, 1, p->step, v);
    hn_axpy(p->nc, 1, p->multiplier, p->impulse);
    p->ops += p->nv + p->nc;
    return HN_OK;
}

/// Velocity gap that rounding leaves, for velocities of size 1. Positions are closed to rounding;
/// where rows depend on each other, that much in q makes them disagree by as much more as the
/// weakest direction of J is weaker than the strongest.
static double rounding_of_gap(const hn_projector *p) {
    const bool dependent = p->have_factor && p->dense && p->rank < p->nc;
    return dependent ? DEPENDENT_ROUNDING / p->weakest : VELOCITY_ROUNDING;
}

/// The problem is linear, so a fresh factor closes the gap at once and a near one does in two or
/// three rounds. A factor that does not contract is made again here, and then by the dense solve.
static hn_status close_velocity_gap(hn_projector *p, double t, const double *q, double *v,
                                    double scale, hn_project_info *info) {
    double gap = info->gap;
    int made_here = !factor_is_near(p, t, q);
    hn_status status = made_here ? make_factor(p, t, q, 0) : HN_OK;

    // correct until the gap is rounding
    while (status == HN_OK && gap > VELOCITY_TOL * scale &&
           info->iterations < MAX_VELOCITY_ITERATIONS) {
        status = correct_velocity(p, v);
        if (status != HN_OK) {
            break;
        }

        double before = gap;
        gap = eval_velocity_gap(p, t, q, v);
        info->iterations++;
        info->gap = gap;
        if (gap <= CONTRACTION * before) {
            continue;
        }

        // a factor that does not contract: made here, then dense
        if (gap <= VELOCITY_ROUNDING * scale || (p->dense && made_here)) {
            break; // rounding, or as good as it can be: what is left is outside the range of J
        }
        status = make_factor(p, t, q, made_here);
        made_here = 1;
    }

    if (status != HN_OK) {
        return status;
    }
    return isfinite(gap) ? HN_OK : HN_ERR_DIVERGED;
}

hn_status hn_project_velocity(hn_projector *p, double t, const double *q, double *v,
                              hn_project_info *info) {
    hn_project_info local;
    info = info ? info : &local;
    *info = (hn_project_info){.rank = p->nc};

    // nothing to close, or nothing that could be
    if (!hn_all_finite(p->nq, q) || !hn_all_finite(p->nv, v)) {
        return HN_ERR_DIVERGED;
    }
    if (p->nc == 0) {
        return HN_OK;
    }

    // the gap as it is
    double scale = size_of_speeds(p, v);
    info->iterations = 1;
    info->gap_before = info->gap = eval_velocity_gap(p, t, q, v);
    if (!isfinite(info->gap)) {
        return HN_ERR_DIVERGED;
    }

    // close it
    memcpy(p->closed, p->gap, (size_t)p->nc * sizeof *p->closed);
    memset(p->impulse, 0, (size_t)p->nc * sizeof *p->impulse);
    memcpy(p->best, v, (size_t)p->nv * sizeof *v);
    hn_status status = HN_OK;
    if (info->gap > VELOCITY_TOL * scale) {
        status = close_velocity_gap(p, t, q, v, scale, info);
    }

    if (status != HN_OK || info->gap > info->gap_before) {
        // no better than before: rounding if the gap was small already
        const bool rounding = status == HN_OK && info->gap_before <= rounding_of_gap(p) * scale;
        info->gap = info->gap_before;
        info->rank = p->have_factor ? p->rank : p->nc;
        memcpy(v, p->best, (size_t)p->nv * sizeof *v);
        return rounding ? HN_OK : (status != HN_OK ? status : HN_ERR_NO_CONVERGENCE);
    }

    // the energy of the correction: 1/2 dv' M dv = 1/2 (J dv)' y
    info->rank = p->have_factor ? p->rank : p->nc;
    if (p->weight == HN_WEIGHT_MASS) {
        hn_axpy(p->nc, -1, p->gap, p->closed);
        info->energy_removed = -0.5 * hn_dot(p->nc, p->closed, p->impulse);
    }
    return HN_OK;
}

long long hn_projector_evals(const hn_projector *p) {
    return p->evals;
}

double hn_projector_ops(const hn_projector *p) {
    return p->ops;
}

long long hn_projector_factorisations(const hn_projector *p) {
    return p->factorisations;
}

long long hn_projector_fallbacks(const hn_projector *p) {
    return p->fallbacks;
}
