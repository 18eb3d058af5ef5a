// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/run_internal.h"

#include "base/clock.h"
#include "linalg/dense.h"
#include "formulations/ground/flops.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_MAX_STEPS 50000000ll
#define LANDING 1e-9    // of a step: a grid point this near to t_end counts as t_end
#define STATE_BOUND 1e9 // a coordinate or speed beyond this has left every mechanism
// A trial that failed outright adds FAILED_TRIAL, a good step takes 1 away: steps that keep running into the end of a
// chart shrink for ever without reaching it, and stop here.
enum { FAILED_TRIAL = 8, TROUBLE_LIMIT = 200 };
// Where Newton's method fails at every other step the step grows back slowly, lest it runs into the same wall each time.
enum { TROUBLE_SEEN = 2 * FAILED_TRIAL };
#define GROWTH_IN_TROUBLE 1.02
#define UNDERFLOW_EPS 3.6e-15 // 16 eps: smaller steps no longer move t reliably

hn_run_opts hn_run_opts_default(void) {
    return (hn_run_opts){.max_steps = DEFAULT_MAX_STEPS, .warn_gap = HN_RUN_WARN_GAP};
}

/// What one pair of readings adds to an interval: the median of some pairs with nothing between, taken off each interval. A
/// reading is a call into the kernel and takes as long as a small mechanism's step.
static double calc_clock_cost(void) {
    enum { PAIRS = 15 };
    double cost[PAIRS];
    for (int i = 0; i < PAIRS; i++) {
        const double mark = hn_clock_thread();
        const double d = hn_clock_thread() - mark;
        int k = i;
        for (; k > 0 && cost[k - 1] > d; k--) {
            cost[k] = cost[k - 1];
        }
        cost[k] = d;
    }
    return cost[PAIRS / 2];
}

// everything between start_clock and stop_clock is the method's own work
static void start_clock(hn_run *run) {
    run->cost_mark = hn_engine_cost(run, &run->main);
    run->cpu_mark = hn_clock_thread();
}

static void stop_clock(hn_run *run) {
    run->summary.cpu_seconds += fmax(0, hn_clock_thread() - run->cpu_mark - run->clock_cost);
    const hn_cost now = hn_engine_cost(run, &run->main),
                  spent = hn_cost_between(&run->cost_mark, &now);
    hn_cost_add(&run->summary.cost, &spent);
    hn_run_tell_charts(run, spent.chart_changes);
}

// --- failure ----------------------------------------------------------------------------------------------

static hn_status fail(hn_run *run, hn_status status) {
    const char *why = NULL;
    if (status != HN_ERR_BUDGET && status != HN_ERR_DIVERGED) {
        why = hn_engine_why(run, &run->main);
    }
    run->summary.state = HN_RUN_FAILED;
    run->summary.status = status;
    if (status == HN_ERR_DIVERGED && !run->summary.reason[0]) {
        snprintf(run->summary.reason, sizeof run->summary.reason,
                 "after t = %.6g s the state stopped being finite or grew beyond %g", run->now.t,
                 STATE_BOUND);
    } else if (!run->summary.reason[0]) {
        snprintf(run->summary.reason, sizeof run->summary.reason, "%s",
                 why ? why : hn_status_text(status));
    }
    if (status == HN_ERR_NO_CONVERGENCE || status == HN_ERR_INCONSISTENT) {
        hn_run_explain_pose(run);
    }
    hn_run_tell_failure(run, status);
    return status;
}

static int state_is_sane(int n, const double *y) {
    return hn_all_finite(n, y) && hn_norm_max(n, y) < STATE_BOUND;
}

// --- one step ---------------------------------------------------------------------------------------------

static hn_status take(hn_run *run, double h, double t_new, int *changed) {
    hn_run_engine *e = &run->main;
    const hn_status status = hn_engine_step(run, e, run->now.t, h);
    if (status != HN_OK) {
        return status;
    }
    if (!state_is_sane(e->ode.n_pos + e->ode.n_vel, e->y_new)) {
        return HN_ERR_DIVERGED;
    }
    *changed = 0;
    // an adaptive step is mended only once its error is accepted
    return run->adaptive ? HN_OK : hn_engine_mend(run, e, t_new, e->y_new, changed);
}

static hn_status accept(hn_run *run, double h, double t_new, int changed) {
    hn_run_engine *e = &run->main;
    const hn_run_state_at spare = run->before;
    hn_engine_accepted(run, e, changed);
    double *const y = e->y;
    e->y = e->y_new;
    e->y_new = y;
    run->before = run->now;
    run->now = spare;
    run->now.t = t_new;
    run->has_step = 1;
    run->h = h;
    run->summary.h_last = h;
    run->summary.t = t_new;
    run->summary.steps++;
    if (changed) {
        hn_run_tell_restart(run);
    }
    return hn_engine_read(run, e, t_new, e->y, run->now.q, run->now.v);
}

// --- corners of loads -------------------------------------------------------------------------------------
// A step never runs across a corner: it ends a few roundings before, so that every stage sees the load as it was, and the
// next one begins at the corner itself.

#define SHORT_OF 8.9e-16 // 4 eps: of the larger of two times

double hn_run_step_short_of(double from, double to) {
    return (to - from) - SHORT_OF * fmax(fabs(from), fabs(to));
}

static double smallest_step(const hn_run *run) {
    return UNDERFLOW_EPS * (1e-3 + fabs(run->now.t));
}

static void find_corner(hn_run *run) {
    run->corner = hn_system_next_corner(run->sys, run->now.t);
    while (run->corner - run->now.t <= 4 * smallest_step(run)) { // no room for a step: it is here
        run->now.t = run->corner;
        run->corner = hn_system_next_corner(run->sys, run->now.t);
    }
}

static hn_status accept_at_corner(hn_run *run, double h) {
    const hn_status status = accept(run, h, run->corner, 1); // slopes kept from before are stale
    run->restart = 1;                                        // once the last step has been sampled
    run->control = (hn_step_control){.last = 1};
    find_corner(run);
    return status;
}

static hn_status step_fixed(hn_run *run) {
    int changed = 0;
    const double h = run->h_next;
    const double here = run->opts.t0 + (double)run->grid * h;
    const double next = run->opts.t0 + (double)(run->grid + 1) * h;
    if (run->corner < next + LANDING * h) {
        const int lands = run->corner > next - LANDING * h;
        const double part = hn_run_step_short_of(run->now.t, run->corner);
        const hn_status status = take(run, part, run->corner, &changed);
        run->grid += status == HN_OK && lands;
        return status == HN_OK ? accept_at_corner(run, part) : status;
    }
    const double rest = run->now.t == here ? h : next - run->now.t;
    const hn_status status = take(run, rest, next, &changed);
    run->grid += status == HN_OK;
    return status == HN_OK ? accept(run, rest, next, changed) : status;
}

static double absolute_tolerance(const hn_run *run, double rtol) {
    const double atol = hn_method_option(&run->spec, "atol", 0);
    return atol > 0 ? atol : rtol;
}

static double largest_step(const hn_run *run) {
    const double hmax = hn_method_option(&run->spec, "hmax", 0);
    return hmax > 0 ? hmax : HUGE_VAL;
}

#define RESTING_STEP 1e-3 // of the time asked for: a driven mechanism at rest tells no time scale

static hn_status choose_first_step(hn_run *run, double rtol, double atol) {
    hn_run_engine *e = &run->main;
    const double h0 = hn_method_option(&run->spec, "h0", 0);
    if (h0 > 0) {
        run->h_next = fmin(h0, largest_step(run));
        return HN_OK;
    }
    if (e->ode.n_pos + e->ode.n_vel == 0) {
        const double h = hn_drive_first_step(run->sys, run->now.v);
        run->h_next =
            fmin(h > 0 ? h : RESTING_STEP * (run->t_asked - run->now.t), largest_step(run));
        return HN_OK;
    }
    return hn_first_step(&e->ode, run->now.t, e->y, run->spec.stepper->order, rtol, atol,
                         largest_step(run), e->y_new, e->err, run->work, &run->h_next);
}

// Error norm of a trial, infinite when it failed; an accepted trial has been mended when this returns <= 1.
static double try_adaptive(hn_run *run, double h, double rtol, double atol, int *changed,
                           hn_status *status) {
    hn_run_engine *e = &run->main;
    *status = take(run, h, run->now.t + h, changed);
    if (*status != HN_OK) {
        return HUGE_VAL;
    }
    const int n = e->ode.n_pos + e->ode.n_vel;
    double err = hn_error_norm(n, e->err, e->y, e->y_new, rtol, atol);
    if (n == 0) {
        *status =
            hn_engine_read(run, e, run->now.t + h, e->y_new, run->work, run->work + run->info.nq);
        err = *status == HN_OK ? hn_drive_norm(run->sys, run->now.q, run->work) : HUGE_VAL;
    }
    if (err <= 1) {
        // a step that nobody looks into is spared the slopes that only dense output needs
        run->has_dense = run->now.t + h >= run->t_asked - LANDING * h;
        *status = run->has_dense ? hn_engine_finish(run, e) : HN_OK;
        if (*status == HN_OK) {
            *status = hn_engine_mend(run, e, run->now.t + h, e->y_new, changed);
        }
    }
    return *status == HN_OK ? err : HUGE_VAL;
}

static hn_status underflow(hn_run *run, hn_status cause) {
    const char *why = NULL;
    if (cause != HN_OK) {
        why = hn_engine_why(run, &run->main);
        why = why ? why : hn_status_text(cause);
    }
    // what stopped the trials is the reason, the small step only its shadow
    if (cause != HN_OK && cause != HN_ERR_DIVERGED) {
        snprintf(run->summary.reason, sizeof run->summary.reason, "%s", why);
        return cause;
    }
    snprintf(run->summary.reason, sizeof run->summary.reason,
             "the step fell to %.2g s at t = %.6g s: %s", run->h_next, run->now.t,
             why ? why : "the error stays above its tolerance");
    return HN_ERR_STEP_UNDERFLOW;
}

static hn_status step_adaptive(hn_run *run) {
    const double rtol = hn_method_option(&run->spec, "rtol", 1e-6);
    const double atol = absolute_tolerance(run, rtol);
    const int order = run->spec.stepper->control_order;
    const bool is_driven = run->main.ode.n_pos + run->main.ode.n_vel == 0;
    const int k = is_driven ? 1 : order > 0 ? order : run->spec.stepper->order;
    hn_status status = HN_OK;
    if (run->h_next <= 0) {
        status = choose_first_step(run, rtol, atol);
        if (status != HN_OK) {
            return status;
        }
    }
    for (;;) {
        const int at_corner = run->now.t + run->h_next >= run->corner;
        const double h = at_corner ? hn_run_step_short_of(run->now.t, run->corner) : run->h_next;
        if (h <= smallest_step(run) || run->trouble > TROUBLE_LIMIT) {
            return underflow(run, status);
        }
        if (run->summary.steps + run->summary.rejected >= run->opts.max_steps) {
            return HN_ERR_BUDGET;
        }
        int changed = 0;
        const double err = try_adaptive(run, h, rtol, atol, &changed, &status);
        run->h_next = fmin(h * hn_step_factor(&run->control, err, k), largest_step(run));
        if (err <= 1) {
            if (run->iterating && run->trouble >= TROUBLE_SEEN) {
                run->h_next = fmin(run->h_next, GROWTH_IN_TROUBLE * h);
            }
            run->trouble -= run->trouble > 0;
            hn_run_look_at_stiffness(run, h);
            if (at_corner) {
                run->h_next = 0; // chosen anew for what begins here
                return accept_at_corner(run, h);
            }
            return accept(run, h, run->now.t + h, changed);
        }
        if (status != HN_OK) {
            run->trouble += FAILED_TRIAL;
            run->iterating = status == HN_ERR_NO_CONVERGENCE; // no end of a chart lies ahead then
        }
        run->summary.rejected++;
    }
}

static hn_status step_of_its_own(hn_run *run) {
    hn_run_engine *e = &run->main;
    double t_new = run->now.t;
    int changed = 0;
    const double stop = isfinite(run->corner)
                            ? run->now.t + hn_run_step_short_of(run->now.t, run->corner)
                            : HUGE_VAL;
    const long long rejected = hn_engine_cost(run, e).rejected;
    hn_status status = HN_OK;
    if (run->restart) {
        status = hn_engine_start(run, e, run->now.t, run->now.q, run->now.v);
        run->restart = 0;
    }
    if (status == HN_OK) {
        status = hn_engine_advance(run, e, run->now.t, stop, &t_new);
    }
    run->summary.rejected += hn_engine_cost(run, e).rejected - rejected;
    if (status == HN_OK && !state_is_sane(e->ode.n_pos + e->ode.n_vel, e->y_new)) {
        status = HN_ERR_DIVERGED;
    }
    if (status == HN_OK) {
        status = hn_engine_mend(run, e, t_new, e->y_new, &changed);
    }
    if (status == HN_OK && t_new >= stop) {
        return accept_at_corner(run, t_new - run->now.t);
    }
    return status == HN_OK ? accept(run, t_new - run->now.t, t_new, changed) : status;
}

static hn_status take_one(hn_run *run) {
    if (hn_engine_paces_itself(run)) {
        return step_of_its_own(run);
    }
    return run->adaptive ? step_adaptive(run) : step_fixed(run);
}

// the end of a chart is not the end of the motion: true where another chart takes over
static bool change_chart(hn_run *run) {
    if (hn_engine_change_chart(run, &run->main, run->now.t) != HN_OK) {
        return false;
    }
    run->summary.reason[0] = '\0';
    run->trouble = 0;
    run->h_next = run->adaptive ? 0 : run->h_next;
    return true;
}

static hn_status step_once(hn_run *run) {
    if (run->summary.steps + run->summary.rejected >= run->opts.max_steps) {
        snprintf(run->summary.reason, sizeof run->summary.reason,
                 "%lld steps were allowed and are used up at t = %.6g s", run->opts.max_steps,
                 run->now.t);
        return HN_ERR_BUDGET;
    }
    long long charts = hn_engine_cost(run, &run->main).chart_changes;
    run->has_dense = 1;
    hn_status status = take_one(run);
    if (status == HN_ERR_CHART && change_chart(run)) {
        charts = hn_engine_cost(run, &run->main).chart_changes;
        status = take_one(run);
    }
    run->dense_valid = status == HN_OK && hn_engine_has_dense(run) && run->has_dense &&
                       hn_engine_cost(run, &run->main).chart_changes == charts;
    return status;
}

static int watch_is_due(hn_run *run) {
    if (run->watch.every == 0) {
        return 0;
    }
    return ++run->watch.since >= run->watch.every;
}

// Steps until t >= t_end, or exactly one when `one` is set; t_end is then where the run is going.
static hn_status step_until(hn_run *run, double t_end, int one) {
    hn_status status = HN_OK;
    int ticking = 0;
    run->t_asked = t_end;
    do {
        const double slack = run->adaptive ? 0 : LANDING * run->h_next;
        if (!one && run->now.t >= t_end - slack) {
            break;
        }
        if (!ticking) {
            start_clock(run);
            ticking = 1;
        }
        status = step_once(run);
        if (status == HN_OK && watch_is_due(run)) {
            stop_clock(run);
            ticking = 0;
            status = hn_run_watch_look(run);
        }
    } while (status == HN_OK && !one);
    if (ticking) {
        stop_clock(run);
    }
    return status == HN_OK ? HN_OK : fail(run, status);
}

hn_status hn_run_advance(hn_run *run, double t_end) {
    if (run->summary.state == HN_RUN_FAILED) {
        return run->summary.status;
    }
    if (!isfinite(t_end)) {
        return HN_ERR_INPUT;
    }
    run->summary.state = HN_RUN_RUNNING;
    const hn_status status = step_until(run, t_end, 0);
    if (status == HN_OK) {
        run->summary.state = HN_RUN_FINISHED;
    }
    return status;
}

hn_status hn_run_step_towards(hn_run *run, double t_look) {
    if (run->summary.state == HN_RUN_FAILED) {
        return run->summary.status;
    }
    run->summary.state = HN_RUN_RUNNING;
    return step_until(run, t_look, 1);
}

hn_status hn_run_step(hn_run *run) {
    return hn_run_step_towards(run, run->now.t);
}

// --- life -------------------------------------------------------------------------------------------------

static hn_status create_memory(hn_run *run, const double *q, const double *v) {
    const size_t nq = (size_t)run->info.nq, nv = (size_t)run->info.nv;
    hn_run_state_at *states[] = {&run->start, &run->now, &run->before};
    for (int i = 0; i < 3; i++) {
        states[i]->q = hn_arena_doubles(run->arena, nq);
        states[i]->v = hn_arena_doubles(run->arena, nv);
    }
    run->sample_q = hn_arena_doubles(run->arena, nq);
    run->sample_v = hn_arena_doubles(run->arena, nv);
    run->sample_a = hn_arena_doubles(run->arena, nv);
    run->sample_lambda = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    run->sample_points = hn_arena_doubles(run->arena, 3 * (size_t)run->info.n_points);
    run->at_q = hn_arena_doubles(run->arena, nq);
    run->at_v = hn_arena_doubles(run->arena, nv);
    run->sample_raw = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    run->at_a = hn_arena_doubles(run->arena, nv);
    run->at_lambda = hn_arena_doubles(run->arena, (size_t)run->info.nc);
    run->work = hn_arena_doubles(run->arena, nq + nv);
    if (hn_arena_failed(run->arena)) {
        return HN_ERR_MEMORY;
    }
    memcpy(run->start.q, q, nq * sizeof *q);
    memcpy(run->start.v, v, nv * sizeof *v);
    hn_status status = hn_eval_create(run->sys, HN_TERM_POINTS, run->arena, &run->points);
    return status == HN_OK ? hn_run_watch_create(run) : status;
}

// the counters of a fresh run; the state goes back to the start
static void clear(hn_run *run) {
    const int every = run->watch.every;
    run->summary = (hn_run_summary){.t = run->opts.t0, .watched_every = every};
    run->n_incidents = 0;
    run->has_step = run->dense_valid = run->trouble = run->held = run->free = 0;
    run->control = (hn_step_control){.last = 1};
    run->h_next = run->adaptive ? 0 : hn_method_option(&run->spec, "h", 0);
    run->now.t = run->opts.t0;
    memcpy(run->now.q, run->start.q, (size_t)run->info.nq * sizeof(double));
    memcpy(run->now.v, run->start.v, (size_t)run->info.nv * sizeof(double));
    run->grid = 0;
    run->restart = 0;
    find_corner(run);
    hn_run_watch_start(run);
    hn_run_tell_step_limit(run);
}

static hn_status start_engine(hn_run *run, hn_run_engine *e) {
    return hn_engine_start(run, e, run->opts.t0, run->start.q, run->start.v);
}

static hn_status create_parts(hn_run *run, const double *q, const double *v, hn_diag *diag) {
    hn_status status = create_memory(run, q, v);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }
    if (!state_is_sane(run->info.nq, q) || !state_is_sane(run->info.nv, v)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "the starting coordinates and speeds must be finite and below %g",
                           STATE_BOUND);
    }
    status = hn_engine_create(run, &run->main, diag);
    if (status == HN_OK) {
        status = hn_engine_create(run, &run->side, diag);
    }
    if (status != HN_OK) {
        return status;
    }
    run->watch.every = 1;
    clear(run);
    status = start_engine(run, &run->main);
    if (status == HN_OK) {
        status = start_engine(run, &run->side);
    }
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
    run->arena = arena;
    run->sys = sys;
    run->spec = *spec;
    run->info = hn_system_get_info(sys);
    run->adaptive = hn_method_is_adaptive(spec) || hn_engine_paces_itself(run);
    run->length = hn_system_length(sys);
    run->clock_cost = calc_clock_cost();
    run->opts = opts ? *opts : hn_run_opts_default();
    if (run->opts.max_steps <= 0) {
        run->opts.max_steps = DEFAULT_MAX_STEPS;
    }
    if (!(run->opts.warn_gap > 0)) {
        run->opts.warn_gap = HN_RUN_WARN_GAP;
    }
    const hn_status status = create_parts(run, q, v, diag);
    if (status != HN_OK) {
        hn_run_free(run);
        return status;
    }
    *out = run;
    return HN_OK;
}

void hn_run_free(hn_run *run) {
    if (!run) {
        return;
    }
    hn_engine_destroy(run, &run->main);
    hn_engine_destroy(run, &run->side);
    hn_run_watch_free(run);
    hn_eval_free(run->points);
    hn_arena_free(run->arena);
    free(run);
}

hn_status hn_run_reset(hn_run *run) {
    clear(run);
    const hn_status status = start_engine(run, &run->main);
    return status == HN_OK ? HN_OK : fail(run, status);
}

double hn_run_time(const hn_run *run) {
    return run->now.t;
}

hn_run_summary hn_run_get_summary(const hn_run *run) {
    return run->summary;
}

int hn_run_incidents(const hn_run *run, const hn_incident **out) {
    *out = run->incidents;
    return run->n_incidents;
}

void hn_run_watch(hn_run *run, int every) {
    run->watch.every = every > 0 ? every : 0;
    run->summary.watched_every = run->watch.every;
}

const hn_method_spec *hn_run_spec(const hn_run *run) {
    return &run->spec;
}

// --- settings while running -------------------------------------------------------------------------------

static hn_status unknown_key(const hn_run *run, const char *key, hn_diag *diag) {
    const char *keys[2 * HN_MAX_OPTIONS];
    char hint[64] = "";
    int n = 0;
    for (int i = 0; i < run->spec.formulation->n_options; i++) {
        keys[n++] = run->spec.formulation->options[i].key;
    }
    for (int i = 0; i < run->spec.stepper->n_options; i++) {
        if (strcmp(run->spec.stepper->options[i].key, key) == 0) {
            return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "make the run anew with it",
                               "%s belongs to the integrator and stays as it is during a run", key);
        }
        keys[n++] = run->spec.stepper->options[i].key;
    }
    const char *near = hn_nearest_name(key, keys, n);
    if (near) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", near);
    }
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "%s has no setting '%s'",
                       run->spec.formulation->name, key);
}

hn_status hn_run_set(hn_run *run, const char *key, double value, hn_diag *diag) {
    const hn_formulation *f = run->spec.formulation;
    int i = 0;
    while (i < f->n_options && strcmp(f->options[i].key, key) != 0) {
        i++;
    }
    if (i == f->n_options) {
        return unknown_key(run, key, diag);
    }
    hn_status status = hn_option_check(&f->options[i], value, diag);
    if (status != HN_OK) {
        return status;
    }
    // an integrator that takes the system as it is has the settings since it was made
    status = f->set && run->main.formulation ? f->set(run->main.formulation, i, value)
                                             : HN_ERR_UNSUPPORTED;
    if (status == HN_OK) {
        status = f->set(run->side.formulation, i, value);
    }
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, "make the run anew with it",
                           "%s of %s cannot change during a run", key, f->name);
    }
    run->spec.formulation_set[i] = value;
    if (run->main.stepper) {
        hn_engine_accepted(run, &run->main, 1); // slopes kept from before are stale
    }
    hn_run_tell_step_limit(run);
    return HN_OK;
}
