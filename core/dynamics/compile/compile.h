// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_COMPILE_H
#define HN_DYNAMICS_COMPILE_H
// From a scene to a system of equations (system.h).

#include "base/diag.h"
#include "dynamics/compile/system.h"

typedef struct hn_system_opts {
    /// parameters stay symbols, for equations that people read; numbers are folded in otherwise
    int symbolic_params;
    /// ends the work early: the status is then HN_ERR_STOPPED, and no tape of the system is
    /// compiled any more
    hn_interrupt interrupt;
} hn_system_opts;
hn_system_opts hn_system_opts_default(void);

/// Compiles a scene to a system. The scene must outlive the system; `opts` and `diags` may be NULL.
/// Fails, with a report in `diags`:
///   HN_ERR_INPUT        a closure row that is a nonzero constant (the loop can never close), a
///                       coordinate that moves no mass, a faulty formula
///   HN_ERR_UNSUPPORTED  a load or constraint that cannot be written for this joint
///   HN_ERR_LIMIT        the equations would be too large
///   HN_ERR_STOPPED       the interrupt of the options ended the work
///   HN_ERR_MEMORY
HN_MUST_CHECK hn_status hn_system_compile(const hn_scene *scene, const hn_system_opts *opts,
                                          hn_system **out, hn_diags *diags);
void hn_system_free(hn_system *sys); ///< NULL is legal

#endif
