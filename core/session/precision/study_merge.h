// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_MERGE_H
#define HN_SESSION_PRECISION_STUDY_MERGE_H
// Parts of a study put together. What two parts both say must be the same in every bit, but for
// what a clock said: of that the record with more samples is taken, and of equals the one that
// comes first in the alphabet, so that neither order nor repetition matters.

#include "session/precision/study.h"

/// The study that these parts are of, as hn_study_run() would have left it: the same numbers (but a
/// clock's) however it was split, whatever the order, and as often as one is given. Overlapping
/// parts are allowed. Fails: HN_ERR_INPUT, told: a text that is no part, parts that contradict each
/// other (in which field), parts that are missing or unfinished (which). HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_study_merge(const hn_study_part_text *parts, int n, hn_study **out,
                                       hn_diags *diags);
#endif
