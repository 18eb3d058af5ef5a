// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SUMMARY_H
#define HN_GRADE_SUMMARY_H

#include "grade/verdict.h"

/// Writes the sentence that sums up a graded matrix of formulas to v->summary: how many entries are
/// right, the mistake that all wrong ones share, and the entries that cannot be read.
void hn_summary_write(hn_verdict *v);

#endif
