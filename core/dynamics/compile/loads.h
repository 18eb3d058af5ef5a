// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LOADS_H
#define HN_DYNAMICS_LOADS_H
// Loads as generalised forces, by virtual work: the power of a load is force . rate, and the
// coefficients of the rates are those that closures use too.
//
//     spring between points, D = p - q, l = |D|, e_i = D . dD/dq_i:  l l' = sum e_i u_i
//         Q_i = -(k (1 - l0 / l) + c l'/ l) e_i,   V = k (l - l0)^2 / 2
//     moment N on a body that turns with w = sum w_i u_i:  Q_i = N . w_i
//     on a coordinate x:  Q_i = tau dx'/du_i
//         follower   tau = k (x_d(t) - x) + c (x_d' - x'), clamped
//         table      tau(t)
//     a hand at h that pulls point p:  Q_i = (k (h - p) - c p') . dp'/du_i

#include "dynamics/compile/system_impl.h"

/// The difference of two scene points, and how the rates move it.
typedef struct hn_span {
    hn_vec3 delta; ///< point p minus point q
    int n;
    int *coordinate;      ///< n system coordinates
    hn_vec3 *coefficient; ///< d delta / dt = sum coefficient u (without what t alone moves)
} hn_span;

/// Functions by which a kind of scene gives spans.
typedef struct hn_geometry {
    void *self;
    /// p minus q in any one frame (loads take only lengths and powers from it), or, with q < 0, p
    /// seen from the world's origin in world axes
    hn_status (*span)(void *self, int p, int q, hn_span *out);
    /// how the rates turn the body of point p, in world axes (delta is not used); NULL where there
    /// are no bodies
    hn_status (*spin)(void *self, int p, hn_span *out);
} hn_geometry;

/// Adds all loads of the scene to f, springs also to the potential.
HN_MUST_CHECK hn_status hn_loads_compile(hn_system *sys, const hn_geometry *geometry);

#endif
