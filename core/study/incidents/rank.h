// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_RANK_INCIDENTS
#define HN_STUDY_RANK_INCIDENTS
// Incidents of dependent or nearly dependent constraints at the state that has been reached.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_rank_loss, hn_incident_near_singular;

#endif
