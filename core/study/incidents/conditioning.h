// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CONDITIONING_INCIDENTS
#define HN_STUDY_CONDITIONING_INCIDENTS
// Incidents of multipliers that grow, lose digits or come from another solver.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_multipliers, hn_incident_ill_conditioned,
    hn_incident_solver;

#endif
