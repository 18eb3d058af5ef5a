#ifndef HN_DYNAMICS_TREE_H
#define HN_DYNAMICS_TREE_H
// The spanning tree of a scene and the frames its equations are written in. Numbers only, no expressions.
//
// Links are the bodies 0 .. nb-1 and the ground (index nb). A link hangs from its parent by one tree joint; the joints left over
// close loops. The tree has the least depth (breadth first from the ground, ties by the order of the joints).
//
// GROUPS. Along consecutive parallel revolute axes absolute angles make M sparse and the closure rows short, so links
// are collected into groups: all revolute links whose axes are parallel and that hang, directly or through one another, from
// one rotating base (prismatic joints pass rotation through). A group's frame F is fixed in its base, z along the axis;
// one base and one axis direction always share one group. A link's orientation in F is Rz(theta) C with theta an absolute
// angle (the SYSTEM coordinate) and C constant. Links that never rotate have theta = 0 and use the first ground group's frame.
//
//        ground --revolute--> crank --revolute--> coupler --prismatic--> slider --revolute--> flap
//        base                 first of group      same group             rigid with coupler   same group

#include "base/arena.h"
#include "base/diag.h"
#include "scene/scene.h"

/// How a link's rotation hangs on its parent's.
typedef enum hn_carry {
    HN_CARRY_GROUP, ///< revolute, same group as the parent: the parent's rotation does not carry it
    HN_CARRY_NEW,   ///< revolute, first of a group whose base rotates with the parent: carried
    HN_CARRY_RIGID  ///< prismatic: turns exactly as the parent does
} hn_carry;

typedef struct hn_link {
    int parent; ///< link, -1 for the ground
    int joint;  ///< scene joint, -1 for the ground
    hn_joint_type type;
    hn_carry carry;
    int reversed; ///< the joint's own parent is this link
    int depth;
    int first_child, next_sibling, last_child; ///< links, -1 ends
    int coordinate;                            ///< system coordinate, -1 for the ground
    int angle; ///< system coordinate that is theta, -1 when the link never rotates
    int angle_ref; ///< revolute: coordinate of the angle that the joint's own angle is counted from, -1: none
    double sign, offset; ///< user coordinate = sign * (q[coordinate] - q[angle_ref] - offset)
    int group;           ///< frame its vectors are in; for the ground too
    int root; ///< the link whose rotation it shares (itself, or up through prismatic joints)
    double C[3]
            [3]; ///< body frame to the frame that theta turns; ground: world to its group's frame
} hn_link;

typedef struct hn_group {
    int base;       ///< link whose rotation carries the frame (a root); nb: the ground
    int moving;     ///< the base rotates
    double R[3][3]; ///< frame to base body axes
    double X[3][3]; ///< frame to the base's theta-free frame: C(base) R
    int n_links;
} hn_group;

typedef struct hn_tree {
    int n_links; ///< nb + 1
    int ground;  ///< nb
    hn_link *links;
    int *order; ///< nb links, parents first
    int n_groups;
    hn_group *groups;
    int n_cut;
    int *cut;       ///< scene joints that close loops, in scene order
    int *joint_cut; ///< per scene joint: index into cut, or -1
    int n_coordinates;
    int *user;    ///< per system coordinate: scene coordinate
    int *link_of; ///< per system coordinate: link
} hn_tree;

/// `align`: turn angles' zero so that a body's arms lie along its axes (off for equations that people read: an absolute angle is then a plain sum of the scene's). Memory from
/// `arena`. Fails: HN_ERR_INPUT when joints marked "cut" leave a body hanging, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_tree_build(const hn_scene *scene, int align, hn_arena *arena,
                                      hn_tree *out, hn_diags *diags);

/// Lowest common ancestor of two links.
int hn_tree_common(const hn_tree *tree, int a, int b);
/// Link of a scene body (HN_GROUND: the ground).
int hn_tree_link(const hn_tree *tree, int body);
/// Where a tree joint sits on the link itself, and on its parent; `at` are 3 quantities in the body's own frame.
const hn_quantity *hn_link_at_own(const hn_scene *scene, const hn_link *link);
const hn_quantity *hn_link_at_parent(const hn_scene *scene, const hn_link *link);
/// The joint's axis on its parent's side.
const double *hn_link_parent_axis(const hn_scene *scene, const hn_link *link);
#endif
