// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SYSTEM_BUILD_H
#define HN_DYNAMICS_SYSTEM_BUILD_H
// Common part of compiling scenes of bodies and scenes of formulas: memory, symbols, rows.

#include "dynamics/compile/system_impl.h"

/// Allocates all arrays that nq, nv and the other sizes decide, with room for `max_rows` rows.
HN_MUST_CHECK hn_status hn_system_allocate(hn_system *sys, int nq, int nv, int max_rows,
                                           int n_loops, int n_points);
/// Makes symbols of the nq coordinates and nv rates under these names (a name that is taken gets
/// underscores), then of t and the gains.
HN_MUST_CHECK hn_status hn_system_make_symbols(hn_system *sys, const char *const *names,
                                               const char *const *rates);
/// Returns the list for faults of the scene. NULL once the graph has run out of memory: it then
/// returns zeros, which the checks would take for faults of the scene.
hn_diags *hn_system_faults(const hn_system *sys);

typedef struct hn_new_row {
    const char *name;
    int loop, is_length; ///< is_length decides the unit in messages
    hn_ex phi, phi_t, gamma;
    const hn_entry *J; ///< n_J entries, their row ignored
    int n_J;
    const char *pointer;         ///< of the joint or formula
    const hn_row_wrench *wrench; ///< NULL: none
} hn_new_row;
/// Adds a closure row. A row that vanishes identically is dropped; one that is a constant other
/// than zero is refused with HN_ERR_INPUT, since its loop can never close.
HN_MUST_CHECK hn_status hn_system_add_row(hn_system *sys, const hn_new_row *row);

#endif
