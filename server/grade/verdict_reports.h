// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VERDICT_REPORTS_H
#define HN_GRADE_VERDICT_REPORTS_H
// Verdicts as reports: for test runners, for a browser, for a spreadsheet.

#include "grade/verdict.h"

#define HN_VERDICT_JUNIT_HEAD "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
#define HN_VERDICT_JUNIT_TAIL "</testsuites>\n"

/// A suite of JUnit's XML, to stand between head and tail: one test case an entry. An entry with
/// less than its points fails, a submission that cannot be graded is an error. `submission` is
/// added to the name of the suite; NULL: none.
void hn_verdict_junit(hn_strbuf *b, const hn_verdict *v, const char *submission);
/// A page of its own for a person, without scripts. It holds the picture `png`, which may be NULL.
void hn_verdict_html(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png);
/// A line of comma-separated values: problem, student, seed, status, score, max_score, and the
/// mistakes. With its head when `head` is not 0.
void hn_verdict_csv(hn_strbuf *b, const hn_verdict *v, int head);
/// Text in XML and HTML: markup escaped, control characters that XML forbids left out.
void hn_verdict_escape(hn_strbuf *b, const char *text);
#endif
