// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_TREE_H
#define HN_DYNAMICS_TREE_H
// The spanning tree of a scene, and the frames that its equations are written in, as numbers.
//
// Links are the bodies 0 .. nb-1, the ground (index nb) and virtual links behind it. A link hangs
// from its parent by one PRIMITIVE joint: revolute, prismatic, spherical (a ball) or fixed. A joint
// of the scene with more degrees of freedom is a chain of primitives through virtual links, which
// have no mass and stand in the joint's own axes; the end of the chain is the body. The tree has
// the least depth in bodies (breadth first from the ground, ties by the order of the joints); the
// joints left over close loops.
//
//     cylindrical  slide z, turn z        universal  turn z, turn x        spherical  ball
//     planar       slide x, y, turn z     free       slide x, y, z, ball   fixed      as its parent
//
// GROUPS. Along consecutive parallel revolute axes absolute angles make M sparse and the closure
// rows short, so links are collected into groups: all revolute links whose axes are parallel and
// that hang, directly or through one another, from one rotating base (prismatic joints pass
// rotation through). A group's frame F is fixed in its base, z along the axis; one base and one
// axis direction always share one group. A link's orientation in F is Rz(theta) C with theta an
// absolute angle (the SYSTEM coordinate) and C constant. Links that never rotate have theta = 0 and
// use the first ground group's frame.
//
// BALLS. A ball has four entries of q, a unit quaternion (the joint's child against its parent, in
// the joint's axes), and three velocities, the angular velocity of the joint's child against its
// parent in the joint's axes on the child. It is a group of its own: the frame is fixed in the link
// itself (theta = 0), and what takes it to the parent is an expression of the quaternion.
//
//        ground --revolute--> crank --revolute--> coupler --prismatic--> slider --revolute--> flap
//        base               first of group      same group         rigid with it       same group

#include "scene/scene.h"

#include <stdbool.h>

/// Dependence of a link's rotation on its parent's.
typedef enum hn_carry {
    /// revolute, in its parent's group: an absolute angle, so the parent's rotation does not carry
    /// it
    HN_CARRY_GROUP,
    /// a ball, or the first revolute of a group: the rotation of the group's base carries it
    HN_CARRY_NEW,
    HN_CARRY_RIGID ///< prismatic or fixed: turns exactly as the parent does
} hn_carry;

typedef struct hn_link {
    int parent; ///< link, -1 for the ground
    int joint;  ///< scene joint, -1 for the ground
    /// scene body; of a virtual link, the body at the end of its chain; -1 for the ground
    int body;
    bool is_virtual;    ///< not the body yet: inside the chain of a joint
    bool is_first;      ///< the first link of its chain
    hn_joint_type type; ///< primitive: revolute, prismatic, spherical or fixed
    hn_carry carry;
    bool reversed; ///< the joint's own parent is this link
    int depth;
    int first_child, next_sibling, last_child; ///< links, -1 ends
    int coordinate; ///< its (first) velocity, -1 for the ground and fixed links
    int n_speeds;   ///< 0, 1, or 3 of a ball
    int part;       ///< which of the scene joint's coordinates is its first
    int position;   ///< its first entry of q, -1
    /// the primitive's axes (z: along or about) on the parent, and on the link itself
    double here[3][3], there[3][3];
    int angle; ///< velocity whose position is theta, -1: theta is 0
    /// revolute: coordinate of the angle that the joint's own angle is counted from, -1: none
    int angle_ref;
    double sign, offset; ///< user coordinate = sign * (q[coordinate] - q[angle_ref] - offset)
    int group;           ///< frame its vectors are in; for the ground too
    int root; ///< the link whose rotation it shares (itself, or up through prismatic joints)
    /// body frame to the frame that theta turns; ground: world to its group's frame
    double C[3][3];
} hn_link;

typedef struct hn_group {
    int base;    ///< link whose rotation carries the frame (a root); nb: the ground; a ball: itself
    bool moving; ///< the base rotates
    int ball;    ///< the link whose own frame it is, -1
    double R[3][3]; ///< frame to base body axes
    /// frame to the base's theta-free frame: C(base) R; ball: axes `here` to that of the parent
    double X[3][3];
    int n_links;
} hn_group;

typedef struct hn_tree {
    int n_links; ///< bodies, ground, virtual ones
    int ground;  ///< nb
    hn_link *links;
    int n_order;
    int *order; ///< all links but the ground, parents first
    int n_groups;
    hn_group *groups;
    int n_cut;
    int *cut;          ///< scene joints that close loops, in scene order
    int *joint_cut;    ///< per scene joint: index into cut, or -1
    int n_coordinates; ///< velocities
    int n_positions;   ///< entries of q
    int *user;         ///< per velocity: scene coordinate
    int *link_of;      ///< per velocity: link
    int *position;     ///< per velocity: entry of q, -1 for the velocities of a ball
} hn_tree;

/// Lowest common ancestor of two links.
int hn_tree_common(const hn_tree *tree, int a, int b);
/// Link of a scene body (HN_GROUND: the ground).
int hn_tree_link(const hn_tree *tree, int body);
/// Returns whether the link never rotates against the ground.
bool hn_tree_is_still(const hn_tree *tree, int link);
/// The number of bodies between a body and the ground along the tree, itself included.
int hn_tree_depth(const hn_tree *tree, int body);
/// One link of the chain that a joint type stands for.
typedef struct hn_primitive {
    hn_joint_type type;
    int along; ///< 0, 1, 2: x (ref), y, z (axis) of the joint
    int part;  ///< which of the joint's coordinates is its first
} hn_primitive;
enum { HN_MAX_PRIMITIVES = 4 };
/// The chain of primitives of a joint type, from the joint's parent to its child; returns how many.
int hn_joint_primitives(hn_joint_type type, const hn_primitive **out);
/// Returns the place of a tree joint on the link itself, and on its parent: 3 quantities in the
/// body's frame.
const hn_quantity *hn_link_at_own(const hn_scene *scene, const hn_link *link);
const hn_quantity *hn_link_at_parent(const hn_scene *scene, const hn_link *link);
#endif
