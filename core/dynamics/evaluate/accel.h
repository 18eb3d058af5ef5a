// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ACCEL_H
#define HN_DYNAMICS_ACCEL_H
// Accelerations and multipliers at one state, from the saddle-point system
//
//     K [a; -lambda] = [f; -(gamma + 2 alpha (J v + phi_t) + beta^2 phi)],   K = [M J'; J 0]  (1)
//
// M a = f + J' lambda are the equations of motion. phi are the constraints. J maps velocities
// to their rates, d(phi)/dt = J v + phi_t with phi_t the derivative by time; the second derivative
// is J a + gamma, so J a + gamma = 0 keeps the loops closed. alpha and beta are Baumgarte's.
//
// The system is solved by a tape (accel_tape.h) that contains a sparse LDL' factorisation of K
// whose order of elimination is chosen when the system is compiled. Its pivots are checked at every
// evaluation. If a pivot is lost, or a value is not finite, the dense least-norm solver of
// linalg/kkt.h, which finds the rank, is used instead, and hn_accel_info.fallback is set.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/native.h"
#include "expr/tape.h"

#include <stdbool.h>

/// The solvers of K.
///
/// "auto" evaluates the tape. If a pivot is below HN_PIVOT_DOUBT, iterative refinement with the
/// sparse factor corrects the answer. If a pivot is below HN_PIVOT_GUARD, or a row of J has
/// nearly vanished, the dense least-norm solver replaces it.
/// Each of the other solvers works alone and
/// fails on a matrix that it cannot solve (linalg/kkt.h).
#define HN_SOLVER_LIST(X)                   \
    X(HN_SOLVER_AUTO, "auto")               \
    X(HN_SOLVER_LDL, "ldl")                 \
    X(HN_SOLVER_DENSE, "dense")             \
    X(HN_SOLVER_RANGE_SPACE, "range-space") \
    X(HN_SOLVER_NULL_SPACE, "null-space")   \
    X(HN_SOLVER_PROXIMAL, "proximal")       \
    X(HN_SOLVER_LEAST_NORM, "least-norm")
typedef enum hn_solver {
#define HN_SOLVER_ENUM(code, name) code,
    HN_SOLVER_LIST(HN_SOLVER_ENUM)
#undef HN_SOLVER_ENUM
        HN_SOLVER_COUNT
} hn_solver;
extern const char *const hn_solver_names[HN_SOLVER_COUNT];

typedef struct hn_accel hn_accel;

typedef struct hn_accel_opts {
    bool baumgarte;   ///< (1) with alpha and beta as inputs; else both are 0
    bool want_lambda; ///< the multipliers are computed too; else what only they need is left out
    hn_solver solver; ///< 0: automatic
} hn_accel_opts;

typedef struct hn_accel_info {
    bool fallback;    ///< the dense least-norm solver answered in place of the tape
    hn_solver solver; ///< the solver that answered; the tape counts as ldl
    int refinements;  ///< corrections of the answer that were kept
    int massless;     ///< the velocity without mass where the range space refused; else -1
    int rank; ///< rank of J: nc where the tape answered, the numerical rank from the least-norm one
    /// smallest pivot, each divided by the sum of the absolute values of its terms [-]; below
    /// HN_PIVOT_GUARD the dense least-norm solver answers
    double pivot_ratio;
    /// shortest row of J against the longest of its loop, squared; 1 where the tape does not serve
    double row_ratio;
    double residual; ///< least-norm solver only: max |J a + gamma|
} hn_accel_info;
#define HN_PIVOT_GUARD 1e-8
/// An answer with a smaller pivot is refined. With larger pivots the answer is right to 1e-13
/// without that, and a refinement would cost more than the tape.
#define HN_PIVOT_DOUBT 1e-3

/// Compiles the terms that the options ask for into one tape. Returns in *out, which lives in the
/// arena. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_accel_create(const hn_system *sys, const hn_accel_opts *opts,
                                        hn_arena *arena, hn_accel **out);
/// Frees what is outside the arena. NULL is legal.
void hn_accel_free(hn_accel *s);
/// Solves for the accelerations a (nv) and multipliers lambda (nc, may be NULL) at one state.
/// alpha and beta [1/s] count only with opts.baumgarte; `info` may be NULL. Allocates nothing.
/// Fails, outputs then untouched:
///   HN_ERR_MASS          a motion that the constraints leave free has no mass
///   HN_ERR_SINGULAR      the chosen solver cannot solve here (hn_accel_refusal)
///   HN_ERR_INCONSISTENT  dependent rows ask for different accelerations
///   HN_ERR_DIVERGED      the state is not finite
HN_MUST_CHECK hn_status hn_accel_eval(hn_accel *s, double t, const double *q, const double *v,
                                      double alpha, double beta, double *a, double *lambda,
                                      hn_accel_info *info);
/// Estimates the 1-norm condition of the equilibrated K (rows that depend on others left out) at a
/// state; about 15.6 - log10 of it digits are left. Fails as the least-norm solve does. Allocates
/// nothing.
HN_MUST_CHECK hn_status hn_accel_condition(hn_accel *s, double t, const double *q, const double *v,
                                           double *condition);
#define HN_CONDITION_LOST 1e13 ///< of the equilibrated K: no digit of the multipliers is left

/// Whether the multipliers of a state are unique, and how far they can be believed.
typedef enum hn_multiplier_mark {
    HN_MULTIPLIERS_DETERMINED,
    HN_MULTIPLIERS_ONE_OF_MANY, ///< rows depend on each other: the least-norm choice of many
    HN_MULTIPLIERS_LOST,        ///< condition above HN_CONDITION_LOST
    HN_MULTIPLIERS_NONE,        ///< the system has no solution there
    HN_MULTIPLIERS_OPEN,        ///< a loop stands open: forces of a mechanism that is torn
    HN_N_MULTIPLIER_MARKS
} hn_multiplier_mark;
/// "determined", "one of many", ...
extern const char *const hn_multiplier_marks[HN_N_MULTIPLIER_MARKS];
/// The mark of the multipliers that hn_accel_eval() found at this state with `info`. If the tape
/// answered without a pivot in doubt or a vanishing row, K is far from singular; else its condition
/// is estimated, at the cost of a dense solve. Never HN_MULTIPLIERS_OPEN, which is for callers who
/// know the gap. Allocates nothing.
hn_multiplier_mark hn_accel_mark(hn_accel *s, double t, const double *q, const double *v,
                                 const hn_accel_info *info);
struct hn_accel_tape;
struct hn_inputs;
/// Returns the layout of the tape's outputs, or NULL where the solver has no tape. Sets *in to the
/// tape and its workspace, for callers that evaluate several states at once. Both are borrowed.
const struct hn_accel_tape *hn_accel_get_tape(const hn_accel *s, const struct hn_inputs **in);
hn_tape_info hn_accel_tape_info(const hn_accel *s);
/// Compiles the tape of the sparse solve natively, waits for it and measures (expr/native.h).
/// Fails as hn_native_measure(), and with HN_ERR_UNSUPPORTED where the solve has no tape.
HN_MUST_CHECK hn_status hn_accel_measure_native(const hn_accel *s, hn_native_costs *costs,
                                                hn_diag *diag);
long long hn_accel_count(const hn_accel *s);
long long
hn_accel_fallbacks(const hn_accel *s); ///< answers of the dense solver in place of the tape's
long long hn_accel_refinements(const hn_accel *s); ///< answers corrected with the sparse factor
/// Arithmetic operations so far, tape and linear algebra.
double hn_accel_ops(const hn_accel *s);
/// Why the last solve failed, in words; NULL when there is nothing to say beyond the status.
const char *hn_accel_refusal(const hn_accel *s);

#endif
