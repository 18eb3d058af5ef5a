// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LAGRANGIAN_H
#define HN_DYNAMICS_LAGRANGIAN_H
// A scene of formulas, or formulas beside bodies, compiled by exact differentiation. With
// L = T - V and p = dT/dv:
//
//     M = dp/dv,   h = (dp/dq) v - dT/dq + dV/dq,   f = Q - h                                 (1)
//     J = dphi/dq, phi_t, gamma = d/dt (J v + phi_t) at zero u-dot                            (2)
//
// gamma is the directional derivative of phi, taken twice along (q', v', t') = (v, 0, 1), so that
// terms of t come in by themselves.

#include "dynamics/compile/system_impl.h"

/// Compiles a scene of formulas into an empty system. Fails as hn_system_compile() does.
HN_MUST_CHECK hn_status hn_lagrangian_compile(hn_system *sys);
/// Adds the energies of formulas to M, f and the energies of a system of bodies. Its coordinates
/// must be known to formulas by then.
HN_MUST_CHECK hn_status hn_lagrangian_add_energies(hn_system *sys);

#endif
