// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_MATRIX_PROPERTY_H
#define HN_GRADE_MATRIX_PROPERTY_H
// Properties of a small matrix whose numbers a student chose: symmetric, definite, singular, zero.
// A nearly singular or nearly zero matrix is neither: only rounding counts as nothing.

#include "grade/parts/matrix.h"

#include <stdbool.h>

/// Whether `m` has a property. `size` has the shape of `m`: what its entries would be if all
/// numbers in their formula were positive. An entry below 1e-12 of its size is rounding, and is
/// taken for zero. Ranks and pivots are those of the matrix with rows and columns scaled to length
/// one, so that a small entry is as good as a large one.
typedef bool hn_matrix_property(const hn_matrix *m, const hn_matrix *size);

/// The property of a name: symmetric, definite, semidefinite, full-rank (of the columns),
/// rows-independent, rows-dependent, singular, nonsingular, at-most-zero (1 x 1), zero, nonzero,
/// rows-nonzero (no row is zero). NULL: there is no such name.
hn_matrix_property *hn_matrix_property_find(const char *name);
#endif
