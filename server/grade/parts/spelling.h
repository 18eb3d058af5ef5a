// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SPELLING_H
#define HN_GRADE_SPELLING_H
// Formulas as students type them, in the spelling of the formula parser:
//
//     np.sin(θ1)   Sin[th1]   \sin\theta_{1}   sin^2(th1)   −l₁·sin(th1)
//     sin(theta1)  sin(th1)   sin(theta_1)     sin(th1)^2   -l1*sin(th1)

#include "base/diag.h"
#include "base/strbuf.h"

/// Rewrites a formula for hn_parse(); a text in that spelling already is copied as it is.
///
/// Typographic signs, Greek letters, sub- and superscript digits become ASCII; `np.`, `math.` and
/// their like are dropped; square brackets and capital letters of functions (Sin[x], ArcTan)
/// become those of the parser. Factors that stand side by side are multiplied, two numbers never.
/// In a text with a backslash LaTeX commands are read. Text that is no formula comes out as some
/// other text that is none: the parser reports it. Output is bounded by a few times the input.
/// Fails: HN_ERR_INPUT (a command of LaTeX that is not known, or a/b c, which may be read in two
/// ways; `diag` says the column of what was typed), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_spelling_normalise(hn_strbuf *out, const char *text, hn_diag *diag);
/// Adds to the sentence about a wrong formula that it has a function without brackets before a sum,
/// as in cos th1-th2, which is read as cos(th1)-th2. Other formulas leave the sentence as it is.
void hn_spelling_remark_bare(const char *formula, char *sentence, size_t size);
/// The i-th shorter name that a name may stand for: theta1 is th1, omega1 is w1, om1 or u1, w1 is
/// om1 or u1, q1 and t1 are th1; a dot may stand before the index or behind it: thetadot1,
/// theta1_dot.
/// Returns 0 when there is none.
int hn_spelling_alias(const char *name, int i, char *out, size_t size);
/// Copies `name` without underscores: theta_1 is theta1. Returns 0 when it has none or is too long.
int hn_spelling_join(const char *name, char *out, size_t size);
#endif
