// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SPELLING_H
#define HN_GRADE_SPELLING_H
// Formulas as students type them, in the spelling of the formula parser:
//
//     np.sin(θ1)   Sin[th1]   \sin\theta_{1}   sin^2(th1)   −l₁·sin(th1)
//     sin(theta1)  sin(th1)   sin(theta_1)     sin(th1)^2   -l1*sin(th1)

#include "base/strbuf.h"

/// Rewrites a formula for hn_parse(); a text in that spelling already is copied as it is.
///
/// Typographic signs, Greek letters, sub- and superscript digits become ASCII; `np.`, `math.` and
/// their like are dropped; square brackets and capital letters of functions (Sin[x], ArcTan)
/// become those of the parser. In a text with a backslash LaTeX commands are read, and factors that
/// stand side by side are multiplied. Text that is no formula comes out as some other text that is
/// none: the parser reports it. Output is bounded by a few times the input.
void hn_spelling_normalise(hn_strbuf *out, const char *text);
/// Copies `name` without underscores: theta_1 is theta1. Returns 0 when it has none or is too long.
int hn_spelling_join(const char *name, char *out, size_t size);
#endif
