// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_INCIDENT_JSON_H
#define HN_SESSION_INCIDENT_JSON_H
// An incident as data: the same object in runs, comparisons and sessions.

#include "base/strbuf.h"
#include "study/run/run.h"

/// Writes one incident:
/// {["method",]"code","t","quantity","value","limit","message","remedies":[...],"tried":[...]}.
/// method -1 leaves "method" out.
void hn_incident_json(hn_strbuf *b, int method, const hn_incident *incident);
/// The same for all incidents of a run, as elements of an array that is open.
void hn_incidents_json(hn_strbuf *b, int method, const hn_run *run);
#endif
