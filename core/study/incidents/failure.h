// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_FAILURE_INCIDENTS
#define HN_STUDY_FAILURE_INCIDENTS
// Incidents that end a run.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_chart_lost, hn_incident_projection_failed,
    hn_incident_newton_failed, hn_incident_step_underflow, hn_incident_diverged, hn_incident_mass,
    hn_incident_program, hn_incident_stopped;
/// Reports the end of a run with its reason.
void hn_failure_report(hn_watch *w, hn_status status, const char *reason);

#endif
