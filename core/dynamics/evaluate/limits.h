// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LIMITS_H
#define HN_DYNAMICS_LIMITS_H
// Values of the coordinates that have limits, those of cut joints among them.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_limits hn_limits;

/// Creates an evaluator of all scene coordinates that have a limit and an expression (entries of
/// orientations have none, nor do coordinates of some cut joints). Memory from `arena`, the tape
/// owned (hn_limits_free). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_limits_create(const hn_system *sys, hn_arena *arena, hn_limits **out);
void hn_limits_free(hn_limits *l);                   ///< NULL is legal
int hn_limits_count(const hn_limits *l);             ///< how many
int hn_limits_coordinate(const hn_limits *l, int i); ///< scene coordinate of number i
/// Writes their values at a state to `values` (count). Allocates nothing.
void hn_limits_eval(hn_limits *l, double t, const double *q, double *values);
#endif
