// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_LANES_SINCOS_H
#define HN_EXPR_LANES_SINCOS_H
// Sine and cosine of many angles at once, bit for bit those of the C library's sincos().
//
// The vector forms do for 4 or 8 angles what the GNU C library does for one: reduction to
// |a| < pi/4, the nearest point k/128, whose sine and cosine stand in a table with twice the
// digits, and polynomials for the rest, every operation rounded as there. Another C library may
// round otherwise: the first use compares HN_LANES_SINCOS_CHECKS angles, and where one bit differs
// the C library is called for each angle.

#include <stdbool.h>

enum { HN_LANES_SINCOS_CHECKS = 4096 };

/// Instruction sets that have forms of their own; each includes those before it.
typedef enum hn_lanes_set {
    HN_LANES_PLAIN,
    HN_LANES_AVX2,
    HN_LANES_AVX512,
    HN_LANES_SETS
} hn_lanes_set;

/// The best set that this processor has.
hn_lanes_set hn_lanes_set_best(void);

/// Doubles in a vector of this set.
int hn_lanes_set_width(hn_lanes_set set);

/// Sine and cosine of n angles [rad]; n is a multiple of the set's width, the three arrays are
/// aligned to a vector, and `sine` and `cosine` may be `angle`.
typedef void (*hn_lanes_sincos)(int n, const double *angle, double *sine, double *cosine);

/// The function for a set that the processor has; compares with the C library as said above. Safe
/// in several threads.
hn_lanes_sincos hn_lanes_sincos_get(hn_lanes_set set);
/// Returns whether that function is a vector form.
bool hn_lanes_sincos_is_vector(hn_lanes_set set);

/// Sine and cosine of four angles [rad] of one state, to sine[4] and cosine[4]: in the time of one
/// and a half, and without a detour through memory that would hold up the processor. The same four
/// angles in the same places as at the thread's last call cost next to nothing: several tapes are
/// run at one configuration.
typedef void (*hn_lanes_sincos_four)(double a, double b, double c, double d, double *sine,
                                     double *cosine);
/// That function; NULL where the processor or the C library leaves none. Safe in several threads.
hn_lanes_sincos_four hn_lanes_sincos_four_get(void);
#endif
