// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/inside.h"

#include "base/units.h"
#include "study/incidents/branch.h"
#include "study/incidents/energy.h"
#include "study/incidents/gap.h"
#include "study/incidents/motion.h"
#include "study/incidents/report.h"

#include <math.h>

/// The report happened at the sample, not at the end of the last step.
static void set_time(hn_incident *i, double t) {
    if (i) {
        i->t = t;
    }
}

static void check_gap(hn_watch *w, const hn_state_at *at, double gap) {
    const double limit = w->warn_gap * w->length;
    if (gap > limit) {
        const int digits = hn_digits_apart(gap, limit, 3);
        set_time(hn_incident_report(w, &hn_incident_gap_open, "gap", gap, limit,
                                    "the loop has opened inside a step: the constraint violation "
                                    "of %.*g m exceeds the limit of %.*g m",
                                    digits, gap, digits, limit),
                 at->t);
    }
}

/// `since_start`: change of energy since the start, less the work done.
static void check_energy(hn_watch *w, const hn_state_at *at, const hn_measure *m,
                         double since_start) {
    const hn_energy_record *e = &w->energy;
    const double change = e->start + since_start - e->last;
    const double range = fmax(e->v_max, m->potential) - fmin(e->v_min, m->potential);
    // against the energies of the steps: a state that is wrong may hold any amount itself
    const double limit = HN_RUN_WARN_ENERGY * (e->t_max + range);
    if (e->conservative && limit > 0 && fabs(change) > fmax(limit, e->noise) &&
        fabs(since_start) > limit) {
        const int digits = hn_digits_apart(fabs(change), limit, 3);
        set_time(
            hn_incident_report(w, &hn_incident_energy_jump, "energy change", change, limit,
                               "inside a step the energy differs by %.*g J from its value at the "
                               "start of the step, more than %.*g J, and no load does work",
                               digits, change, digits, limit),
            at->t);
    }
}

static void check_branch(hn_watch *w, const hn_state_at *at) {
    const hn_stepping *s = w->run;
    const hn_state_at *from = at->t < s->now.t ? &s->before : &s->now;
    hn_mode_watch_values(w->mode, at->t, at->q, w->modes);
    for (int k = 0; k < hn_mode_watch_count(w->mode); k++) {
        const double jump = fabs(w->modes[k] - w->last_modes[k]);
        if (w->modes[k] * w->last_modes[k] < 0 && jump > HN_RUN_WARN_MODE &&
            hn_motion_unexplained_between(w, from, at, 0) > HN_RUN_WARN_JUMP &&
            !hn_motion_is_followed(w, from, at)) {
            set_time(
                hn_incident_report(w, &hn_incident_branch_flip, "assembly mode", w->modes[k],
                                   HN_RUN_WARN_MODE,
                                   "the loop jumped to its other assembly mode inside a step (the "
                                   "number whose sign tells the modes apart went from %.2g to "
                                   "%.2g)",
                                   w->last_modes[k], w->modes[k]),
                at->t);
            return;
        }
    }
}

void hn_inside_check(hn_watch *w, const hn_state_at *at, const hn_measure *m,
                     double energy_change) {
    w->worst_gap = fmax(w->worst_gap, m->gap);
    w->worst_velocity_gap = fmax(w->worst_velocity_gap, m->velocity_gap);
    w->worst_energy_change = fmax(w->worst_energy_change, fabs(energy_change));
    check_gap(w, at, m->gap);
    check_energy(w, at, m, energy_change);
    check_branch(w, at);
}
