// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stepping/stepping.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A trial that failed outright adds FAILED_TRIAL, a good step takes 1 away: steps that keep running
// into the end of a chart shrink for ever without reaching it, and stop at TROUBLE_LIMIT.
enum { FAILED_TRIAL = 8, TROUBLE_LIMIT = 200 };
// If Newton's method fails at every other step the step grows back slowly, lest it runs into the
// same wall each time.
enum { TROUBLE_SEEN = 2 * FAILED_TRIAL };
#define GROWTH_IN_TROUBLE 1.02
#define UNDERFLOW_EPS 3.6e-15 // 16 eps: smaller steps no longer move t reliably
#define SHORT_OF 8.9e-16      // 4 eps: of the larger of two times
#define RESTING_STEP 1e-3     // of the time asked for: a driven mechanism at rest has no time scale

bool hn_stepping_is_sane(int n, const double *y) {
    bool sane = true;
    for (int i = 0; i < n; i++) {
        sane &= fabs(y[i]) < HN_STEPPING_BOUND; // false where it is not a number
    }
    return sane;
}

// ---- a trial and its acceptance ----

/// One trial of size h towards t_new. A fixed step is corrected here, an adaptive one only once its
/// error is accepted.
static hn_status try_step(hn_stepping *s, double h, double t_new, int *changed) {
    hn_engine *e = &s->engine;
    HN_TRY(hn_engine_step(e, s->now.t, h));
    if (!hn_stepping_is_sane(e->ode.n_pos + e->ode.n_vel, e->y_new)) {
        return HN_ERR_DIVERGED;
    }
    *changed = 0;
    return s->adaptive ? HN_OK : hn_engine_correct(e, t_new, e->y_new, changed);
}

static void copy_state(const hn_stepping *s, const hn_state_at *from, hn_state_at *to) {
    to->t = from->t;
    memcpy(to->q, from->q, (size_t)s->info.nq * sizeof *to->q);
    memcpy(to->v, from->v, (size_t)s->info.nv * sizeof *to->v);
}

/// Keeps the start of the present step, for whoever looks back from an event: `older` is given up
/// for `newer`.
static void keep_state(hn_stepping *s, hn_state_at *older, hn_state_at *newer) {
    const hn_state_at spare = *older;
    *older = *newer;
    *newer = spare;
    copy_state(s, &s->before, newer);
}

static hn_status accept(hn_stepping *s, double h, double t_new, int changed) {
    hn_engine *e = &s->engine;
    const hn_state_at spare = s->before;
    hn_engine_accepted(e, changed);

    // the new state takes the place of the old one, which becomes the start of the last step
    double *const y = e->y;
    e->y = e->y_new;
    e->y_new = y;
    s->before = s->now;
    s->now = spare;
    s->now.t = t_new;

    if ((s->steps & (s->steps + 1)) == 0) {
        keep_state(s, &s->earlier, &s->recent);
    }
    if (s->steps % HN_STEPPING_KEPT == 0) {
        keep_state(s, &s->shortly, &s->latest);
    }
    s->has_step = true;
    s->corrected = changed;
    s->h = h;
    s->steps++;
    return hn_engine_read(e, t_new, e->y, s->now.q, s->now.v);
}

// ---- corners of loads ----

double hn_stepping_short_of(double from, double to) {
    return (to - from) - SHORT_OF * fmax(fabs(from), fabs(to));
}

static double smallest_step(const hn_stepping *s) {
    return UNDERFLOW_EPS * (1e-3 + fabs(s->now.t));
}

static void find_corner(hn_stepping *s) {
    s->corner = hn_system_next_corner(s->sys, s->now.t);
    while (s->corner - s->now.t <= 4 * smallest_step(s)) { // no room for a step: it is here
        s->now.t = s->corner;
        s->corner = hn_system_next_corner(s->sys, s->now.t);
    }
}

static hn_status accept_at_corner(hn_stepping *s, double h) {
    const hn_status status = accept(s, h, s->corner, 1); // slopes kept from before are stale
    s->restart = true;                                   // once the last step has been sampled
    s->control = (hn_step_control){.last = 1};
    find_corner(s);
    return status;
}

void hn_stepping_loads_changed(hn_stepping *s, double t) {
    find_corner(s);
    if (s->now.t < t) {
        return;
    }
    s->restart = true;
    s->control = (hn_step_control){.last = 1};
    s->h_next = s->adaptive ? 0 : s->h_next;
    if (s->engine.stepper) {
        hn_engine_accepted(&s->engine, 1); // slopes kept from before are stale
    }
}

// ---- fixed steps ----

static hn_status step_fixed(hn_stepping *s) {
    int changed = 0;
    const double h = s->h_next;
    const double here = s->t0 + (double)s->grid * h;
    const double next = s->t0 + (double)(s->grid + 1) * h;

    // a corner on the way ends this step; the one after it goes on to the grid point
    if (s->corner < next + HN_STEPPING_LANDING * h) {
        const bool lands = s->corner > next - HN_STEPPING_LANDING * h;
        const double part = hn_stepping_short_of(s->now.t, s->corner);
        HN_TRY(try_step(s, part, s->corner, &changed));
        s->grid += lands;
        return accept_at_corner(s, part);
    }
    const double rest = s->now.t == here ? h : next - s->now.t;
    HN_TRY(try_step(s, rest, next, &changed));
    s->grid++;
    return accept(s, rest, next, changed);
}

// ---- steps from tolerances ----

/// With no degree of freedom left the drive alone bounds the step.
static bool is_driven(const hn_stepping *s) {
    return s->engine.ode.n_pos + s->engine.ode.n_vel == 0;
}

static hn_step_tolerances find_tolerances(const hn_stepping *s) {
    const hn_stepper *stepper = s->spec.stepper;
    const double rtol = hn_method_option(&s->spec, "rtol", 1e-6);
    const double atol = hn_method_option(&s->spec, "atol", 0);
    const double hmax = hn_method_option(&s->spec, "hmax", 0);
    const int order = stepper->control_order > 0 ? stepper->control_order : stepper->order;
    return (hn_step_tolerances){.rtol = rtol,
                                .atol = atol > 0 ? atol : rtol,
                                .largest = hmax > 0 ? hmax : HUGE_VAL,
                                .order = order};
}

static hn_status choose_first_step(hn_stepping *s, const hn_step_tolerances *tol) {
    hn_engine *e = &s->engine;
    const double h0 = hn_method_option(&s->spec, "h0", 0);
    if (h0 > 0) {
        s->h_next = fmin(h0, tol->largest);
        return HN_OK;
    }
    if (is_driven(s)) {
        const double h = hn_drive_first_step(s->sys, s->now.v);
        s->h_next = fmin(h > 0 ? h : RESTING_STEP * (s->t_asked - s->now.t), tol->largest);
        return HN_OK;
    }
    return hn_first_step(&e->ode, s->now.t, e->y, s->spec.stepper->order, tol->rtol, tol->atol,
                         tol->largest, e->y_new, e->err, s->work, &s->h_next);
}

/// Returns the error norm of a trial, infinite when it failed; a trial with a norm <= 1 has been
/// corrected.
static double try_adaptive(hn_stepping *s, double h, const hn_step_tolerances *tol, int *changed,
                           hn_status *status) {
    hn_engine *e = &s->engine;
    *status = try_step(s, h, s->now.t + h, changed);
    if (*status != HN_OK) {
        return HUGE_VAL;
    }

    // the error of the trial; without degrees of freedom it is that of the drive
    const int n = e->ode.n_pos + e->ode.n_vel;
    const hn_tolerance allowed = hn_tolerance_for(&e->ode, tol->rtol, tol->atol);
    double err = hn_error_norm(n, e->err, e->y, e->y_new, &allowed);
    if (is_driven(s)) {
        *status = hn_engine_read(e, s->now.t + h, e->y_new, s->work, s->work + s->info.nq);
        err = *status == HN_OK ? hn_drive_norm(s->sys, s->now.q, s->work) : HUGE_VAL;
    }

    // accepted: prepare dense output, and correct the loops
    if (err <= 1) {
        // dense output costs extra evaluations: only for a step that may be sampled inside
        s->has_dense = s->now.t + h >= s->t_asked - HN_STEPPING_LANDING * h;
        *status = s->has_dense ? hn_engine_finish(e) : HN_OK;
        if (*status == HN_OK) {
            *status = hn_engine_correct(e, s->now.t + h, e->y_new, changed);
        }
    }
    return *status == HN_OK ? err : HUGE_VAL;
}

/// The status and reason of a run whose step has become too small, `cause` the failure of its last
/// trial.
static hn_status underflow(hn_stepping *s, hn_status cause) {
    const char *why = NULL;
    if (cause != HN_OK) {
        why = hn_engine_why(&s->engine);
        why = why ? why : hn_status_text(cause);
    }
    // the failure of the trials is the reason, the small step only its consequence
    if (cause != HN_OK && cause != HN_ERR_DIVERGED) {
        snprintf(s->reason, sizeof s->reason, "%s", why);
        return cause;
    }
    snprintf(s->reason, sizeof s->reason, "the step fell to %.2g s at t = %.6g s: %s", s->h_next,
             s->now.t, why ? why : "the error stays above its tolerance");
    return HN_ERR_STEP_UNDERFLOW;
}

static hn_status accept_adaptive(hn_stepping *s, double h, bool at_corner, int changed) {
    if (s->iterating && s->trouble >= TROUBLE_SEEN) {
        s->h_next = fmin(s->h_next, GROWTH_IN_TROUBLE * h);
    }
    s->trouble -= s->trouble > 0;
    if (at_corner) {
        s->h_next = 0; // chosen anew for what begins here
        return accept_at_corner(s, h);
    }
    return accept(s, h, s->now.t + h, changed);
}

static hn_status step_adaptive(hn_stepping *s) {
    hn_step_tolerances tol = s->tol;
    hn_status status = HN_OK;
    if (is_driven(s)) {
        tol.order = 1;
    }
    if (s->h_next <= 0) {
        HN_TRY(choose_first_step(s, &tol));
    }
    for (;;) {
        const bool at_corner = s->now.t + s->h_next >= s->corner;
        const double h = at_corner ? hn_stepping_short_of(s->now.t, s->corner) : s->h_next;
        if (h <= smallest_step(s) || s->trouble > TROUBLE_LIMIT) {
            return underflow(s, status);
        }
        if (s->steps + s->rejected >= s->max_steps) {
            return HN_ERR_STOPPED;
        }

        // a trial, and the next size by its error
        int changed = 0;
        const double err = try_adaptive(s, h, &tol, &changed, &status);
        s->h_next = fmin(h * hn_step_factor(&s->control, err, tol.order), tol.largest);
        if (err <= 1) {
            return accept_adaptive(s, h, at_corner, changed);
        }
        if (status != HN_OK) {
            s->trouble += FAILED_TRIAL;
            s->iterating = status == HN_ERR_NO_CONVERGENCE; // no end of a chart lies ahead then
        }
        s->rejected++;
    }
}

/// A step of an integrator that chooses its size itself.
static hn_status step_of_its_own(hn_stepping *s) {
    hn_engine *e = &s->engine;
    double t_new = s->now.t;
    int changed = 0;
    const double stop =
        isfinite(s->corner) ? s->now.t + hn_stepping_short_of(s->now.t, s->corner) : HUGE_VAL;
    const long long rejected = hn_engine_cost(e).rejected;
    hn_status status = HN_OK;
    if (s->restart) {
        status = hn_engine_start(e, s->now.t, s->now.q, s->now.v);
        s->restart = false;
    }
    HN_THEN(status, hn_engine_advance(e, s->now.t, stop, &t_new));
    s->rejected +=
        hn_engine_cost(e).rejected - rejected; // counted whether or not the step came off

    HN_TRY(status);
    if (!hn_stepping_is_sane(e->ode.n_pos + e->ode.n_vel, e->y_new)) {
        return HN_ERR_DIVERGED;
    }
    HN_TRY(hn_engine_correct(e, t_new, e->y_new, &changed));
    return t_new >= stop ? accept_at_corner(s, t_new - s->now.t)
                         : accept(s, t_new - s->now.t, t_new, changed);
}

// ---- any step ----

static hn_status take_step(hn_stepping *s) {
    if (hn_engine_paces_itself(&s->spec)) {
        return step_of_its_own(s);
    }
    return s->adaptive ? step_adaptive(s) : step_fixed(s);
}

/// The end of a chart is not the end of the motion: true where another chart takes over.
static bool change_chart(hn_stepping *s) {
    if (hn_engine_change_chart(&s->engine, s->now.t) != HN_OK) {
        return false;
    }
    s->reason[0] = '\0';
    s->trouble = 0;
    s->h_next = s->adaptive ? 0 : s->h_next;
    return true;
}

static long long count_charts(const hn_stepping *s) {
    return hn_engine_has_chart(&s->engine) ? hn_engine_cost(&s->engine).chart_changes : 0;
}

hn_status hn_stepping_step(hn_stepping *s) {
    if (s->steps + s->rejected >= s->max_steps) {
        snprintf(s->reason, sizeof s->reason,
                 "%lld steps were allowed and are used up at t = %.6g s", s->max_steps, s->now.t);
        return HN_ERR_STOPPED;
    }
    long long charts = count_charts(s);
    s->has_dense = true;
    s->dense_valid = false;
    hn_status status = take_step(s);
    if (status == HN_ERR_CHART && change_chart(s)) {
        charts = count_charts(s);
        status = take_step(s);
    }
    HN_TRY(status);
    s->dense_valid = s->has_dense && hn_engine_has_dense(&s->engine) && count_charts(s) == charts;
    return HN_OK;
}

// ---- life ----

void hn_stepping_clear(hn_stepping *s) {
    s->has_step = s->dense_valid = s->corrected = s->restart = s->iterating = false;
    s->trouble = 0;
    s->steps = s->rejected = s->grid = 0;
    s->h = 0;
    s->reason[0] = '\0';
    s->headway = (hn_headway){.t = s->t0};
    s->control = (hn_step_control){.last = 1};
    s->h_next = s->adaptive ? 0 : hn_method_option(&s->spec, "h", 0);
    s->now.t = s->start.t = s->t0;
    memcpy(s->now.q, s->start.q, (size_t)s->info.nq * sizeof(double));
    memcpy(s->now.v, s->start.v, (size_t)s->info.nv * sizeof(double));
    copy_state(s, &s->start, &s->earlier);
    copy_state(s, &s->start, &s->recent);
    copy_state(s, &s->start, &s->shortly);
    copy_state(s, &s->start, &s->latest);
    find_corner(s);
}

hn_status hn_stepping_start_engine(hn_stepping *s, hn_engine *e) {
    return hn_engine_start(e, s->t0, s->start.q, s->start.v);
}

static hn_status create_memory(hn_stepping *s) {
    const hn_accel_opts with_lambda = {.want_lambda = 1};
    const size_t nq = (size_t)s->info.nq, nv = (size_t)s->info.nv;
    hn_state_at *states[] = {&s->start,  &s->now,     &s->before, &s->earlier,
                             &s->recent, &s->shortly, &s->latest};
    for (size_t i = 0; i < sizeof states / sizeof *states; i++) {
        states[i]->q = hn_arena_doubles(s->arena, nq);
        states[i]->v = hn_arena_doubles(s->arena, nv);
    }
    s->work = hn_arena_doubles(s->arena, nq + nv);
    return hn_arena_failed(s->arena) ? HN_ERR_MEMORY
                                     : hn_accel_create(s->sys, &with_lambda, s->arena, &s->accel);
}

hn_status hn_stepping_create(const hn_system *sys, const hn_method_spec *spec, double t0,
                             long long max_steps, const double *q, const double *v, hn_arena *arena,
                             hn_stepping *s, hn_diag *diag) {
    *s = (hn_stepping){.sys = sys,
                       .spec = *spec,
                       .info = hn_system_get_info(sys),
                       .arena = arena,
                       .t0 = t0,
                       .max_steps = max_steps};
    s->adaptive = hn_method_is_adaptive(spec) || hn_engine_paces_itself(spec);
    s->tol = find_tolerances(s);
    const hn_status status = create_memory(s);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }

    memcpy(s->start.q, q, (size_t)s->info.nq * sizeof *q);
    memcpy(s->start.v, v, (size_t)s->info.nv * sizeof *v);
    if (!hn_stepping_is_sane(s->info.nq, q) || !hn_stepping_is_sane(s->info.nv, v)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/scene/start", NULL,
                           "the starting coordinates and velocities must be finite and below %g",
                           HN_STEPPING_BOUND);
    }
    return hn_engine_create(sys, &s->spec, s->accel, arena, &s->engine, diag);
}

void hn_stepping_free(hn_stepping *s) {
    hn_engine_destroy(&s->engine);
    hn_accel_free(s->accel);
}
