// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_MECH_H
#define HN_DYNAMICS_MECH_H
// Tracing a tree of bodies: the expressions that are known of each link, and the passes that make
// them. The passes, in their order: geometry, composites, mass (here), bias forces and energy
// (bias.h), loops (loops.h), constraints (constraints.h).
//
// Frames of a link i (see tree.h): F its group's frame; E = Rz(-theta) F, in which the body's own
// arms are constants; and the WORK frame its vectors are kept in: F where the base of the group
// does not rotate (there the angular velocity is u z, and products with it stay short), E elsewhere
// (there inertias and arms stay constants). Forces flow along the translation tree (to the parent);
// moments along the rotation tree: what carries a link's rotation takes its moment, so a group
// child's moment passes its parent by and reaches the group's base.

#include "dynamics/compile/system_impl.h"

#include <stdbool.h>

typedef struct hn_link_trace {
    hn_ex c, s; ///< of theta; 1, 0 where the link never rotates
    /// from the parent's joint point to this one's, in E(parent), with the slide of a prismatic
    /// joint
    hn_vec3 arm;
    hn_vec3 slide; ///< prismatic: direction of a growing coordinate, in E(parent)
    /// ball: column k is the axis of velocity k, in E (a turning link also has z: hn_mech_axis)
    hn_mat3 spin;
    hn_mat3 turned; ///< ball: the turn of its frame against the joint's axes on the parent
    hn_vec3 r;      ///< arm in the parent's work frame

    // own body, about its joint point, in E
    hn_ex mass;
    hn_vec3 s_own;
    hn_sym3 I_own;

    // composites about the joint point: total mass; what turns with the link (K) with everything
    // that hangs on group children as point masses; the same with all revolute children as point
    // masses (B); everything, rigid (full), in E
    hn_ex m;
    hn_vec3 sK, sB, sF;
    hn_sym3 IK, IB, IF;
    hn_vec3 sigma, eta; ///< of group children: sum of full first moments; sum s x (z x r)

    // motion at zero u-dot, in the work frame
    /// angular velocity and acceleration; acceleration of the joint point, minus gravity
    hn_vec3 w, al, a;
    hn_mat3 B;     ///< a point at r accelerates by a + B r
    hn_vec3 kappa; ///< prismatic: 2 w x d q', work frame of the parent
    hn_vec3 gravity;

    // bias forces, in the work frame
    hn_vec3 f, gf, pf;                   ///< whole; without m a; without B s either
    hn_vec3 n_rest, n_own, n_new, n_all; ///< see bias.c
} hn_link_trace;

typedef struct hn_mech {
    hn_system *sys;
    hn_graph *g;
    const hn_tree *tree;
    hn_link_trace *at;         ///< per link
    hn_vec3 *base_w, *base_al; ///< per group, in F
    /// per group: F to the theta-free frame of its base (of a ball: of its parent)
    hn_mat3 *group_X;
    hn_mat3 *to_world; ///< per group: F to world
    hn_vec3 *position; ///< per link: joint point in the world
    int *path;         ///< scratch, n_links
    int *place_row; ///< per cut joint: the first of its three position rows, -1: it has not three
    int *passed;    ///< per link: closures whose loop it is part of
} hn_mech;

/// Returns whether the link's work frame is F.
bool hn_mech_is_planar(const hn_mech *m, int link);
hn_vec3 hn_mech_E_to_work(const hn_mech *m, int link, hn_vec3 v);
hn_vec3 hn_mech_work_to_E(const hn_mech *m, int link, hn_vec3 v);
/// Work frame of a link to that of its parent, and back.
hn_vec3 hn_mech_up(const hn_mech *m, int link, hn_vec3 v);
hn_vec3 hn_mech_down(const hn_mech *m, int link, hn_vec3 v);
/// A cross product where the link can only use the z component of moments, a whole one elsewhere.
hn_vec3 hn_mech_moment(const hn_mech *m, int link, hn_vec3 r, hn_vec3 f);
/// Prismatic: direction in the work frame (its own and its parent's).
hn_vec3 hn_mech_slide(const hn_mech *m, int link);
/// The position behind a velocity that has one of its own.
hn_ex hn_mech_q(const hn_mech *m, int coordinate);
/// The arm from the link's joint point to a point that is given in the body's own axes, in E.
HN_MUST_CHECK hn_status hn_mech_arm_of(const hn_mech *m, int link, const hn_quantity *at,
                                       hn_vec3 *out);
/// The position in the world of a point at `arm`.
hn_vec3 hn_mech_world(const hn_mech *m, int link, hn_vec3 arm);

HN_MUST_CHECK hn_status hn_mech_trace_geometry(hn_mech *m); ///< arms, own bodies, world positions
void hn_mech_trace_composites(hn_mech *m); ///< inward: masses, moments and inertias of subtrees
void hn_mech_trace_mass(hn_mech *m);       ///< sys->M

#endif
