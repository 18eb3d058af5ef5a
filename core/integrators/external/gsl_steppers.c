// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/gsl_control.h"
#include "integrators/step/options.h"
#include "linalg/dense.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Four integrators of the GNU Scientific Library under the library's own step control, to compare
// with. Only the first step is ours (hn_first_step): the library asks its caller for it. The
// library allocates when an instance is made and nothing in a step.

#define ROUNDING 1e-16 // see probe()
#define PROBE_MIN 1e-5 // of its unit: an entry near zero is moved by a sensible amount
#define FAR 1e30       // no bound on time [s]
#define FAR_STEP 1e10  // a state without entries has no error to choose a step by [s]
// A trial that was refused outright adds REFUSED_TRIAL, a step without takes 1 away: steps that
// keep running into the end of a chart shrink for ever without reaching it, and stop here.
enum { REFUSED_TRIAL = 8, TROUBLE_LIMIT = 200 };

typedef struct gsl_stepper {
    const gsl_odeiv2_step_type *type;
    int start_order; // power of h in the error of the first step
    int n;
    double rtol, atol, h0, hmax;
    bool has_tolerance; ///< the library has units and angles of the tolerance
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver; // NULL: no entries
    const hn_ode *ode;         // of the call that is under way
    double h;                  // the library's wish for the next step, 0: not chosen yet
    int fresh;                 // nothing before this state may be used
    hn_status refused;         // what the right-hand side said last, HN_OK or why not
    hn_status refusal;         // its last refusal
    int refusals;              // in this step
    int trouble;               // see advance()
    double *f0, *f1, *moved;   // n
    double *turns;             // n: whole turns of angles, left out of what the library sees
    double *whole;             // n: a state of the library with these turns
    long long rejected;
    unsigned long failed_before;
    char why[160];
} gsl_stepper;

// ---- what the library asks ----

// a refused right-hand side is a step too long: the library halves it and tries again
static int told(gsl_stepper *s, hn_status status) {
    s->refused = status;
    if (status != HN_OK) {
        s->refusal = status;
        s->refusals++;
    }
    return status == HN_OK ? GSL_SUCCESS : GSL_FAILURE;
}

// The library sees angles without the whole turns that they had at its last start: its own measures
// are relative to |y| (the weights of bsimp, say).
static const double *with_turns(gsl_stepper *s, const double *y) {
    for (int i = 0; i < s->n; i++) {
        s->whole[i] = y[i] + s->turns[i];
    }
    return s->whole;
}

static int give_slope(double t, const double *y, double *ydot, void *user) {
    gsl_stepper *s = user;
    return told(s, s->ode->rhs(s->ode->self, t, with_turns(s, y), ydot));
}

// Displacement of a difference quotient that balances truncation and rounding (Hairer & Wanner
// 1996, section IV.8).
static double probe(double x, double unit) {
    return sqrt(ROUNDING * unit * fmax(PROBE_MIN * unit, fabs(x)));
}

static hn_status difference_jacobian(gsl_stepper *s, double t, const double *y, double *jac) {
    const int n = s->n;
    memcpy(s->moved, y, (size_t)n * sizeof *y);
    for (int j = 0; j < n; j++) {
        s->moved[j] = y[j] + probe(y[j], s->ode->unit ? s->ode->unit[j] : 1);
        const double d = s->moved[j] - y[j];
        const hn_status status = s->ode->rhs(s->ode->self, t, s->moved, s->f1);
        if (status != HN_OK) {
            return status;
        }
        for (int i = 0; i < n; i++) {
            jac[i * n + j] = (s->f1[i] - s->f0[i]) / d;
        }
        s->moved[j] = y[j];
    }
    return HN_OK;
}

static int give_jacobian(double t, const double *state, double *jac, double *time_slope,
                         void *user) {
    gsl_stepper *s = user;
    const double *y = with_turns(s, state);
    const double later = t + probe(t, 1);
    hn_status status = s->ode->rhs(s->ode->self, t, y, s->f0);
    HN_THEN(status, s->ode->rhs(s->ode->self, later, y, s->f1));
    for (int i = 0; status == HN_OK && i < s->n; i++) {
        time_slope[i] = (s->f1[i] - s->f0[i]) / (later - t);
    }
    HN_THEN(status, s->ode->jacobian ? s->ode->jacobian(s->ode->self, t, y, jac)
                                     : difference_jacobian(s, t, y, jac));
    return told(s, status);
}

// ---- life ----

static gsl_stepper *create(const gsl_odeiv2_step_type *type, int start_order, int n,
                           hn_arena *arena) {
    gsl_stepper *s = hn_arena_get(arena, sizeof *s);
    double *const room = hn_arena_doubles(arena, 5 * (size_t)n);
    if (!s || !room) {
        return NULL;
    }
    // the library's own way to report faults ends the program; with it off they come back as
    // numbers
    gsl_set_error_handler_off();

    *s = (gsl_stepper){.type = type, .start_order = start_order, .n = n, .fresh = 1};
    s->f0 = room;
    s->f1 = room + n;
    s->moved = room + 2 * (size_t)n;
    s->turns = room + 3 * (size_t)n;
    s->whole = room + 4 * (size_t)n;
    s->rtol = s->atol = 1e-6;
    s->hmax = FAR_STEP;
    s->system = (gsl_odeiv2_system){give_slope, give_jacobian, (size_t)n, s};

    // a system without coordinates has nothing for the library to step
    if (n > 0) {
        s->driver = gsl_odeiv2_driver_alloc_y_new(&s->system, type, 1, s->atol, s->rtol);
        return s->driver ? s : NULL;
    }
    return s;
}

static void destroy(void *self) {
    gsl_stepper *s = self;
    if (s->driver) {
        gsl_odeiv2_driver_free(s->driver);
    }
}

static void configure(void *self, const double *options) {
    gsl_stepper *s = self;
    s->rtol = options[HN_ADAPTIVE_RTOL];
    s->atol = options[HN_ADAPTIVE_ATOL] > 0 ? options[HN_ADAPTIVE_ATOL] : s->rtol;
    s->h0 = options[HN_ADAPTIVE_FIRST_STEP];
    s->hmax = options[HN_ADAPTIVE_LARGEST_STEP] > 0 ? options[HN_ADAPTIVE_LARGEST_STEP] : FAR_STEP;
    if (s->driver) {
        // |error| <= atol + rtol |y|, entry by entry
        gsl_odeiv2_control_init(s->driver->c, s->atol, s->rtol, 1, 0);
    }
}

static void accepted(void *self, int changed) {
    gsl_stepper *s = self;
    s->fresh |= changed;
}

// ---- a step ----

/// Gives the library the units and angles of the tolerance; once, as it allocates.
static hn_status use_tolerance(gsl_stepper *s) {
    bool plain = !s->ode->is_angle;
    for (int i = 0; i < s->n && s->ode->unit; i++) {
        plain = plain && s->ode->unit[i] == 1;
    }
    if (plain || s->has_tolerance) {
        return HN_OK;
    }
    const hn_tolerance tol = hn_tolerance_for(s->ode, s->rtol, s->atol);
    gsl_odeiv2_control *c = hn_gsl_control_create(&tol, s->n);
    if (!c) {
        return HN_ERR_MEMORY;
    }
    gsl_odeiv2_control_free(s->driver->c);
    s->driver->c = c;
    gsl_odeiv2_control_set_driver(c, s->driver);
    s->has_tolerance = true;
    return HN_OK;
}

static hn_status restart(gsl_stepper *s, double t, const double *y) {
    gsl_odeiv2_step_reset(s->driver->s);
    gsl_odeiv2_evolve_reset(s->driver->e);
    s->failed_before = 0;
    s->fresh = 0;
    const hn_tolerance tol = hn_tolerance_for(s->ode, s->rtol, s->atol);
    hn_whole_turns(&tol, s->n, y, s->turns);
    HN_TRY(use_tolerance(s));
    if (s->h > 0) {
        return HN_OK; // the motion goes on at its pace
    }
    if (s->h0 > 0) {
        s->h = s->h0;
        return HN_OK;
    }
    return hn_first_step(s->ode, t, y, s->start_order, s->rtol, s->atol, s->hmax, s->f0, s->f1,
                         s->moved, &s->h);
}

static hn_status explain(gsl_stepper *s, int code, double t) {
    if (s->refused != HN_OK) {
        return s->refused; // the formulation knows why
    }
    snprintf(s->why, sizeof s->why,
             "GSL's %s: the step fell to %.2g s at t = %.6g s and the error stays above its "
             "tolerance (%s)",
             s->type->name, s->h, t, gsl_strerror(code));
    return HN_ERR_STEP_UNDERFLOW;
}

static hn_status advance(void *self, const hn_ode *ode, double t, double t_stop, const double *y,
                         double *t_new, double *y_new) {
    gsl_stepper *s = self;
    if (!s->driver) {
        *t_new = fmin(t + s->hmax, t_stop);
        return HN_OK;
    }

    // a run that meets too many refused states ends
    s->ode = ode;
    s->refused = HN_OK;
    s->refusals = 0;
    if (s->trouble > TROUBLE_LIMIT) {
        return s->refusal;
    }
    if (s->fresh) {
        const hn_status status = restart(s, t, y);
        if (status != HN_OK) {
            return status;
        }
    }

    // one step of the library, held to hmax and to the stop
    gsl_odeiv2_evolve *e = s->driver->e;
    const double wish = s->h;
    s->h = fmin(s->h, s->hmax);
    for (int i = 0; i < s->n; i++) {
        y_new[i] = y[i] - s->turns[i];
    }
    *t_new = t;
    const int code = gsl_odeiv2_evolve_apply(e, s->driver->c, s->driver->s, &s->system, t_new,
                                             fmin(t_stop, FAR), &s->h, y_new);

    hn_axpy(s->n, 1, s->turns, y_new);

    // count what the library rejected, and explain a failure
    s->rejected += (long long)(e->failed_steps - s->failed_before);
    s->failed_before = e->failed_steps;
    s->trouble += s->refusals > 0 ? REFUSED_TRIAL * s->refusals : -(s->trouble > 0);
    if (code != GSL_SUCCESS) {
        return explain(s, code, t);
    }
    if (*t_new == t_stop) {
        s->h = fmax(s->h, wish); // a step cut short at the stop says nothing about the next
    }
    return HN_OK;
}

static void add_cost(const void *self, hn_cost *cost) {
    const gsl_stepper *s = self;
    cost->rejected += s->rejected;
}

static const char *why(const void *self) {
    const gsl_stepper *s = self;
    return s->why[0] ? s->why : NULL;
}

static hn_status prepare(void *self, const hn_ode *ode) {
    const gsl_stepper *s = self;
    const int with_jacobian = s->type == gsl_odeiv2_step_msbdf || s->type == gsl_odeiv2_step_bsimp;
    return with_jacobian && ode->prepare ? ode->prepare(ode->self) : HN_OK;
}

// ---- the four ----

static void *create_rk8pd(int n_pos, int n_vel, hn_arena *arena) {
    return create(gsl_odeiv2_step_rk8pd, 8, n_pos + n_vel, arena);
}

static void *create_msadams(int n_pos, int n_vel, hn_arena *arena) {
    return create(gsl_odeiv2_step_msadams, 2, n_pos + n_vel, arena);
}

static void *create_msbdf(int n_pos, int n_vel, hn_arena *arena) {
    return create(gsl_odeiv2_step_msbdf, 2, n_pos + n_vel, arena);
}

static void *create_bsimp(int n_pos, int n_vel, hn_arena *arena) {
    return create(gsl_odeiv2_step_bsimp, 2, n_pos + n_vel, arena);
}

#define GSL_SOURCE "GNU Scientific Library, gsl_odeiv2; "
// clang-format off
#define GSL_STEPPER(NAME, TITLE, ABOUT, SOURCE, ORDER, MULTISTEP, STAGES, REAL, IMAG) \
    const hn_stepper hn_stepper_gsl_##NAME = {                                        \
        .name = "gsl-" #NAME,                                                         \
        .title = TITLE,                                                               \
        .about = ABOUT,                                                               \
        .source = GSL_SOURCE SOURCE,                                                  \
        .order = ORDER,                                                               \
        .multistep = MULTISTEP,                                                       \
        .stages = STAGES,                                                             \
        .adaptive = true,                                                             \
        .real_limit = REAL,                                                           \
        .imag_limit = IMAG,                                                           \
        .n_options = HN_ADAPTIVE_OPTIONS,                                             \
        .options = {HN_OPTIONS_ADAPTIVE},                                             \
        .create = create_##NAME,                                                      \
        .destroy = destroy,                                                           \
        .configure = configure,                                                       \
        .prepare = prepare,                                                           \
        .advance = advance,                                                           \
        .on_accepted = accepted,                                                         \
        .add_cost = add_cost,                                                         \
        .why = why,                                                                   \
    }
// clang-format on

GSL_STEPPER(rk8pd, "GSL Prince-Dormand 8(9)",
            "GSL's explicit Runge-Kutta pair with GSL's step control, to compare with dop853. It "
            "has no dense output: each sample between steps costs a step. rtol limits the error of "
            "one step, not that of the motion: over the shipped scenes at rtol=1e-6 the median "
            "error is 1.4 times rtol, and one scene in ten has more than 190 times rtol.",
            "Prince & Dormand 1981", 8, false, 13, HUGE_VAL, HUGE_VAL);

GSL_STEPPER(
    msadams, "GSL Adams 1-12",
    "GSL's multistep method for smooth motion, order 1 to 12, two evaluations per step. It "
    "restarts at order 1 when the state is changed after a step (projection, new independent "
    "coordinates): combine it with formulations that do not change the state. rtol limits the "
    "error of one step, not that of the motion: over the shipped scenes at rtol=1e-6 the median "
    "error is 460 times rtol, and one scene in ten has more than 7100000 times rtol.",
    "Byrne & Hindmarsh 1975", 12, true, 2, HUGE_VAL, HUGE_VAL);

GSL_STEPPER(
    msbdf, "GSL BDF 1-5",
    "GSL's multistep method for stiff motion, order 1 to 5, with a Jacobian. It restarts "
    "at order 1 when the state is changed after a step (projection, new independent "
    "coordinates): combine it with formulations that do not change the state. rtol limits "
    "the error of one step, not that of the motion: over the shipped scenes at rtol=1e-6 "
    "the median error is 740 times rtol, and one scene in ten has more than 1000000 times rtol.",
    "Byrne & Hindmarsh 1975", 5, true, 2, HUGE_VAL, HUGE_VAL);

GSL_STEPPER(
    bsimp, "GSL Bader-Deuflhard",
    "GSL's linearly implicit extrapolation for stiff motion: long steps of high order, "
    "with many evaluations and a Jacobian each. rtol limits the error of one step, not "
    "that of the motion: over the shipped scenes at rtol=1e-6 the median error is 53 times rtol, "
    "and one scene in ten has more than 12000 times rtol.",
    "Bader & Deuflhard 1983", 12, false, 30, HUGE_VAL, HUGE_VAL);
