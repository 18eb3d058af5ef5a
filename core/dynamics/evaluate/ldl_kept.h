// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LDL_KEPT_H
#define HN_DYNAMICS_LDL_KEPT_H
// The symbolic factorisations of a system (ldl.h), each built when it is first asked for and kept
// as long as the system: a run, its samples, its pilot run and its error estimate share them.

#include "dynamics/evaluate/factor.h"
#include "dynamics/evaluate/ldl.h"

/// Finds the factorisation of K with this weight; borrowed, lives as long as the system. Adds nodes
/// to the system's graph. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ldl_kept_get(const hn_system *sys, hn_factor_weight weight,
                                        const hn_ldl **out);
#endif
