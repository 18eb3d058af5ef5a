// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_LANES_H
#define HN_EXPR_LANES_H
// A tape at many states at once: each slot of the workspace holds a block of HN_LANES doubles, one
// for each lane, and an instruction is carried out on the whole block by vector instructions that
// the processor has (lanes_sincos.h). One dispatch serves all lanes, so this needs no compiler.
//
// Every operation is rounded as the interpreter rounds it, and functions are those of the operator
// table: a lane's results are the bits of hn_tape_run() (but for which NaN), whatever the other
// lanes hold.

#include "expr/lanes_sincos.h"
#include "expr/tape.h"

#include <stdint.h>

enum { HN_LANES = 32 };
/// One bit for each lane.
typedef uint32_t hn_lane_bits;

/// Doubles that a workspace needs, aligned to 64 bytes (hn_arena_doubles).
size_t hn_lanes_work_size(const hn_tape *tape);
/// Loads the constants into a fresh workspace; every other entry becomes 0.
void hn_lanes_prepare(const hn_tape *tape, double *work);
/// Evaluates all lanes. Input i of lane k is work[HN_LANES i + k], and stays as it is; its output j
/// is work[HN_LANES s + k] with s = hn_tape_output_slots()[j]. `set` is one that the processor has.
/// Allocates nothing.
void hn_lanes_run(const hn_tape *tape, hn_lanes_set set, double *work);
#endif
