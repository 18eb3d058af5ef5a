// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/rank.h"

#include "study/incidents/pose.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

/// Reports redundant constraints at the start. They do no harm, so the report offers no remedy.
static void report_redundant(hn_watch *w) {
    const int nc = w->run->info.nc, rank = w->accel_info.rank;
    w->singular.at_start =
        hn_singularity_is_local(w->singular.monitor, w->run->now.t, w->run->now.q);
    if (w->singular.at_start) {
        hn_incident_report(w, &hn_incident_rank_loss, "rank of J", rank, nc,
                           "the start is a singular configuration: %d of %d constraint equations "
                           "depend on the others there, and are independent in configurations "
                           "next to it; the motion may branch, and the run follows one branch",
                           nc - rank, nc);
        return;
    }
    hn_incident *i = hn_incident_report(w, &hn_incident_rank_loss, "rank of J", rank, nc,
                                        "%d of %d constraint equations depend on the others; the "
                                        "motion is unique, single multipliers are not",
                                        nc - rank, nc);
    if (i) {
        i->remedy[0][0] = '\0';
    }
}

static void check_rank(hn_watch *w) {
    const int nc = w->run->info.nc, rank = w->accel_info.rank;
    if (nc == 0 || w->accel_status != HN_OK) {
        return;
    }

    // at the start: redundant loop equations are a property of the scene
    if (w->at_start) {
        if (rank < nc) {
            report_redundant(w);
        }
        return;
    }

    // later: only a rank below that of the start is an incident
    if (rank >= w->start_rank) {
        hn_incident_over(&w->log, HN_INCIDENT_RANK_LOSS);
        return;
    }

    hn_incident *i = hn_incident_report(w, &hn_incident_rank_loss, "rank of J", rank, nc,
                                        "%d of %d constraint equations depend on the others in "
                                        "this configuration, where branches may cross",
                                        nc - rank, nc);
    if (i) {
        hn_pose_describe(w, i, w->run->now.t, w->run->now.q, w->singular.info.sigma_min);
    }
}

/// Shares of the largest sigma_min so far, and of sigma_max.
static const double FALLEN = 0.15, TINY = 1e-3;

/// Links of very different masses give J M^-1 J' pivots of very different sizes everywhere: near a
/// singular configuration sigma_min is small against what it was elsewhere, or next to nothing.
static bool has_fallen(const hn_watch *w) {
    const hn_singularity_info *info = &w->singular.info;
    return info->sigma_min < FALLEN * w->singular.largest || info->ratio < TINY;
}

static void check_near(hn_watch *w) {
    const hn_stepping *s = w->run;
    if (s->info.nc == 0) {
        return;
    }

    // J M^-1 J' has singular values squared. A pivot that is lost where J is not says only that the
    // order of elimination does not suit the configuration, or that open loops part dependent rows
    const double row = w->shortest_row, ratio = w->singular.info.ratio;
    const bool dependent = w->start_rank < s->info.nc;
    const double pivot = w->accel_status == HN_OK && (w->accel_info.fallback || dependent)
                             ? ratio * ratio
                             : row * row * w->accel_info.pivot_ratio;
    // accelerations that fail for another reason, as numbers that overflow, say nothing about rows
    const bool failed =
        w->accel_status == HN_ERR_SINGULAR || w->accel_status == HN_ERR_INCONSISTENT;
    const bool near = pivot < HN_RUN_WARN_PIVOT && (failed || has_fallen(w));
    if (!near || w->accel_info.rank < s->info.nc) {
        hn_incident_over(&w->log, HN_INCIDENT_NEAR_SINGULAR);
        return;
    }
    hn_incident *i = hn_incident_report(
        w, &hn_incident_near_singular, "pivot ratio", pivot, HN_RUN_WARN_PIVOT,
        "the constraint equations are almost dependent: pivot ratio %.2g, limit %.0e (1 is far "
        "from a singular configuration, 0 is one)",
        pivot, HN_RUN_WARN_PIVOT);
    if (i) {
        hn_pose_describe(w, i, s->now.t, s->now.q, w->singular.info.sigma_min);
    }
}

const hn_incident_kind hn_incident_rank_loss = {
    .code = HN_INCIDENT_RANK_LOSS,
    .spelling = "rank-loss",
    .name = "constraint equations are dependent",
    .rule = "Where rows of J depend on each other, only the sum of their forces is determined; the "
            "least-norm multipliers are shown. If the rows depend on each other in all "
            "configurations, the motion is still unique. If only in this one, it may branch.",
    .check = check_rank,
    .remedies = {{hn_remedy_plain, 0}, {hn_remedy_robust, 0}, {hn_remedy_finer, 0.5}},
};

const hn_incident_kind hn_incident_near_singular = {
    .code = HN_INCIDENT_NEAR_SINGULAR,
    .spelling = "near-singular",
    .name = "close to a singular configuration",
    .rule = "Near a configuration where constraint equations become dependent (a change point of a "
            "linkage) the multipliers grow without bound, and small errors grow with them.",
    .check = check_near,
    .remedies = {{hn_remedy_robust, 0}, {hn_remedy_finer, 0.25}},
};
