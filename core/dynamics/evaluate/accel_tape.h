// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ACCEL_TAPE_H
#define HN_DYNAMICS_ACCEL_TAPE_H
// The tape that solves for accelerations and multipliers (accel.h): the system's right-hand sides
// and the factor of ldl.h, in one sequence of operations whose order is chosen once. Outputs: a,
// lambda if wanted, then pivot and reference of each guard, then the squared length of each row of
// J.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/inputs.h"
#include "dynamics/evaluate/row_groups.h"

#include <stdbool.h>

/// Bounds for an answer that nobody need look at, far above those at which one is in doubt:
/// roundings of the comparison do not matter.
#define HN_ACCEL_SURE_PIVOT (2 * HN_PIVOT_DOUBT)
#define HN_ACCEL_SURE_ROW (2 * HN_ROW_LOST)

typedef struct hn_accel_tape {
    bool available; ///< a static order exists; without one there is no tape
    int n_answer;   ///< a, and lambda if wanted
    int n_guards;   ///< pairs of a pivot and its reference
    int n_out;      ///< all outputs; the last nc are the squared lengths of the rows
} hn_accel_tape;

/// Compiles the tape, with memory from `arena`; `inputs` receives it where there is one.
///
/// want_lambda  in  the multipliers are outputs too
/// baumgarte    in  the right-hand side of the closure rows has Baumgarte's terms
HN_MUST_CHECK hn_status hn_accel_tape_compile(const hn_system *sys, bool want_lambda,
                                              bool baumgarte, hn_arena *arena, hn_inputs *inputs,
                                              hn_accel_tape *out);

/// Runs the tape and copies its answer as hn_accel_tape_take() does. Returns whether the answer is
/// finite, every pivot above HN_ACCEL_SURE_PIVOT times its reference and every row's squared length
/// above HN_ACCEL_SURE_ROW times the largest: `true` is sure, `false` asks for a closer look.
bool hn_accel_tape_solve(const hn_accel_tape *tape, const hn_inputs *in, double *a, double *lambda);

/// The smallest pivot relative to its reference after a run of the tape [-]; 0: not a number.
double hn_accel_tape_worst_pivot(const hn_accel_tape *tape, const hn_inputs *in);

/// Copies the answer, a (nv) and lambda (nc, or NULL). Returns false where an entry of it is not
/// finite.
bool hn_accel_tape_take(const hn_accel_tape *tape, const hn_inputs *in, double *a, double *lambda);
#endif
