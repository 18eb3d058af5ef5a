// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VALUE_LIKENESS_H
#define HN_GRADE_VALUE_LIKENESS_H
// A hash by which equal wrong answers to one part are found in a class. Each student may have a
// variant of his own, so the variant's numbers are replaced by their names first: "0.77*sin(th1)"
// of one variant and "0.52*sin(th1)" of another are both l1*sin(th1).

#include "grade/parts/value_sheet.h"

#include <stdint.h>

/// Returns the hash of a wrong answer, 0 where it says nothing. With `by_values` two formulas are
/// equal when they have the same values, else when they are the same text, blanks and capitals
/// aside. A number that holds none of the variant's numbers is equal within one variant alone.
uint64_t hn_value_likeness(hn_value_sheet *s, const cJSON *node, bool by_values);
#endif
