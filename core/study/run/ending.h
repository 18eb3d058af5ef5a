// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ENDING_H
#define HN_STUDY_ENDING_H
// The early end of a run, as data that outlives the run: the code, the figures and the remedies of
// the incident that ended it. Its sentence and its time are kept beside it.

#include "study/run/run.h"

typedef struct hn_ending {
    char code[32];     ///< of the incident, or the name of the status; "": it did not end early
    char quantity[32]; ///< what went beyond its limit; "": none
    double value, limit;
    hn_remedy remedy[HN_REMEDIES]; ///< best first; "" ends the list
} hn_ending;

/// Returns the incident that ended a run: the one whose message is the reason, otherwise the last
/// one reported at the time reached. NULL where nothing ended it, where a limit of time or steps
/// did, and where no incident was reported.
const hn_incident *hn_ending_cause(const hn_run *run, hn_status ended, const char *reason,
                                   double t);
/// Reads the ending of a run. `ended`: its status; HN_OK gives an empty one.
hn_ending hn_ending_of(const hn_run *run, hn_status ended, const char *reason, double t);
/// The ending of something that has no run: a code, and no figures.
hn_ending hn_ending_named(const char *code);

#endif
