// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_PIVOT_NOISE_H
#define HN_DYNAMICS_PIVOT_NOISE_H
// The noise floor of the pivots of J when the constraints are violated by a given gap.
//
// Rows that depend on others while the loops are closed become independent when the loops are open:
// J and gamma are then wrong by about the gap over the length (and by the velocity gap over the
// velocity), a little more in a loop of short links. Pivots below that size are noise.

#include "dynamics/compile/system.h"

/// A row shorter than this share of the longest would be mostly noise if stretched to unit length.
#define HN_PIVOT_NOISE_ROW_FLOOR 0.05

/// J at a state (the entries that are not identically zero) and the constraint violation there.
typedef struct hn_pivot_noise_terms {
    int n_J;
    const int *row, *col;
    const double *J;     ///< nc x nv row-major, or NULL: the entries stand in a list
    const double *list;  ///< n_J values of the entries
    const double *phi;   ///< nc
    const double *phi_t; ///< nc
} hn_pivot_noise_terms;

/// Returns the relative gap of the loops at velocities v (nv): the largest of phi over the length
/// and of J v + phi_t over the velocities. Writes J v + phi_t to rate (nc); size (nc) is scratch.
double hn_pivot_noise_gap(const hn_system *sys, const hn_pivot_noise_terms *at, const double *v,
                          double *rate, double *size);
/// The size, of unit rows, below which pivots of J are noise when the loops are open by `gap`
/// (relative).
double hn_pivot_noise_of(double gap);
/// By how much, relative to the accelerations, dependent rows may disagree about these there. A
/// larger difference is a contradiction in the scene.
double hn_pivot_noise_of_sides(double gap);

#endif
