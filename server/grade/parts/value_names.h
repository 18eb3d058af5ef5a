// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_VALUE_NAMES_H
#define HN_GRADE_PARTS_VALUE_NAMES_H
// Mistakes of a formula that its values at the states tell: one name in place of another, relative
// angles in place of absolute ones, and a number that is wrong as a factor. A number has one value,
// which is too little for any of these.

#include "grade/parts/value_search.h"

/// Tries angles that are measured from the link before: th2 + th1 in place of th2.
void hn_value_names_try_relative(hn_value_search *f);
/// Tries names in place of others and wrong factors, of the whole formula and of one of its terms.
void hn_value_names_try(hn_value_search *f);
#endif
