// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_BUDGET_H
#define HN_STUDY_BUDGET_H
// The error budget of a run: what each step adds to the error at the end, and to the energy, split
// by cause. While errors are small the parts add up to the whole; where they no longer do, the
// document says so, and until when they did.
//
// Step k takes y_k = (q, v) to y_(k+1); u_(k+1) is its result before the projection, y_(k+1) after
// it. From the same y_k two exact flows are computed to all digits: B solves the differential
// equation of the formulation, I the equations of motion of index 1, which exist off the loops too.
// Then
//
//     e_k = y_(k+1) - I(y_k) = [u_(k+1) - B(y_k)] + [B(y_k) - I(y_k)] + [y_(k+1) - u_(k+1)]    (1)
//                                 truncation         formulation          projection
//     y_N - exact(T) = sum over k of  DI_(T - t_(k+1)) e_k,   to first order                    (2)
//
// with DI the derivative of I by its start, carried backwards from T: one row of it, transposed
// step by step from exact derivatives (flow.h). Each part is split at y_(k+1) into what lies
// along the loops' motion and what opens the loops; of the latter, what projection does not remove
// is summed as drift. Rounding and the linear solve are measured by a second
// run with compensated sums, and one with another solver, and are then subtracted from truncation.
//
// The same for energy, where the flow I itself may do work: through the loops, as lambda'(J v +
// phi_t), when they are not closed at speed level, and from outside (dampers, drives). In a
// conservative scene nothing may come from outside: that checks the rest.
// Source: Hairer, Norsett and Wanner 1993, section II.3 (the error as a sum of transported local
// errors).

#include "integrators/method/method_spec.h"
#include "study/run/ending.h"
#include "study/run/run.h"

#include <stdbool.h>

/// Names of a part of a budget: name in documents, letter on its bar, word over its
/// column, and what it is.
typedef struct hn_budget_part_words {
    const char *name;
    const char *letter;
    const char *word;
    const char *about;
} hn_budget_part_words;

#define HN_CAUSE_LIST(X)                                                                  \
    X(HN_CAUSE_TRUNCATION, "truncation", "T", "steps", "error of the integrator's steps") \
    X(HN_CAUSE_FORMULATION, "formulation", "F", "formulation",                            \
      "terms that the formulation adds to the equations")                                 \
    X(HN_CAUSE_PROJECTION, "projection", "P", "projection",                               \
      "displacement by the projection along the motion")                                  \
    X(HN_CAUSE_DRIFT, "drift", "D", "drift",                                              \
      "error of the steps off the loops, less what the projection removes of it")         \
    X(HN_CAUSE_SOLVE, "solve", "L", "solve",                                              \
      "rounding in the linear solve, against another solver")                             \
    X(HN_CAUSE_ROUNDING, "rounding", "R", "rounding",                                     \
      "rounding in the sums, against compensated sums")

typedef enum hn_cause {
#define HN_CAUSE_ENUM(code, name, letter, word, about) code,
    HN_CAUSE_LIST(HN_CAUSE_ENUM)
#undef HN_CAUSE_ENUM
        HN_CAUSE_COUNT
} hn_cause;
/// The words of a row of HN_CAUSE_LIST.
const hn_budget_part_words *hn_cause_words(hn_cause cause);

#define HN_ENERGY_LIST(X)                                                                          \
    X(HN_ENERGY_TRUNCATION, "truncation", "T", "steps", "error of the integrator's steps")         \
    X(HN_ENERGY_FORMULATION, "formulation", "F", "formulation", "terms that the formulation adds") \
    X(HN_ENERGY_PROJECTION, "projection", "P", "projection", "work of the projection")             \
    X(HN_ENERGY_LOOPS, "loops", "O", "loops",                                                      \
      "constraint forces, where velocities open the loops")                                        \
    X(HN_ENERGY_OUTSIDE, "outside", "W", "loads", "work of dampers, drives and loads: no error")

typedef enum hn_energy_item {
#define HN_ENERGY_ENUM(code, name, letter, word, about) code,
    HN_ENERGY_LIST(HN_ENERGY_ENUM)
#undef HN_ENERGY_ENUM
        HN_ENERGY_COUNT
} hn_energy_item;
/// The words of a row of HN_ENERGY_LIST.
const hn_budget_part_words *hn_energy_item_words(hn_energy_item item);

typedef struct hn_budget {
    hn_run_state state; ///< of the run; a budget of a failed one goes to where it got
    char reason[256];
    /// of a run that ended early, as data; of HN_ERR_NO_CONVERGENCE: where the flows ended
    hn_ending ending;
    double t; ///< reached [s]
    long long steps;
    /// user coordinate whose error it is: the one asked for, or the one whose error is largest at
    /// the end; -1: the run ended early
    int coordinate;
    double error;                ///< of it, signed: the run's value less the reference's [rad or m]
    double part[HN_CAUSE_COUNT]; ///< signed, same unit; NaN: not known for this method
    double sum;                  ///< of the parts: equals `error` as far as first order holds
    /// 0: the integrator takes the constraints as they are: formulation and truncation are one
    int has_equations;
    double energy;                        ///< E(end) - E(start) [J]
    double energy_parts[HN_ENERGY_COUNT]; ///< [J], adds up to `energy`
    /// sum of |work of the loop forces| over the steps [J]: in the parts positive and negative work
    /// cancel
    double loop_work_abs;
    double swing;     ///< largest T plus range of V [J]: the scale of energies
    int conservative; ///< nothing should come from outside
} hn_budget;

typedef struct hn_budget_opts {
    long long max_steps; ///< 0: 200,000
    /// n_user: the exact motion at T, in user coordinates; NULL: found here, by a run at tight
    /// tolerance
    const double *exact;
    /// whose error is split: 1 + a user coordinate; 0: the one whose error is largest at the end
    int coordinate;
    int (*stop)(void *user); ///< asked now and then; NULL: never
    void (*progress)(void *user, double share);
    void *user;
} hn_budget_opts;

/// Computes the error budget of one method from the assembled state (q, v) in system coordinates to
/// the time T [s]. Costs some 100 times the run, whatever the number of degrees of freedom.
/// Fails: HN_ERR_LIMIT (more steps than can be kept; the message has the number), HN_ERR_STOPPED
/// (stopped on request), HN_ERR_NO_CONVERGENCE (the flows beside the run, or the exact motion,
/// could not be followed: past a configuration where J loses rank there is no flow off the loops),
/// HN_ERR_MEMORY; and as hn_run_create().
HN_MUST_CHECK hn_status hn_budget_make(const hn_system *sys, const hn_method_spec *spec,
                                       const double *q, const double *v, double T,
                                       const hn_budget_opts *opts, hn_budget *out, hn_diag *diag);
#endif
