// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel.h"

#include "dynamics/evaluate/accel_tape.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "dynamics/evaluate/inputs.h"
#include "dynamics/evaluate/pivot_noise.h"
#include "dynamics/evaluate/row_groups.h"
#include "linalg/dense.h"
#include "linalg/kkt.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

const char *const hn_solver_names[HN_SOLVER_COUNT] = {
#define HN_SOLVER_NAME(code, name) name,
    HN_SOLVER_LIST(HN_SOLVER_NAME)
#undef HN_SOLVER_NAME
};

static const double ROW_RESIDUAL = 1e-2; // by which rows that have all but vanished may disagree

struct hn_accel {
    int nv, nc;
    const hn_system *sys;
    hn_accel_opts opts;
    hn_inputs in;
    hn_accel_tape tape;
    double tape_ops; ///< of one run
    hn_row_groups rows;
    // the dense solve
    hn_eval *terms;
    int n_M, n_J;
    const int *M_row, *M_col, *J_row, *J_col;
    double *M, *J, *mass; ///< dense, filled where they are used, and the diagonal of M
    hn_kkt *kkt;
    double *gamma, *dense_a, *dense_lambda;
    double *row_unit;   ///< nc: the characteristic length for rows in metres, else 1
    double *speed_unit; ///< nv: the same for velocities of lengths
    double pull;        ///< squared rate at which the present call pulls the gap to zero [1/s^2]
    // refinement of the tape's answer
    hn_factor *factor;
    double *rest, *step; ///< nv + nc each
    hn_sum2 *sum;        ///< nv + nc
    long long count, fallbacks, refinements;
    double ops;
    char refusal[160];
};

// ---- compiling ----

static hn_status prepare_dense(hn_accel *s, const hn_system *sys, hn_arena *arena) {
    const unsigned terms =
        HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA | HN_TERM_PHI | HN_TERM_PHI_T;
    const size_t nv = (size_t)s->nv, nc = (size_t)s->nc;
    s->kkt = hn_kkt_create(arena, s->nv, s->nc);
    s->M = hn_arena_doubles(arena, nv * nv);
    s->J = hn_arena_doubles(arena, nc * nv);
    s->mass = hn_arena_doubles(arena, nv);
    s->rest = hn_arena_doubles(arena, (size_t)s->nv + (size_t)s->nc);
    s->step = hn_arena_doubles(arena, (size_t)s->nv + (size_t)s->nc);
    s->sum = hn_arena_get(arena, ((size_t)s->nv + (size_t)s->nc + 1) * sizeof *s->sum);
    s->gamma = hn_arena_doubles(arena, (size_t)s->nc);
    s->dense_a = hn_arena_doubles(arena, (size_t)s->nv);
    s->dense_lambda = hn_arena_doubles(arena, (size_t)s->nc);
    s->row_unit = hn_arena_doubles(arena, (size_t)s->nc);
    s->speed_unit = hn_arena_doubles(arena, (size_t)s->nv);
    if (!s->kkt || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // the terms by themselves, and their patterns
    for (int i = 0; i < s->nc; i++) {
        s->row_unit[i] = hn_system_row_unit(sys, i);
    }
    for (int i = 0; i < s->nv; i++) {
        s->speed_unit[i] = hn_system_velocity_unit(sys, i);
    }
    HN_TRY(hn_eval_create_listed(sys, terms, arena, &s->terms));
    s->n_M = hn_eval_pattern(s->terms, HN_TERM_M, &s->M_row, &s->M_col);
    s->n_J = hn_eval_pattern(s->terms, HN_TERM_J, &s->J_row, &s->J_col);

    // what only the tape's answer needs: guards of rows, refinement
    if (!s->tape.available) {
        return HN_OK;
    }
    s->tape_ops = hn_tape_get_info(s->in.tape).ops;
    HN_TRY(hn_row_groups_init(sys, arena, &s->rows));
    return hn_factor_create(sys, HN_FACTOR_MASS, arena, &s->factor);
}

static hn_status build(hn_accel *s, const hn_system *sys, hn_arena *arena) {
    if (s->opts.solver == HN_SOLVER_AUTO || s->opts.solver == HN_SOLVER_LDL) {
        HN_TRY(hn_accel_tape_compile(sys, s->opts.want_lambda, s->opts.baumgarte, arena, &s->in,
                                     &s->tape));
    }
    if (!s->tape.available) {
        HN_TRY(hn_inputs_create(sys, arena, &s->in));
    }
    return prepare_dense(s, sys, arena);
}

hn_status hn_accel_create(const hn_system *sys, const hn_accel_opts *opts, hn_arena *arena,
                          hn_accel **out) {
    HN_ASSERT(sys && opts && arena && out);
    hn_accel *s = hn_arena_get(arena, sizeof *s);
    *out = NULL;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->sys = sys;
    s->nv = sys->nv;
    s->nc = sys->nc;
    s->opts = *opts;
    hn_status status = build(s, sys, arena);
    if (status != HN_OK) {
        hn_accel_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

void hn_accel_free(hn_accel *s) {
    if (s) {
        hn_inputs_free(&s->in);
        hn_eval_free(s->terms);
        hn_factor_free(s->factor);
        s->terms = NULL;
        s->factor = NULL;
    }
}

// ---- running ----

static bool all_finite(const double *x, int n) {
    double zero = 0;
    for (int i = 0; i < n; i++) {
        zero += x[i] * 0; // a value that is not finite leaves NaN
    }
    return zero == 0;
}

/// Adds Baumgarte's terms to gamma; returns the relative gap of the loops (hn_pivot_noise_gap).
static double stabilise(hn_accel *s, const double *v, double alpha, double beta) {
    const hn_pivot_noise_terms at = {.n_J = s->n_J,
                                     .row = s->J_row,
                                     .col = s->J_col,
                                     .list = hn_eval_list(s->terms, HN_TERM_J),
                                     .phi = hn_eval_get(s->terms, HN_TERM_PHI),
                                     .phi_t = hn_eval_get(s->terms, HN_TERM_PHI_T)};
    const double *rate = s->rest, gap = hn_pivot_noise_gap(s->sys, &at, v, s->rest, s->step);
    for (int i = 0; s->opts.baumgarte && i < s->nc; i++) {
        s->gamma[i] += 2 * alpha * rate[i] + beta * beta * at.phi[i];
    }
    return gap;
}

/// The terms at the state in s->in, gamma with Baumgarte's part. Returns the relative gap of the
/// loops.
static double eval_terms(hn_accel *s, double t, const double *q, const double *v, double alpha,
                         double beta) {
    hn_eval_run(s->terms, t, q, v);
    s->ops += hn_eval_info(s->terms).ops + 4.0 * s->n_J;
    s->pull = s->opts.baumgarte ? beta * beta : 0;
    memcpy(s->gamma, hn_eval_get(s->terms, HN_TERM_GAMMA), (size_t)s->nc * sizeof *s->gamma);
    const double *M = hn_eval_list(s->terms, HN_TERM_M);
    for (int k = 0; k < s->n_M; k++) {
        if (s->M_row[k] == s->M_col[k]) {
            s->mass[s->M_row[k]] = M[k];
        }
    }
    return stabilise(s, v, alpha, beta);
}

// ---- refinement ----

static void subtract(hn_accel *s, int row, double entry, double x) {
    hn_sum2_add_product(&s->sum[row], -entry, x);
}

/// rest = [f; -gamma] - K [a; -lambda] in twice the working precision, entry by entry.
static void find_rest(hn_accel *s, const double *a, const double *lambda) {
    const double *M = hn_eval_list(s->terms, HN_TERM_M), *J = hn_eval_list(s->terms, HN_TERM_J);
    const double *f = hn_eval_get(s->terms, HN_TERM_F);

    // the right-hand sides
    for (int i = 0; i < s->nv + s->nc; i++) {
        s->sum[i] = (hn_sum2){i < s->nv ? f[i] : -s->gamma[i - s->nv], 0};
    }

    // less M a
    for (int k = 0; k < s->n_M; k++) {
        const int i = s->M_row[k], j = s->M_col[k];
        subtract(s, i, M[k], a[j]);
        if (i != j) {
            subtract(s, j, M[k], a[i]);
        }
    }

    // plus J' lambda, less J a
    for (int k = 0; k < s->n_J; k++) {
        const int i = s->J_row[k], j = s->J_col[k];
        subtract(s, j, -J[k], lambda[i]);
        subtract(s, s->nv + i, J[k], a[j]);
    }

    for (int i = 0; i < s->nv + s->nc; i++) {
        s->rest[i] = hn_sum2_value(&s->sum[i]);
    }
}

/// Returns whether the multipliers lie in a direction in which J is weaker than what open loops
/// change, as rows are that depend on each other while the loops are closed: |J' lambda| against
/// |lambda| times the longest row, in units of sqrt(M_jj).
static bool rests_on_noise(hn_accel *s, const double *lambda, double rank_tol) {
    const double *J = hn_eval_list(s->terms, HN_TERM_J);
    double *force = s->rest, *length = s->step, forces = 0, longest = 0, size = 0;
    memset(force, 0, (size_t)s->nv * sizeof *force);
    memset(length, 0, (size_t)s->nc * sizeof *length);

    // forces, and the lengths of the rows
    for (int k = 0; k < s->n_J; k++) {
        const int i = s->J_row[k], j = s->J_col[k];
        if (s->mass[j] > 0) {
            force[j] += J[k] * lambda[i] / sqrt(s->mass[j]);
            length[i] += J[k] * J[k] / s->mass[j];
        }
    }

    // against the multipliers
    s->ops += 7.0 * s->n_J;
    for (int j = 0; j < s->nv; j++) {
        forces = hypot(forces, force[j]);
    }
    for (int i = 0; i < s->nc; i++) {
        longest = fmax(longest, sqrt(length[i]) / s->row_unit[i]);
        size = hypot(size, lambda[i] * s->row_unit[i]);
    }
    return forces < rank_tol * longest * size;
}

/// Solves with the sparse factor and corrects the answer while the corrections halve. Fails where
/// the factor does, and where the answer rests on what the gap of the loops leaves of dependent
/// rows.
static hn_status solve_refined(hn_accel *s, double t, const double *q, double gap, double *a,
                               double *lambda, hn_accel_info *info) {
    enum { MAX_CORRECTIONS = 4 };
    double *step_a = s->step, *step_l = s->step + s->nv, last = HUGE_VAL;

    // the sparse factor here
    const hn_status status = hn_factor_update(s->factor, t, q, NULL);
    s->ops += hn_factor_get_info(s->factor).update_ops;
    HN_TRY(status);

    // from zero, corrected while the corrections halve
    memset(s->dense_a, 0, (size_t)s->nv * sizeof *s->dense_a);
    memset(s->dense_lambda, 0, (size_t)s->nc * sizeof *s->dense_lambda);
    for (int turn = 0; turn <= MAX_CORRECTIONS; turn++) {
        find_rest(s, s->dense_a, s->dense_lambda);
        hn_factor_solve(s->factor, s->rest, s->rest + s->nv, step_a, step_l);
        s->ops += hn_factor_get_info(s->factor).solve_ops + 34.0 * (s->n_M + s->n_J);

        const double size = hn_norm_max(s->nv, s->dense_a);
        const double moved = hn_norm_max(s->nv, step_a);
        if (!isfinite(moved) || !(moved < 0.5 * last)) {
            break;
        }

        hn_axpy(s->nv, 1, step_a, s->dense_a);
        hn_axpy(s->nc, 1, step_l, s->dense_lambda);
        info->refinements = turn;
        last = moved;
        if (turn > 0 && moved <= DBL_EPSILON * size) {
            break;
        }
    }

    // taken only if it is an answer
    const double rank_tol = fmax(hn_kkt_opts_default().rank_tol, hn_pivot_noise_of(gap));
    if (!hn_all_finite(s->nv, s->dense_a) || !hn_all_finite(s->nc, s->dense_lambda) ||
        rests_on_noise(s, s->dense_lambda, rank_tol)) {
        return HN_ERR_SINGULAR;
    }
    s->refinements++;
    memcpy(a, s->dense_a, (size_t)s->nv * sizeof *a);
    if (lambda) {
        memcpy(lambda, s->dense_lambda, (size_t)s->nc * sizeof *lambda);
    }
    return HN_OK;
}

// ---- the dense ways ----

static hn_kkt_way way_of(hn_solver solver) {
    switch (solver) {
    case HN_SOLVER_DENSE:
        return HN_KKT_DENSE;
    case HN_SOLVER_RANGE_SPACE:
        return HN_KKT_RANGE_SPACE;
    case HN_SOLVER_NULL_SPACE:
        return HN_KKT_NULL_SPACE;
    case HN_SOLVER_PROXIMAL:
        return HN_KKT_PROXIMAL;
    default:
        return HN_KKT_LEAST_NORM;
    }
}

static const char *name_of_speed(const hn_accel *s, int i) {
    if (i >= hn_system_get_info(s->sys).n_user) {
        return "a speed";
    }
    return hn_system_scene(s->sys)->coordinates[hn_system_user_coordinate(s->sys, i)].name;
}

/// The first velocity that moves no mass by itself, -1: each moves some.
static int find_massless(const hn_accel *s) {
    const double nothing = 1e-14; // of the largest mass, as in the dense solves
    double heaviest = 0;
    for (int i = 0; i < s->nv; i++) {
        heaviest = fmax(heaviest, s->mass[i]);
    }
    for (int i = 0; i < s->nv; i++) {
        if (s->mass[i] <= nothing * heaviest) {
            return i;
        }
    }
    return -1;
}

static void refuse_massless(hn_accel *s) {
    const int massless = find_massless(s);
    snprintf(s->refusal, sizeof s->refusal,
             "the loops allow a motion that moves no mass%s%.60s: forces do not determine its "
             "acceleration; give its bodies a mass",
             massless >= 0 ? ", such as that of " : "",
             massless >= 0 ? name_of_speed(s, massless) : "");
}

/// Notes why the solve failed. Returns HN_ERR_MASS where a mass is missing, else `status`.
static hn_status refuse(hn_accel *s, hn_solver solver, hn_status status, int massless) {
    const char *name = hn_solver_names[solver];
    if (massless >= 0) {
        snprintf(s->refusal, sizeof s->refusal,
                 "solver=%s needs the inverse of M, but %s moves no mass; use solver=auto", name,
                 name_of_speed(s, massless));
        return HN_ERR_MASS;
    }
    if (status == HN_ERR_SINGULAR && solver != HN_SOLVER_AUTO && solver != HN_SOLVER_LEAST_NORM) {
        snprintf(s->refusal, sizeof s->refusal,
                 "solver=%s needs independent constraint equations; use solver=auto, proximal or "
                 "least-norm",
                 name);
    } else if (status == HN_ERR_SINGULAR) {
        refuse_massless(s);
        return HN_ERR_MASS;
    }
    return status;
}

static double dense_ops(const hn_accel *s) {
    const double n = s->nv, c = s->nc;
    return 2 * n * c * c + 4 * n * n * c + n * n * n / 3 + 4 * (n * n + 2 * n * c);
}

/// The accelerations that the present velocities alone can make, in the units of the equilibrated
/// system: the largest sqrt(M_jj) v_j times the largest rate, a length counting by the mechanism's.
/// A pull on the gap makes others: the gap is a difference of lengths, and the pull one of lengths
/// times its squared rate, however small both are.
static double accelerations_of_motion(const hn_accel *s) {
    const double *v = s->in.x + s->in.nq;
    double momentum = 0, rate = 0, inertia = 0;
    for (int i = 0; i < s->nv; i++) {
        const double root = sqrt(fmax(s->mass[i], 0));
        momentum = fmax(momentum, root * fabs(v[i]));
        inertia = fmax(inertia, root * s->speed_unit[i]);
        rate = fmax(rate, fabs(v[i]) / s->speed_unit[i]);
    }
    return fmax(momentum * rate, inertia * s->pull);
}

/// Tolerances of the dense solve. A row that is short at a pose is not stretched to unit length:
/// that would amplify its rounding. A row below HN_ROW_LOST holds nothing but rounding and the
/// error of the step, so it is compared with rows as long as they are.
static hn_kkt_opts dense_opts(const hn_accel *s, double gap, double row_ratio, int want_cond) {
    hn_kkt_opts opts = hn_kkt_opts_default();
    opts.row_floor = HN_PIVOT_NOISE_ROW_FLOOR;
    opts.row_unit = s->row_unit;
    opts.rank_tol = fmax(opts.rank_tol, hn_pivot_noise_of(gap));
    opts.noise = hn_pivot_noise_of_sides(gap);
    opts.motion = accelerations_of_motion(s);
    opts.want_cond = want_cond;
    if (row_ratio < HN_ROW_LOST) {
        opts.row_floor = 1;
        opts.rank_tol = fmax(opts.rank_tol, HN_ROW_RANK_TOL);
        opts.residual_tol = fmax(opts.residual_tol, ROW_RESIDUAL);
    }
    return opts;
}

/// One of the dense ways, with the terms as they were last evaluated.
static hn_status run_kkt(hn_accel *s, hn_kkt_way way, hn_kkt_info *info, const hn_kkt_opts *opts) {
    hn_eval_spread(s->terms, HN_TERM_M, s->M);
    hn_eval_spread(s->terms, HN_TERM_J, s->J);
    return hn_kkt_solve(s->kkt, way, s->nv, s->nc, s->M, s->J, hn_eval_get(s->terms, HN_TERM_F),
                        s->gamma, s->dense_a, s->dense_lambda, info, opts);
}

static hn_status solve_dense(hn_accel *s, hn_solver solver, double gap, double *a, double *lambda,
                             hn_accel_info *info) {
    const hn_kkt_opts opts = dense_opts(s, gap, info->row_ratio, 0);
    hn_kkt_info dense;
    const hn_status status = run_kkt(s, way_of(solver), &dense, &opts);

    s->ops += dense_ops(s);
    info->massless = dense.massless;
    if (status != HN_OK) {
        return refuse(s, solver, status, dense.massless);
    }

    // what the solve found
    info->solver = solver;
    info->rank = dense.rank;
    info->residual = dense.residual;
    info->refinements = dense.refinements;
    memcpy(a, s->dense_a, (size_t)s->nv * sizeof *a);
    if (lambda) {
        memcpy(lambda, s->dense_lambda, (size_t)s->nc * sizeof *lambda);
    }
    return HN_OK;
}

/// As in hn_accel_info, after a run of the tape.
static double find_row_ratio(hn_accel *s) {
    return hn_row_groups_ratio(&s->rows, s->in.x, s->in.slots + s->tape.n_out - s->nc);
}

/// Takes the answer of the tape that has been run. HN_ERR_SINGULAR: a pivot is lost, or so small
/// that the answer needs correction (*doubtful).
static hn_status judge_answer(hn_accel *s, double *a, double *lambda, hn_accel_info *info,
                              int *doubtful) {
    if (!s->tape.available) {
        return HN_ERR_SINGULAR;
    }
    info->pivot_ratio = hn_accel_tape_worst_pivot(&s->tape, &s->in);
    info->row_ratio = find_row_ratio(s);
    info->solver = HN_SOLVER_LDL;
    if (info->row_ratio < HN_ROW_LOST) {
        return HN_ERR_SINGULAR;
    }
    *doubtful = info->pivot_ratio >= HN_PIVOT_GUARD && info->pivot_ratio < HN_PIVOT_DOUBT;
    const int good =
        info->pivot_ratio >= HN_PIVOT_DOUBT && hn_accel_tape_take(&s->tape, &s->in, a, lambda);
    return good ? HN_OK : HN_ERR_SINGULAR;
}

/// The answer at the state in s->in, for which the tape has been run if there is one, where it is
/// in doubt or somebody asks for more. A function of its own: it is rare.
__attribute__((noinline)) static hn_status eval_carefully(hn_accel *s, double t, const double *q,
                                                          const double *v, double alpha,
                                                          double beta, double *a, double *lambda,
                                                          hn_accel_info *info) {
    hn_accel_info own;
    const hn_solver solver = s->opts.solver;
    int doubtful = 0;

    // what the tape found
    info = info ? info : &own;
    *info = (hn_accel_info){.solver = solver, .rank = s->nc, .massless = -1, .row_ratio = 1};
    hn_status status = judge_answer(s, a, lambda, info, &doubtful);
    if (status == HN_OK) {
        return HN_OK;
    }

    // a state that is not finite has no accelerations
    if (!all_finite(s->in.x, s->in.n)) {
        s->fallbacks++;
        return HN_ERR_DIVERGED;
    }

    // pivots in doubt: the tape's factor, refined
    const double gap = eval_terms(s, t, q, v, alpha, beta);
    if (doubtful && solve_refined(s, t, q, gap, a, lambda, info) == HN_OK) {
        return HN_OK;
    }

    // else the dense solve
    if (solver == HN_SOLVER_LDL) {
        return refuse(s, solver, HN_ERR_SINGULAR, -1);
    }
    info->fallback = solver == HN_SOLVER_AUTO;
    s->fallbacks += info->fallback;
    return solve_dense(s, solver == HN_SOLVER_AUTO ? HN_SOLVER_LEAST_NORM : solver, gap, a, lambda,
                       info);
}

hn_status hn_accel_eval(hn_accel *s, double t, const double *q, const double *v, double alpha,
                        double beta, double *a, double *lambda, hn_accel_info *info) {
    HN_ASSERT(!lambda || s->opts.want_lambda);
    s->count++;
    s->refusal[0] = '\0';
    hn_inputs_set(&s->in, t, q, v, alpha, beta);

    // the tape first
    if (s->tape.available) {
        s->ops += s->tape_ops;
        if (info) {
            hn_tape_run(s->in.tape, s->in.x);
        } else if (hn_accel_tape_solve(&s->tape, &s->in, a, lambda)) {
            return HN_OK;
        }
    }
    return eval_carefully(s, t, q, v, alpha, beta, a, lambda, info);
}

hn_status hn_accel_condition(hn_accel *s, double t, const double *q, const double *v,
                             double *condition) {
    hn_kkt_info dense = {0};
    double row_ratio = 1;
    hn_inputs_set(&s->in, t, q, v, 0, 0);
    if (!all_finite(s->in.x, s->in.n)) {
        return HN_ERR_DIVERGED;
    }
    if (s->tape.available) { // a row that the accelerations leave out is left out here
        hn_tape_run(s->in.tape, s->in.x);
        row_ratio = find_row_ratio(s);
    }
    const hn_kkt_opts opts = dense_opts(s, eval_terms(s, t, q, v, 0, 0), row_ratio, 1);
    const hn_status status = run_kkt(s, HN_KKT_LEAST_NORM, &dense, &opts);
    *condition = status == HN_OK ? dense.cond : 0;
    return status;
}

const char *const hn_multiplier_marks[HN_N_MULTIPLIER_MARKS] = {
    "determined", "one of many", "no digit left", "no solution", "of open loops"};

hn_multiplier_mark hn_accel_mark(hn_accel *s, double t, const double *q, const double *v,
                                 const hn_accel_info *info) {
    const int sure = s->tape.available && !info->fallback && info->pivot_ratio >= HN_PIVOT_DOUBT &&
                     info->row_ratio >= HN_PIVOT_GUARD;
    double condition = 0;
    if (s->nc == 0 || sure) {
        return HN_MULTIPLIERS_DETERMINED;
    }
    if (hn_accel_condition(s, t, q, v, &condition) != HN_OK) {
        return HN_MULTIPLIERS_NONE;
    }
    return condition > HN_CONDITION_LOST ? HN_MULTIPLIERS_LOST
           : info->rank < s->nc          ? HN_MULTIPLIERS_ONE_OF_MANY
                                         : HN_MULTIPLIERS_DETERMINED;
}

const hn_accel_tape *hn_accel_get_tape(const hn_accel *s, const hn_inputs **in) {
    *in = &s->in;
    return s->tape.available ? &s->tape : NULL;
}

hn_tape_info hn_accel_tape_info(const hn_accel *s) {
    return s->tape.available ? hn_tape_get_info(s->in.tape) : hn_eval_info(s->terms);
}

hn_status hn_accel_measure_native(const hn_accel *s, hn_native_costs *costs, hn_diag *diag) {
    if (!s->tape.available) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "the dense solver is not compiled to instructions");
    }
    return hn_native_measure(s->in.tape, costs, diag);
}

long long hn_accel_count(const hn_accel *s) {
    return s->count;
}

long long hn_accel_fallbacks(const hn_accel *s) {
    return s->fallbacks;
}

long long hn_accel_refinements(const hn_accel *s) {
    return s->refinements;
}

double hn_accel_ops(const hn_accel *s) {
    return s->ops;
}

const char *hn_accel_refusal(const hn_accel *s) {
    return s->refusal[0] ? s->refusal : NULL;
}
