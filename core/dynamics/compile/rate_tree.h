// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_RATE_TREE_H
#define HN_DYNAMICS_RATE_TREE_H
// The system's velocities as sums of the user's rates, in the form of a tree:
//
//     v_i = sign_i user_i + v_base(i)                                                        (1)
//
// so that a rate of the user moves v_i and all that is counted from it, directly or through others.
// The same numbers as hn_system_rates_from_user(), without a matrix.

#include "base/arena.h"
#include "dynamics/compile/system.h"

#include <stdbool.h>

typedef struct hn_rate_tree {
    int n;
    int *base;           ///< the velocity that v_i is counted from, -1: none
    double *sign;        ///< 1 or -1
    int *order;          ///< all velocities, bases first
    int *first, *beyond; ///< numbers by which "counted from" is a comparison
} hn_rate_tree;

/// Arrays from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_rate_tree_init(hn_rate_tree *r, const hn_system *sys, hn_arena *arena);
/// The rate of v_i for a unit rate of user coordinate k: sign_k where v_i is v_k or counted from
/// it, else 0.
double hn_rate_tree_share(const hn_rate_tree *r, int i, int k);

#endif
