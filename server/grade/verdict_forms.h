// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VERDICT_FORMS_H
#define HN_GRADE_VERDICT_FORMS_H
// Further forms of a verdict: for test reports, for a browser.

#include "grade/verdict.h"

/// JUnit's XML: one test case an entry; an entry with less than its points fails, a submission that
/// cannot be graded is an error.
void hn_verdict_junit(hn_strbuf *b, const hn_verdict *v);
/// A page of its own for a person, without scripts.
void hn_verdict_html(hn_strbuf *b, const hn_verdict *v);
/// A line of comma-separated values: problem, student, seed, status, score, max_score, and the
/// mistakes. With its head when `head` is not 0.
void hn_verdict_csv(hn_strbuf *b, const hn_verdict *v, int head);
#endif
