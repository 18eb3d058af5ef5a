// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_MATRIX_H
#define HN_GRADE_MATRIX_H
// Small matrices of numbers: what the values of a student's formula are made of. Shapes that do not
// fit are reported in words for the student.

#include "base/arena.h"
#include "base/diag.h"

enum { HN_MATRIX_LARGEST = 16 };

/// Row-major; number: 1 x 1 that may multiply any matrix, and 0 may be added to any.
typedef struct hn_matrix {
    int rows, cols, number;
    double *x; ///< borrowed from the arena
} hn_matrix;

/// The memory for results, and the place for a reason.
typedef struct hn_matrix_desk {
    hn_arena *arena;
    hn_diag *diag;
} hn_matrix_desk;

/// A zero matrix; x is NULL when memory is out.
hn_matrix hn_matrix_new(hn_arena *arena, int rows, int cols);

// Each fails: HN_ERR_UNSUPPORTED (shapes do not fit, with both), HN_ERR_MEMORY.

/// a + sign * b; the number 0 fits every shape.
HN_MUST_CHECK hn_status hn_matrix_add(const hn_matrix_desk *p, const hn_matrix *a,
                                      const hn_matrix *b, double sign, hn_matrix *out);
/// a b; a number scales.
HN_MUST_CHECK hn_status hn_matrix_multiply(const hn_matrix_desk *p, const hn_matrix *a,
                                           const hn_matrix *b, hn_matrix *out);
/// Entry by entry, in one shape; a number scales.
HN_MUST_CHECK hn_status hn_matrix_multiply_entries(const hn_matrix_desk *p, const hn_matrix *a,
                                                   const hn_matrix *b, hn_matrix *out);
HN_MUST_CHECK hn_status hn_matrix_transpose(const hn_matrix_desk *p, const hn_matrix *a,
                                            hn_matrix *out);
/// Fails also: HN_ERR_SINGULAR.
HN_MUST_CHECK hn_status hn_matrix_invert(const hn_matrix_desk *p, const hn_matrix *a,
                                         hn_matrix *out);
#endif
