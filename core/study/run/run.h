// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_RUN_H
#define HN_STUDY_RUN_H
// A run: one method on one scene. It steps, keeps time as t0 + n h, samples, counts, and reports
// incidents. A run that fails keeps its last good state and the reason. It has three parts:
// stepping (study/stepping), watching (study/incidents) and sampling (sampling.h).

#include "study/incidents/kinds.h"
#include "study/run/sampling.h"

#include <stdbool.h>

typedef enum hn_run_state {
    HN_RUN_READY,
    HN_RUN_RUNNING,
    HN_RUN_FINISHED,
    HN_RUN_FAILED
} hn_run_state;

typedef struct hn_run_opts {
    double t0;
    double t_end;        ///< end that the run is for: a longer step is reported; 0: not known
    bool to_the_end;     ///< nobody stops it before: more fixed steps than max_steps end it at once
    long long max_steps; ///< HN_ERR_STOPPED beyond; 0: 50,000,000
    double warn_gap;     ///< times the characteristic length; 0: HN_RUN_WARN_GAP
    int raw_lambda;      ///< samples carry the scheme's own multipliers too, where it has some
} hn_run_opts;
/// The options that the program uses.
hn_run_opts hn_run_opts_default(void);

typedef struct hn_run_summary {
    hn_run_state state;
    hn_status status; ///< HN_OK while all is well
    char reason[480]; ///< why it failed, "" otherwise
    double t;         ///< reached
    long long steps, rejected;
    double h_last;
    hn_cost cost;
    /// CPU time of this thread spent stepping (sampling and output excluded), and cost.elsewhere
    double cpu_seconds;
    /// over all accepted steps that were checked, and all samples between steps
    double worst_gap, worst_velocity_gap;
    double worst_energy_change; ///< less the work of drives, dampers and loads [J]
    int watched_every;          ///< 1: every step
    long long samples_inside;   ///< samples between steps that were checked
} hn_run_summary;

typedef struct hn_run hn_run;

/// Makes a run from the assembled state (q, v) in system coordinates. The system must outlive it.
/// Nothing allocates after this. A formulation that cannot start at this state (a dead point, a
/// lost rank) gives a run that has failed already, so that a table can show it with its reason.
/// Fails: HN_ERR_UNSUPPORTED with the formulation's reason, HN_ERR_INPUT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_run_create(const hn_system *sys, const hn_method_spec *spec,
                                      const double *q, const double *v, const hn_run_opts *opts,
                                      hn_run **out, hn_diag *diag);
void hn_run_free(hn_run *run);
/// Steps until t >= t_end: a fixed-step run lands on its own grid (t0 + n h); an adaptive run steps
/// past, and samples are interpolated. If a load given as a table has a corner a step ends and
/// the integrator starts anew; a fixed-step run then goes on with a shorter step to its next grid
/// point.
/// Returns HN_OK or the failure, which is also kept in the summary; calling again returns the same
/// failure.
hn_status hn_run_advance(hn_run *run, double t_end);
/// Makes exactly one accepted step.
hn_status hn_run_step(hn_run *run);
/// Makes one accepted step on the way to `t_sample`. Steps that end before that time skip the
/// evaluations that only dense output needs; a sample inside such a step is computed by a second,
/// shorter step from its start, which leaves the run as it was.
hn_status hn_run_step_towards(hn_run *run, double t_sample);
double hn_run_time(const hn_run *run);
hn_run_state hn_run_get_state(const hn_run *run);
/// Operations so far, as in the summary, without its reading of a clock.
double hn_run_ops(const hn_run *run);
/// Computes the sample at time t: the present time, a time within the last step, or, with fixed
/// steps, less than one step ahead. Within a step it uses the integrator's dense output. If
/// there is none, ahead of the present time, and for raw multipliers it makes a step of the same
/// integrator aside, which leaves the run as it was.
hn_status hn_run_sample(hn_run *run, double t, hn_sample *out);
/// Returns how far the multipliers of the last sample are determined; near a singular configuration
/// at the cost of a dense solve. Allocates nothing.
hn_multiplier_mark hn_run_sample_mark(hn_run *run);
/// Why the last sample that failed could not be taken, in words. Borrowed, until the run goes on.
const char *hn_run_sample_why(const hn_run *run, hn_status status);
/// Returns whether the integrator finds multipliers of its own (hn_sample.raw_lambda).
bool hn_run_has_raw_lambda(const hn_run *run);
hn_run_summary hn_run_get_summary(const hn_run *run);
int hn_run_incidents(const hn_run *run, const hn_incident **out); ///< count; borrowed
/// The smallest singular value of the constraint rows after the last step
/// (dynamics/analyse/singularity_monitor.h); NaN without rows.
double hn_run_sigma_min(const hn_run *run);
/// The condition number of the constraint rows there: largest over smallest singular value. NaN
/// without rows, HUGE_VAL where the smallest is 0.
double hn_run_condition(const hn_run *run);
/// Returns 1 where the run has passed through a singular configuration or near one; *t is the first
/// time [s].
int hn_run_passed_singular(const hn_run *run, double *t);
/// Sets the run back to the start; counters and incidents are forgotten.
hn_status hn_run_reset(hn_run *run);
/// Sets how often the state is checked against the table of incidents: after every n-th step, or
/// never (0). A check costs one more evaluation, which is not counted as the method's cost.
void hn_run_watch(hn_run *run, int every);
/// Changes an option of the formulation ("alpha") while running, kept over a reset. Fails with the
/// reason in diag: HN_ERR_INPUT: unknown key or bad value; HN_ERR_UNSUPPORTED: fixed once the run
/// is made (an integrator's option, a basis).
hn_status hn_run_set(hn_run *run, const char *key, double value, hn_diag *diag);
/// Tells the run that the log of pulls of its system has a new entry at time t [s], no earlier than
/// the present time, or that the time where steps stop for it was moved (t = HUGE_VAL).
void hn_run_loads_changed(hn_run *run, double t);
const hn_method_spec *hn_run_spec(const hn_run *run);
/// Returns the parts of a run, for studies that read the state after each step: the one that makes
/// steps, and the engine that computes samples between steps.
hn_stepping *hn_run_stepping(hn_run *run);
hn_engine *hn_run_side_engine(hn_run *run);
/// Returns the part that checks the states; sets the reason why the run ended. For the diagnosis.
hn_watch *hn_run_watching(hn_run *run);
void hn_run_set_reason(hn_run *run, const char *reason);
bool hn_run_is_conservative(const hn_run *run);
#endif
