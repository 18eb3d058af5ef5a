// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/ahead.h"

#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <math.h>
#include <stdbool.h>

/// Share of the largest sigma_min: a configuration this close counts as the one that was announced.
static const double REACHED = 0.02;
/// And one that is reached, not only passed.
static const double LOST = 2e-3;

/// Returns whether the run has come to the configuration of a prediction: close to it at the end of
/// a step, or across it within one, which is reported.
static bool has_come_true(const hn_watch *w, const hn_incident *i) {
    const hn_singular_record *s = &w->singular;
    if (s->lowest < REACHED * s->largest) {
        return true;
    }
    for (int k = 0; k < w->log.n; k++) {
        const hn_incident *other = &w->log.list[k];
        const bool singular =
            other->code == HN_INCIDENT_NEAR_SINGULAR || other->code == HN_INCIDENT_RANK_LOSS;
        if (singular && other->t >= i->t) {
            return true;
        }
    }
    return false;
}

/// Closes the latest prediction where its time has passed; its text says so where the run did not
/// reach the configuration. That is judged some steps after its time; where the next prediction
/// comes before, by then in its favour.
static void conclude(hn_watch *w) {
    hn_singular_record *s = &w->singular;
    hn_incident *i = s->announced <= w->log.n ? &w->log.list[s->announced - 1] : NULL;
    const bool true_by_now = !i || has_come_true(w, i);
    const bool next = s->info.ahead < HUGE_VAL && w->run->now.t > s->due;
    if (!(w->run->now.t > s->due + 2 * w->run->h) && !(next && true_by_now)) {
        return;
    }
    s->announced = 0;
    hn_incident_over(&w->log, HN_INCIDENT_RANK_AHEAD);
    if (!true_by_now) {
        hn_incident_append(&w->log, i,
                           "; withdrawn at t = %.4g s: the run did not reach a singular "
                           "configuration, sigma_min stayed above %.2g",
                           w->run->now.t, s->lowest);
    }
}

static void check(hn_watch *w) {
    hn_singular_record *s = &w->singular;
    if (w->run->info.nc == 0) {
        return;
    }
    s->lowest = fmin(s->lowest, s->info.sigma_min);

    // what was announced is judged when a step across it has been seen
    if (s->announced) {
        conclude(w);
    }
    if (!(s->info.ahead < HUGE_VAL)) {
        return;
    }
    const hn_incident *i = hn_incident_report(
        w, &hn_incident_rank_ahead, "time to go", s->info.ahead, 0,
        s->info.lowest < LOST * s->largest
            ? "a singular configuration (J loses rank) lies %.3g s ahead, at t = %.4g s, as a "
              "pilot run shows; now the smallest singular value of the scaled J, sigma_min, is "
              "%.2g, and the largest %.2g"
            : "an almost singular configuration (J almost loses rank) lies %.3g s ahead, at "
              "t = %.4g s, as a pilot run shows; now the smallest singular value of the scaled J, "
              "sigma_min, is %.2g, and the largest %.2g",
        s->info.ahead, w->run->now.t + s->info.ahead, s->info.sigma_min, s->info.sigma_max);
    if (i || !s->announced) { // without a place in the list it is counted, and over likewise
        s->announced = i ? 1 + (int)(i - w->log.list) : HN_RUN_MAX_INCIDENTS + 1;
        s->lowest = s->info.sigma_min;
        s->due = s->info.predicted;
    }
}

const hn_incident_kind hn_incident_rank_ahead = {
    .code = HN_INCIDENT_RANK_AHEAD,
    .spelling = "rank-ahead",
    .name = "a singular configuration lies ahead",
    .rule = "The smallest singular value of J falls towards zero on the way. Where it is zero, "
            "constraint equations are dependent, and the motion may branch (a change point) or "
            "lock.",
    .check = check,
    .remedies = {{hn_remedy_robust, 0}},
};
