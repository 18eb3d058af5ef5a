// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REDUNDANCY_H
#define HN_DYNAMICS_REDUNDANCY_H
// Redundant closure rows, by name: rows that vanish in every pose (the compiler dropped them), and
// rows that follow from the rows before them at one pose.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

/// Writes "redundant_rows" {"vanish": [names], "follow": [{"row", "from": [names]}], "singular"?}
/// into the JSON object that is open in `b`, for the pose q (nq) at time t. "singular", where rows
/// follow from others and there are fewer than 100 velocities: some of them do so only at this
/// pose, which is then a singular configuration.
///
/// Rows are taken in their order. A row follows from the rows kept before when the part of it
/// outside their span is below 1e-9 of its length; lengths are measured by diag(M)^-1/2, so that
/// the units of coordinates do not matter. "from" names the rows that it is a combination of; it is
/// empty for a row that is zero at this pose. Compiles a tape: see system.h on threads.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT; the object is then incomplete.
HN_MUST_CHECK hn_status hn_system_redundancy_put(hn_strbuf *b, const hn_system *sys, double t,
                                                 const double *q);
#endif
