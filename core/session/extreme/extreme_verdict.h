// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_VERDICT_H
#define HN_SESSION_EXTREME_EXTREME_VERDICT_H
// Verdicts: the outcome of a run as a word, and numbers compared with predictions.

#include "base/status.h"
#include "session/extreme/extreme_case.h"

/// The word of the table: "pass" and so on.
const char *hn_extreme_verdict_name(hn_extreme_verdict verdict);
/// Returns what a status is called in the files: "finished", "diverged", "refused", ...
const char *hn_extreme_outcome(hn_status status);
/// Returns all such words; "ended" stands for any way of not coming to the end.
const char *const *hn_extreme_outcomes(int *n);
/// Sets verdict and words of a trial whose numbers are all there.
void hn_extreme_conclude(hn_extreme_trial *trial);
#endif
