// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REDUCED_TAPE_H
#define HN_DYNAMICS_REDUCED_TAPE_H
// One tape for an evaluation in reduced coordinates. From a predicted configuration it makes one
// step of Newton's method in the dependent coordinates d, and at the corrected configuration it
// gives the gap that is left, the basis of the velocities and the accelerations of the independent
// coordinates i:
//
//     q_d <- q_d - J_d^-1 phi   where |phi| >= closed, else q_d stays                        (1)
//     v = N u + s,   N = [I; -J_d^-1 J_i],   s = [0; -J_d^-1 phi_t]                          (2)
//     (N' M N) u' = N' (f - M c),   c = [0; -J_d^-1 gamma]                                   (3)
//
// A correction of a closed configuration would add nothing but rounding, which near a singular
// configuration is not small. The order of elimination is chosen once (block_lu.h), so every pivot
// is compared with its value where the tape was made. If one has become small, the caller solves
// by other means.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/tape.h"

#include <stdbool.h>

typedef struct hn_reduced_tape hn_reduced_tape;

/// The velocities of the system split into dependent and independent ones, and J at a
/// configuration where the order is chosen.
typedef struct hn_reduced_split {
    int rank, r;          ///< numbers of dependent and independent velocities
    const int *dep, *ind; ///< rank, r: which
    const double *J;      ///< the entries of J, without those that are zero everywhere, by rows
    double closed;        ///< a gap below this is left as it is [the units of the rows]
} hn_reduced_split;

/// Compiles the tape for a split. *out is NULL where it cannot serve: a ball among the coordinates,
/// dependent rows, no constraint at all, or too many coordinates to be written out. Adds nodes to
/// the system's graph. Memory from `arena`; the tape is freed by hn_reduced_tape_free(). Fails:
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_reduced_tape_create(const hn_system *sys, const hn_reduced_split *split,
                                               hn_arena *arena, hn_reduced_tape **out);
void hn_reduced_tape_free(hn_reduced_tape *tape); ///< NULL is legal
/// Returns whether the tape was made for these dependent velocities (rank).
bool hn_reduced_tape_is_for(const hn_reduced_tape *tape, const int *dep, int rank);

/// Runs the tape at (t, q, u): q (nq) with the dependent entries predicted, u (r) the independent
/// velocities. Allocates nothing.
void hn_reduced_tape_run(hn_reduced_tape *tape, double t, const double *q, const double *u);

// ---- of the last run ----

/// Takes the pivots of the last run for the measure of those of later runs.
void hn_reduced_tape_take_measure(hn_reduced_tape *tape);
/// Returns whether every pivot is well above zero, compared with those of
/// hn_reduced_tape_take_measure().
bool hn_reduced_tape_is_sure(const hn_reduced_tape *tape);
/// Returns ||phi|| at the corrected configuration [the units of the rows].
double hn_reduced_tape_gap(const hn_reduced_tape *tape);
/// Returns det J_d there.
double hn_reduced_tape_determinant(const hn_reduced_tape *tape);
/// Writes the corrected dependent entries of q (nq); the independent ones are left alone.
void hn_reduced_tape_get_position(const hn_reduced_tape *tape, double *q);
/// Writes u' (r). Returns false where it is not finite.
bool hn_reduced_tape_get_accelerations(const hn_reduced_tape *tape, double *u_dot);
/// Writes N (nv x r row-major) and s (nv) of (2).
void hn_reduced_tape_get_basis(const hn_reduced_tape *tape, double *N, double *s);
hn_tape_info hn_reduced_tape_info(const hn_reduced_tape *tape);

#endif
