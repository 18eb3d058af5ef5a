// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_ROWS_H
#define HN_DYNAMICS_ASSEMBLE_ROWS_H
// The closure rows of a large mechanism in the user's rates, entry by entry, and steps that close
// them. Their cost grows with the entries, linearly for a chain of loops, where the dense ways
// of assemble_position.c are cubic.
//
//     least norm  dz = -J' (J J')^-1 r        damped  dz = -J' (J J' + mu I)^-1 r            (1)
//
// Source: Golub & Van Loan 2013, section 5.3; Nocedal & Wright 2006, section 10.3.

#include "dynamics/assembly/assemble_state.h"

/// From so many velocities on a mechanism is large.
enum { HN_ASSEMBLE_LARGE = 100 };
bool hn_assemble_is_large(const hn_assembler *s);

typedef struct hn_assemble_rows hn_assemble_rows;

/// Rows of J in the n_kept user coordinates kept[k] (borrowed). *out stays NULL where rows meet so
/// often that dense ways cost no more. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_rows_create(const hn_assembler *s, int n_kept, const int *kept,
                                                hn_assemble_rows **out);
/// Takes J where s->eval was last run, rows times row_unit (nc; NULL: brought to length 1), columns
/// times the reach of their coordinate.
void hn_assemble_rows_fill(hn_assemble_rows *r, const double *row_unit);
/// Returns whether every row stands well apart from the others, after filling with rows of length
/// 1.
bool hn_assemble_rows_stand_apart(hn_assemble_rows *r);
/// y (n_kept) = J' x, and y (nc) = J x.
void hn_assemble_rows_gradient(const hn_assemble_rows *r, const double *x, double *y);
void hn_assemble_rows_change(const hn_assemble_rows *r, const double *x, double *y);
/// Largest entry on the diagonal of J J', and |J|, the root of the sum of its squares.
double hn_assemble_rows_largest(const hn_assemble_rows *r);
double hn_assemble_rows_size(const hn_assemble_rows *r);
/// The step (1) for the residual `r` (nc) into `step` (n_kept); mu = 0: of least norm. Fails:
/// HN_ERR_SINGULAR when rows depend on each other, HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_assemble_rows_step(hn_assemble_rows *rows, const double *r, double mu,
                                              double *step);

#endif
