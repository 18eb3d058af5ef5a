// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_REPORT_INCIDENT_H
#define HN_STUDY_REPORT_INCIDENT_H
// Adds the report of a check to the log: its message, and the remedies of its kind.

#include "study/incidents/watch.h"

/// Reports that a condition holds, with the remedies of the row that apply to this run. Returns
/// NULL where it is known already or no room is left.
/// hn_incident_put() is the same for a condition of which hn_incident_begins() was asked.
hn_incident *hn_incident_report(hn_watch *w, const hn_incident_kind *kind, const char *quantity,
                                double value, double limit, const char *format, ...)
    HN_PRINTF(6, 7);
hn_incident *hn_incident_put(hn_watch *w, const hn_incident_kind *kind, const char *quantity,
                             double value, double limit, const char *format, ...) HN_PRINTF(6, 7);

#endif
