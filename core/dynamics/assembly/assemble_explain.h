// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_EXPLAIN_H
#define HN_DYNAMICS_ASSEMBLE_EXPLAIN_H
// Why a loop stays open, in words: the gap, the pins, and a missing length. If the joints of the
// loop that may turn are parallel revolutes, the loop is a polygon: bodies between two turning
// joints form one side (pinned joints make them rigid), and it closes if and only if no side is
// longer than all the others together.

#include "dynamics/assembly/assemble_state.h"

/// Reports in s->diags why loop `loop` stays open at s->x.
void hn_assemble_explain(hn_assembler *s, int loop);

#endif
