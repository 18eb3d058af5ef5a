// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/ahead.h"

#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <math.h>

static void check(hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    if (w->run->info.nc == 0) {
        return;
    }
    if (!(s->info.ahead < HUGE_VAL)) {
        if (w->run->now.t > s->info.predicted) {
            hn_incident_over(&w->log, HN_INCIDENT_RANK_AHEAD);
        }
        return;
    }
    hn_incident_report(w, &hn_incident_rank_ahead, "time to go", s->info.ahead, 0,
                       "J loses rank in %.3g s, at t = %.4g s: a pilot run from here reaches a "
                       "singular configuration then; sigma_min is %.2g of %.2g now",
                       s->info.ahead, w->run->now.t + s->info.ahead, s->info.sigma_min,
                       s->info.sigma_max);
}

const hn_incident_kind hn_incident_rank_ahead = {
    .code = HN_INCIDENT_RANK_AHEAD,
    .spelling = "rank-ahead",
    .name = "a singular configuration lies ahead",
    .rule = "The smallest singular value of J falls towards zero. Where it vanishes constraint "
            "equations become dependent, and the motion may branch or lock.",
    .check = check,
    .remedies = {{hn_remedy_robust, 0}},
};
