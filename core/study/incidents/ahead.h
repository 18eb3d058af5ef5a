// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_AHEAD_INCIDENTS
#define HN_STUDY_AHEAD_INCIDENTS
// The incident of a singular configuration that is predicted.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_rank_ahead;

#endif
