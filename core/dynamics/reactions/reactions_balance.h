// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REACTIONS_BALANCE_H
#define HN_DYNAMICS_REACTIONS_BALANCE_H
// The balance of every body, leaves first, which gives the wrenches of the joints.

#include "dynamics/reactions/reactions_state.h"

#include <stdbool.h>

/// Computes the wrench of every joint and of every constraint between points for the multipliers
/// `lambda`. With `bare` masses and loads are left out: what remains is the part of `lambda` alone.
void hn_reaction_balance(hn_reactions *r, const double *lambda, int bare,
                         hn_reaction_wrench *constraint);
/// Work of a tree joint's wrench along its own degrees of freedom against what is put in there,
/// relative; see hn_reactions_defect.
double hn_reaction_calc_defect(const hn_reactions *r);

#endif
