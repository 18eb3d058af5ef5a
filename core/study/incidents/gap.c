// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/gap.h"

#include "base/units.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <stdio.h>

static void check(hn_watch *w) {
    const double gap = w->measure.gap, limit = w->warn_gap * w->length;
    if (w->at_start || !(gap > limit)) {
        hn_incident_over(&w->log, HN_INCIDENT_GAP_OPEN);
        return;
    }
    if (!hn_incident_begins(&w->log, HN_INCIDENT_GAP_OPEN)) { // before its text is made
        return;
    }
    const int digits = hn_digits_apart(gap, limit, 3);
    hn_incident_put(w, &hn_incident_gap_open, "gap", gap, limit,
                    "the loop has opened: the constraint violation of %.*g m exceeds the limit "
                    "of %.*g m",
                    digits, gap, digits, limit);
}

const hn_incident_kind hn_incident_gap_open = {
    .code = HN_INCIDENT_GAP_OPEN,
    .each_step = true,
    .is_wrong = true,
    .spelling = "gap-open",
    .name = "the loop has opened",
    .rule = "This method imposes the constraint on accelerations only. Nothing corrects the errors "
            "of the two integrations that follow, and the gap grows with the square of time.",
    .check = check,
    .remedies = {{hn_remedy_close, 0}, {hn_remedy_finer, 0.5}, {hn_remedy_feedback, 0.4}},
};

hn_status hn_gap_judge(const hn_watch *w, char why[256]) {
    const double gap = w->measure.gap;
    if (!(gap > HN_RUN_LOST_GAP * w->length)) {
        return HN_OK;
    }
    snprintf(why, 256,
             "at t = %.6g s the loops are open by %.3g m, more than half the mechanism's length of "
             "%.3g m, so the motion is no longer this mechanism's",
             w->run->now.t, gap, w->length);
    return HN_ERR_DIVERGED;
}
