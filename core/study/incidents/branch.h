// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_BRANCH_INCIDENTS
#define HN_STUDY_BRANCH_INCIDENTS
// The incident of a run that jumps to another branch, or turns off at a singular configuration.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_branch_flip;

#endif
