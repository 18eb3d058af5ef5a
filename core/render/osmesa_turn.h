// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_OSMESA_TURN_H
#define HN_RENDER_OSMESA_TURN_H
// One thread at a time uses OSMesa: OSMesa 22 keeps one list of drawing buffers for the process
// and changes it without a lock. A thread that paints for long gives its turn up between tiles, so
// that a small picture does not wait for the end of a large one. The turn guards OSMesa, not state
// of ours.

#include "base/interrupt.h"

#include <stdbool.h>

/// Waits for the turn. `interrupt` (NULL: never) is asked meanwhile, without the turn; returns
/// false, without the turn, when it ends the wait.
bool hn_osmesa_turn_take(const hn_interrupt *interrupt);
/// Gives the turn up.
void hn_osmesa_turn_give(void);
/// Gives the turn up and waits for it again: a thread that waits already has it first. Returns as
/// hn_osmesa_turn_take().
bool hn_osmesa_turn_pass(const hn_interrupt *interrupt);
#endif
