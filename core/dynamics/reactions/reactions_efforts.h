// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REACTIONS_EFFORTS_H
#define HN_DYNAMICS_REACTIONS_EFFORTS_H
// Generalised forces along coordinates: of energies given as formulas, and of constraints on
// coordinates.

#include "dynamics/reactions/reactions_state.h"

#include <stdbool.h>

/// Derives the generalised forces of the energies: their coordinates, the force at zero
/// accelerations (one expression each, in the arena), and its derivatives by the accelerations.
HN_MUST_CHECK hn_status hn_reaction_derive_energies(hn_reactions *r, hn_arena *arena,
                                                    hn_ex **at_zero, hn_entries *inertia);
void hn_reaction_read_energies(hn_reactions *r, const double *a); ///< of the last run of the tape
HN_MUST_CHECK hn_status hn_reaction_list_efforts(hn_reactions *r, hn_arena *arena);
void hn_reaction_read_efforts(hn_reactions *r, const double *lambda);
bool hn_reaction_is_formal(const hn_reactions *r, int coordinate); ///< no joint of bodies has it

#endif
