// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_LIMIT_INCIDENTS
#define HN_STUDY_LIMIT_INCIDENTS
// The incident of a coordinate that leaves its limits: reported each time it does, again only after
// it has come back.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_joint_limit;

#endif
