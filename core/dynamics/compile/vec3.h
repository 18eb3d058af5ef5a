// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_VEC3_H
#define HN_DYNAMICS_VEC3_H
// Vectors and 3 x 3 matrices of expressions. A component that is zero costs no node, so that a
// planar mechanism never builds what only a spatial one needs.

#include "expr/graph.h"
#include "linalg/small3.h"

#include <stdbool.h>

typedef struct hn_vec3 {
    hn_ex x[3];
} hn_vec3;

typedef struct hn_mat3 {
    hn_ex x[3][3];
} hn_mat3;

/// Symmetric: xx yy zz xy xz yz.
typedef struct hn_sym3 {
    hn_ex x[6];
} hn_sym3;

/// Vectors: of zeros, of numbers; whether all components are zero; sums, multiples and products.
hn_vec3 hn_vec3_zero(void);
hn_vec3 hn_vec3_num(const double v[3]);
hn_vec3 hn_vec3_add(hn_graph *g, hn_vec3 a, hn_vec3 b);
hn_vec3 hn_vec3_sub(hn_graph *g, hn_vec3 a, hn_vec3 b);
hn_vec3 hn_vec3_scale(hn_graph *g, hn_ex k, hn_vec3 a);
hn_vec3 hn_vec3_cross(hn_graph *g, hn_vec3 a, hn_vec3 b);
hn_ex hn_vec3_cross_z(hn_graph *g, hn_vec3 a, hn_vec3 b); ///< only the z component
hn_ex hn_vec3_dot(hn_graph *g, hn_vec3 a, hn_vec3 b);

/// Matrices: the identity, of numbers; m a, m' a, a b, and column j of m.
hn_mat3 hn_mat3_identity(void);
hn_mat3 hn_mat3_num(double m[3][3]);
hn_vec3 hn_mat3_apply(hn_graph *g, const hn_mat3 *m, hn_vec3 a);
hn_vec3 hn_mat3_apply_transposed(hn_graph *g, const hn_mat3 *m, hn_vec3 a);
hn_mat3 hn_mat3_mul(hn_graph *g, const hn_mat3 *a, const hn_mat3 *b);
hn_vec3 hn_mat3_column(const hn_mat3 *m, int j);
/// Rotation about z by the angle whose cosine and sine are given.
hn_mat3 hn_mat3_turn_z(hn_ex c, hn_ex s);

/// Number entries within 1e-14 of 0, 1 and -1 become exactly that.
void hn_mat3_snap(hn_mat3 *m);

/// m a, and a + b.
hn_vec3 hn_sym3_apply(hn_graph *g, const hn_sym3 *m, hn_vec3 a);
hn_sym3 hn_sym3_add(hn_graph *g, const hn_sym3 *a, const hn_sym3 *b);
/// R m R'.
hn_sym3 hn_sym3_rotate(hn_graph *g, const hn_mat3 *R, const hn_sym3 *m);
/// The same for a rotation about z.
hn_sym3 hn_sym3_turn_z(hn_graph *g, hn_ex c, hn_ex s, const hn_sym3 *m);
/// The increment of the inertia of a set of bodies (mass m, first moment s about its own point)
/// when it is referred to another point; r is its own point, seen from the other one:
///     2 (r.s) 1 - (r s' + s r') + m (r^2 1 - r r')
/// `only_zz`: the other entries are left zero.
hn_sym3 hn_sym3_shift(hn_graph *g, hn_ex m, hn_vec3 s, hn_vec3 r, int only_zz);

/// The matrix B = [al x] + w w' - w^2 1 of a body with angular velocity w and angular acceleration
/// al: a point at r accelerates by B r relative to the body's origin.
hn_mat3 hn_mat3_accel(hn_graph *g, hn_vec3 w, hn_vec3 al);
#endif
