// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_SOLVE_H
#define HN_SESSION_EXTREME_EXTREME_SOLVE_H
// The saddle system of a scene's start by one of the dense solvers, beside an elimination with
// twice the digits.

#include "session/extreme/extreme_internal.h"

/// The saddle system of the scene's start by the way of that name.
void hn_extreme_solve(hn_extreme_bench *bench, const hn_extreme_point *point,
                      hn_extreme_answer *out);
int hn_extreme_is_solver(const char *name);
#endif
