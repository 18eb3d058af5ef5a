// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_CLASS_SUMMARY_H
#define HN_CLASS_CLASS_SUMMARY_H
// The summary of a graded class, for its teacher.

#include "class/class_grading.h"

/// Adds the scores as a histogram, the commonest mistakes, who handed in equal wrong answers,
/// near-copies that differ in their names alone (programs also in comments and the order of
/// statements), programs that share most of their statements, and names with more than one
/// submission.
/// `programs`: they handed in programs.
void hn_class_summary(hn_strbuf *b, const hn_class_result *r, bool programs);

#endif
