// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VERDICT_PLATFORMS_H
#define HN_GRADE_VERDICT_PLATFORMS_H
// Verdicts as the documents that teaching platforms read. The keys are theirs.

#include "grade/verdict.h"

/// PrairieLearn's results.json for external grading: score from 0 to 1, a test for each entry.
/// gradable is false for a submission that cannot be graded: it costs no attempt. `png` may be
/// NULL; a picture that would make the file larger than its limit of 1 MB is left out.
void hn_verdict_prairielearn(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png);
/// Two lines for Autolab's autograder: its semantic feedback, then the scores, one for each part
/// (the exercise's id where it has no parts). A submission that cannot be graded scores 0 and says
/// why.
void hn_verdict_autolab(hn_strbuf *b, const hn_verdict *v);
/// The object that a combinator template grader of CodeRunner returns.
void hn_verdict_coderunner(hn_strbuf *b, const hn_verdict *v);
/// The score of LTI 1.3 (Assignment and Grade Services) with the time of this call. Without
/// scoreGiven, and gradingProgress Failed, for a submission that cannot be graded.
void hn_verdict_lti_score(hn_strbuf *b, const hn_verdict *v);
#endif
