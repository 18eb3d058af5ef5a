#ifndef HN_DYNAMICS_PIVOT_NOISE_H
#define HN_DYNAMICS_PIVOT_NOISE_H
// How finely rows of J may be told apart. Rows that depend on others on the closed set come apart
// where the loops stand open: there J and gamma are off by about the gap over the length (and the
// velocity gap over the velocity), a bit more in a loop of short links. What is not larger tells
// nothing.

#include "dynamics/compile/system.h"

/// A shorter row (of the longest) is mostly blur if stretched to unit length.
#define HN_PIVOT_NOISE_ROW_FLOOR 0.05

/// What belongs to a state: the entries of J that are not identically zero, and the gaps.
typedef struct hn_pivot_noise_terms {
    int n_J;
    const int *row, *col;
    const double *J;     ///< nc x nv row-major
    const double *phi;   ///< nc
    const double *phi_t; ///< nc
} hn_pivot_noise_terms;

/// The relative gap of the loops at velocities v (nv); rate (nc) receives J v + phi_t, size (nc) is
/// scratch.
double hn_pivot_noise_gap(const hn_system *sys, const hn_pivot_noise_terms *at, const double *v,
                          double *rate, double *size);
/// The size, of unit rows, below which pivots of J are blur where the loops stand open by `gap`
/// (relative).
double hn_pivot_noise_of(double gap);
/// How much dependent rows may disagree there about the accelerations, relative to these: what is
/// more than the gap explains is a contradiction of the scene.
double hn_pivot_noise_of_sides(double gap);

#endif
