// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_BUDGET_STATE_H
#define HN_STUDY_BUDGET_STATE_H
// The state of an error budget while it is made: the record of the steps and the workspaces.
// budget.c fills the record from the start of the run to its end; budget_back.c reads it from the
// end back to the start.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/linearise.h"
#include "formulations/ground/accel_jacobian.h"
#include "linalg/saddle.h"
#include "study/budget/budget.h"
#include "study/budget/flow.h"
#include "study/run/run.h"

enum { HN_BOOKS_BETWEEN_QUESTIONS = 16 }; ///< steps

#define HN_BOOKS_ARRIVED 1e-12 // of the time asked for

/// The three parts of (1), each a displacement in q along the speeds (nv) and one in v (nv).
enum { HN_PART_TRUNCATION, HN_PART_FORMULATION, HN_PART_PROJECTION, HN_PARTS };

typedef struct hn_budget_work {
    hn_arena *arena;
    const hn_system *sys;
    hn_system_info info;
    int ny, nd; ///< nq + nv, 2 nv
    hn_run *run;
    hn_stepping *steps; ///< of the run
    const hn_budget_opts *opts;
    hn_budget *out;
    double asked; ///< end [s]
    double stuck; ///< where a flow, or the exact motion, could not be followed [s]
    hn_accel *accel;
    hn_eval *eval;     ///< energy, J, phi_t
    hn_linear *linear; ///< M, J, V
    hn_saddle_ws *saddle;
    hn_ode plain; ///< the equations of motion as index 1
    hn_flow *flow, *own_flow;
    hn_accel_jacobian *slopes; ///< of `plain`
    hn_flow_carrier *carrier;
    int own_size;
    hn_state_at unmended;
    double *record; ///< per step: t, h, y (ny), the parts (HN_PARTS x nd)
    size_t kept, room, width;
    double *y, *y_own, *flowed, *owned;     ///< ny each
    double *w, *column, *up, *down, *split; ///< nd, nd, ny, ny, nd
    double *zero, *gap, *a, *lambda;
    double v_min, v_max, t_max;
} hn_budget_work;

/// Returns the record of step k: t, h, y, parts.
double *hn_budget_work_record(const hn_budget_work *b, size_t k);
/// Copies the state that the run has reached: y (ny).
void hn_budget_work_present(const hn_budget_work *b, double *y);
/// Reports the share that is done (0 to 1) to the caller and returns 1 if the caller asks to stop.
int hn_budget_work_asked_to_stop(const hn_budget_work *b, double share);
#endif
