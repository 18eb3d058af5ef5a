// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VALUE_MISTAKES_H
#define HN_GRADE_VALUE_MISTAKES_H
// Names the mistake in a wrong number or formula: first the mistakes that the exercise lists, then
// those that every formula invites (a sign, a factor, degrees, a name left out).

#include "grade/parts/value_sheet.h"

/// Writes the mistake in entry k, whose values are wrong, and its share of the points. `formula`:
/// the answer itself. r->likely says that chance may explain the answer as well.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_value_explain(hn_value_sheet *s, int k, const double *given,
                                         hn_ex formula, hn_part_result *r);
#endif
