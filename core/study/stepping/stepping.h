// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_STEPPING_H
#define HN_STUDY_STEPPING_H
// The stepping half of a run: where it is, and how it gets to the next state. It knows nothing of
// what is watched (study/incidents) or sampled (study/run).
//
// Fixed steps stay on the grid t0 + n h. Steps chosen from tolerances go past the time asked for,
// and samples are interpolated. A load given as a table has corners: a step ends a few roundings
// before a corner, so that every stage sees the load as it was, and the next step begins at the
// corner itself, where the integrator starts anew.

#include "integrators/step/control.h"
#include "study/stepping/engine.h"
#include "study/stepping/headway.h"

/// Share of a step: a grid point that is closer than this to the requested end counts as the end.
#define HN_STEPPING_LANDING 1e-9
#define HN_STEPPING_KEPT 100 ///< steps between states that are kept for trials of remedies
/// A larger coordinate or velocity ends the run [m, rad, or per second]: no mechanism has such a
/// state. It tells numbers that have blown up, in whatever unit, and nothing is rounded by it.
#define HN_STEPPING_BOUND 1e9

/// The tolerances by which an adaptive method chooses its steps.
typedef struct hn_step_tolerances {
    double rtol, atol, largest; ///< [-], [-], [s]
    int order;                  ///< that the control reckons with
} hn_step_tolerances;

typedef struct hn_stepping {
    const hn_system *sys;
    hn_method_spec spec;
    hn_system_info info;
    hn_arena *arena;
    double t0;
    long long max_steps; ///< accepted and rejected steps that are allowed
    bool adaptive;       ///< steps are chosen from tolerances, here or by the integrator itself
    hn_engine engine;
    hn_accel *accel; ///< accelerations at any state: first step sizes, samples, checks
    hn_state_at start, now, before;
    /// The states after the two latest powers of two of steps: `earlier` lies at most half of the
    /// run back and no less than a quarter, before whatever went wrong lately.
    hn_state_at earlier, recent;
    /// The states after the two latest multiples of HN_STEPPING_KEPT steps: `shortly` lies once to
    /// twice as many steps back.
    hn_state_at shortly, latest;

    bool has_step;    ///< `before` is the start of the last step
    double t_asked;   ///< the step that reaches this time is the one that may be sampled inside
    bool has_dense;   ///< what dense output needs was evaluated in the last step
    bool dense_valid; ///< the stepper's dense output belongs to the chart that is still in use
    bool corrected;   ///< the formulation changed the state at the end of the last step
    double h, h_next; ///< last and next step [s]; next 0: to be chosen
    long long grid;   ///< fixed steps: grid points passed, t0 + grid h
    double corner;    ///< next corner of a load, HUGE_VAL: none
    bool restart;     ///< an integrator that paces itself forgets what was before a corner
    int trouble;      ///< trials that failed lately, see step_adaptive
    bool iterating;   ///< the last of them was an iteration that did not converge
    hn_step_control control;
    hn_step_tolerances tol;
    long long steps, rejected;
    hn_headway headway;
    char reason[256]; ///< why the last step failed where that needs words of its own, else ""
    double *work;     ///< nq + nv
} hn_stepping;

/// Makes the stepping half of a run from the state (q, v) at time t0; memory from `arena`, nothing
/// allocates after this.
/// Fails: HN_ERR_UNSUPPORTED, HN_ERR_INPUT (a start that is not finite), HN_ERR_MEMORY, with the
/// reason in diag.
HN_MUST_CHECK hn_status hn_stepping_create(const hn_system *sys, const hn_method_spec *spec,
                                           double t0, long long max_steps, const double *q,
                                           const double *v, hn_arena *arena, hn_stepping *s,
                                           hn_diag *diag);
void hn_stepping_free(hn_stepping *s);
/// Sets the state and the counters back to the start; the engine is started by
/// hn_stepping_start_engine().
void hn_stepping_clear(hn_stepping *s);
HN_MUST_CHECK hn_status hn_stepping_start_engine(hn_stepping *s, hn_engine *e);
/// The log of pulls has a new entry at time t or a new stop: the next step ends at the next corner,
/// and where the state is at t already the integrator starts anew.
void hn_stepping_loads_changed(hn_stepping *s, double t);
/// Makes one accepted step. Fails with the method's status, and the state stays where it was.
HN_MUST_CHECK hn_status hn_stepping_step(hn_stepping *s);
/// The size of a step from one time towards a corner: it ends a few roundings before.
double hn_stepping_short_of(double from, double to);
/// Says whether all n entries are finite and below HN_STEPPING_BOUND.
bool hn_stepping_is_sane(int n, const double *y);

#endif
