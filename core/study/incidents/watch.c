// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/watch.h"

#include "linalg/dense.h"
#include "study/incidents/crossing.h"
#include "study/incidents/energy.h"
#include "study/incidents/gap.h"
#include "study/incidents/heading.h"
#include "study/incidents/kinds.h"
#include "study/incidents/motion.h"
#include "study/incidents/stiffness.h"

#include <math.h>
#include <string.h>

// ---- memory ----

static hn_status create_memory(hn_watch *w) {
    hn_arena *arena = w->run->arena;
    const size_t nq = (size_t)w->run->info.nq, nv = (size_t)w->run->info.nv,
                 nc = (size_t)w->run->info.nc;
    double **const velocities[] = {&w->a, &w->scratch, &w->singular.inside, &w->singular.whole};
    double **const rows[] = {&w->lambda, &w->row_size};
    for (size_t i = 0; i < sizeof velocities / sizeof *velocities; i++) {
        *velocities[i] = hn_arena_doubles(arena, nv);
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        *rows[i] = hn_arena_doubles(arena, nc);
    }
    w->singular.inside_q = hn_arena_doubles(arena, nq);
    w->checked_q = hn_arena_doubles(arena, nq);

    const size_t limits = (size_t)hn_system_scene(w->run->sys)->n_coordinates + 1;
    w->before = hn_arena_get(arena, HN_RUN_MAX_INCIDENTS * sizeof *w->before);
    w->before_at = hn_arena_get(arena, HN_RUN_MAX_INCIDENTS * sizeof *w->before_at);
    for (int k = 0; w->before && k < HN_RUN_MAX_INCIDENTS; k++) {
        w->before[k] =
            (hn_state_at){.q = hn_arena_doubles(arena, nq), .v = hn_arena_doubles(arena, nv)};
    }
    w->beyond = hn_arena_get(arena, limits);
    w->limited = hn_arena_doubles(arena, limits);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : hn_heading_create(w);
}

static hn_status create_evaluators(hn_watch *w) {
    const unsigned each_step = HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_RATES | HN_TERM_ENERGY;
    const hn_system *sys = w->run->sys;
    hn_arena *arena = w->run->arena;
    HN_TRY(hn_eval_create(sys, each_step, arena, &w->eval));
    w->phi = hn_eval_get(w->eval, HN_TERM_PHI);
    w->phi_t = hn_eval_get(w->eval, HN_TERM_PHI_T);
    w->closure_rates = hn_eval_get(w->eval, HN_TERM_RATES);
    w->energies = hn_eval_get(w->eval, HN_TERM_ENERGY);

    HN_TRY(hn_eval_create_listed(sys, HN_CLOSURE_ROWS_TERMS, arena, &w->rows_eval));
    HN_TRY(hn_closure_rows_create(w->rows_eval, w->run->info.nc, arena, &w->rows));
    HN_TRY(hn_limits_create(sys, arena, &w->limits));
    HN_TRY(hn_mode_watch_create(sys, arena, &w->mode));
    const size_t loops = (size_t)hn_mode_watch_count(w->mode);
    w->modes = hn_arena_doubles(arena, loops);
    w->last_modes = hn_arena_doubles(arena, loops);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY
                                  : hn_singularity_create(sys, arena, &w->singular.monitor);
}

hn_status hn_watch_create(const hn_stepping *run, const hn_cost *cost, double warn_gap,
                          hn_watch *w) {
    *w = (hn_watch){.run = run, .cost = cost, .warn_gap = warn_gap, .every = 1};
    w->length = hn_system_length(run->sys);
    w->energy.conservative = hn_energy_is_conservative(run->sys);
    HN_TRY(hn_incident_log_create(&w->log));
    HN_TRY(create_memory(w));
    HN_TRY(create_evaluators(w));
    return hn_work_create(run, !w->energy.conservative, &w->work);
}

void hn_watch_free(hn_watch *w) {
    hn_incident_log_free(&w->log);
    hn_eval_free(w->eval);
    hn_eval_free(w->rows_eval);
    hn_mode_watch_free(w->mode);
    hn_limits_free(w->limits);
    hn_singularity_free(w->singular.monitor);
    hn_work_free(&w->work);
}

// ---- measuring ----

/// As hn_norm2(), which divides by the largest: squares of common size need no scaling.
static double measure_length(int n, const double *x) {
    static const double SMALL = 0x1p-900, LARGE = 0x1p900;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * x[i];
    }
    return sum > SMALL && sum < LARGE ? sqrt(sum) : hn_norm2(n, x);
}

hn_measure hn_watch_measure(hn_watch *w, double t, const double *q, const double *v) {
    const int nc = w->run->info.nc;
    hn_eval_run(w->eval, t, q, v);
    return (hn_measure){.gap = measure_length(nc, w->phi),
                        .velocity_gap = measure_length(nc, w->closure_rates),
                        .kinetic = w->energies[0],
                        .potential = w->energies[1]};
}

/// The largest length of each row so far, and the shortest row against its own.
static void measure_rows(hn_watch *w) {
    w->shortest_row = 1;
    for (int i = 0; i < w->run->info.nc; i++) {
        const double size = hn_closure_rows_length(&w->rows, i);
        const double largest = w->row_size[i] = fmax(w->row_size[i], size);
        w->shortest_row = fmin(w->shortest_row, largest > 0 ? size / largest : 1);
    }
}

/// Accelerations, multipliers, singular values at the present state.
static void measure_solution(hn_watch *w) {
    const hn_stepping *s = w->run;
    w->accel_info = (hn_accel_info){0};
    w->accel_status = hn_accel_eval(s->accel, s->now.t, s->now.q, s->now.v, 0, 0, w->a, w->lambda,
                                    &w->accel_info);
    if (w->at_start) {
        w->start_rank = w->accel_status == HN_OK ? w->accel_info.rank : s->info.nc;
    }
    hn_singularity_check(w->singular.monitor, s->now.t, s->now.q, s->now.v, &w->singular.info);
    w->singular.largest = fmax(w->singular.largest, w->singular.info.sigma_min);
    measure_rows(w);
}

/// As fmax(), in place and without its call: it is made several times a step.
static void raise_to(double *most, double x) {
    *most = x > *most ? x : *most;
}

static void measure_present(hn_watch *w) {
    const hn_stepping *s = w->run;
    w->measure = hn_watch_measure(w, s->now.t, s->now.q, s->now.v);
    if (w->at_start) {
        hn_work_start(&w->work);
        hn_energy_start(w);
    } else {
        hn_energy_record_state(w);
    }
    const double change = fabs(w->energy.last - w->energy.start);
    raise_to(&w->worst_gap, w->measure.gap);
    raise_to(&w->worst_velocity_gap, w->measure.velocity_gap);
    raise_to(&w->worst_energy_change, change);
}

// ---- when the full check is due ----

/// Finds the incidents that are checked after every step, and those whose end needs no full check.
static void find_own_pace(hn_watch *w) {
    w->n_each_step = 0;
    w->own_pace = 0;
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        const hn_incident_kind *kind = hn_incident_kinds()[i];
        w->own_pace |= kind->each_step || !kind->check ? 1u << kind->code : 0;
        const bool possible = !kind->is_possible || kind->is_possible(w);
        if (kind->check && kind->each_step && possible) {
            w->each_step[w->n_each_step++] = kind;
        }
    }
}

// Gap and energy are checked after every step. The rest costs as much as two steps of a small
// mechanism: singular values, multipliers, branches, limits. What it reports happens near singular
// configurations or in steps that the velocities do not explain. On a way of one length sigma_min
// changes by no more than STEEP times its largest, so it is far from them on a way as long as it is
// large, and short steps are checked once in that way. Near a singular configuration, while
// something is reported, and after a step that is not explained, they are checked after every step.
static const double STEEP = 3;
static const double MARGIN = 2;         // the way is so many times shorter than that
static const double LEAST = 0.01;       // of the length: shorter ways say nothing new
static const double LONGEST = 0.1;      // and longer ones lose the direction of the motion
static const double WELL = 0.4;         // sigma_min above this share of the largest so far is far
static const double PIVOT_MARGIN = 1e2; // times the pivot ratio that is reported
static const double NEAR_DUE = 10;      // steps before a predicted time: near it
static const double UNEXPLAINED = 0.1;  // of a step's motion

/// Returns whether a prediction is open and its time near or past; before that it needs no full
/// checks.
static bool is_prediction_due(const hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    return s->announced && w->run->now.t > s->due - NEAR_DUE * w->run->h;
}

/// Returns whether the full check that has just been made is far from everything that is reported.
static bool is_calm(const hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    const double row = w->shortest_row;
    return !s->passing && !is_prediction_due(w) && w->accel_status == HN_OK &&
           !w->accel_info.fallback && w->accel_info.rank == w->start_rank &&
           s->info.sigma_min > WELL * s->largest &&
           row * row * w->accel_info.pivot_ratio > PIVOT_MARGIN * HN_RUN_WARN_PIVOT;
}

/// Returns the way from the state of a full check to where the next is due [of the length].
static double find_stride(const hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    const double share = s->info.sigma_min / s->largest;
    const double way = (share - WELL) / (MARGIN * STEEP);
    return way > LONGEST ? LONGEST : way > LEAST ? way : LEAST;
}

/// Returns whether the run has gone further than that since the last full check. In motion without
/// jumps a way grows with the square of time at most: it is not measured before it can be
/// that long.
static bool is_far(hn_watch *w) {
    enum { MOST = 4 }; // a short way says little of one that is longer by more
    const double t = w->run->now.t;
    if (t < w->near_until) {
        return false;
    }
    const double way = hn_motion_way(w, w->checked_q, w->scratch);
    const double times = way * MOST > w->stride ? w->stride / way : MOST;
    w->near_until = w->checked_t + sqrt(times) * (t - w->checked_t);
    return way > w->stride;
}

static bool is_full_check_due(hn_watch *w) {
    const hn_stepping *s = w->run;
    const unsigned waiting = is_prediction_due(w) ? 0 : 1u << HN_INCIDENT_RANK_AHEAD;
    const bool reported = (w->log.active & ~w->own_pace & ~waiting) != 0 ||
                          w->singular.fallbacks != w->cost->fallbacks;
    if (w->at_start || s->info.nc == 0 || !w->calm || reported) {
        return true;
    }
    return !hn_motion_is_steady(w, UNEXPLAINED) || is_far(w);
}

// ---- checking ----

static void check_kinds(hn_watch *w, bool full) {
    if (!full) {
        for (int i = 0; i < w->n_each_step; i++) {
            w->each_step[i]->check(w);
        }
        return;
    }
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        const hn_incident_kind *kind = hn_incident_kinds()[i];
        if (kind->check) {
            kind->check(w);
        }
    }
}

static void check_present(hn_watch *w) {
    const hn_stepping *s = w->run;
    measure_present(w);
    const bool full = is_full_check_due(w);
    if (full && s->info.nc > 0) {
        hn_eval_run(w->rows_eval, s->now.t, s->now.q, s->now.v);
        if (!w->at_start) {
            hn_crossing_check(w); // before the monitor sees the end of the step
        }
        measure_solution(w);
        memcpy(w->checked_q, s->now.q, (size_t)s->info.nq * sizeof *w->checked_q);
        w->checked_t = w->near_until = s->now.t;
    }
    check_kinds(w, full);
    if (full) {
        w->checks++;
        w->calm = s->info.nc > 0 && !w->at_start && is_calm(w);
        w->stride = find_stride(w);
    }
    raise_to(&w->swiftest, hn_norm_max(s->info.nv, s->now.v));
}

static void forget(hn_watch *w) {
    // what the run has met
    hn_singular_record *s = &w->singular;
    hn_incident_log_clear(&w->log);
    hn_heading_start(w);
    hn_singularity_reset(s->monitor);

    // when the next full check is due
    find_own_pace(w);
    w->calm = false;
    w->checks = 0;

    // how near the singularity was
    s->info = (hn_singularity_info){.ratio = 1, .ahead = HUGE_VAL, .predicted = -HUGE_VAL};
    s->largest = s->multiplier = s->kinetic = 0;
    s->fallbacks = 0;
    s->passing = 0;
    s->announced = 0;
    s->at_start = false;

    // rows, limits and the worst figures
    memset(w->row_size, 0, (size_t)w->run->info.nc * sizeof *w->row_size);
    memset(w->beyond, 0, (size_t)hn_limits_count(w->limits));
    w->worst_gap = w->worst_velocity_gap = w->worst_energy_change = w->swiftest = 0;

    // the stability limit, and the end of the run
    w->held = w->released = 0;
    w->restarts = 0;
    w->failure = HN_OK;
    w->diagnosed = 0;
    w->start_rank = 0;
    w->shortest_row = 1;
}

void hn_watch_start(hn_watch *w) {
    forget(w);
    hn_mode_watch_values(w->mode, w->run->now.t, w->run->now.q, w->last_modes);
    w->at_start = true;
    check_present(w);
    w->at_start = false;
    hn_step_limit_check(w);
}

void hn_watch_step(hn_watch *w) {
    hn_stiffness_check_step(w);
}

bool hn_watch_measures_steps(const hn_watch *w) {
    return w->every > 0 && w->work.on;
}

void hn_watch_measure_step(hn_watch *w) {
    hn_work_step(&w->work);
}

double hn_watch_energy_change(hn_watch *w, const hn_state_at *at, const hn_measure *m,
                              double *work) {
    *work = w->every > 0 || !w->work.on ? hn_work_at(&w->work, at) : nan("");
    return m->kinetic + m->potential - *work - w->energy.start;
}

hn_singularity_info hn_watch_singularity(const hn_watch *w) {
    const hn_state_at *now = &w->run->now;
    hn_singularity_info info = w->singular.info;
    if (now->t != w->checked_t) {
        (void)hn_singularity_probe_both(w->singular.monitor, now->t, now->q, &info);
    }
    return info;
}

hn_status hn_watch_check(hn_watch *w, char why[256]) {
    check_present(w);
    return hn_gap_judge(w, why);
}
