// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_STIFFNESS_INCIDENTS
#define HN_STUDY_STIFFNESS_INCIDENTS
// Incidents of steps that are shorter than the motion needs, or too long for the feedback on the
// gap.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_stiff, hn_incident_restarts, hn_incident_step_limit,
    hn_incident_step_long;
/// After an accepted step.
void hn_stiffness_check_step(hn_watch *w);
/// The rate of the feedback against the limit of the integrator: at the start, and when an option
/// changes.
void hn_step_limit_check(hn_watch *w);
/// A fixed step against the length of the run, where that is known: at the start.
void hn_step_long_check(hn_watch *w);

#endif
