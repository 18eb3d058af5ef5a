// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_MERGE_H
#define HN_SESSION_PRECISION_STUDY_MERGE_H
// Merges the parts of a study. Two parts that hold the same point must agree in every bit, except
// for CPU times. The one of two records with more CPU samples counts; the first of equals in
// alphabetical order. So neither order nor repetition of the parts matters.

#include "session/precision/study.h"

/// Returns the whole study, as hn_study_run() would have left it. The numbers, except for CPU
/// times, do not depend on how the study was split. Parts may overlap or be repeated.
/// Fails: HN_ERR_INPUT when a text is no part of a study, when parts contradict each other (names
/// the field), when parts are missing or unfinished (names them); HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_study_merge(const hn_study_part_text *parts, int n, hn_study **out,
                                       hn_diags *diags);
#endif
