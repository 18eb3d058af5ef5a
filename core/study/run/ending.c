// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/ending.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// An incident counts as the end of the run when it was reported no earlier than this share of t.
static const double AT_END = 1e-9;

const hn_incident *hn_ending_cause(const hn_run *run, hn_status ended, const char *reason,
                                   double t) {
    const hn_incident *list, *cause = NULL;
    if (ended == HN_OK || ended == HN_ERR_STOPPED) {
        return NULL;
    }
    const int n = hn_run_incidents(run, &list);
    for (int i = 0; i < n; i++) {
        if (strcmp(list[i].message, reason) == 0) {
            return &list[i];
        }
        if (list[i].t >= t - AT_END * fabs(t)) {
            cause = &list[i];
        }
    }
    return cause;
}

hn_ending hn_ending_named(const char *code) {
    hn_ending e = {.value = (double)NAN, .limit = (double)NAN};
    snprintf(e.code, sizeof e.code, "%s", code);
    return e;
}

hn_ending hn_ending_of(const hn_run *run, hn_status ended, const char *reason, double t) {
    if (ended == HN_OK) {
        return hn_ending_named("");
    }
    const hn_incident *cause = hn_ending_cause(run, ended, reason, t);
    if (!cause) {
        return hn_ending_named(hn_status_name(ended));
    }
    hn_ending e = hn_ending_named(hn_incident_spelling(cause->code));
    snprintf(e.quantity, sizeof e.quantity, "%s", cause->quantity ? cause->quantity : "");
    e.value = cause->value;
    e.limit = cause->limit;
    memcpy(e.remedy, cause->remedy, sizeof e.remedy);
    return e;
}
