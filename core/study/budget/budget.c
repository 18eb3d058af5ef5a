// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "study/budget/budget_back.h"
#include "study/budget/budget_state.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STEPS = 200000, NODES = 3 };
#define MOST_DOUBLES 40e6 // of memory for the steps: 320 MB
#define FLOW_TOL 1e-14    // of the flows beside each step

static const hn_budget_part_words cause_words[HN_CAUSE_COUNT] = {
#define HN_CAUSE_ROW(code, name, letter, word, about) {name, letter, word, about},
    HN_CAUSE_LIST(HN_CAUSE_ROW)
#undef HN_CAUSE_ROW
};
static const hn_budget_part_words energy_item_words[HN_ENERGY_COUNT] = {
#define HN_ENERGY_ROW(code, name, letter, word, about) {name, letter, word, about},
    HN_ENERGY_LIST(HN_ENERGY_ROW)
#undef HN_ENERGY_ROW
};

const hn_budget_part_words *hn_cause_words(hn_cause cause) {
    return &cause_words[cause];
}

const hn_budget_part_words *hn_energy_item_words(hn_energy_item item) {
    return &energy_item_words[item];
}

// ---- the equations of motion as index 1, defined off the loops too ----

static hn_status plain_rhs(void *self, double t, const double *y, double *ydot) {
    hn_budget_work *b = self;
    const double *v = y + b->info.nq;
    hn_system_kinematics(b->sys, y, v, ydot);
    return hn_accel_eval(b->accel, t, y, v, 0, 0, ydot + b->info.nq, b->lambda, NULL);
}

static double energy_at(hn_budget_work *b, double t, const double *y) {
    hn_eval_run(b->eval, t, y, y + b->info.nq);
    const double *e = hn_eval_get(b->eval, HN_TERM_ENERGY);
    b->t_max = fmax(b->t_max, e[0]);
    b->v_min = fmin(b->v_min, e[1]);
    b->v_max = fmax(b->v_max, e[1]);
    return e[0] + e[1];
}

/// lambda'(J v + phi_t): the power of loop forces on loops that are not closed in speed.
static hn_status loop_power(hn_budget_work *b, double t, const double *y, double *power) {
    const int nv = b->info.nv, nc = b->info.nc;
    const double *v = y + b->info.nq;
    const hn_status status = hn_accel_eval(b->accel, t, y, v, 0, 0, b->a, b->lambda, NULL);
    hn_eval_run(b->eval, t, y, v);
    hn_mat_vec(nc, nv, hn_eval_get(b->eval, HN_TERM_J), v, b->gap);
    hn_axpy(nc, 1, hn_eval_get(b->eval, HN_TERM_PHI_T), b->gap);
    *power = hn_dot(nc, b->lambda, b->gap);
    return status;
}

/// The flow I over one step, into b->flowed, and the work of the loop forces on the way, by Gauss
/// quadrature of order 6.
static hn_status follow(hn_budget_work *b, double t, double h, const double *y, double *work) {
    static const double at[NODES] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
    static const double weight[NODES] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    memcpy(b->flowed, y, (size_t)b->ny * sizeof *y);
    double here = 0;
    *work = 0;
    hn_status status = HN_OK;
    for (int i = 0; status == HN_OK && i < NODES; i++) {
        double power = 0;
        status = hn_flow_run(b->flow, &b->plain, FLOW_TOL, t + here, at[i] * h - here, b->flowed,
                             b->flowed);
        here = at[i] * h;
        status = status == HN_OK ? loop_power(b, t + here, b->flowed, &power) : status;
        *work += weight[i] * h * power;
    }
    return status == HN_OK
               ? hn_flow_run(b->flow, &b->plain, FLOW_TOL, t + here, h - here, b->flowed, b->flowed)
               : status;
}

// ---- one step ----

static bool is_ode(const hn_budget_work *b) {
    const hn_method_spec *spec = hn_run_spec(b->run);
    return hn_method_form(spec->formulation, spec->stepper) == HN_FORM_ODE;
}

/// The flow B over one step, into b->owned, from the engine's own unknowns.
static hn_status follow_own(hn_budget_work *b, hn_engine *e, double t, double h, const double *y) {
    if (!b->own_flow) {
        const hn_status status = hn_flow_create(e->ode.n_pos, e->ode.n_vel, b->arena, &b->own_flow);
        if (status != HN_OK) {
            return status;
        }
        b->own_size = e->ode.n_pos + e->ode.n_vel;
    }
    if (e->ode.n_pos + e->ode.n_vel != b->own_size) {
        return HN_ERR_CHART; // the rank has changed, and with it the number of unknowns
    }
    const hn_status status = hn_flow_run(b->own_flow, &e->ode, FLOW_TOL, t, h, y, b->y_own);
    return status == HN_OK ? hn_engine_read(e, t + h, b->y_own, b->owned, b->owned + b->info.nq)
                           : status;
}

/// The flow B over a step that is already made, by a copy of the formulation that starts where the
/// step started.
static hn_status follow_aside(hn_budget_work *b, double t, double h, const double *y) {
    hn_engine *side = hn_run_side_engine(b->run);
    HN_TRY(hn_engine_start(side, t, y, y + b->info.nq));
    return follow_own(b, side, t, h, side->y);
}

/// The displacement from one state to another, in q along the velocities and in v: out (nd).
static void difference(const hn_budget_work *b, const double *from, const double *to, double *out) {
    hn_system_difference(b->sys, from, to, out);
    for (int i = 0; i < b->info.nv; i++) {
        out[b->info.nv + i] = to[b->info.nq + i] - from[b->info.nq + i];
    }
}

static hn_status make_room(hn_budget_work *b, hn_diag *diag) {
    if (b->kept < b->room) {
        return HN_OK;
    }
    const size_t room = b->room ? 2 * b->room : 1024;
    double *more = (double)(room * b->width) > 2 * MOST_DOUBLES
                       ? NULL
                       : realloc(b->record, room * b->width * sizeof *more);
    if (!more) {
        return hn_diag_set(diag, HN_ERR_LIMIT, "/time", "a larger step, or a shorter time",
                           "the error budget of more than %zu steps does not fit into memory",
                           b->kept);
    }
    b->record = more;
    b->room = room;
    return HN_OK;
}

/// Records a step of size h from t, at whose start y is: the three parts of (1) as displacements,
/// and the energy that each part changes. `work` is the work of the loops on the exact flow.
static void record_step(hn_budget_work *b, double t, double h, const double *y, double work) {
    hn_budget *out = b->out;
    double *r = hn_budget_work_record(b, b->kept), *part = r + 2 + b->ny;
    const double *after_own = is_ode(b) ? b->owned : b->flowed;
    const double *unmended = b->unmended.q; // q and v stand together

    // the three parts of (1)
    r[0] = t;
    r[1] = h;
    hn_budget_work_present(b, b->y);
    difference(b, after_own, unmended, part + HN_PART_TRUNCATION * b->nd);
    difference(b, b->flowed, after_own, part + HN_PART_FORMULATION * b->nd);
    difference(b, unmended, b->y, part + HN_PART_PROJECTION * b->nd);

    // energy: each part from the states that it lies between
    const double e0 = energy_at(b, t, y), e1 = energy_at(b, t + h, b->flowed),
                 e2 = energy_at(b, t + h, after_own), e3 = energy_at(b, t + h, unmended),
                 e4 = energy_at(b, t + h, b->y);
    out->energy_parts[HN_ENERGY_LOOPS] += work;
    out->energy_parts[HN_ENERGY_OUTSIDE] += e1 - e0 - work;
    out->energy_parts[HN_ENERGY_FORMULATION] += e2 - e1;
    out->energy_parts[HN_ENERGY_TRUNCATION] += e3 - e2;
    out->energy_parts[HN_ENERGY_PROJECTION] += e4 - e3;
    out->loop_work_abs += fabs(work);
    b->kept++;
}

/// Makes one step of the run and records it: the exact flows over the same time, the differences
/// between them and the step, and the energies.
static hn_status book_step(hn_budget_work *b, hn_diag *diag) {
    hn_stepping *steps = b->steps;
    HN_TRY(make_room(b, diag));

    // state at the start of the step, and the step size where it is known beforehand
    double *y = hn_budget_work_record(b, b->kept) + 2, work = 0;
    const double t = steps->now.t, planned = steps->adaptive ? 0 : steps->h_next;
    hn_budget_work_present(b, y);

    // B comes before the step where the step size is known: the formulation still has the chart or
    // basis that the step will use
    int owned = is_ode(b) && planned > 0 &&
                follow_own(b, &steps->engine, t, planned, steps->engine.y) == HN_OK;

    // the step of the run itself
    HN_TRY(hn_run_step(b->run));
    const double h = steps->now.t - t;

    // the exact flows I and B over the same time
    hn_status status = follow(b, t, h, y, &work);
    if (status == HN_OK && is_ode(b) && (!owned || fabs(h - planned) > 1e-9 * h)) {
        status = follow_aside(b, t, h, y);
        owned = 1;
    }
    if (status != HN_OK) {
        b->stuck = t;
        return hn_diag_set(diag, HN_ERR_NO_CONVERGENCE, NULL, NULL,
                           "the equations of motion could not be followed beside the step from t = "
                           "%.4g to %.4g s: %s",
                           t, steps->now.t, hn_status_text(status));
    }

    record_step(b, t, h, y, work);
    return HN_OK;
}

static hn_status book_steps(hn_budget_work *b, double T, hn_diag *diag) {
    const long long most = b->opts->max_steps > 0 ? b->opts->max_steps : MOST_STEPS;
    hn_status status = HN_OK;
    while (status == HN_OK && b->steps->now.t < T * (1 - HN_BOOKS_ARRIVED)) {
        if ((long long)b->kept >= most) {
            return hn_diag_set(diag, HN_ERR_LIMIT, "/time", "a larger step, or a shorter time",
                               "an error budget can have at most %lld steps", most);
        }
        if (b->kept % HN_BOOKS_BETWEEN_QUESTIONS == 0 &&
            hn_budget_work_asked_to_stop(b, 0.3 * b->steps->now.t / T)) {
            return hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "stopped on request");
        }
        if (b->steps->adaptive && b->steps->h_next > T - b->steps->now.t) {
            b->steps->h_next = T - b->steps->now.t; // the last step ends at T
        }
        status = book_step(b, diag);
    }
    return status;
}

// ---- the whole ----

static hn_status create_memory(hn_budget_work *b) {
    hn_arena *arena = b->arena;
    const size_t ny = (size_t)b->ny, nd = (size_t)b->nd, nv = (size_t)b->info.nv;

    // vectors, by their sizes
    double **states[] = {&b->y, &b->y_own, &b->flowed, &b->owned, &b->up, &b->down};
    for (size_t i = 0; i < sizeof states / sizeof *states; i++) {
        *states[i] = hn_arena_doubles(arena, ny + nv); // room for user coordinates too
    }
    double **displacements[] = {&b->w, &b->column, &b->split};
    for (size_t i = 0; i < sizeof displacements / sizeof *displacements; i++) {
        *displacements[i] = hn_arena_doubles(arena, nd);
    }
    b->zero = hn_arena_doubles(arena, nv);
    b->a = hn_arena_doubles(arena, nv);
    b->gap = hn_arena_doubles(arena, (size_t)b->info.nc);
    b->lambda = hn_arena_doubles(arena, (size_t)b->info.nc);
    b->unmended.q = hn_arena_doubles(arena, ny);

    // constant entries, and the layout of a record
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    memset(b->zero, 0, nv * sizeof *b->zero);
    b->unmended.v = b->unmended.q + b->info.nq;
    b->width = 2 + ny + HN_PARTS * nd;
    return HN_OK;
}

static hn_status create_parts(hn_budget_work *b) {
    const hn_accel_opts with = {.want_lambda = 1};
    hn_status status = create_memory(b);

    // evaluators of the mechanism
    HN_THEN(status, hn_accel_create(b->sys, &with, b->arena, &b->accel));
    HN_THEN(status,
            hn_eval_create(b->sys, HN_TERM_ENERGY | HN_TERM_J | HN_TERM_PHI_T, b->arena, &b->eval));
    HN_THEN(status, hn_linear_create(b->sys, HN_LINEAR_M | HN_LINEAR_J | HN_LINEAR_V, b->arena,
                                     &b->linear));
    HN_THEN(status, hn_flow_create(b->info.nq, b->info.nv, b->arena, &b->flow));
    HN_THEN(status, hn_accel_jacobian_create(b->sys, &(hn_accel_law){0}, b->arena, &b->slopes));
    HN_THEN(status, hn_flow_carrier_create(b->info.nq, b->info.nv, b->nd, b->arena, &b->carrier));

    // the splitting of displacements, and the equations that the flows solve
    b->saddle = status == HN_OK ? hn_saddle_ws_create(b->arena, b->info.nv, b->info.nc) : NULL;
    b->plain = (hn_ode){.n_pos = b->info.nq,
                        .n_vel = b->info.nv,
                        .self = b,
                        .rhs = plain_rhs,
                        .is_angle = hn_system_angles(b->sys)};
    return status == HN_OK && !b->saddle ? HN_ERR_MEMORY : status;
}

/// Adds to the message the singular configuration that the run has passed: it is the usual reason
/// why a flow cannot be followed.
static void explain(const hn_budget_work *b, hn_diag *diag) {
    double t;
    if (hn_run_passed_singular(b->run, &t)) {
        const size_t used = strlen(diag->message);
        snprintf(diag->message + used, sizeof diag->message - used,
                 "; near t = %.3g s the constraints become almost dependent (J almost loses rank), "
                 "and motions with open loops cannot be followed beyond",
                 t);
    }
}

static hn_status keep_books(hn_budget_work *b, double T, hn_diag *diag) {
    hn_budget *out = b->out;
    hn_budget_work_present(b, b->y);
    const double start = energy_at(b, b->steps->now.t, b->y);
    out->conservative = hn_run_is_conservative(b->run);

    // the run, step by step
    b->steps->engine.uncorrected = &b->unmended;
    hn_status status = book_steps(b, T, diag);

    // how far it got, and its energy
    const hn_run_summary s = hn_run_get_summary(b->run);
    const int failed = s.state == HN_RUN_FAILED;
    out->state = failed ? HN_RUN_FAILED : HN_RUN_FINISHED;
    snprintf(out->reason, sizeof out->reason, "%.255s", s.reason);
    out->ending = hn_ending_of(b->run, failed ? s.status : HN_OK, s.reason, s.t);
    out->t = b->steps->now.t;
    out->steps = (long long)b->kept;
    hn_budget_work_present(b, b->y);
    out->energy = energy_at(b, out->t, b->y) - start;
    out->swing = b->t_max + b->v_max - b->v_min;
    if (failed) {
        return HN_OK; // the energy holds as far as the run got; there is no error at the end
    }

    // the error at the end and its causes
    HN_THEN(status, hn_budget_work_look_back(b, out->t, diag));
    if (status == HN_ERR_NO_CONVERGENCE) {
        explain(b, diag);
        out->ending = hn_ending_named(hn_status_name(status));
        snprintf(out->ending.quantity, sizeof out->ending.quantity, "t");
        out->ending.value = out->t = b->stuck;
        out->ending.limit = T;
    }
    return status;
}

hn_status hn_budget_make(const hn_system *sys, const hn_method_spec *spec, const double *q,
                         const double *v, double T, const hn_budget_opts *opts, hn_budget *out,
                         hn_diag *diag) {
    static const hn_budget_opts none = {0};
    hn_budget_work b = {.sys = sys,
                        .info = hn_system_get_info(sys),
                        .opts = opts ? opts : &none,
                        .out = out,
                        .asked = T,
                        .v_min = HUGE_VAL,
                        .v_max = -HUGE_VAL};
    *out = (hn_budget){.coordinate = -1};
    b.ny = b.info.nq + b.info.nv;
    b.nd = 2 * b.info.nv;

    if (!(T > 0) || !isfinite(T)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/time", NULL,
                           "the end time is %g s; it must be above 0", T);
    }

    // the run, and the budget kept beside it
    const hn_run_opts run_opts = hn_run_opts_default();
    hn_status status = hn_run_create(sys, spec, q, v, &run_opts, &b.run, diag);
    if (status == HN_OK) {
        out->has_equations = is_ode(&b);
        b.steps = hn_run_stepping(b.run);
        b.arena = hn_arena_create(1 << 16);
        status = b.arena ? create_parts(&b) : HN_ERR_MEMORY;
        status = status == HN_OK
                     ? keep_books(&b, T, diag)
                     : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }

    hn_accel_free(b.accel);
    hn_eval_free(b.eval);
    hn_linear_free(b.linear);
    hn_accel_jacobian_free(b.slopes);
    free(b.record);
    hn_run_free(b.run);
    hn_arena_free(b.arena);
    return hn_system_stopped(sys, status, diag);
}
