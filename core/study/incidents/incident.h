// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INCIDENT_H
#define HN_STUDY_INCIDENT_H
// Incidents: the things that can happen to a run and are worth a report, as one table. A row holds the code, its spelling in
// JSON, a name for people and the rule behind it.

#include "base/strbuf.h"

/// Codes, in the order of the table.
typedef enum hn_incident_code {
    HN_INCIDENT_NEAR_SINGULAR,
    HN_INCIDENT_RANK_LOSS,
    HN_INCIDENT_BRANCH_FLIP,
    HN_INCIDENT_GAP_OPEN,
    HN_INCIDENT_ENERGY_JUMP,
    HN_INCIDENT_CHART_CHANGE,
    HN_INCIDENT_CHART_LOST,
    HN_INCIDENT_STEP_LIMIT,
    HN_INCIDENT_PROJECTION_FAILED,
    HN_INCIDENT_DIVERGED,
    HN_INCIDENT_STEP_UNDERFLOW,
    HN_INCIDENT_BUDGET,
    HN_INCIDENT_RANK_AHEAD,
    HN_INCIDENT_ILL_CONDITIONED,
    HN_INCIDENT_MULTIPLIERS,
    HN_INCIDENT_SOLVER,
    HN_INCIDENT_JOINT_LIMIT,
    HN_INCIDENT_NEWTON_FAILED,
    HN_INCIDENT_ENERGY_DRIFT,
    HN_INCIDENT_STIFF,
    HN_INCIDENT_MASS,
    HN_INCIDENT_RESTARTS,
    HN_INCIDENT_COUNT
} hn_incident_code;

/// One row of the table.
typedef struct hn_incident_kind {
    const char *spelling; ///< as in JSON: "gap-open"
    const char *name;     ///< for people: "the loop has opened"
    const char *rule;     ///< the mechanics or numerics behind it, in one or two sentences
} hn_incident_kind;

/// The table, HN_INCIDENT_COUNT rows indexed by code. Static.
const hn_incident_kind *hn_incident_kinds(void);
/// "gap-open"; "?" for a code that is none.
const char *hn_incident_spelling(hn_incident_code code);
/// Writes the table as an array: [{"code","name","rule"}].
void hn_incident_kinds_json(hn_strbuf *b);

/// One report.
typedef struct hn_incident {
    hn_incident_code code;
    double t;
    const char *quantity; ///< "gap", "pivot ratio": static text
    double value, limit;
    char message[400]; ///< what happened in this run, with numbers and units
    /// Up to three things to try: a spelling of a method, or "h=0.005"; "" ends the list.
    char remedy[3][96];
    /// Rises by one each time the report is written or completed; a reader that keeps the last one it saw knows what is new.
    unsigned revision;
} hn_incident;

enum { HN_RUN_MAX_INCIDENTS = 64 };

#endif
