// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/tree.h"

#include <stdbool.h>

static const hn_quantity ORIGIN[3]; // of a virtual link

const hn_quantity *hn_link_at_own(const hn_scene *scene, const hn_link *link) {
    const hn_joint *joint = &scene->joints[link->joint];
    return link->is_virtual ? ORIGIN : link->reversed ? joint->parent_at : joint->child_at;
}

const hn_quantity *hn_link_at_parent(const hn_scene *scene, const hn_link *link) {
    const hn_joint *joint = &scene->joints[link->joint];
    return !link->is_first ? ORIGIN : link->reversed ? joint->child_at : joint->parent_at;
}

// clang-format off
static const struct {
    int n;
    hn_primitive list[HN_MAX_PRIMITIVES]; // type, axis, first coordinate
} CHAINS[HN_JOINT_TYPE_COUNT] = {
    [HN_JOINT_REVOLUTE]    = {1, {{HN_JOINT_REVOLUTE, 2, 0}}},
    [HN_JOINT_PRISMATIC]   = {1, {{HN_JOINT_PRISMATIC, 2, 0}}},
    [HN_JOINT_CYLINDRICAL] = {2, {{HN_JOINT_PRISMATIC, 2, 1}, {HN_JOINT_REVOLUTE, 2, 0}}},
    [HN_JOINT_UNIVERSAL]   = {2, {{HN_JOINT_REVOLUTE, 2, 0}, {HN_JOINT_REVOLUTE, 0, 1}}},
    [HN_JOINT_SPHERICAL]   = {1, {{HN_JOINT_SPHERICAL, 2, 0}}},
    [HN_JOINT_PLANAR]      = {3, {{HN_JOINT_PRISMATIC, 0, 0}, {HN_JOINT_PRISMATIC, 1, 1},
                                  {HN_JOINT_REVOLUTE, 2, 2}}},
    [HN_JOINT_FIXED]       = {1, {{HN_JOINT_FIXED, 2, 0}}},
    [HN_JOINT_FREE]        = {4, {{HN_JOINT_PRISMATIC, 0, 0}, {HN_JOINT_PRISMATIC, 1, 1},
                                  {HN_JOINT_PRISMATIC, 2, 2}, {HN_JOINT_SPHERICAL, 2, 3}}},
};
// clang-format on

int hn_joint_primitives(hn_joint_type type, const hn_primitive **out) {
    *out = CHAINS[type].list;
    return CHAINS[type].n;
}

bool hn_tree_is_still(const hn_tree *tree, int link) {
    return tree->links[link].angle < 0 && !tree->groups[tree->links[link].group].moving;
}

int hn_tree_depth(const hn_tree *tree, int body) {
    int depth = 0;
    for (int l = hn_tree_link(tree, body); l != tree->ground; l = tree->links[l].parent) {
        depth += !tree->links[l].is_virtual;
    }
    return depth;
}

int hn_tree_link(const hn_tree *tree, int body) {
    return body == HN_GROUND ? tree->ground : body;
}

int hn_tree_common(const hn_tree *tree, int a, int b) {
    while (a != b) {
        if (tree->links[a].depth >= tree->links[b].depth) {
            a = tree->links[a].parent;
        } else {
            b = tree->links[b].parent;
        }
    }
    return a;
}
