// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_RUN_H
#define HN_STUDY_RUN_H
// A run: one method on one scene. It steps, keeps time as t0 + n h, samples, counts, and tells what it met. A run
// that fails keeps its last good state and says why.

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/compile/system.h"
#include "integrators/method/method_spec.h"
#include "study/incidents/incident.h"

typedef enum hn_run_state {
    HN_RUN_READY,
    HN_RUN_RUNNING,
    HN_RUN_FINISHED,
    HN_RUN_FAILED
} hn_run_state;

#define HN_RUN_WARN_GAP 1e-3 ///< gap / characteristic length that is told
/// Gap / characteristic length that ends a run: rows of J are lever arms of about that length, so with pins half of it apart they
/// point up to 30 degrees away from where they would; what is computed with them is no motion of this mechanism.
#define HN_RUN_LOST_GAP 0.5
#define HN_RUN_WARN_PIVOT 1e-4 ///< pivot ratio of K that is told as near-singular
#define HN_RUN_WARN_ENERGY \
    1e-2 ///< energy change in one step / (T + range of V), conservative scenes only
#define HN_RUN_WARN_DRIFT \
    1e-2 ///< energy change since the start / (largest T + range of V), conservative scenes only
#define HN_RUN_WARN_CONDITION \
    1e8 ///< of the equilibrated K: half the digits of the multipliers are gone
#define HN_RUN_WARN_MULTIPLIERS 1e3 ///< growth against the largest seen away from singular poses
#define HN_RUN_WARN_TURN 0.5 ///< [rad] between the direction of motion and its smooth continuation
#define HN_RUN_WARN_JUMP 0.5 ///< part of a step's motion that its speeds do not explain
/// Of the speeds: how closely they are reversed, and of the whole change how little the accelerations explain, in one step that is told.
#define HN_RUN_WARN_BACK 0.3
#define HN_RUN_WARN_MODE \
    0.1 ///< change of the assembly-mode value that a jump to the other branch makes at least

typedef struct hn_run_opts {
    double t0;
    long long max_steps; ///< HN_ERR_BUDGET beyond; 0: 50,000,000
    double warn_gap;     ///< times the characteristic length; 0: HN_RUN_WARN_GAP
    int raw_lambda;      ///< samples carry the scheme's own multipliers too, where it has some
} hn_run_opts;
hn_run_opts hn_run_opts_default(void);

/// State at one time, in USER coordinates; arrays borrowed from the run, valid until its next call.
typedef struct hn_sample {
    double t;
    const double *q, *v; ///< n_user
    const double *a;     ///< n_user accelerations
    const double *
        lambda; ///< nc, recomputed from the saddle system at this state; a and lambda are NaN where it has no solution
    const double *
        raw_lambda; ///< nc: the multipliers that the scheme itself found at the end of its step, converging with a
    ///< lower order or not at all; NULL: none, or not asked for (hn_run_opts)
    const double *points;                             ///< 3 n_points
    double gap, velocity_gap;                         ///< ||phi||, ||J v + phi_t||
    double kinetic, potential, energy, energy_change; ///< change: since the start
    double
        pivot_ratio; ///< see hn_accel_info, times the square of the shortest row of J against the largest it has been
    int rank;
} hn_sample;

typedef struct hn_run_summary {
    hn_run_state state;
    hn_status status; ///< HN_OK while all is well
    char reason[256]; ///< why it failed, "" otherwise
    double t;         ///< reached
    long long steps, rejected;
    double h_last;
    hn_cost cost;
    double cpu_seconds; ///< thread CPU time spent stepping (sampling and output excluded)
    double worst_gap, worst_velocity_gap,
        worst_energy_change; ///< over all accepted steps that were watched
    int watched_every;       ///< 1: every step
} hn_run_summary;

typedef struct hn_run hn_run;

/// A run from the assembled state (q, v) in system coordinates. The system must outlive it. Fails: HN_ERR_UNSUPPORTED with the formulation's reason,
/// HN_ERR_INPUT, HN_ERR_MEMORY. Nothing allocates after this. A formulation that cannot start at this state (a dead point, a lost
/// rank) gives a run that has failed already, so that a table can show it with its reason.
HN_MUST_CHECK hn_status hn_run_create(const hn_system *sys, const hn_method_spec *spec,
                                      const double *q, const double *v, const hn_run_opts *opts,
                                      hn_run **out, hn_diag *diag);
void hn_run_free(hn_run *run);
/// Where a load given as a table has a corner a step ends and the integrator starts anew; a fixed-step run then goes on with a
/// shorter step to its next grid point, so that these stay at t0 + n h.
/// Steps until t >= t_end: a fixed-step run lands on its own grid (t0 + n h); an adaptive run steps past and interpolates. Returns HN_OK or the
/// failure, which is also kept in the summary. Calling again after a failure returns the same failure.
hn_status hn_run_advance(hn_run *run, double t_end);
/// Exactly one accepted step.
hn_status hn_run_step(hn_run *run);
/// The same on the way to t_look: only the step that reaches it will be sampled inside, so the others are spared what serves
/// dense output alone. A sample inside such a step is a side step.
hn_status hn_run_step_towards(hn_run *run, double t_look);
double hn_run_time(const hn_run *run);
/// The sample at time t, where t is the present time or lies within the last step (dense output where the integrator has it, else a
/// side step of the same integrator from that step's start, which leaves the run as it was) or ahead of the present time by
/// less than one step (fixed: a side step). With raw multipliers asked for it is always a side step.
hn_status hn_run_sample(hn_run *run, double t, hn_sample *out);
/// What the multipliers of the last sample are worth; near a singular pose at the cost of a dense solve. Allocates nothing.
hn_multiplier_mark hn_run_sample_mark(hn_run *run);
/// Why the last sample that failed could not be taken, in words. Borrowed, until the run goes on.
const char *hn_run_sample_why(const hn_run *run, hn_status status);
/// 1 if the integrator finds multipliers of its own (hn_sample.raw_lambda).
int hn_run_has_raw_lambda(const hn_run *run);
hn_run_summary hn_run_get_summary(const hn_run *run);
int hn_run_incidents(const hn_run *run, const hn_incident **out); ///< count; borrowed
/// 1 where the run has passed a singular pose, or near one: *t the first time [s].
int hn_run_passed_singular(const hn_run *run, double *t);
/// Back to the start; counters and incidents forgotten.
hn_status hn_run_reset(hn_run *run);
/// A run's watch (gap, energy per step) costs an extra evaluation a step that is not counted as method cost; 0 switches it off, n: every n-th step.
void hn_run_watch(hn_run *run, int every);
/// Changes a setting of the formulation ("alpha") while running. HN_ERR_INPUT: unknown key or bad value, HN_ERR_UNSUPPORTED: fixed
/// once the run is made (an integrator's setting, a basis); told in diag. Kept over a reset.
hn_status hn_run_set(hn_run *run, const char *key, double value, hn_diag *diag);
const hn_method_spec *hn_run_spec(const hn_run *run);
#endif
