// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INCIDENT_KINDS
#define HN_STUDY_INCIDENT_KINDS
// The table of incidents: one row per kind, indexed by code.

#include "base/strbuf.h"
#include "study/incidents/incident.h"

/// HN_INCIDENT_COUNT rows. Static.
const hn_incident_kind *const *hn_incident_kinds(void);
/// "gap-open"; "?" for a code that is none.
const char *hn_incident_spelling(hn_incident_code code);
/// Writes the table as an array: [{"code","name","rule"}].
void hn_incident_kinds_json(hn_strbuf *b);

#endif
