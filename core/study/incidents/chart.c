// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/chart.h"

#include "study/incidents/report.h"

void hn_chart_check(hn_watch *w, long long changes) {
    if (changes == 0) {
        return;
    }
    hn_incident_over(&w->log, HN_INCIDENT_CHART_CHANGE);
    // without the missing term the result depends on them
    const bool wrong = w->run->spec.formulation->traits & HN_TRAIT_COUNTER_EXAMPLE;
    hn_incident_report(w, &hn_incident_chart_change, "chart changes", (double)changes, 0,
                       "the method chose other independent coordinates; %s",
                       wrong ? "its motion, wrong by the missing term, depends on them"
                             : "that alone changes nothing of the motion");
}

const hn_incident_kind hn_incident_chart_change = {
    .code = HN_INCIDENT_CHART_CHANGE,
    .spelling = "chart-change",
    .name = "changed its independent coordinates",
    .rule = "A set of independent coordinates is valid for a part of the motion. At a dead "
            "point of one of them, where it turns back, another coordinate must take its place.",
};
