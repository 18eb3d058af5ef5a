// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/minimal_state.h"

#include "formulations/chart/chart_follow.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// accepted steps over which HN_POSITION_AUTO counts what Newton's method costs
enum { STEPS_MEASURED = 8 };
enum { RUNS_OF_DYADS = 4 }; // of the tape, in the time of an evaluation with dyads

hn_status hn_minimal_init(hn_minimal_state *s, const hn_system *sys, hn_arena *arena,
                          hn_diag *diag) {
    const size_t nv = (size_t)hn_system_get_info(sys).nv;
    s->q = hn_arena_doubles(arena, (size_t)hn_system_get_info(sys).nq);
    s->v = hn_arena_doubles(arena, nv);
    s->last_v = hn_arena_doubles(arena, nv);
    s->is_angle = hn_arena_get(arena, nv * sizeof *s->is_angle);
    if (!s->q || !s->v || !s->last_v || !s->is_angle) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    const hn_status status = hn_chart_init(&s->chart, sys, 1, arena, diag);
    s->chart.plain_only = 1;
    s->position = HN_POSITION_NEWTON;
    s->dyads = NULL;
    s->closings = s->newton_steps = 0;
    s->n_settled = 0;
    s->arena = arena;
    return status;
}

void hn_minimal_destroy(void *self) {
    hn_minimal_state *s = self;
    hn_chart_destroy(&s->chart);
    hn_minimal_tape_free(&s->tape);
    hn_chart_jacobian_free(&s->slopes);
    hn_dyads_free(s->dyads);
    s->dyads = NULL;
}

// one closing by the tape; what HN_POSITION_AUTO counts
static bool close_by_tape(hn_minimal_state *s, double t, const double *y, double tol) {
    hn_chart *chart = &s->chart;
    const long long newton = chart->cost.newton;
    const bool closed = hn_minimal_tape_close(&s->tape, chart, t, y, tol);
    s->closings += chart->cost.newton > newton;
    s->newton_steps += chart->cost.newton - newton;
    return closed;
}

// `here` goes to the closed pose with the independent entries of y, with its factor
static hn_status place(hn_minimal_state *s, double t, const double *y, double tol) {
    hn_chart *chart = &s->chart;
    hn_chart_point *p = &chart->here;
    int same = p->valid && !p->is_bare && p->t == t && p->tol <= tol;
    for (int j = 0; j < chart->r && same; j++) {
        same = p->q[chart->at[chart->ind[j]]] == y[j];
    }
    if (same) {
        return HN_OK;
    }
    const long long newton = chart->cost.newton;
    const hn_status status = hn_chart_follow(chart, p, &chart->probe, t, y, s->q, tol);
    s->closings++;
    s->newton_steps += chart->cost.newton - newton;
    return status == HN_OK ? hn_chart_check_mode(chart) : status;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    hn_minimal_state *s = self;
    const int r = s->chart.r;
    s->chart.cost.evals++;
    for (int j = 0; j < r; j++) {
        ydot[j] = y[r + j];
    }
    if (close_by_tape(s, t, y, HN_CHART_TOL) &&
        hn_minimal_tape_get_accelerations(&s->tape, ydot + r)) {
        return HN_OK;
    }
    HN_TRY(place(s, t, y, HN_CHART_TOL));
    hn_chart_speeds(&s->chart, &s->chart.here, y + r, s->v);
    return hn_chart_accel(&s->chart, s->v, ydot + r);
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    const hn_minimal_state *s = self;
    (void)t;
    memcpy(pos_dot, y + s->chart.r, (size_t)s->chart.r * sizeof *y);
    return HN_OK;
}

static hn_status prepare(void *self) {
    hn_minimal_state *s = self;
    return hn_chart_jacobian_prepare(&s->slopes, &s->chart, s->arena);
}

static hn_status jacobian(void *self, double t, const double *y, double *jac) {
    hn_minimal_state *s = self;
    HN_TRY(place(s, t, y, HN_CHART_TOL));
    hn_chart_speeds(&s->chart, &s->chart.here, y + s->chart.r, s->v);
    HN_TRY(hn_chart_jacobian_at(&s->slopes, &s->chart, s->arena, s->v));
    hn_chart_jacobian_minimal(&s->slopes, &s->chart, jac);
    return HN_OK;
}

void hn_minimal_ode(void *self, hn_ode *out) {
    const hn_minimal_state *s = self;
    *out = (hn_ode){.n_pos = s->chart.r,
                    .n_vel = s->chart.r,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics,
                    .jacobian = jacobian,
                    .prepare = prepare,
                    .is_angle = s->is_angle};
}

// the closed form takes over at the closed pose `here`; 0: a dyad stands at its dead point
static bool adopt_dyads(hn_minimal_state *s, double t) {
    if (!hn_dyads_take_branch(s->dyads, t, s->chart.here.q)) {
        return false;
    }
    s->chart.dyads = s->dyads;
    return true;
}

// the closed form must serve, or the run is refused with the reason
static hn_status demand_dyads(hn_minimal_state *s, double t) {
    hn_chart *chart = &s->chart;
    const char *refusal = hn_dyads_refusal(s->dyads);
    if (refusal) {
        char text[HN_CHART_TEXT];
        snprintf(text, sizeof text, "no position analysis in closed form: %.180s", refusal);
        return hn_chart_fail(chart, HN_ERR_UNSUPPORTED, t, chart->here.q, text);
    }
    return adopt_dyads(s, t) ? HN_OK
                             : hn_chart_fail(chart, HN_ERR_CHART, t, chart->here.q,
                                             "a dyad is at its dead point: the configuration does "
                                             "not determine how it continues");
}

// a closed form for the coordinates chosen, if there is one and it is wanted; at the closed pose
// `here`
static hn_status choose_position(hn_minimal_state *s, double t) {
    hn_chart *chart = &s->chart;
    hn_status status = HN_OK;
    if (s->position == HN_POSITION_NEWTON || chart->nc == 0) {
        return HN_OK;
    }
    if (!s->dyads || !hn_dyads_serve(s->dyads, chart->dep, chart->rank)) {
        hn_dyads_free(s->dyads);
        s->dyads = NULL;
        status = hn_dyads_create(chart->sys, chart->dep, chart->rank, s->arena, &s->dyads);
    }
    if (status != HN_OK) {
        return hn_chart_fail(chart, status, t, chart->here.q, hn_status_text(status));
    }
    return s->position == HN_POSITION_DYADS ? demand_dyads(s, t) : HN_OK;
}

// In the tape with the accelerations Newton's method took a run for each of its steps, and an
// evaluation with the closed form takes the time of about RUNS_OF_DYADS of them: measured on the
// shipped scenes, 2 to 4.5. Elsewhere it took a loop evaluation, a factor and a solve for each; the
// closed form takes one run of its tape for each closing, and looks at its branches twice a step.
static bool are_dyads_cheaper(const hn_minimal_state *s) {
    const hn_chart *chart = &s->chart;
    if (s->tape.serves) {
        return s->newton_steps > RUNS_OF_DYADS * s->closings;
    }
    const double step = hn_eval_info(chart->loop).ops + hn_sparse_lu_factor_ops(chart->here.lu) +
                        hn_sparse_lu_solve_ops(chart->here.lu);
    const double newton = step * (double)s->newton_steps;
    const double dyads = hn_dyads_info(s->dyads).ops * (double)s->closings +
                         2.0 * hn_dyads_branch_info(s->dyads).ops * STEPS_MEASURED;
    return dyads < newton;
}

static void compare_costs(hn_minimal_state *s, double t) {
    const hn_chart *chart = &s->chart;
    if (s->position != HN_POSITION_AUTO || chart->dyads || !s->dyads ||
        hn_dyads_refusal(s->dyads) || ++s->n_settled < STEPS_MEASURED) {
        return;
    }
    if (are_dyads_cheaper(s)) {
        (void)adopt_dyads(s, t); // at a dead point Newton's method goes on, as long as it can
    }
    s->closings = s->newton_steps = 0; // a mechanism that starts from rest needs more of them later
    s->n_settled = 0;
}

// the rest of a start or a change of chart, once the columns are chosen; s->q, s->v hold the state
static hn_status settle_in(hn_minimal_state *s, double t, double *y) {
    hn_chart *chart = &s->chart;
    HN_TRY(hn_chart_close(chart, &chart->here, t, s->q, HN_CHART_TOL_FINE));
    HN_TRY(choose_position(s, t));
    if (s->position != HN_POSITION_DYADS) {
        HN_TRY(hn_minimal_tape_begin(&s->tape, chart, s->arena));
    }
    for (int j = 0; j < chart->r; j++) {
        const int at = chart->at[chart->ind[j]];
        s->is_angle[j] = hn_system_angles(chart->sys)[at];
        y[j] = s->q[at];
        y[chart->r + j] = s->v[chart->ind[j]];
    }
    hn_status status = hn_chart_settle(chart);
    hn_chart_speeds(chart, &chart->here, y + chart->r, s->last_v);
    return status;
}

hn_status hn_minimal_change_chart(void *self, double t, double *y) {
    hn_minimal_state *s = self;
    hn_chart *chart = &s->chart;
    memcpy(s->q, chart->base.q, (size_t)chart->nq * sizeof *s->q);
    hn_chart_speeds(chart, &chart->base, y + chart->r, s->v);
    HN_TRY(hn_chart_choose_other(chart));
    chart->dyads = NULL;
    chart->cost.chart_changes++;
    return settle_in(s, t, y);
}

hn_status hn_minimal_start(hn_minimal_state *s, int first, double t, const double *q,
                           const double *v, double *y) {
    hn_chart *chart = &s->chart;
    memmove(s->q, q, (size_t)chart->nq * sizeof *q);
    memmove(s->v, v, (size_t)chart->nv * sizeof *v);
    chart->dyads = NULL;
    // a start that is made again gives the same bits
    s->closings = s->newton_steps = 0;
    s->n_settled = 0;
    HN_TRY(hn_chart_choose(chart, t, s->q, first));
    return settle_in(s, t, y);
}

hn_status hn_minimal_get_state(void *self, double t, const double *y, double *q, double *v) {
    hn_minimal_state *s = self;
    hn_chart *chart = &s->chart;
    hn_chart_predict(chart, t, y, q);
    // at the accepted state itself nothing has to be solved
    const hn_chart_point *p = &chart->base;
    if (!hn_chart_is_at(chart, p, t, q)) {
        HN_TRY(hn_chart_follow(chart, &chart->probe, &chart->here, t, y, q, HN_CHART_TOL_FINE));
        p = &chart->probe;
    }
    hn_chart_speeds(chart, p, y + chart->r, v);
    return HN_OK;
}

// A step that jumps over a dead point finds a closed loop on the near side of it again: the
// coordinate turns back although the mechanism went on. Then |det J_d| was on its way to zero and
// all speeds have turned round.
static bool jumped_a_dead_point(const hn_minimal_state *s, double h) {
    const hn_chart *chart = &s->chart;
    double along = 0;
    if (chart->r == 0 || !hn_chart_nears_end(chart, h)) {
        return false;
    }
    for (int i = 0; i < chart->nv; i++) {
        along += s->v[i] * s->last_v[i] / (chart->scale[i] * chart->scale[i]);
    }
    return along < 0;
}

// A closed form keeps its sign and so never goes over to the other mode: where the two ways of
// assembling a dyad meet inside a step, it turns back on a kinked path. The tangent does not: from
// the last state forth or from this one back it arrives at a pose of the other sign (of two points
// on either side of the meeting at least one sees it).
static hn_status check_dyads(hn_minimal_state *s, double t, const double *y) {
    hn_chart *chart = &s->chart;
    const hn_chart_point *here = &chart->here, *base = &chart->base;
    int turned;
    if (!chart->dyads || !base->valid) {
        return HN_OK;
    }
    hn_chart_predict(chart, t, y, s->q);
    turned = hn_dyads_find_turned(chart->dyads, t, s->q);
    if (turned < 0) {
        for (int j = 0; j < chart->r; j++) {
            s->v[j] = base->q[chart->at[chart->ind[j]]];
        }
        hn_chart_predict_from(chart, here, base->t, s->v, s->q);
        turned = hn_dyads_find_turned(chart->dyads, base->t, s->q);
    }
    return turned < 0 ? HN_OK : hn_chart_fail_dyad(chart, turned);
}

hn_status hn_minimal_settle(hn_minimal_state *s, double t, const double *y) {
    hn_chart *chart = &s->chart;
    const double h = t - chart->base.t;

    // close the loops at the end of the step, in the same assembly mode
    if (close_by_tape(s, t, y, HN_CHART_TOL_FINE)) {
        hn_minimal_tape_put(&s->tape, chart);
    } else {
        HN_TRY(place(s, t, y, HN_CHART_TOL_FINE));
    }
    HN_TRY(check_dyads(s, t, y));
    hn_chart_speeds(chart, &chart->here, y + chart->r, s->v);
    if (jumped_a_dead_point(s, h)) {
        chart->here.valid = 0;
        return hn_chart_fail_end(chart, t, chart->here.q,
                                 "the coordinate turns back at a dead point inside this step");
    }

    // the velocities, for the next step's check
    HN_TRY(hn_chart_settle(chart));
    if (h != 0) {
        memcpy(s->last_v, s->v, (size_t)chart->nv * sizeof(double));
    }

    compare_costs(s, t);
    return HN_OK;
}

void hn_minimal_add_cost(const void *self, hn_cost *cost) {
    const hn_minimal_state *s = self;
    hn_chart_add_cost(&s->chart, cost);
    hn_chart_jacobian_add_cost(&s->slopes, cost);
    cost->ops += s->chart.dyads ? hn_dyads_ops(s->chart.dyads) : 0;
}

const char *hn_minimal_why(const void *self) {
    const hn_minimal_state *s = self;
    return s->chart.why[0] ? s->chart.why : NULL;
}
