// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/incident_json.h"

void hn_incident_json(hn_strbuf *b, int method, const hn_incident *incident) {
    hn_json_object(b);
    if (method >= 0) {
        hn_json_put_int(b, "method", method);
    }

    // what happened, when, by which measure
    hn_json_put_string(b, "code", hn_incident_spelling(incident->code));
    hn_json_put_number(b, "t", incident->t);
    hn_json_put_string(b, "quantity", incident->quantity);
    hn_json_put_number(b, "value", incident->value);
    hn_json_put_number(b, "limit", incident->limit);
    hn_json_put_int(b, "times", incident->times);
    hn_json_put_string(b, "message", incident->message);

    // remedies, and the result of the trial of each
    hn_json_key(b, "remedies");
    hn_json_array(b);
    for (int i = 0; i < HN_REMEDIES && incident->remedy[i][0]; i++) {
        hn_json_string(b, incident->remedy[i]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "tried");
    hn_json_array(b);
    for (int i = 0; i < HN_REMEDIES && incident->remedy[i][0]; i++) {
        hn_json_string(b, incident->tried[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

void hn_incidents_json(hn_strbuf *b, int method, const hn_run *run) {
    const hn_incident *list;
    const int n = hn_run_incidents(run, &list);
    for (int i = 0; i < n; i++) {
        hn_incident_json(b, method, &list[i]);
    }
}
