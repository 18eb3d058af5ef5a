// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_LANES_TAPE_H
#define HN_EXPR_LANES_TAPE_H
// A tape in lanes by the quickest code there is: the interpreter of lanes.h, and once it is ready
// the same compiled natively (native.h), bit for bit.

#include "expr/lanes.h"

typedef struct hn_lanes_tape {
    const hn_tape *tape; ///< borrowed
    hn_lanes_set set;
    struct hn_native_state *native; ///< NULL: the interpreter alone
} hn_lanes_tape;

/// Prepares a tape for lanes by a set that the processor has; free with hn_lanes_tape_reset().
void hn_lanes_tape_init(hn_lanes_tape *l, const hn_tape *tape, hn_lanes_set set);
void hn_lanes_tape_reset(hn_lanes_tape *l);
/// As hn_lanes_run().
void hn_lanes_tape_run(const hn_lanes_tape *l, double *work);
#endif
