// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INSIDE_INCIDENTS_H
#define HN_STUDY_INSIDE_INCIDENTS_H
// Checks of samples between steps: every state that is put out is checked like the states that the
// run steps to.

#include "study/incidents/watch.h"

/// Checks a sample that lies inside a step or ahead of the last one: gap, energy and assembly mode.
/// Its gap and energy count in the worst of the run. `energy_change` as hn_watch_energy_change().
void hn_inside_check(hn_watch *w, const hn_state_at *at, const hn_measure *m, double energy_change);

#endif
