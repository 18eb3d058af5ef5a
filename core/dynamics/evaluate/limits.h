#ifndef HN_DYNAMICS_LIMITS_H
#define HN_DYNAMICS_LIMITS_H
// Values of the coordinates that have limits, those of cut joints among them.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_limits hn_limits;

/// Of all scene coordinates with a limit that the state gives (entries of orientations have none,
/// nor have coordinates of cut joints without a formula). Memory from `arena`, the tape owned
/// (hn_limits_free).
HN_MUST_CHECK hn_status hn_limits_create(const hn_system *sys, hn_arena *arena, hn_limits **out);
void hn_limits_free(hn_limits *l);                   ///< NULL is legal
int hn_limits_count(const hn_limits *l);             ///< how many
int hn_limits_coordinate(const hn_limits *l, int i); ///< scene coordinate of number i
/// Their values at a state into `values` (count). Allocates nothing.
void hn_limits_eval(hn_limits *l, double t, const double *q, double *values);
#endif
