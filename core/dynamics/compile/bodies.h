// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_BODIES_H
#define HN_DYNAMICS_BODIES_H
// A scene of bodies and joints, compiled: symbols, terms, rows, loops, points, drawing.

#include "dynamics/compile/system_impl.h"

/// Compiles into an empty system. Fails as hn_system_compile() does.
HN_MUST_CHECK hn_status hn_bodies_compile(hn_system *sys);

#endif
