// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/run.h"

#include "base/suggest.h"
#include "formulations/ground/flops.h"
#include "study/incidents/chart.h"
#include "study/incidents/energy.h"
#include "study/incidents/failure.h"
#include "study/incidents/pose.h"
#include "study/incidents/stiffness.h"
#include "study/run/step_clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_MAX_STEPS 50000000ll

/// Returns the cost of the stepping so far.
typedef struct cost_clock {
    hn_cost cost, mark; ///< in all; of the engine when the last interval ended
    hn_step_clock time;
} cost_clock;

struct hn_run {
    hn_arena *arena;
    hn_run_opts opts;
    hn_run_state state;
    hn_status status;
    char reason[480];
    int since; ///< accepted steps since the last check
    cost_clock clock;
    hn_stepping stepping;
    hn_watch watch;
    hn_sampling sampling;
};

hn_run_opts hn_run_opts_default(void) {
    return (hn_run_opts){.max_steps = DEFAULT_MAX_STEPS, .warn_gap = HN_RUN_WARN_GAP};
}

// ---- the clock ----

/// Marks the cost of the engine, so that a sample between steps adds nothing to that of the
/// stepping.
static void mark_cost(hn_run *run) {
    run->clock.mark = hn_engine_cost(&run->stepping.engine);
}

/// Returns whether the next check could see a difference in what the engine has done: a fallback,
/// or another chart.
static bool is_cost_due(const hn_run *run) {
    const long long now = hn_engine_fallbacks(&run->stepping.engine);
    return now < 0 || now != run->clock.mark.fallbacks;
}

/// Everything between start_clock and stop_clock is the method's own work. Checks between steps
/// leave the engine alone.
static void start_clock(hn_run *run) {
    hn_step_clock_start(&run->clock.time);
}

static void stop_clock(hn_run *run) {
    hn_step_clock_stop(&run->clock.time);
}

/// Adds what the engine has done since the last time.
static void take_cost(hn_run *run) {
    cost_clock *c = &run->clock;
    const hn_cost now = hn_engine_cost(&run->stepping.engine);
    const hn_cost spent = hn_cost_between(&c->mark, &now);
    hn_cost_add(&c->cost, &spent);
    c->mark = now;
    hn_chart_check(&run->watch, spent.chart_changes);
}

// ---- stepping ----

/// Returns whether the accelerations at the last good state are not numbers, or those of the start
/// cannot be had.
static bool is_undefined(hn_run *run) {
    hn_stepping *s = &run->stepping;
    double sum = 0, *a = run->watch.a;
    hn_accel_info info;
    const hn_status status =
        hn_accel_eval(s->accel, s->now.t, s->now.q, s->now.v, 0, 0, a, run->watch.lambda, &info);
    for (int i = 0; i < s->info.nv; i++) {
        sum += a[i];
    }
    return status == HN_OK ? !isfinite(sum) : s->steps == 0;
}

/// Ends the run: keeps status and reason, and reports them as an incident.
static hn_status fail(hn_run *run, hn_status status) {
    const hn_stepping *s = &run->stepping;
    const char *why = NULL;
    run->state = HN_RUN_FAILED;
    run->status = status;

    // the reason: of the check, of the step, or of the method
    if (!run->reason[0] && s->reason[0]) {
        memcpy(run->reason, s->reason, sizeof run->reason);
    }
    if (status != HN_ERR_STOPPED && status != HN_ERR_DIVERGED) {
        why = hn_engine_why(&s->engine);
    }
    if (!run->reason[0] && status == HN_ERR_DIVERGED && is_undefined(run)) {
        snprintf(
            run->reason, sizeof run->reason,
            "at t = %.6g s a force or a constraint of the scene is not a number, as of a spring "
            "without length, a division by 0 or the root of a negative number",
            s->now.t);
    } else if (!run->reason[0] && status == HN_ERR_DIVERGED) {
        snprintf(run->reason, sizeof run->reason,
                 "after t = %.6g s the state stopped being finite or grew beyond %g", s->now.t,
                 HN_STEPPING_BOUND);
    } else if (!run->reason[0]) {
        snprintf(run->reason, sizeof run->reason, "%s", why ? why : hn_status_text(status));
    }
    if (status == HN_ERR_CHART || status == HN_ERR_UNSUPPORTED) {
        hn_pose_blames_start(&run->watch, run->reason);
    }
    if (status == HN_ERR_NO_CONVERGENCE || status == HN_ERR_INCONSISTENT) {
        hn_pose_explain(&run->watch, run->reason);
        hn_energy_explain(&run->watch, run->reason);
    }
    hn_failure_report(&run->watch, status, run->reason);
    return status;
}

/// One accepted step, and the check of its end where one is due. The clock runs between checks.
static hn_status step_and_check(hn_run *run, bool *ticking) {
    if (!*ticking) {
        start_clock(run);
        *ticking = true;
    }

    // the step, timed; what is measured on it is not
    HN_TRY(hn_stepping_step(&run->stepping));
    const hn_status pace = hn_headway_step(&run->stepping);
    hn_watch_step(&run->watch);
    HN_TRY(pace);
    if (hn_watch_measures_steps(&run->watch)) {
        stop_clock(run);
        *ticking = false;
        hn_watch_measure_step(&run->watch);
    }

    // a check of the state every so many steps
    if (run->watch.every == 0 || ++run->since < run->watch.every) {
        return HN_OK;
    }
    run->since = 0;
    if (*ticking) {
        stop_clock(run);
        *ticking = false;
    }
    if (is_cost_due(run)) {
        take_cost(run);
    }
    return hn_watch_check(&run->watch, run->reason);
}

/// Steps until t >= t_end, or exactly once when `one` is set; t_end is then where the run is going.
static hn_status step_until(hn_run *run, double t_end, bool one) {
    hn_stepping *s = &run->stepping;
    hn_status status = HN_OK;
    bool ticking = false;

    if (run->state == HN_RUN_FAILED) {
        return run->status;
    }

    mark_cost(run);
    run->state = HN_RUN_RUNNING;
    s->t_asked = t_end;
    const bool whole = run->opts.to_the_end && s->steps == 0;
    if (hn_headway_check_steps(s, whole ? fmax(t_end, run->opts.t_end) : t_end) != HN_OK) {
        return fail(run, HN_ERR_STOPPED);
    }

    // a fixed step may end just short of the time that was asked for
    do {
        const double slack = s->adaptive ? 0 : HN_STEPPING_LANDING * s->h_next;
        if (!one && s->now.t >= t_end - slack) {
            break;
        }
        status = step_and_check(run, &ticking);
    } while (status == HN_OK && !one);

    if (ticking) {
        stop_clock(run);
    }
    take_cost(run);
    return status == HN_OK ? HN_OK : fail(run, status);
}

hn_status hn_run_advance(hn_run *run, double t_end) {
    if (run->state != HN_RUN_FAILED && !isfinite(t_end)) {
        return HN_ERR_INPUT;
    }
    HN_TRY(step_until(run, t_end, false));
    run->state = HN_RUN_FINISHED;
    return HN_OK;
}

hn_status hn_run_step_towards(hn_run *run, double t_sample) {
    return step_until(run, t_sample, true);
}

hn_status hn_run_step(hn_run *run) {
    return hn_run_step_towards(run, run->stepping.now.t);
}

// ---- life ----

/// The counters of a fresh run; the state goes back to the start.
static void clear(hn_run *run) {
    run->state = HN_RUN_READY;
    run->status = HN_OK;
    run->reason[0] = '\0';
    run->since = 0;
    run->clock.cost = (hn_cost){0};
    hn_step_clock_clear(&run->clock.time);
    hn_stepping_clear(&run->stepping);
    hn_watch_start(&run->watch);
    run->sampling.inside = 0;
    hn_step_long_check(&run->watch);
}

static hn_status create_parts(hn_run *run, const hn_system *sys, const hn_method_spec *spec,
                              const double *q, const double *v, hn_diag *diag) {
    hn_stepping *s = &run->stepping;
    HN_TRY(hn_stepping_create(sys, spec, run->opts.t0, run->opts.max_steps, q, v, run->arena, s,
                              diag));
    hn_status status = hn_watch_create(s, &run->clock.cost, run->opts.warn_gap, &run->watch);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }
    run->watch.t_end = run->opts.t_end;
    HN_TRY(hn_sampling_create(s, &run->watch, run->opts.raw_lambda, &run->sampling, diag));

    // a formulation that cannot start at this state gives a run in the failed state
    clear(run);
    status = hn_stepping_start_engine(s, &s->engine);
    HN_THEN(status, hn_stepping_start_engine(s, &run->sampling.side));
    if (status == HN_ERR_MEMORY) {
        return hn_diag_set(diag, status, NULL, NULL, "out of memory");
    }
    if (status != HN_OK) {
        fail(run, status);
    }
    return HN_OK;
}

hn_status hn_run_create(const hn_system *sys, const hn_method_spec *spec, const double *q,
                        const double *v, const hn_run_opts *opts, hn_run **out, hn_diag *diag) {
    hn_run *run = calloc(1, sizeof *run);
    hn_arena *arena = hn_arena_create(0);
    if (!run || !arena) {
        free(run);
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // options, with their default values
    run->arena = arena;
    hn_step_clock_create(&run->clock.time);
    run->opts = opts ? *opts : hn_run_opts_default();
    if (run->opts.max_steps <= 0) {
        run->opts.max_steps = DEFAULT_MAX_STEPS;
    }
    if (!(run->opts.warn_gap > 0)) {
        run->opts.warn_gap = HN_RUN_WARN_GAP;
    }

    // stepping, sampling and the watch
    const hn_status status = create_parts(run, sys, spec, q, v, diag);
    if (status != HN_OK) {
        hn_run_free(run);
        return hn_system_stopped(sys, status, diag);
    }
    *out = run;
    return HN_OK;
}

void hn_run_free(hn_run *run) {
    if (!run) {
        return;
    }
    hn_sampling_free(&run->sampling);
    hn_watch_free(&run->watch);
    hn_stepping_free(&run->stepping);
    hn_arena_free(run->arena);
    free(run);
}

hn_status hn_run_reset(hn_run *run) {
    clear(run);
    const hn_status status = hn_stepping_start_engine(&run->stepping, &run->stepping.engine);
    return status == HN_OK ? HN_OK : fail(run, status);
}

// ---- reading ----

double hn_run_time(const hn_run *run) {
    return run->stepping.now.t;
}

hn_run_state hn_run_get_state(const hn_run *run) {
    return run->state;
}

double hn_run_ops(const hn_run *run) {
    return run->clock.cost.ops;
}

hn_run_summary hn_run_get_summary(const hn_run *run) {
    const hn_stepping *s = &run->stepping;
    hn_run_summary out = {.state = run->state,
                          .status = run->status,
                          .t = s->now.t,
                          .steps = s->steps,
                          .rejected = s->rejected,
                          .h_last = s->h,
                          .cost = run->clock.cost,
                          .cpu_seconds =
                              hn_step_clock_read(&run->clock.time) + run->clock.cost.elsewhere,
                          .worst_gap = run->watch.worst_gap,
                          .worst_velocity_gap = run->watch.worst_velocity_gap,
                          .worst_energy_change = run->watch.worst_energy_change,
                          .watched_every = run->watch.every,
                          .samples_inside = run->sampling.inside};
    memcpy(out.reason, run->reason, sizeof out.reason);
    return out;
}

int hn_run_incidents(const hn_run *run, const hn_incident **out) {
    *out = run->watch.log.list;
    return run->watch.log.n;
}

double hn_run_sigma_min(const hn_run *run) {
    const bool any = run->stepping.info.nc > 0;
    return any ? hn_watch_singularity(&run->watch).sigma_min : (double)NAN;
}

double hn_run_condition(const hn_run *run) {
    const bool any = run->stepping.info.nc > 0;
    const double ratio = any ? hn_watch_singularity(&run->watch).ratio : (double)NAN;
    return isnan(ratio) ? ratio : ratio > 0 ? 1 / ratio : HUGE_VAL;
}

int hn_run_passed_singular(const hn_run *run, double *t) {
    const hn_incident *list = run->watch.log.list;
    for (int i = 0; i < run->watch.log.n; i++) {
        if (list[i].code == HN_INCIDENT_NEAR_SINGULAR || list[i].code == HN_INCIDENT_RANK_LOSS) {
            *t = list[i].t;
            return 1;
        }
    }
    return 0;
}

hn_status hn_run_sample(hn_run *run, double t, hn_sample *out) {
    if (!isfinite(t)) {
        return HN_ERR_INPUT;
    }
    const bool failed = run->state == HN_RUN_FAILED;
    const hn_status status = hn_sampling_at(&run->sampling, t, failed, out);

    // a motion that grows beyond every bound on the way to its next step has ended there
    const bool ended = status == HN_ERR_DIVERGED && !failed && t > run->stepping.now.t;
    return ended ? fail(run, status) : status;
}

hn_multiplier_mark hn_run_sample_mark(hn_run *run) {
    const hn_sampling *s = &run->sampling;
    const hn_watch *w = &run->watch;
    if (s->status != HN_OK) {
        return HN_MULTIPLIERS_NONE;
    }

    // digits come first: a force without any is worth nothing, whatever the loops do
    const hn_multiplier_mark mark = hn_accel_mark(run->stepping.accel, s->t, s->q, s->v, &s->info);
    const bool open = s->gap > w->warn_gap * w->length;
    return open && (mark == HN_MULTIPLIERS_DETERMINED || mark == HN_MULTIPLIERS_ONE_OF_MANY)
               ? HN_MULTIPLIERS_OPEN
               : mark;
}

const char *hn_run_sample_why(const hn_run *run, hn_status status) {
    const char *why = status != HN_ERR_DIVERGED ? hn_engine_why(&run->sampling.side) : NULL;
    return why ? why : hn_status_text(status);
}

bool hn_run_has_raw_lambda(const hn_run *run) {
    return hn_engine_has_raw_lambda(&run->stepping.engine);
}

const hn_method_spec *hn_run_spec(const hn_run *run) {
    return &run->stepping.spec;
}

hn_stepping *hn_run_stepping(hn_run *run) {
    return &run->stepping;
}

hn_engine *hn_run_side_engine(hn_run *run) {
    return &run->sampling.side;
}

hn_watch *hn_run_watching(hn_run *run) {
    return &run->watch;
}

void hn_run_set_reason(hn_run *run, const char *reason) {
    snprintf(run->reason, sizeof run->reason, "%.479s", reason);
}

bool hn_run_is_conservative(const hn_run *run) {
    return run->watch.energy.conservative;
}

void hn_run_watch(hn_run *run, int every) {
    run->watch.every = every > 0 ? every : 0;
}

void hn_run_loads_changed(hn_run *run, double t) {
    if (run->state == HN_RUN_FAILED) {
        return;
    }
    hn_stepping_loads_changed(&run->stepping, t);
    run->watch.work.at_corner |= run->stepping.now.t >= t;
}

// ---- options while running ----

static hn_status unknown_key(const hn_run *run, const char *key, hn_diag *diag) {
    const hn_method_spec *spec = hn_run_spec(run);
    const char *keys[2 * HN_MAX_OPTIONS];
    char hint[HN_DIAG_HINT];
    int n = 0;
    for (int i = 0; i < spec->formulation->n_options; i++) {
        keys[n++] = spec->formulation->options[i].key;
    }

    // an option of the integrator is known, but fixed
    for (int i = 0; i < spec->stepper->n_options; i++) {
        if (strcmp(spec->stepper->options[i].key, key) == 0) {
            return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "start a new run with the new value",
                               "%s is an option of the integrator and cannot change during a run",
                               key);
        }
        keys[n++] = spec->stepper->options[i].key;
    }
    hn_suggest(hint, key, keys, n, NULL);
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "%s has no option '%s'",
                       spec->formulation->name, key);
}

hn_status hn_run_set(hn_run *run, const char *key, double value, hn_diag *diag) {
    hn_stepping *s = &run->stepping;
    const hn_formulation *f = s->spec.formulation;
    int i = 0;
    while (i < f->n_options && strcmp(f->options[i].key, key) != 0) {
        i++;
    }
    if (i == f->n_options) {
        return unknown_key(run, key, diag);
    }
    HN_TRY(hn_option_check(&f->options[i], value, diag));

    // an integrator that takes the system as it is has had the options since it was made
    hn_status status = f->set && s->engine.formulation ? f->set(s->engine.formulation, i, value)
                                                       : HN_ERR_UNSUPPORTED;
    HN_THEN(status, f->set(run->sampling.side.formulation, i, value));
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, "start a new run with the new value",
                           "%s of %s cannot change during a run", key, f->name);
    }
    s->spec.formulation_set[i] = value;
    if (s->engine.stepper) {
        hn_engine_accepted(&s->engine, 1); // slopes kept from before are stale
    }
    hn_step_limit_check(&run->watch);
    return HN_OK;
}
