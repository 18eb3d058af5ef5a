// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_ACCEL_JACOBIAN_H
#define HN_FORMULATIONS_ACCEL_JACOBIAN_H
// Exact derivatives of the accelerations that a formulation makes of the equations of motion, for
// Newton's method in implicit integrators. The accelerations solve
//
//  M a = f + J' lambda,   J a + gamma + 2 alpha (J v + phi_t) + beta^2 phi + give lambda = 0  (1)
//
// (give = 0 but for a penalty, where it is one over the weight), so along a displacement dx of the
// positions and dv of the speeds
//
//     [M  -J'  ] [da     ]     [K    C  ] [dx]      B_q = gamma_q + (J a)_q + 2 alpha V + beta^2 J
//     [J   give] [dlambda] = - [B_q  B_v] [dv],     B_v = gamma_v + 2 alpha J               (2)
//
// with K, C, V of dynamics/evaluate/linearise.h. An implicit integrator solves, for y =
// (q, v), (s - dF/dy) y' = (r1, r2), needs no dF/dy, which is full: with dx = P dv + g from the
// kinematics (P = 1/s, a 3 x 3 block for a ball) it is
//
//     [M + C/s + K P/s      -J' ] [dv       ]     [M r2 - K g  ]
//     [J + B_v/s + B_q P/s  give] [dlambda/s] =   [J r2 - B_q g] / s                          (3)
//
// as sparse as the mechanism (linalg/newton_matrix.h); accel_newton.h solves it. Rows of J that
// depend on others are left out. The length of a quaternion, which no motion changes, is held:
// derivatives are those along rotations.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_accel_jacobian hn_accel_jacobian;

/// q itself, or with balls a copy in `unit` (nq) whose quaternions have length 1: the pose that
/// accelerations belong to. Inside a step an integrator leaves the length by its local error; that
/// must not stretch the bodies.
const double *hn_unit_positions(const hn_system *sys, const double *q, double *unit);

/// The constants of (1): [1/s], [1/s], and 1 / weight of a penalty.
typedef struct hn_accel_law {
    double alpha, beta, give;
} hn_accel_law;

/// Memory from `arena`, tapes owned by it. `law`: only which of its entries are zero counts here;
/// those that are zero stay so. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_accel_jacobian_create(const hn_system *sys, const hn_accel_law *law,
                                                 hn_arena *arena, hn_accel_jacobian **out);
void hn_accel_jacobian_free(hn_accel_jacobian *j); ///< NULL is legal
/// Takes the derivatives at a state. Allocates nothing. Fails as hn_accel_eval() does,
/// HN_ERR_SINGULAR, HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_accel_jacobian_at(hn_accel_jacobian *j, double t, const double *q,
                                             const double *v, const hn_accel_law *law);
/// Factors the matrix on the left of (2), which the functions below solve with.
/// Fails: HN_ERR_SINGULAR, HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_accel_jacobian_prepare(hn_accel_jacobian *j);
/// Solves (2) for da (nv) with dx and dv (nv each, NULL: zero).
void hn_accel_jacobian_along(hn_accel_jacobian *j, const double *dx, const double *dv, double *da);
/// out (2 nv) = A' w with A = d(x', v')/d(x, v) along displacements: w (2 nv) weighs x' and v'; x'
/// of a ball also turns with it. From the same factor, as (2) transposed is (2) with the
/// multipliers' sign changed.
void hn_accel_jacobian_back(hn_accel_jacobian *j, const double *w, double *out);
/// rows (nc) = (J v + phi_t)_q dx; made with alpha or beta not zero only.
void hn_accel_jacobian_carry(const hn_accel_jacobian *j, const double *dx, double *rows);
/// d(q', v')/d(q, v), (nq + nv) square, row-major. Fails as hn_accel_jacobian_prepare().
HN_MUST_CHECK hn_status hn_accel_jacobian_fill(hn_accel_jacobian *j, double *jac);
long long hn_accel_jacobian_evals(const hn_accel_jacobian *j); ///< accelerations found on the way
double hn_accel_jacobian_ops(const hn_accel_jacobian *j);      ///< arithmetic operations so far

#endif
