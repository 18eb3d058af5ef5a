// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/incident.h"

static const hn_incident_kind kinds[HN_INCIDENT_COUNT] = {
    [HN_INCIDENT_NEAR_SINGULAR] =
        {"near-singular", "close to a singular configuration",
         "Near a configuration where constraint equations become dependent the multipliers grow "
         "without bound, and small errors grow with them."},
    [HN_INCIDENT_RANK_LOSS] =
        {"rank-loss", "constraint equations are dependent",
         "Where rows of J depend on each other only the sum of their forces is determined. The "
         "motion is unique; the least-norm multipliers are shown."},
    [HN_INCIDENT_BRANCH_FLIP] =
        {"branch-flip", "jumped to another branch",
         "The same lengths close in more than one way. A step that is too long can land on "
         "another of these branches."},
    [HN_INCIDENT_GAP_OPEN] =
        {"gap-open", "the loop has opened",
         "A constraint that is imposed only on accelerations leaves the errors of two "
         "integrations uncorrected: the gap grows with the square of time."},
    [HN_INCIDENT_ENERGY_JUMP] =
        {"energy-jump", "the energy jumped",
         "A mechanism without loads that do work keeps its energy. A jump within one step means "
         "that the step misses the motion, whether or not the loops are closed."},
    [HN_INCIDENT_ENERGY_DRIFT] =
        {"energy-drift", "the energy drifted",
         "A mechanism without loads that do work keeps its energy. A slow gain or loss is the "
         "error of the method, and the motion becomes faster or slower with it."},
    [HN_INCIDENT_CHART_CHANGE] =
        {"chart-change", "changed its independent coordinates",
         "A set of independent coordinates serves one part of the motion. At a turning point of "
         "one of them another coordinate must take its place."},
    [HN_INCIDENT_CHART_LOST] =
        {"chart-lost", "the independent coordinates no longer determine the configuration",
         "A set of independent coordinates serves one part of the motion. At a turning point of "
         "one of them the dependent coordinates cannot be solved for."},
    [HN_INCIDENT_STEP_LIMIT] =
        {"step-limit", "the step is at its stability limit",
         "The step times the fastest rate must stay within the stability region of the "
         "integrator."},
    [HN_INCIDENT_PROJECTION_FAILED] =
        {"projection-failed", "the projection did not close the loop",
         "Projection searches for the nearest closed configuration. From too far away, or where "
         "none exists, the iteration does not converge."},
    [HN_INCIDENT_NEWTON_FAILED] =
        {"newton-failed", "Newton's method did not converge",
         "An implicit step is found by iteration. The iteration does not converge from a step "
         "that is too long, or near a configuration where J loses rank."},
    [HN_INCIDENT_STIFF] =
        {"stiff", "a stiff part limits the step",
         "Some part of the motion decays much faster than the mechanism moves. An explicit "
         "method must take steps as short as that decay; an implicit method need not."},
    [HN_INCIDENT_DIVERGED] =
        {"diverged", "diverged",
         "An explicit step beyond its stability limit multiplies the error at every step."},
    [HN_INCIDENT_STEP_UNDERFLOW] =
        {"step-underflow", "the step became too small",
         "The tolerance cannot be met with any step that the arithmetic can resolve."},
    [HN_INCIDENT_BUDGET] =
        {"budget", "the time limit was reached",
         "Each method may use a limited computing time, so that the other methods do not wait "
         "for it."},
    [HN_INCIDENT_RANK_AHEAD] =
        {"rank-ahead", "a singular configuration lies ahead",
         "The smallest singular value of J falls towards zero. Where it vanishes constraint "
         "equations become dependent, and the motion may branch or lock."},
    [HN_INCIDENT_ILL_CONDITIONED] =
        {"ill-conditioned", "few digits of the multipliers are left",
         "Accelerations and multipliers lose as many of their sixteen digits as the condition "
         "number of K has. Near a singular configuration it has no bound."},
    [HN_INCIDENT_MULTIPLIERS] =
        {"multipliers-grow", "the multipliers grow",
         "Where the rows of J become dependent ever larger multipliers balance the same loads. "
         "They cancel each other; the joints do not carry forces of that size."},
    [HN_INCIDENT_SOLVER] =
        {"solver-fallback", "the dense solver took over",
         "The sparse solver keeps one order of pivots. Where one of them vanishes a dense "
         "least-norm solver gives the answer: slower, and as accurate."},
    [HN_INCIDENT_RESTARTS] =
        {"order-lost", "restarts at order 1 after every step",
         "A multistep method gets its order from previous steps. A correction of the state after "
         "each step makes them useless: the order stays 1 and the steps stay short."},
    [HN_INCIDENT_MASS] =
        {"mass-singular", "the mass matrix has no inverse",
         "A link without mass makes M singular. The constraints may still determine the motion, "
         "but only for methods that never form the inverse of M."},
    [HN_INCIDENT_JOINT_LIMIT] =
        {"joint-limit", "a coordinate passed its limit",
         "A limit in a scene is watched, not enforced: no force holds the coordinate there."},
};

const hn_incident_kind *hn_incident_kinds(void) {
    return kinds;
}

const char *hn_incident_spelling(hn_incident_code code) {
    return code < HN_INCIDENT_COUNT ? kinds[code].spelling : "?";
}

void hn_incident_kinds_json(hn_strbuf *b) {
    hn_json_array(b);
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "code", kinds[i].spelling);
        hn_json_put_string(b, "name", kinds[i].name);
        hn_json_put_string(b, "rule", kinds[i].rule);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}
