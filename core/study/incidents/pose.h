// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_POSE_INCIDENTS
#define HN_STUDY_POSE_INCIDENTS
// Describes a singular configuration in words: dependent constraints, bodies, degrees of freedom,
// branches.

#include "study/incidents/watch.h"

#include <stdbool.h>

/// Appends to report i what is there: constraints, bodies, degrees of freedom, branches. The report
/// will be completed with the way on which the run leaves.
void hn_pose_describe(hn_watch *w, hn_incident *i, double t, const double *q, double sigma_min);
/// Returns whether the run ended where it began, in a singular configuration. There J leaves more
/// coordinates than the motion has, so that no choice among them is independent: it is written as
/// the reason in place of what the method met.
bool hn_pose_blames_start(const hn_watch *w, char why[256]);
/// Appends to the reason of a failure that the configuration is singular, where it is.
void hn_pose_explain(const hn_watch *w, char why[256]);

#endif
