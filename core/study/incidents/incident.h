// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INCIDENT_H
#define HN_STUDY_INCIDENT_H
// Incidents: what can happen to a run and is worth a report. Each kind is one row of a table: code,
// spelling in JSON, name for people, the rule behind it, the check that finds it and the remedies
// that are offered. A new kind is a code here, a row in the file of its family and a line in
// kinds.c.

#include <stdbool.h>

/// Codes, in the order in which a state is checked.
typedef enum hn_incident_code {
    HN_INCIDENT_GAP_OPEN,
    HN_INCIDENT_ENERGY_DRIFT,
    HN_INCIDENT_ENERGY_JUMP,
    HN_INCIDENT_BRANCH_FLIP,
    HN_INCIDENT_RANK_AHEAD,
    HN_INCIDENT_MULTIPLIERS,
    HN_INCIDENT_ILL_CONDITIONED,
    HN_INCIDENT_SOLVER,
    HN_INCIDENT_RANK_LOSS,
    HN_INCIDENT_NEAR_SINGULAR,
    HN_INCIDENT_JOINT_LIMIT,
    HN_INCIDENT_STIFF,
    HN_INCIDENT_RESTARTS,
    HN_INCIDENT_STEP_LIMIT,
    HN_INCIDENT_STEP_LONG,
    HN_INCIDENT_CHART_CHANGE,
    HN_INCIDENT_CHART_LOST,
    HN_INCIDENT_PROJECTION_FAILED,
    HN_INCIDENT_NEWTON_FAILED,
    HN_INCIDENT_STEP_UNDERFLOW,
    HN_INCIDENT_DIVERGED,
    HN_INCIDENT_MASS,
    HN_INCIDENT_PROGRAM,
    HN_INCIDENT_STOPPED,
    HN_INCIDENT_COUNT
} hn_incident_code;

/// A remedy: a spelling of a method, or "h=0.005" for the same method with another step. Also the
/// sentence on its trial. "" is none.
typedef char hn_remedy[128];
enum { HN_REMEDIES = 3 };

/// One report.
typedef struct hn_incident {
    hn_incident_code code;
    double t;
    const char *quantity; ///< "gap", "pivot ratio": static text
    double value, limit;
    int times; ///< how often its kind has come so far in this run, those that are not listed too
    char message[400];             ///< what happened in this run, with numbers and units
    hn_remedy remedy[HN_REMEDIES]; ///< what to try, best first; "" ends the list
    /// "tried ...": what each of them gave in a trial; "not tried: ...": why there was none; "":
    /// not yet.
    hn_remedy tried[HN_REMEDIES];
    /// Rises each time a report is written or completed; a reader that keeps the newest one it saw
    /// knows what is new.
    unsigned revision;
} hn_incident;

enum { HN_RUN_MAX_INCIDENTS = 64 };

typedef struct hn_watch hn_watch;

/// Writes one remedy; write() returns false where it does not apply to the run. `factor` is the
/// row's.
typedef struct hn_remedy_rule {
    bool (*write)(const hn_watch *w, double factor, hn_remedy out);
    double factor;
} hn_remedy_rule;

/// One row of the table.
typedef struct hn_incident_kind {
    hn_incident_code code;
    const char *spelling; ///< as in JSON: "gap-open"
    const char *name;     ///< for people: "the loop has opened"
    const char *rule;     ///< the mechanics or numerics behind it, in one or two sentences
    /// Checks the state that the run has reached, and reports. NULL: reported at another moment (a
    /// chart that changes, the end of a run).
    void (*check)(hn_watch *w);
    bool each_step; ///< checked after every step, not only where a full check is due
    /// Says whether it can come in this run at all. NULL: in every run.
    bool (*is_possible)(const hn_watch *w);
    hn_remedy_rule remedies[4]; ///< what is offered, best first
    bool is_wrong; ///< from this incident on, the motion of the run is wrong; or the run ends
} hn_incident_kind;

#endif
