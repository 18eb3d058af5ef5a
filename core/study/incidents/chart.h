// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CHART_INCIDENTS
#define HN_STUDY_CHART_INCIDENTS
// The incident of a chart that changes.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_chart_change;
/// Reports chart changes made since the last check.
void hn_chart_check(hn_watch *w, long long changes);

#endif
