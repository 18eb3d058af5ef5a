// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_BIAS_H
#define HN_DYNAMICS_BIAS_H
// Bias forces h (what the joints must give at zero u-dot, gravity included) and energy of a tree of
// bodies, by recursion; the derivation is in bias.c.

#include "dynamics/compile/mech.h"

void hn_mech_trace_bias(hn_mech *m);   ///< adds -h to sys->f
void hn_mech_trace_energy(hn_mech *m); ///< kinetic; adds gravity to potential

#endif
