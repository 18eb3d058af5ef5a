// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/kinds.h"

#include "study/incidents/ahead.h"
#include "study/incidents/branch.h"
#include "study/incidents/chart.h"
#include "study/incidents/conditioning.h"
#include "study/incidents/energy.h"
#include "study/incidents/failure.h"
#include "study/incidents/gap.h"
#include "study/incidents/limits.h"
#include "study/incidents/rank.h"
#include "study/incidents/stiffness.h"

static const hn_incident_kind *const kinds[HN_INCIDENT_COUNT] = {
    [HN_INCIDENT_GAP_OPEN] = &hn_incident_gap_open,
    [HN_INCIDENT_ENERGY_DRIFT] = &hn_incident_energy_drift,
    [HN_INCIDENT_ENERGY_JUMP] = &hn_incident_energy_jump,
    [HN_INCIDENT_BRANCH_FLIP] = &hn_incident_branch_flip,
    [HN_INCIDENT_RANK_AHEAD] = &hn_incident_rank_ahead,
    [HN_INCIDENT_MULTIPLIERS] = &hn_incident_multipliers,
    [HN_INCIDENT_ILL_CONDITIONED] = &hn_incident_ill_conditioned,
    [HN_INCIDENT_SOLVER] = &hn_incident_solver,
    [HN_INCIDENT_RANK_LOSS] = &hn_incident_rank_loss,
    [HN_INCIDENT_NEAR_SINGULAR] = &hn_incident_near_singular,
    [HN_INCIDENT_JOINT_LIMIT] = &hn_incident_joint_limit,
    [HN_INCIDENT_STIFF] = &hn_incident_stiff,
    [HN_INCIDENT_RESTARTS] = &hn_incident_restarts,
    [HN_INCIDENT_STEP_LIMIT] = &hn_incident_step_limit,
    [HN_INCIDENT_STEP_LONG] = &hn_incident_step_long,
    [HN_INCIDENT_CHART_CHANGE] = &hn_incident_chart_change,
    [HN_INCIDENT_CHART_LOST] = &hn_incident_chart_lost,
    [HN_INCIDENT_PROJECTION_FAILED] = &hn_incident_projection_failed,
    [HN_INCIDENT_NEWTON_FAILED] = &hn_incident_newton_failed,
    [HN_INCIDENT_STEP_UNDERFLOW] = &hn_incident_step_underflow,
    [HN_INCIDENT_DIVERGED] = &hn_incident_diverged,
    [HN_INCIDENT_MASS] = &hn_incident_mass,
    [HN_INCIDENT_PROGRAM] = &hn_incident_program,
    [HN_INCIDENT_STOPPED] = &hn_incident_stopped,
};

const hn_incident_kind *const *hn_incident_kinds(void) {
    return kinds;
}

const char *hn_incident_spelling(hn_incident_code code) {
    return code < HN_INCIDENT_COUNT ? kinds[code]->spelling : "?";
}

void hn_incident_kinds_json(hn_strbuf *b) {
    hn_json_array(b);
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "code", kinds[i]->spelling);
        hn_json_put_string(b, "name", kinds[i]->name);
        hn_json_put_string(b, "rule", kinds[i]->rule);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}
