#ifndef HN_DYNAMICS_REACTIONS_H
#define HN_DYNAMICS_REACTIONS_H
// What every joint carries: the force and moment that the joint's parent exerts on its child, at the joint's place, and the
// balance of each body with them. A scene of bodies only.
//
// Poses, velocities and accelerations of the bodies come from a tape; each body's balance (Newton and Euler) then gives the
// wrench of its tree joint, leaves first, once loads and the closing joints' multipliers are taken off. What a joint's own
// actuator or spring gives along its freedom is part of the wrench.

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/system.h"

typedef struct hn_wrench {
    double force[3];  ///< [N], world axes, on the child
    double moment[3]; ///< [N m], world axes, about the joint's place on the child
    double place[3];  ///< [m], world
    double in_joint_force[3],
        in_joint_moment
            [3];    ///< the same in the joint's own axes on its parent: ref, axis x ref, axis
    int determined; ///< 0: redundant rows, so this is one of many (least-norm multipliers)
} hn_wrench;

typedef struct hn_reactions hn_reactions;
/// Memory from `arena`, the tape owned (hn_reactions_free). HN_ERR_UNSUPPORTED for a Lagrangian.
HN_MUST_CHECK hn_status hn_reactions_create(const hn_system *sys, hn_arena *arena,
                                            hn_reactions **out, hn_diag *diag);
void hn_reactions_free(hn_reactions *r); ///< NULL is legal
/// Per scene joint (n_joints) its wrench, per constraint beside the joints (n_constraints; NULL: not wanted) the wrench on the body of its
/// first point, from a state, its accelerations and multipliers (system coordinates). Allocates nothing.
HN_MUST_CHECK hn_status hn_reactions_eval(hn_reactions *r, double t, const double *q,
                                          const double *v, const double *a, const double *lambda,
                                          hn_wrench *joints, hn_wrench *constraints);
/// After an eval: largest residual of m a = sum of forces and of the moments about the centre of mass over all bodies, relative to the largest
/// force [-] and moment. The tree joints are found from it; what it tells is that bodies whose wrenches all came from elsewhere
/// (closing joints, loads) and generalised forces along the freedoms agree.
double hn_reactions_defect(const hn_reactions *r);
#endif
