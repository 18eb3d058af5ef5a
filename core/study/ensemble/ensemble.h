// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ENSEMBLE_H
#define HN_STUDY_ENSEMBLE_H
// Many runs of one scene by one method at once, each with its own start, step, alpha and beta.
// Every thread steps HN_LANES runs side by side by vector instructions
// (integrators/explicit/rk_lanes.h); a lane whose run has ended takes up the next one.
//
// A run's state is bit for bit that of a single run without a watch (study/run/run.h), whatever the
// number of threads, the instruction set and the runs beside it. If a pivot of a lane is so
// small that its rank is in doubt, the ordinary stepping makes the step. Serves explicit
// Runge-Kutta methods with a fixed step and a plain sum on index-1 and Baumgarte with given alpha
// and beta.

#include "expr/lanes.h"
#include "integrators/method/method_spec.h"

typedef struct hn_ensemble hn_ensemble;

typedef struct hn_ensemble_opts {
    int threads;         ///< at most so many; 0: one for each processor
    hn_lanes_set set;    ///< one that the processor has
    long long max_steps; ///< of one run
} hn_ensemble_opts;
/// All processors, the best instruction set, 50,000,000 steps.
hn_ensemble_opts hn_ensemble_opts_default(void);

/// The start of one run, at time 0, and its options.
typedef struct hn_ensemble_start {
    const double *q, *v; ///< nq, nv: a state in system coordinates
    double h;            ///< [s] above 0
    double alpha, beta;  ///< [1/s]; used by Baumgarte only
} hn_ensemble_start;

/// Outcome of one run.
typedef struct hn_ensemble_end {
    /// HN_OK: it reached the end; else as hn_run_advance(), at the last good state
    hn_status status;
    double t;           ///< reached [s]: the first grid point at or beyond the end asked for
    long long steps;    ///< made
    long long in_doubt; ///< of these, the steps that the ordinary stepping made
} hn_ensemble_end;

/// Checks that runs of this method on this system can step side by side. Fails: HN_ERR_UNSUPPORTED,
/// with the reason.
HN_MUST_CHECK hn_status hn_ensemble_check(const hn_system *sys, const hn_method_spec *spec,
                                          hn_diag *diag);
/// Makes an ensemble with memory for its threads; the system must outlive it.
/// hn_ensemble_start_of() takes the step and the options of `spec`. Fails: as hn_ensemble_check(),
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ensemble_create(const hn_system *sys, const hn_method_spec *spec,
                                           const hn_ensemble_opts *opts, hn_ensemble **out,
                                           hn_diag *diag);
void hn_ensemble_free(hn_ensemble *e); ///< NULL is legal
/// Returns a start from this state with the options of the method as it is spelled.
hn_ensemble_start hn_ensemble_start_of(const hn_ensemble *e, const double *q, const double *v);
/// Runs n members to t_end [s]. The last good state of member i goes to q (n x nq) and v (n x nv),
/// row i, its end to ends[i]. One call at a time; allocates nothing but threads.
void hn_ensemble_run(hn_ensemble *e, int n, const hn_ensemble_start *starts, double t_end,
                     double *q, double *v, hn_ensemble_end *ends);
#endif
