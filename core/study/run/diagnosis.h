// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_DIAGNOSIS_H
#define HN_STUDY_DIAGNOSIS_H
// The diagnosis of a run that went wrong. The cause comes from the spectrum of the equations at a
// state before the event; the remedies are tried in short runs from that state, or from the start.

#include "study/run/run.h"

/// Names the cause of a failure where it is a step above the stability limit, and tries the
/// remedies of the incidents that make a result wrong: those that remove the incident are kept,
/// with what they gave; where none does the message says so. Reports change their revision. Done
/// once per report; bounded by a number of steps, so that the same run gives the same words.
/// Allocates. A failure on the way (no memory, no spectrum) leaves the reports as they are.
void hn_run_diagnose(hn_run *run);

#endif
