// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_INCIDENT_LIST_H
#define HN_CLI_INCIDENT_LIST_H
// The incidents of a run as a person reads them: first what is wrong, then the warnings, each in
// order of time; the one that ended the run is apart from the others.

#include "base/strbuf.h"
#include "study/run/run.h"

#include <cjson/cJSON.h>

#include <stddef.h>

enum { HN_INCIDENT_LINE = 640 }; ///< room for a line of either kind

typedef struct hn_incident_list {
    const cJSON *item[HN_RUN_MAX_INCIDENTS];
    int n;
    const cJSON *end; ///< the incident that ended the run; NULL: none did
} hn_incident_list;

/// Takes the incidents of one run: first what is wrong, then the warnings, each in order of time.
/// Those of one time keep their order. A sample inside a step may find an incident later than the
/// end of the run.
///
/// incidents  in  list of incidents of a document; NULL: none
/// method     in  number of the method in the list of a comparison; -1: the list is all of one run
/// reason     in  why the run ended early; "": it did not
void hn_incident_list_take(hn_incident_list *list, const cJSON *incidents, int method,
                           const char *reason);

/// Writes "t = 0.3 s: MESSAGE", or the message alone where it begins with its time.
void hn_incident_line(const cJSON *incident, char *out, size_t size);

/// Writes "and 7 more incidents (--json lists them all)" behind the first `told` of the list. Kinds
/// that were recorded as often as any may be are named, with the time of the last: later ones are
/// in no list.
void hn_incident_more(hn_strbuf *b, const hn_incident_list *list, int told);

/// Writes " at t = 1.43 s: REASON", or ": REASON" where the reason says that time itself. If an
/// incident ended the run its message is the reason, with what was tried against it.
void hn_incident_ending(const hn_incident_list *list, double t, const char *reason, char *out,
                        size_t size);

/// The first remedy of an incident, where it was tried with success; NULL otherwise.
const char *hn_incident_remedy(const cJSON *incident);
#endif
