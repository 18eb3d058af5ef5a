// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_RUN_INTERNAL_H
#define HN_STUDY_RUN_INTERNAL_H
// The inside of a run, shared by run.c (life and steps), run_sample.c (states at a time), run_watch.c
// (what is looked at after a step) and run_tell.c (incidents).

#include "dynamics/assembly/mode.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/limits.h"
#include "dynamics/analyse/singularity_monitor.h"
#include "integrators/step/control.h"
#include "study/run/run.h"

/// One copy of formulation and stepper. A run has two: `main` makes the steps, `side` looks at times between them, so that a
/// sample never touches charts, warm starts or kept slopes of the run itself.
typedef struct hn_run_engine {
    void *formulation, *stepper; ///< stepper: of an hn_stepper or an hn_dae_stepper
    hn_ode ode; ///< with a differential-algebraic pair y' for a first step size only
    double *y, *y_new, *err;
    struct hn_run_state_at *
        unmended; ///< gets the state before it is mended, for an account of the step; NULL: nobody asks
} hn_run_engine;

typedef struct hn_run_state_at {
    double t;
    double *q, *v; ///< system coordinates
} hn_run_state_at;

/// The direction of motion, in speeds scaled by the masses and of unit length.
typedef struct hn_run_heading {
    double t;
    double *e; ///< nv, and time where the mechanism is driven and has no freedom of its own, else 0
} hn_run_heading;

/// What the watch knows of singular poses on the way.
typedef struct hn_run_ahead {
    hn_singularity *radar;
    hn_singularity_info info;              ///< the last look
    double largest;                  ///< sigma_min so far
    hn_run_heading older, last, now; ///< the first two away from singular poses
    int n_headings;
    double fastest;      ///< largest scaled speeds so far
    double *smooth;      ///< nv + 1: a heading continued
    int driven;          ///< the rows move with time
    double multiplier;   ///< largest |lambda| away from singular poses
    long long fallbacks; ///< of the method, as told so far
    double *entered;     ///< nq: where J all but lost rank, as long as it stays so
    int inside;          ///< it does: 1, 2 once that has been told
    int passing;         ///< 1 + number of the incident that told the pose being passed, 0: none
} hn_run_ahead;

/// A state inside the last step.
typedef struct hn_run_between {
    double *q;           ///< nq
    double *step, *part; ///< nv: from the start of the step to its end, and to the state
} hn_run_between;

/// What the watch knows of the last state it saw.
typedef struct hn_run_watch_state {
    int every;
    long long since; ///< accepted steps since the last look
    hn_eval *eval;   ///< phi, phi_t, J, energy
    hn_accel *accel;
    hn_mode_watch *mode;
    double *a, *lambda, *speed_gap;
    hn_run_ahead ahead;
    hn_run_between between;
    double *row_size; ///< nc: largest length of each row of J so far
    double start_energy, last_energy, v_min, v_max, t_max; ///< t_max: largest kinetic energy so far
    double swiftest;                                       ///< largest of the speeds so far
    double *modes, *last_modes;                            ///< per loop
    int start_rank;
    long long restarts; ///< steps after which a multistep integrator had to start again
    int conservative;
    hn_limits *limits;           ///< coordinates with limits
    char *beyond;                ///< per limit: it is passed at present
    double *limited;             ///< their values
    int told[HN_INCIDENT_COUNT]; ///< so far, by kind
    unsigned active; ///< a bit per incident that holds at present: told once, not each step
} hn_run_watch_state;

struct hn_run {
    hn_arena *arena;
    const hn_system *sys;
    hn_method_spec spec;
    hn_run_opts opts;
    hn_system_info info;
    int adaptive; ///< hn_method_is_adaptive, or the integrator paces itself
    double length;
    hn_run_engine main, side;
    hn_run_state_at start, now, before;
    int has_step;    ///< `before` is the start of the last step
    double t_asked;  ///< the step that reaches this time is the one that may be looked into
    int has_dense;   ///< what dense output needs was evaluated in the last step
    int dense_valid; ///< the stepper's dense output belongs to the chart that is still in use
    double h, h_next;
    long long grid; ///< fixed steps: grid points passed, t0 + grid h
    double corner;  ///< next corner of a load, HUGE_VAL: none
    int restart;    ///< an integrator that paces itself forgets what was before a corner
    int trouble;    ///< trials that failed lately, see step_adaptive
    int iterating;  ///< the last of them was an iteration that did not converge
    int held,
        free; ///< steps at the stability limit lately, and since then others in a row: run_stiff.c
    hn_step_control control;
    hn_run_summary summary;
    hn_cost cost_mark;
    double cpu_mark, clock_cost; ///< [s]
    hn_incident incidents[HN_RUN_MAX_INCIDENTS];
    int n_incidents;
    unsigned revision; ///< of the incident written or completed last; never reset
    hn_run_watch_state watch;
    hn_eval *points;
    // what a sample hands out
    double *sample_q, *sample_v, *sample_a, *sample_lambda, *sample_points, *sample_raw;
    double *at_q, *at_v, *at_a, *at_lambda, *work;
    double at_t; ///< of the last sample, and what the solve there said
    hn_accel_info at_info;
    hn_status at_status;
    const double *at_raw; ///< raw multipliers of the state in at_q, at_v, or NULL
};

// engines, run_engine.c: e is &run->main or &run->side ------------------------------------------------------
HN_MUST_CHECK hn_status hn_engine_create(hn_run *run, hn_run_engine *e, hn_diag *diag);
void hn_engine_destroy(hn_run *run, hn_run_engine *e);
/// e->y from a state, everything before forgotten; the first time it makes the stepper of an ordinary differential equation, whose
/// size may depend on the state.
hn_status hn_engine_start(hn_run *run, hn_run_engine *e, double t, const double *q,
                          const double *v);
/// A trial from e->y to e->y_new, e->err its error.
hn_status hn_engine_step(hn_run *run, hn_run_engine *e, double t, double h);
/// 1 if the integrator chooses the size of its steps itself: then `advance` takes the place of `step`.
int hn_engine_paces_itself(const hn_run *run);
hn_status hn_engine_advance(hn_run *run, hn_run_engine *e, double t, double t_stop, double *t_new);
/// Goes on in another chart from the accepted state, see hn_formulation.change_chart.
hn_status hn_engine_change_chart(hn_run *run, hn_run_engine *e, double t);
hn_status hn_engine_finish(hn_run *run, hn_run_engine *e); ///< what dense output needs beside
/// What the formulation does to a state at the end of a step; *changed is set to 1 when y moved.
hn_status hn_engine_mend(hn_run *run, hn_run_engine *e, double t, double *y, int *changed);
void hn_engine_accepted(hn_run *run, hn_run_engine *e, int changed);
hn_status hn_engine_read(hn_run *run, hn_run_engine *e, double t, const double *y, double *q,
                         double *v);
int hn_engine_has_dense(const hn_run *run);
void hn_engine_dense(hn_run *run, hn_run_engine *e, double theta, double *y);
int hn_engine_has_raw_lambda(const hn_run *run);
/// The scheme's own multipliers at the end of its last accepted step, NULL: none.
const double *hn_engine_raw_lambda(const hn_run *run, const hn_run_engine *e);
hn_cost hn_engine_cost(const hn_run *run, const hn_run_engine *e);
const char *hn_engine_why(const hn_run *run, const hn_run_engine *e);

/// Memory and evaluators of the watch.
HN_MUST_CHECK hn_status hn_run_watch_create(hn_run *run);
void hn_run_watch_free(hn_run *run);
/// After an accepted step of size h: tells when stability has held the step for a while.
void hn_run_look_at_stiffness(hn_run *run, double h);
/// Size of a step towards a corner: it ends a few roundings before.
double hn_run_step_short_of(double from, double to);
/// Tells coordinates that have left their limits since the last look.
void hn_run_look_at_limits(hn_run *run);
/// Forgets the past and looks at the start.
void hn_run_watch_start(hn_run *run);
/// Looks at the state the run has reached. Fails with HN_ERR_DIVERGED, the reason in the summary, when what has been reached is no state
/// of the mechanism any more (HN_RUN_LOST_GAP).
HN_MUST_CHECK hn_status hn_run_watch_look(hn_run *run);
/// How much of the last step's motion its speeds do not explain, over that motion, or `least` where it was less: 0 for smooth
/// motion, about 1 or more for a jump.
double hn_run_unexplained_motion(const hn_run *run, double least);
/// Shortest row of J against the largest that row has been, at the state last measured.
double hn_run_shortest_row(const hn_run *run);
/// Tells when a condition begins to hold, not at every step while it does; `hn_run_over` when it ceases. NULL: known already, or
/// no room left.
hn_incident *hn_run_tell(hn_run *run, hn_incident_code code, const char *quantity, double value,
                         double limit, const char *format, ...) HN_PRINTF(6, 7);
void hn_run_over(hn_run *run, hn_incident_code code);
int hn_run_has_formulation(const hn_run *run, const char *name);
typedef char hn_remedy[96];
/// Another formulation with its defaults, the integrator as it is; a smaller step or tolerance of the same method.
void hn_run_remedy_formulation(const hn_run *run, const char *name, hn_remedy out);
/// A step whose state was changed has been accepted: told where most are such, and the integrator starts again at order 1 each time.
void hn_run_tell_restart(hn_run *run);
void hn_run_remedy_finer(const hn_run *run, double factor, hn_remedy out);
/// What goes through singular poses: projection with a fixed step like the present one.
void hn_run_remedy_robust(const hn_run *run, hn_remedy out);

// singular poses, run_ahead.c ------------------------------------------------------------------------------------
HN_MUST_CHECK hn_status hn_run_ahead_create(hn_run *run);
void hn_run_ahead_free(hn_run *run);
void hn_run_ahead_start(hn_run *run);
/// Looks at the state the run has reached; `lambda` (nc) NULL where there is none.
void hn_run_ahead_look(hn_run *run, const double *lambda);
/// 1 when the present state is close to a singular pose.
int hn_run_is_near_singular(const hn_run *run);
/// Adds to the reason of a failure that the pose is singular, where it is.
void hn_run_explain_pose(hn_run *run);
/// Adds to the message of incident i what waits at a pose: rows, bodies, freedoms, branches.
void hn_run_describe_pose(hn_run *run, hn_incident *i, double t, const double *q, double sigma_min);
/// How far the motion from `from` (nq) to now would have opened a loop with one of its coordinates alone, over the length: with J of
/// the state last measured. `step` (nv) gets the motion.
double hn_run_way(hn_run *run, const double *from, double *step);

// run_between.c
HN_MUST_CHECK hn_status hn_run_between_create(hn_run *run);
/// Tells a singular pose that the last step went across; comes before the look at its end.
void hn_run_look_between(hn_run *run);

/// Tells a failure as an incident.
void hn_run_tell_failure(hn_run *run, hn_status status);
void hn_run_tell_charts(hn_run *run, long long changes);
/// alpha h against the integrator's limit.
void hn_run_tell_step_limit(hn_run *run);
/// ||phi||, ||J v + phi_t||, kinetic and potential energy at a state, with the watch's evaluator.
void hn_run_measure(hn_run *run, double t, const double *q, const double *v, double *gap,
                    double *speed_gap, double *kinetic, double *potential);
hn_status hn_run_accelerations(hn_run *run, double t, const double *q, const double *v, double *a,
                               double *lambda, hn_accel_info *info);

#endif
