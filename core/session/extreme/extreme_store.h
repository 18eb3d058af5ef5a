// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_STORE_H
#define HN_SESSION_EXTREME_EXTREME_STORE_H
// The journal of an unfinished matrix: a line for each trial, with its numbers and outcomes, from
// which verdicts follow.

#include "session/extreme/extreme.h"
#include "session/extreme/extreme_internal.h"

/// Reads from the folder the trials that an earlier run of the same cases finished, and keeps new
/// ones there until all are done. Call before hn_extreme_run(). Fails as hn_journal_open(),
/// HN_ERR_IO and HN_ERR_MEMORY for a scene that cannot be read.
HN_MUST_CHECK hn_status hn_extreme_resume(hn_extreme *x, const char *folder, hn_diags *diags);
/// Puts trial k of case i into the journal.
void hn_extreme_keep(hn_extreme *x, int i, int k);
#endif
