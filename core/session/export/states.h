// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_STATES_H
#define HN_SESSION_EXPORT_STATES_H
// States of a scene's motion with their accelerations, as numbers to check programs against.

#include "session/export/places.h"

/// Compiles the system of e->model with parameters as symbols, and finds its start, a later state
/// before the first singular configuration, and the energy: e->sys, info, x, start, later, energy.
/// e->sys is freed by the caller, whatever happens.
/// Fails: as hn_system_compile(); HN_ERR_STOPPED (the limits), or as a run does when no later state
/// can be reached.
HN_MUST_CHECK hn_status hn_export_states_find(hn_exporter *e, hn_diags *diags);
/// Finds the state at time t > 0, after hn_export_states_find(). Memory from e->arena. Fails as a
/// run does.
HN_MUST_CHECK hn_status hn_export_state_at(hn_exporter *e, double t, hn_export_state *out,
                                           hn_diags *diags);

#endif
