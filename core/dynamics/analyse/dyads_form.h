#ifndef HN_DYNAMICS_DYADS_FORM_H
#define HN_DYNAMICS_DYADS_FORM_H
// One step of a position analysis while it is recognised and solved; for dyads*.c only.

#include "dynamics/analyse/dyads.h"

/// A vector of the rows of a block; one entry where it has one row.
typedef struct hn_pair {
    hn_ex e[2];
} hn_pair;

/// phi = A cos x + B sin x + y (U cos x + V sin x + W) + C cos y + D sin y + E, or with A x for an
/// unknown that slides. What the kind has not is zero.
typedef struct hn_dyad_form {
    hn_pair A, B, C, D, U, V, W, E;
} hn_dyad_form;

typedef struct hn_dyad_step {
    hn_dyad dyad;
    hn_dyad_form form;
    int is_angle[2]; ///< an unknown that came from atan2
    hn_ex sign;      ///< its symbol; the number 1 where there is one way only
    /// what the square root is taken of: negative where it cannot be closed; the number 1 where
    /// there is none
    hn_ex room;
    hn_ex branch; ///< has the sign of `sign`, at a pose that is closed
    hn_ex x[2];
    // the same for people: the second unknown from the first, and parts that would be written out
    // many times by names of their own
    hn_ex told[2];
    int n_parts;
    hn_ex part[HN_DYAD_PARTS], part_is[HN_DYAD_PARTS];
} hn_dyad_step;

/// Recognises the block (row, unknown and n of step->dyad are set). Fills kind and form; 0 when it
/// has no shape of the list. Values for every symbol at random poses are made from `seed`; `x` has
/// room for all of the graph's symbols.
int hn_dyad_recognise(const hn_system *sys, hn_dyad_step *step, double *x, unsigned *seed);
/// Fills the expressions of the solution from the form of step number `k`.
void hn_dyad_solve_form(const hn_system *sys, hn_dyad_step *step, int k);
#endif
