// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_FRAME_H
#define HN_IMPORT_FRAME_H
// Places and directions of rigid bodies in numbers, and what their mass amounts to. Columns of R
// are the axes of the inner frame in those of the outer one: x_outer = p + R x_inner.

#include <stdbool.h>

typedef struct hn_im_frame {
    double R[3][3];
    double p[3]; ///< [m]
} hn_im_frame;

/// The frame that is its outer one.
hn_im_frame hn_im_frame_unit(void);
/// a b: the frame b, given in a, seen from outside.
hn_im_frame hn_im_frame_mul(const hn_im_frame *a, const hn_im_frame *b);
hn_im_frame hn_im_frame_inverse(const hn_im_frame *a);
void hn_im_place(const hn_im_frame *a, const double x[3], double out[3]); ///< p + R x
void hn_im_turn(const hn_im_frame *a, const double x[3], double out[3]);  ///< R x

/// 0 when there is no direction in it (length below 1e-10).
bool hn_im_normalise(double a[3]);
/// A unit vector across the unit vector `axis`: the coordinate axis least aligned with it, x before
/// y before z, made perpendicular.
void hn_im_across(const double axis[3], double out[3]);

// Rotations; entries that miss 0 or 1 by rounding are set to it, so that planar mechanisms stay
// planar.
void hn_im_rotation(const double axis[3], double angle, double R[3][3]); ///< axis of length 1
void hn_im_from_quaternion(const double q[4], double R[3][3]);           ///< w x y z of length 1
/// Rotation vector (axis times angle, angle at most pi) of a rotation.
void hn_im_rotation_vector(double R[3][3], double out[3]);
void hn_im_snap(double R[3][3]);

/// Mass [kg], centre of mass [m] and tensor about it [kg m^2]: xx yy zz xy xz yz.
typedef struct hn_im_mass {
    double m, c[3], I[6];
} hn_im_mass;

/// The same body seen from the frame in which `at` is given.
hn_im_mass hn_im_mass_moved(const hn_im_mass *a, const hn_im_frame *at);
/// Two bodies made one (Steiner).
hn_im_mass hn_im_mass_sum(const hn_im_mass *a, const hn_im_mass *b);

typedef enum hn_im_solid {
    HN_IM_SPHERE,
    HN_IM_CAPSULE,
    HN_IM_CYLINDER,
    HN_IM_ELLIPSOID,
    HN_IM_BOX
} hn_im_solid;
/// Volume [m^3]. size: sphere r; capsule and cylinder r, half length along z; ellipsoid half axes;
/// box half edges [m].
double hn_im_volume(hn_im_solid solid, const double size[3]);
/// Homogeneous, of mass m, centred at the origin, axes along the frame.
hn_im_mass hn_im_solid_mass(hn_im_solid solid, const double size[3], double m);
#endif
