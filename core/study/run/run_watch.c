// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/mode.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "study/run/run_internal.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- set-up -----------------------------------------------------------------------------------------------

static int is_conservative(const hn_system *sys) {
    const hn_scene *scene = hn_system_scene(sys);
    for (int i = 0; i < scene->n_loads; i++) {
        const hn_load *load = &scene->loads[i];
        const int spring = load->kind == HN_LOAD_SPRING || load->kind == HN_LOAD_JOINT_SPRING;
        if (!spring || load->damping.value != 0 || load->damping.varies) {
            return 0;
        }
    }
    return !hn_system_get_info(sys).has_time;
}

hn_status hn_run_watch_create(hn_run *run) {
    hn_run_watch_state *w = &run->watch;
    const unsigned terms = HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_ENERGY;
    const hn_accel_opts opts = {.want_lambda = 1};
    w->a = hn_arena_doubles(run->arena, (size_t)run->info.nv);
    w->lambda = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    w->speed_gap = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    w->row_size = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    w->conservative = is_conservative(run->sys);
    const size_t n = (size_t)hn_system_scene(run->sys)->n_coordinates + 1;
    w->beyond = hn_arena_get(run->arena, n);
    w->limited = hn_arena_doubles(run->arena, n);
    if (hn_arena_failed(run->arena)) {
        return HN_ERR_MEMORY;
    }
    hn_status status = hn_eval_create(run->sys, terms, run->arena, &w->eval);
    if (status == HN_OK) {
        status = hn_limits_create(run->sys, run->arena, &w->limits);
    }
    if (status == HN_OK) {
        status = hn_accel_create(run->sys, &opts, run->arena, &w->accel);
    }
    if (status == HN_OK) {
        status = hn_mode_watch_create(run->sys, run->arena, &w->mode);
    }
    if (status == HN_OK) {
        const size_t loops = (size_t)hn_mode_watch_count(w->mode);
        w->modes = hn_arena_doubles(run->arena, loops);
        w->last_modes = hn_arena_doubles(run->arena, loops);
        status = hn_arena_failed(run->arena) ? HN_ERR_MEMORY : HN_OK;
    }
    if (status == HN_OK) {
        status = hn_run_between_create(run);
    }
    return status == HN_OK ? hn_run_ahead_create(run) : status;
}

void hn_run_watch_free(hn_run *run) {
    hn_eval_free(run->watch.eval);
    hn_accel_free(run->watch.accel);
    hn_mode_watch_free(run->watch.mode);
    hn_limits_free(run->watch.limits);
    hn_run_ahead_free(run);
}

void hn_run_measure(hn_run *run, double t, const double *q, const double *v, double *gap,
                    double *speed_gap, double *kinetic, double *potential) {
    hn_eval *e = run->watch.eval;
    const int nv = run->info.nv, nc = run->info.nc;
    hn_eval_run(e, t, q, v);
    *gap = hn_norm2(nc, hn_eval_get(e, HN_TERM_PHI));
    hn_mat_vec(nc, nv, hn_eval_get(e, HN_TERM_J), v, run->watch.speed_gap);
    hn_axpy(nc, 1, hn_eval_get(e, HN_TERM_PHI_T), run->watch.speed_gap);
    *speed_gap = hn_norm2(nc, run->watch.speed_gap);
    *kinetic = hn_eval_get(e, HN_TERM_ENERGY)[0];
    *potential = hn_eval_get(e, HN_TERM_ENERGY)[1];
}

hn_status hn_run_accelerations(hn_run *run, double t, const double *q, const double *v, double *a,
                               double *lambda, hn_accel_info *info) {
    return hn_accel_eval(run->watch.accel, t, q, v, 0, 0, a, lambda, info);
}

// --- the look ---------------------------------------------------------------------------------------------

static void look_at_gap(hn_run *run, double gap) {
    const double limit = run->opts.warn_gap * run->length;
    if (!(gap > limit)) {
        hn_run_over(run, HN_INCIDENT_GAP_OPEN);
        return;
    }
    hn_incident *i = hn_run_tell(run, HN_INCIDENT_GAP_OPEN, "gap", gap, limit,
                                 "the loop gap is %.3g m and stands above %.3g m", gap, limit);
    if (!i) {
        return;
    }
    hn_run_remedy_formulation(run, "projection", i->remedy[0]);
    hn_run_remedy_finer(run, 0.5, i->remedy[1]);
    if (hn_run_has_formulation(run, "index1")) {
        hn_run_remedy_formulation(run, "baumgarte", i->remedy[2]);
    }
}

static void remedies_of_energy(hn_run *run, hn_incident *i) {
    if (!i) {
        return;
    }
    hn_run_remedy_finer(run, 0.25, i->remedy[0]);
    if (run->spec.formulation->model_error) {
        hn_run_remedy_formulation(run, "nullspace", i->remedy[1]);
    }
}

// little by little, a method can lose all the energy there is without a jump
static void look_at_drift(hn_run *run, double change) {
    const hn_run_watch_state *w = &run->watch;
    const double limit = HN_RUN_WARN_DRIFT * (w->t_max + (w->v_max - w->v_min));
    if (!w->conservative || !(fabs(change) > limit) || limit == 0) {
        hn_run_over(run, HN_INCIDENT_ENERGY_DRIFT);
        return;
    }
    remedies_of_energy(run,
                       hn_run_tell(run, HN_INCIDENT_ENERGY_DRIFT, "energy change", change, limit,
                                   "the energy has changed by %.3g J since the start, more than "
                                   "%.3g J, and no load does work",
                                   change, limit));
}

static void look_at_energy(hn_run *run, double kinetic, double potential) {
    hn_run_watch_state *w = &run->watch;
    const double energy = kinetic + potential, change = energy - w->last_energy;
    w->v_min = fmin(w->v_min, potential);
    w->v_max = fmax(w->v_max, potential);
    w->t_max = fmax(w->t_max, kinetic);
    w->last_energy = energy;
    look_at_drift(run, energy - w->start_energy);
    const double limit = HN_RUN_WARN_ENERGY * (kinetic + (w->v_max - w->v_min)) * w->every;
    if (!w->conservative || !(fabs(change) > limit) || limit == 0) {
        hn_run_over(run, HN_INCIDENT_ENERGY_JUMP);
        return;
    }
    remedies_of_energy(run,
                       hn_run_tell(run, HN_INCIDENT_ENERGY_JUMP, "energy change", change, limit,
                                   "the energy changed by %.3g J in one step, more than %.3g J",
                                   change, limit));
}

// Where all links of a loop lie on one line a whole row dies away: the pivots of K, each measured against its own row, do not
// see that.
double hn_run_shortest_row(const hn_run *run) {
    const double *J = hn_eval_get(run->watch.eval, HN_TERM_J);
    double least = 1;
    for (int i = 0; i < run->info.nc; i++) {
        const double size = hn_norm2(run->info.nv, J + (size_t)i * (size_t)run->info.nv);
        const double largest = fmax(run->watch.row_size[i], size);
        least = fmin(least, largest > 0 ? size / largest : 1);
    }
    return least;
}

static void measure_rows(hn_run *run) {
    const double *J = hn_eval_get(run->watch.eval, HN_TERM_J);
    for (int i = 0; i < run->info.nc; i++) {
        const double size = hn_norm2(run->info.nv, J + (size_t)i * (size_t)run->info.nv);
        run->watch.row_size[i] = fmax(run->watch.row_size[i], size);
    }
}

// A motion turns back where its speeds are small, and there its accelerations say so.
static void look_at_turn(hn_run *run) {
    const int n = run->info.nv;
    double back = 0;
    if (!run->has_step) {
        return;
    }
    for (int i = 0; i < n; i++) {
        back = hypot(back, run->now.v[i] + run->before.v[i]);
    }
    const double speed = fmin(hn_norm2(n, run->now.v), hn_norm2(n, run->before.v));
    const double change = (run->now.t - run->before.t) * hn_norm2(n, run->watch.a);
    if (!(back < HN_RUN_WARN_BACK * speed) || !(change < HN_RUN_WARN_BACK * 2 * speed)) {
        return;
    }
    hn_incident *i = hn_run_tell(
        run, HN_INCIDENT_BRANCH_FLIP, "change of speed", 2 * speed, change,
        "the speeds turned round within one step of %.3g s: by the accelerations they could change "
        "by %.2g of their size, and they changed by 2",
        run->now.t - run->before.t, change / speed);
    if (i && hn_run_has_formulation(run, "nullspace-untracked")) {
        hn_run_remedy_formulation(run, "nullspace", i->remedy[0]);
    } else if (i) {
        hn_run_remedy_finer(run, 0.25, i->remedy[0]);
    }
}

static void look_at_rank(hn_run *run, int at_start) {
    hn_run_watch_state *w = &run->watch;
    hn_accel_info info = {0};
    if (run->info.nc == 0) {
        return;
    }
    const hn_status status =
        hn_run_accelerations(run, run->now.t, run->now.q, run->now.v, w->a, w->lambda, &info);
    if (at_start) {
        w->start_rank = status == HN_OK ? info.rank : run->info.nc;
    }
    if (status == HN_OK && !at_start) {
        look_at_turn(run);
    }
    hn_run_ahead_look(run, status == HN_OK ? w->lambda : NULL);
    if (status == HN_OK && info.rank < (at_start ? run->info.nc : w->start_rank)) {
        hn_incident *i =
            hn_run_tell(run, HN_INCIDENT_RANK_LOSS, "rank of J", info.rank, run->info.nc,
                        at_start ? "%d of %d closure rows depend on the others: the motion is "
                                   "unique, single multipliers are not"
                                 : "%d of %d closure rows depend on the others in this pose: "
                                   "branches may cross here",
                        run->info.nc - info.rank, run->info.nc);
        if (i && !at_start) {
            hn_run_remedy_robust(run, i->remedy[0]);
            hn_run_describe_pose(run, i, run->now.t, run->now.q, w->ahead.info.sigma_min);
        }
    } else if (!at_start && status == HN_OK) {
        hn_run_over(run, HN_INCIDENT_RANK_LOSS);
    }
    measure_rows(run);
    // J M^-1 J': squared. A pivot that is lost where J is not says only that the order of elimination does not suit the pose.
    const double row = hn_run_shortest_row(run), ratio = w->ahead.info.ratio;
    const double pivot =
        status == HN_OK && info.fallback ? ratio * ratio : row * row * info.pivot_ratio;
    const int near = status != HN_OK || pivot < HN_RUN_WARN_PIVOT;
    if (!near || info.rank < run->info.nc) {
        hn_run_over(run, HN_INCIDENT_NEAR_SINGULAR);
        return;
    }
    hn_incident *i =
        hn_run_tell(run, HN_INCIDENT_NEAR_SINGULAR, "pivot ratio", pivot, HN_RUN_WARN_PIVOT,
                    "the closure rows are nearly dependent: pivot ratio %.2g, told below %.0e",
                    pivot, HN_RUN_WARN_PIVOT);
    if (i) {
        hn_run_remedy_robust(run, i->remedy[0]);
        hn_run_remedy_finer(run, 0.25, i->remedy[1]);
        hn_run_describe_pose(run, i, run->now.t, run->now.q, w->ahead.info.sigma_min);
    }
}

double hn_run_unexplained_motion(const hn_run *run, double least) {
    const double half = 0.5 * (run->now.t - run->before.t);
    double moved = least, rest = 0, *step = run->watch.a;
    hn_system_difference(run->sys, run->before.q, run->now.q, step);
    for (int i = 0; i < run->info.nv; i++) {
        moved = fmax(moved, fabs(step[i]));
        rest = fmax(rest, fabs(step[i] - half * (run->now.v[i] + run->before.v[i])));
    }
    return moved > 0 ? rest / moved : 0;
}

/// The loop whose mode changed its sign by most since the last look, -1: none changed it by more than what is told.
static int find_flipped_loop(const hn_run_watch_state *w) {
    double most = HN_RUN_WARN_MODE;
    int loop = -1;
    for (int k = 0; k < hn_mode_watch_count(w->mode); k++) {
        const double jump = fabs(w->modes[k] - w->last_modes[k]);
        if (w->modes[k] * w->last_modes[k] < 0 && jump > most) {
            most = jump;
            loop = k;
        }
    }
    return loop;
}

// A change of sign in smooth motion is a dead point that was passed; with a jump it is the other branch.
static void look_at_mode(hn_run *run) {
    hn_run_watch_state *w = &run->watch;
    hn_mode_watch_values(w->mode, run->now.t, run->now.q, w->modes);
    const int loop = find_flipped_loop(w);
    const int named = !hn_system_scene(run->sys)->is_lagrangian; // formulas share their loops
    if (loop >= 0 && hn_run_unexplained_motion(run, 0) > HN_RUN_WARN_JUMP) {
        hn_incident *i = hn_run_tell(
            run, HN_INCIDENT_BRANCH_FLIP, "assembly mode", w->modes[loop], HN_RUN_WARN_MODE,
            "the loop%s%s went from one assembly mode to the other in one step (%.2g to %.2g)",
            named ? " " : "", named ? hn_system_loop_name(run->sys, loop) : "", w->last_modes[loop],
            w->modes[loop]);
        if (i) {
            hn_run_remedy_finer(run, 0.25, i->remedy[0]);
            hn_run_remedy_formulation(run, "projection", i->remedy[1]);
        }
    } else {
        hn_run_over(run, HN_INCIDENT_BRANCH_FLIP);
    }
    double *const seen = w->last_modes;
    w->last_modes = w->modes;
    w->modes = seen;
}

/// What is left of a mechanism whose loops stand this far open is another one.
static hn_status judge_gap(hn_run *run, double gap) {
    const double limit = HN_RUN_LOST_GAP * run->length;
    if (!(gap > limit)) {
        return HN_OK;
    }
    snprintf(
        run->summary.reason, sizeof run->summary.reason,
        "at t = %.6g s the loops stand open by %.3g m, more than half the characteristic length "
        "of %.3g m: what moves there is no longer this mechanism",
        run->now.t, gap, run->length);
    return HN_ERR_DIVERGED;
}

void hn_run_watch_start(hn_run *run) {
    hn_run_watch_state *w = &run->watch;
    double gap = 0, speed_gap = 0, kinetic = 0, potential = 0;
    w->active = 0;
    memset(w->told, 0, sizeof w->told);
    memset(w->row_size, 0, (size_t)run->info.nc * sizeof *w->row_size);
    w->since = 0;
    hn_run_ahead_start(run);
    hn_run_measure(run, run->now.t, run->now.q, run->now.v, &gap, &speed_gap, &kinetic, &potential);
    w->start_energy = w->last_energy = kinetic + potential;
    w->v_min = w->v_max = potential;
    w->t_max = kinetic;
    w->swiftest = hn_norm_max(run->info.nv, run->now.v);
    hn_mode_watch_values(w->mode, run->now.t, run->now.q, w->last_modes);
    run->summary.worst_gap = gap;
    run->summary.worst_velocity_gap = speed_gap;
    look_at_rank(run, 1);
    memset(w->beyond, 0, (size_t)hn_limits_count(w->limits));
    hn_run_look_at_limits(run);
}

hn_status hn_run_watch_look(hn_run *run) {
    double gap = 0, speed_gap = 0, kinetic = 0, potential = 0;
    hn_run_summary *s = &run->summary;
    run->watch.since = 0;
    hn_run_measure(run, run->now.t, run->now.q, run->now.v, &gap, &speed_gap, &kinetic, &potential);
    const double change = fabs(kinetic + potential - run->watch.start_energy);
    s->worst_gap = fmax(s->worst_gap, gap);
    s->worst_velocity_gap = fmax(s->worst_velocity_gap, speed_gap);
    s->worst_energy_change = fmax(s->worst_energy_change, change);
    hn_run_look_between(run);
    look_at_gap(run, gap);
    look_at_energy(run, kinetic, potential);
    look_at_mode(run);
    look_at_rank(run, 0);
    hn_run_look_at_limits(run);
    run->watch.swiftest = fmax(run->watch.swiftest, hn_norm_max(run->info.nv, run->now.v));
    return judge_gap(run, gap);
}
