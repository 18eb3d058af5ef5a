// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REACTIONS_H
#define HN_DYNAMICS_REACTIONS_H
// The forces and moments of joints and constraints, and generalised forces along coordinates
// (efforts).
//
// Signs. Every wrench acts ON the second of the two partners:
//     joint                  on its child, by its parent
//     distance               on the body of `to`, by that of `from`
//     line, plane, rolling   on the body of the point that is guided, by that of the guide
// hn_wrench.body names it. A weight that hangs from the ground by a joint (parent: the ground) or
// by a distance (from: the ground) gets an upward force m g. Constraints on coordinates (gear,
// motion, formula) act along these and are efforts; they are listed once.
//
// A joint's wrench contains everything that acts between its two bodies: beside what the joint
// itself carries, the drives, springs and other loads along its own coordinates. Along the axis of
// a prismatic joint the force is therefore that of its drive and loads.
//
// Poses, velocities and accelerations of the bodies come from a tape; each body's balance (Newton
// and Euler) then gives the wrench of its tree joint, leaves first, once loads and the closing
// joints' multipliers are taken off. The effort of a joint's own actuator or spring along its
// freedom is part of the wrench.
//
// Energies given as formulas beside the bodies say what they do along coordinates and nothing about
// where. They are taken to act in the joints, between the two bodies of the joint whose coordinate
// they name, as a motor there would, inertia included; what they do
// is in the wrench along the joint's freedom, and is reported beside it. A formula that stands for
// a part somewhere else also loads joints across their degrees of freedom: that is not in any
// formula, and not in the wrenches. A scene of formulas alone has efforts only.

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/compile/system.h"

#include <stdbool.h>

typedef struct hn_wrench {
    int body;         ///< scene body on which it acts, HN_GROUND: the ground
    double force[3];  ///< [N], world axes
    double moment[3]; ///< [N m], world axes, about the place
    double place[3];  ///< [m], world: of the joint on its child, of the constraint's point
    /// the same in the joint's own axes on its parent: ref, axis x ref, axis
    double in_joint_force[3], in_joint_moment[3];
    int determined; ///< 0: redundant rows, so this is one of many (least-norm multipliers)
} hn_wrench;

/// A generalised force along one coordinate: of a row of a constraint on coordinates (a gear, a
/// formula), or of the energies.
typedef struct hn_effort {
    const char *name; ///< of the row; "energies"
    int row;          ///< -1: the energies
    int coordinate;   ///< of the scene, and of one of its joints where it is the energies'
    double value;     ///< [N m] along an angle, [N] along a length, else [J] per unit
    int determined;   ///< as for a wrench
} hn_effort;

typedef struct hn_reactions hn_reactions;
/// Memory from `arena`, the tape owned (hn_reactions_free). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_reactions_create(const hn_system *sys, hn_arena *arena,
                                            hn_reactions **out, hn_diag *diag);
void hn_reactions_free(hn_reactions *r); ///< NULL is legal
/// Per scene joint (n_joints) its wrench, zero for one that only carries a coordinate of formulas;
/// per constraint beside the joints (n_constraints; NULL: not wanted) the wrench by the rule of
/// signs above, zero for one on coordinates. From a state, its accelerations and multipliers
/// (system coordinates). Allocates nothing.
HN_MUST_CHECK hn_status hn_reactions_eval(hn_reactions *r, double t, const double *q,
                                          const double *v, const double *a, const double *lambda,
                                          hn_wrench *joints, hn_wrench *constraints);
/// Efforts of the last eval: constraints in the order of their rows, then the energies.
int hn_reactions_effort_count(const hn_reactions *r);
hn_effort hn_reactions_effort(const hn_reactions *r, int k);
/// Returns whether a constraint beside the joints acts between points; if not, it has efforts only.
bool hn_reactions_has_place(const hn_reactions *r, int constraint);
/// After an eval: largest residual of m a = sum of forces and of the moments about the centre of
/// mass over all bodies, relative to the largest force [-] and moment. The tree joints are found
/// from it; what it tells is that bodies whose wrenches all came from elsewhere (closing joints,
/// loads) and generalised forces along the degrees of freedom agree.
double hn_reactions_defect(const hn_reactions *r);
#endif
