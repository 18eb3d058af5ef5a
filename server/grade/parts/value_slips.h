// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_VALUE_SLIPS_H
#define HN_GRADE_PARTS_VALUE_SLIPS_H
// Slips at one place of a formula: the reference is written again with one term left out, one sign
// turned round, one sine in place of a cosine, one square, exponent or divisor left out.

#include "grade/parts/value_search.h"

/// Tries every slip at one place of the reference. For a number only where few are possible, and
/// where the number agrees closely, and the more of them there are the closer: among many
/// candidates one agrees by chance.
void hn_value_slips_try(hn_value_search *f);
#endif
