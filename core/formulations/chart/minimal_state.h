// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_MINIMAL_STATE_H
#define HN_FORMULATIONS_MINIMAL_STATE_H
// Common part of coordinate partitioning and reduced coordinates: the state y = (q_i, v_i), with
// one entry each for every degree of freedom. An independent velocity must be the derivative of one
// entry of q, so the velocities of ball joints are always dependent; a scene where that is
// impossible is refused. Every right-hand side closes the loops first, by Newton from a tangent
// prediction (in one tape with the accelerations, minimal_tape.h, where that serves) or, where the
// loops fall apart into dyads, in closed form, so no gap can open.

#include "formulations/chart/chart.h"
#include "formulations/chart/chart_jacobian.h"
#include "formulations/chart/minimal_tape.h"

/// Ways to close loops once the independent coordinates are known.
typedef enum hn_position {
    /// by Newton's method at first; in closed form once Newton's method has cost more
    HN_POSITION_AUTO,
    HN_POSITION_NEWTON,
    HN_POSITION_DYADS ///< in closed form, or not at all
} hn_position;

typedef struct hn_minimal_state {
    hn_chart chart;
    hn_chart_jacobian slopes;
    hn_position position; ///< HN_POSITION_NEWTON after init
    hn_minimal_tape tape; ///< answers first
    hn_dyads *dyads;      ///< for the present choice of coordinates; NULL before the first start
    // what HN_POSITION_AUTO measures since the start or the last comparison
    long long closings, newton_steps;
    int n_settled;
    hn_arena *arena;
    double *q, *v; ///< nq, nv, scratch
    // at the last accepted state, for seeing a dead point that lies inside a step
    double *last_v; ///< nv
    bool *is_angle; ///< nv, of the independent coordinates: the first r entries
} hn_minimal_state;

/// Closed forms add nodes to the system's graph when the state is set (dynamics/compile/system.h
/// says who may when).
HN_MUST_CHECK hn_status hn_minimal_init(hn_minimal_state *s, const hn_system *sys, hn_arena *arena,
                                        hn_diag *diag);
void hn_minimal_destroy(void *self);
void hn_minimal_ode(void *self, hn_ode *out);
/// Chooses a chart (`first` as for hn_chart_choose), closes the loops at the independent entries of
/// q.
HN_MUST_CHECK hn_status hn_minimal_start(hn_minimal_state *s, int first, double t, const double *q,
                                         const double *v, double *y);
/// Goes on in another chart from the accepted state y (t), after a step from it failed with
/// HN_ERR_CHART. Fails: HN_ERR_CHART where the present chart is the best one.
hn_status hn_minimal_change_chart(void *self, double t, double *y);
hn_status hn_minimal_get_state(void *self, double t, const double *y, double *q, double *v);
/// Closes the loops at an accepted state as far as rounding allows and makes it the base of the
/// next step.
HN_MUST_CHECK hn_status hn_minimal_settle(hn_minimal_state *s, double t, const double *y);
void hn_minimal_add_cost(const void *self, hn_cost *cost);
const char *hn_minimal_why(const void *self);

#endif
