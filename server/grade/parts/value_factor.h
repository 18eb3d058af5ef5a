// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_VALUE_FACTOR_H
#define HN_GRADE_PARTS_VALUE_FACTOR_H
// A wrong number in a formula: a term, or the whole, is off by the same factor at all states.

#include <stdbool.h>
#include <stddef.h>

/// Returns whether the factor has one value at all `n` states, as exactly as numbers are typed.
bool hn_value_factor_is_constant(const double *factor, int n);
/// Returns the factor as exactly as it is meant, and writes it for people: 1/4, or three digits
/// where no fraction with a small divisor is near. *fraction (may be NULL): one is.
double hn_value_factor_name(const double *factor, int n, char *text, size_t size, bool *fraction);
#endif
