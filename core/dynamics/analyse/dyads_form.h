// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_DYADS_FORM_H
#define HN_DYNAMICS_DYADS_FORM_H
// One step of a position analysis: its recognition from phi, and its solution in closed form.

#include "dynamics/analyse/dyads.h"

#include <stdbool.h>

/// A vector of the rows of a block; one entry where it has one row.
typedef struct hn_pair {
    hn_ex e[2];
} hn_pair;

/// phi = A cos x + B sin x + y (U cos x + V sin x + W) + C cos y + D sin y + E, or with A x for an
/// unknown that slides. Members that the kind lacks are zero.
typedef struct hn_dyad_form {
    hn_pair A, B, C, D, U, V, W, E;
} hn_dyad_form;

typedef struct hn_dyad_step {
    hn_dyad dyad;
    hn_dyad_form form;
    int is_angle[2]; ///< an unknown that came from atan2
    hn_ex sign;      ///< symbol of the branch; the number 1 where there is one way only
    /// the radicand: negative where the step cannot be closed; the number 1 without a square root
    hn_ex room;
    hn_ex branch; ///< has the sign of the branch at a closed pose
    hn_ex x[2];   ///< the solution
    /// the solution for people: the second unknown from the first, with names for parts that occur
    /// many times
    hn_ex shown[2];
    int n_parts;
    hn_ex part[HN_DYAD_PARTS], part_is[HN_DYAD_PARTS];
} hn_dyad_step;

/// Recognises the block whose row, unknown and n are set in step->dyad, and fills kind and form.
/// Random poses are made from `seed`; `x` has room for all of the graph's symbols.
/// Returns 0 when it has none of the forms in dyads.h.
bool hn_dyad_recognise(const hn_system *sys, hn_dyad_step *step, double *x, unsigned *seed);
/// Fills the expressions of the solution from the form; `k` is the number of the step.
void hn_dyad_solve_form(const hn_system *sys, hn_dyad_step *step, int k);
#endif
