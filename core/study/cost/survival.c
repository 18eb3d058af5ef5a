// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/survival.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const double LEAST_STEP = 2.2, MOST_STEP = 20; // times the usual one

const char *hn_survival_name(hn_survival_end end) {
    static const char *const names[HN_SURVIVAL_ENDS] = {
        [HN_SURVIVAL_SURVIVED] = "survived", [HN_SURVIVAL_OFF] = "off",
        [HN_SURVIVAL_STOPPED] = "stopped",   [HN_SURVIVAL_TOLD] = "told",
        [HN_SURVIVAL_SILENT] = "silent",
    };
    HN_ASSERT((int)end >= 0 && end < HN_SURVIVAL_ENDS);
    return names[end];
}

double hn_survival_step(double usual, int k, int n) {
    return usual * (LEAST_STEP + (MOST_STEP - LEAST_STEP) * k / (n - 1));
}

/// Returns whether a run that is wrong has reported it.
static hn_survival_end told_or_silent(const hn_run *run) {
    const hn_incident *incident = NULL;
    const int n = hn_run_incidents(run, &incident);
    for (int i = 0; i < n; i++) {
        switch (incident[i].code) {
        case HN_INCIDENT_BRANCH_FLIP:
        case HN_INCIDENT_GAP_OPEN:
        case HN_INCIDENT_ENERGY_JUMP:
        case HN_INCIDENT_STEP_LIMIT:
            return HN_SURVIVAL_TOLD;
        default:
            break; // a configuration near a singular one does not make a run wrong
        }
    }
    return HN_SURVIVAL_SILENT;
}

static void set_stopped(const hn_run *run, hn_survival *out) {
    const hn_run_summary s = hn_run_get_summary(run);
    out->end = HN_SURVIVAL_STOPPED;
    out->t = s.t;
    snprintf(out->reason, sizeof out->reason, "%.255s", s.reason);
}

static bool is_cut(const hn_walk_limits *l, double started) {
    return l && ((l->stop && l->stop(l->user)) ||
                 (l->seconds > 0 && hn_clock_thread() - started > l->seconds));
}

int hn_survival_try(hn_run *run, const hn_survival_judge *j, hn_survival *out) {
    const double started = hn_clock_thread();
    double left = j->T, folded_at = j->T;
    int folded = 0;
    *out = (hn_survival){.end = HN_SURVIVAL_SURVIVED, .t = j->T};

    // advance to each check time; stop where the limits or the run end it
    for (int k = 1; k <= j->n; k++) {
        const double t = j->T * (k - j->before) / j->n;
        hn_sample sample = {0};
        if (is_cut(j->limits, started)) {
            return 0;
        }
        if (hn_run_advance(run, t) != HN_OK ||
            hn_run_sample(run, j->at_steps ? hn_run_time(run) : t, &sample) != HN_OK) {
            set_stopped(run, out);
            return 1;
        }

        // compare with the exact motion: distance, and loops that have folded over
        const hn_survival_seen seen = j->look(j->user, k, &sample);
        if (!(out->worst > j->limit) && !(seen.distance <= j->limit)) {
            left = t;
        }
        if (!folded && seen.folded) {
            folded_at = t;
        }
        folded |= seen.folded;
        out->worst = isnan(seen.distance) ? HUGE_VAL : fmax(out->worst, seen.distance);
    }

    // a run that left the motion: whether it reported this
    if (!(out->worst <= j->limit)) {
        const hn_survival_end told = told_or_silent(run);
        out->end =
            folded || (j->ask_incidents && told == HN_SURVIVAL_TOLD) ? told : HN_SURVIVAL_OFF;
        out->t = folded ? folded_at : left;
    }
    return 1;
}

// ---- by the reference solution ----

typedef struct beside {
    const hn_ref *ref;
    hn_errors *errors;
} beside;

static hn_survival_seen look(void *user, int k, const hn_sample *s) {
    const beside *b = user;
    return (hn_survival_seen){hn_errors_between(b->errors, s->q, hn_ref_at(b->ref, k).q), 0};
}

hn_status hn_survival_by_reference(const hn_system *sys, const hn_ref *ref, hn_arena *arena,
                                   hn_survival_judge *out) {
    beside *b = hn_arena_get(arena, sizeof *b);
    *out = (hn_survival_judge){.look = look,
                               .user = b,
                               .T = ref->T,
                               .n = ref->n,
                               .limit = HN_SURVIVAL_DISTANCE,
                               .ask_incidents = 1};
    if (!b) {
        return HN_ERR_MEMORY;
    }
    *b = (beside){.ref = ref};
    return hn_errors_create(sys, arena, &b->errors);
}

void hn_survival_unjudge(hn_survival_judge *judge) {
    beside *b = judge->user;
    if (b) {
        hn_errors_free(b->errors);
        judge->user = NULL;
    }
}
