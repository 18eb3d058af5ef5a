// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SMALL3_H
#define HN_LINALG_SMALL3_H
// Vectors of three numbers and 3 x 3 matrices (rows first). Outputs may be the same array as an
// input, unless said otherwise.

/// Rounding of a product of a few unit rotations [-]; see hn_num3_snap().
#define HN_NUM3_SNAP 1e-14

/// out = a b.
void hn_num3_mul(double a[3][3], double b[3][3], double out[3][3]);
/// out = a', the transpose.
void hn_num3_transpose(double a[3][3], double out[3][3]);
/// out = a x.
void hn_num3_apply(double a[3][3], const double x[3], double out[3]);

/// Sets entries nearer than `within` to a whole number to that number: an axis-aligned constant
/// rotation must fold to zeros and ones. Leaves no negative zero.
void hn_num3_snap(double a[3][3], double within);
/// out = a b for two rotations, snapped within HN_NUM3_SNAP.
void hn_num3_compose(double a[3][3], double b[3][3], double out[3][3]);

/// out = a x b.
void hn_num3_cross(const double a[3], const double b[3], double out[3]);
double hn_num3_dot(const double a[3], const double b[3]);
/// Euclidean length.
double hn_num3_norm(const double a[3]);
#endif
