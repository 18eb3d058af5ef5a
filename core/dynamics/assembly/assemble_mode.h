// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_MODE_H
#define HN_DYNAMICS_ASSEMBLE_MODE_H
// The search for the assembly mode that a scene asks for.
//
// No small correction leads from one mode to another, so the dependent coordinates of a loop in the
// wrong mode start again from random values, the others from where they are. Loops are corrected
// one after the other: a try finds either of a loop's two modes about as often, so each loop needs
// two tries on average, and n loops together would need 2^n.

#include "dynamics/assembly/assemble_state.h"

/// Moves s->x from a closed pose to one in the assembly mode that the scene asks for.
/// Fails: HN_ERR_UNREACHABLE, with a report, when it was not found; s->x is then unchanged.
///        HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_mode(hn_assembler *s);

#endif
