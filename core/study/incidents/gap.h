// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_GAP_INCIDENTS
#define HN_STUDY_GAP_INCIDENTS
// Incidents of the loop gap (constraint violation).

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_gap_open;
/// Fails with HN_ERR_DIVERGED and the reason in `why` where the loops are so far open that what
/// moves is another mechanism.
HN_MUST_CHECK hn_status hn_gap_judge(const hn_watch *w, char why[256]);

#endif
