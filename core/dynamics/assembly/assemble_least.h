// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_LEAST_H
#define HN_DYNAMICS_ASSEMBLE_LEAST_H
// The least change of the velocities of a large mechanism, weighted by mass, that closes
// J v + phi_t, pinned rates held. Sparse, in system velocities:
//
//     [M J' P'; J 0 0; P 0 0] [dv; y; z] = [0; -gap; 0]                                      (1)
//
// where P dv are the rates that are held. Costs what the factors of (1) hold, linearly for a chain
// of loops.

#include "dynamics/assembly/assemble_state.h"

typedef struct hn_assemble_least hn_assemble_least;

/// Factors (1) at the state where s->eval was last run; what can move are the n_free user rates
/// free[k]. *out stays NULL where this does not serve and the dense way decides: rows that may
/// depend on each other, mass that is not definite. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_least_create(const hn_assembler *s, int n_free, const int *free,
                                                 hn_assemble_least **out);
void hn_assemble_least_free(hn_assemble_least *l); ///< NULL is legal
/// The change (n, user rates) that closes `gap` (nc); 0 for held rates.
void hn_assemble_least_change(hn_assemble_least *l, const double *gap, double *change);

#endif
