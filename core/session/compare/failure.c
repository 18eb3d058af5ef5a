// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/failure.h"

#include <math.h>
#include <string.h>

/// An incident counts as the end of the run when it was reported no earlier than this share of t.
static const double AT_END = 1e-9;

const hn_incident *hn_failure_cause(const hn_run *run, hn_status ended, const char *reason,
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

void hn_failure_put_json(hn_strbuf *b, const hn_run *run, hn_status ended, const char *reason,
                         double t) {
    hn_json_key(b, "failure");
    if (ended == HN_OK) {
        hn_json_null(b);
        return;
    }
    const hn_incident *cause = hn_failure_cause(run, ended, reason, t);
    hn_json_object(b);
    hn_json_put_string(b, "code",
                       cause ? hn_incident_spelling(cause->code) : hn_status_name(ended));
    hn_json_put_string(b, "quantity", cause ? cause->quantity : NULL);
    hn_json_put_number(b, "value", cause ? cause->value : (double)NAN);
    hn_json_put_number(b, "limit", cause ? cause->limit : (double)NAN);
    hn_json_put_number(b, "t", t);
    hn_json_put_string(b, "message", reason);

    // what the engine would try
    hn_json_key(b, "remedies");
    hn_json_array(b);
    for (int i = 0; cause && i < 3 && cause->remedy[i][0]; i++) {
        hn_json_string(b, cause->remedy[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
