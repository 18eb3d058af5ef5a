// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/pose.h"

#include <stdio.h>
#include <string.h>

/// Share of the largest sigma_min: the reason of a failure names the configuration from here on.
static const double SINGULAR = 0.02;

static const char *body_name(const hn_watch *w, int body) {
    return body >= 0 ? hn_system_scene(w->run->sys)->bodies[body].name : "ground";
}

static void append_rows(hn_watch *w, hn_incident *i, const hn_singularity_pose *pose) {
    const hn_system *sys = w->run->sys;
    for (int k = 0; k < pose->n_rows; k++) {
        hn_incident_append(&w->log, i, "%s%s", k ? ", " : "; rows ",
                           hn_system_row_name(sys, pose->rows[k]));
    }
    if (pose->n_rows == 0) {
        return;
    }

    // the joint whose loop they close
    const int loop = hn_system_row_loop(sys, pose->rows[0]);
    const int joint = loop >= 0 ? hn_system_loop_joint(sys, loop) : -1;
    if (joint >= 0) {
        const hn_joint *j = &hn_system_scene(sys)->joints[joint];
        hn_incident_append(&w->log, i, " (between %s and %s)", body_name(w, j->parent),
                           body_name(w, j->child));
    }
}

void hn_pose_describe(hn_watch *w, hn_incident *i, double t, const double *q, double sigma_min) {
    static const char *const branches[] = {
        [HN_BRANCHES_CROSS] = "; change point: two branches of motion cross",
        [HN_BRANCHES_NONE] = "; no motion leads through it: the mechanism locks",
        [HN_BRANCHES_CUSP] = "; two branches touch",
        [HN_BRANCHES_UNKNOWN] = "",
    };
    hn_singularity_pose pose;
    hn_singularity_pose_at(w->singular.monitor, t, q, sigma_min, &pose);
    append_rows(w, i, &pose);
    if (pose.mobility > pose.mobility_before) {
        hn_incident_append(&w->log, i, "; %d degree%s of freedom there instead of %d",
                           pose.mobility, pose.mobility == 1 ? "" : "s", pose.mobility_before);
    }
    hn_incident_append(&w->log, i, "%s", branches[pose.branches]);
    if (w->measure.gap > w->warn_gap * w->length) {
        hn_incident_append(
            &w->log, i,
            "; the loop is open here, so this describes the open chain and not the mechanism");
    }
    w->singular.passing = 1 + (int)(i - w->log.list);
}

bool hn_pose_blames_start(const hn_watch *w, char why[256]) {
    if (!w->singular.at_start || w->run->steps > 0) {
        return false;
    }
    const int nc = w->run->info.nc;
    snprintf(
        why, 256,
        "the start is a singular configuration: %d of %d constraint equations depend on the "
        "others there, and no choice of coordinates is independent; start beside it, or take a "
        "method that keeps all coordinates",
        nc - w->start_rank, nc);
    return true;
}

void hn_pose_explain(const hn_watch *w, char why[256]) {
    const hn_singular_record *s = &w->singular;
    const hn_state_at *now = &w->run->now;
    const size_t used = strlen(why);
    if (now->t == w->run->t0 && hn_singularity_is_local(s->monitor, now->t, now->q)) {
        const int more =
            snprintf(why + used, 256 - used,
                     "; the start is a singular configuration, and its velocities lead "
                     "along none of the motions through it: start beside it");
        why[more < 256 - (int)used ? (int)used + more : (int)used] = '\0';
        return;
    }
    if (w->run->info.nc > 0 && s->info.sigma_min < SINGULAR * s->largest) {
        const int more = snprintf(
            why + used, 256 - used,
            "; the constraints are almost dependent there: the smallest singular value of J is "
            "%.2g, and was %.2g before",
            s->info.sigma_min, s->largest);
        why[more < 256 - (int)used ? (int)used + more : (int)used] = '\0'; // no half a number
    }
}
