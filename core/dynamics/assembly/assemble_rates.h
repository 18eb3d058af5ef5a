// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_RATES_H
#define HN_DYNAMICS_ASSEMBLE_RATES_H
// Rates that keep the loops closed: pinned ones as they are, the others changed as little as the
// mass allows.

#include "dynamics/assembly/assemble.h"
#include "dynamics/assembly/assemble_state.h"

/// Writes v (n, system velocities) at the pose s->q from the start rates of the scene, and the gaps
/// before and after into `report`. Fails: HN_ERR_INCONSISTENT (pinned rates contradict each other:
/// s->diags say which), HN_ERR_MEMORY, the failures of hn_saddle_factor().
HN_MUST_CHECK hn_status hn_assemble_rates(hn_assembler *s, double *v, hn_assembly *report);

#endif
