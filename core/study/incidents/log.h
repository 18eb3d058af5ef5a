// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INCIDENT_LOG_H
#define HN_STUDY_INCIDENT_LOG_H
// The reports of one run. A condition is reported when it begins to hold, not at every step while
// it does.

#include "base/status.h"
#include "study/incidents/incident.h"

/// Reports of one kind, so that a condition that comes and goes leaves room for others.
enum { HN_INCIDENT_MOST_OF_ONE_KIND = 5 };

typedef struct hn_incident_log {
    /// owned; room for HN_RUN_MAX_INCIDENTS, of which pages that no report reaches are not touched
    hn_incident *list;
    int n;
    int reported[HN_INCIDENT_COUNT]; ///< in the list, by kind
    int times[HN_INCIDENT_COUNT];    ///< how often each condition has begun, listed or not
    unsigned active;                 ///< a bit per kind whose condition holds at present
    unsigned revision;               ///< of the report written or completed last; never set back
} hn_incident_log;

/// Makes room for the reports of a run. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_incident_log_create(hn_incident_log *log);
void hn_incident_log_free(hn_incident_log *log);
/// Forgets all reports; revisions go on.
void hn_incident_log_clear(hn_incident_log *log);
/// Says whether the condition has been reported and still holds.
bool hn_incident_holds(const hn_incident_log *log, hn_incident_code code);
/// Records that the condition no longer holds: it is reported again when it next begins.
void hn_incident_over(hn_incident_log *log, hn_incident_code code);
/// Counts a condition that begins to hold, unless it holds already. Returns whether a report of it
/// would be kept: it is new, and there is room. Ask it before a text is made, once.
bool hn_incident_begins(hn_incident_log *log, hn_incident_code code);
/// Adds a report without remedies of a condition that has begun. Returns NULL where no room is
/// left.
hn_incident *hn_incident_add(hn_incident_log *log, const hn_incident *report);
/// Makes room for one report of this kind, for the end of a run, which is always reported.
void hn_incident_make_room(hn_incident_log *log, hn_incident_code code);
/// Appends to a message; the report counts as new from then on.
void hn_incident_append(hn_incident_log *log, hn_incident *i, const char *format, ...)
    HN_PRINTF(3, 4);

#endif
