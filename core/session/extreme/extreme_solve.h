// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_SOLVE_H
#define HN_SESSION_EXTREME_EXTREME_SOLVE_H
// Solves the saddle system at a scene's start by one of the dense solvers and compares the answer
// with an elimination in twice the digits.

#include "session/extreme/extreme_internal.h"

#include <stdbool.h>

/// Solves the saddle system at the point's start with the solver of that name.
void hn_extreme_solve(hn_extreme_bench *bench, const hn_extreme_point *point,
                      hn_extreme_answer *out);
bool hn_extreme_is_solver(const char *name);
#endif
