// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/tree_build.h"

#include "dynamics/compile/tree_frames.h"
#include "dynamics/compile/vec3.h"

#include <stdbool.h>
#include <string.h>

/// Axes of a joint on one side as columns: ref, axis x ref, axis.
static void joint_triad(const double axis[3], const double ref[3], double out[3][3]) {
    double y[3];
    hn_num3_cross(axis, ref, y);
    for (int i = 0; i < 3; i++) {
        out[i][0] = ref[i];
        out[i][1] = y[i];
        out[i][2] = axis[i];
    }
    hn_num3_snap(out, HN_NUM3_SNAP);
}

/// Columns of a triad turned round so that the last is the axis `along`.
static void primitive_triad(double triad[3][3], int along, double out[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            out[i][k] = triad[i][(along + 1 + k) % 3];
        }
    }
}

static void hang_link(hn_tree *tree, int child, int parent) {
    hn_link *link = &tree->links[child];
    link->parent = parent;
    link->depth = tree->links[parent].depth + 1;
    if (tree->links[parent].last_child < 0) {
        tree->links[parent].first_child = child;
    } else {
        tree->links[tree->links[parent].last_child].next_sibling = child;
    }
    tree->links[parent].last_child = child;
    tree->order[tree->n_order++] = child;
}

/// Hangs a body from `parent` by the joint's chain of primitives, gone through backwards where the
/// body is the joint's parent.
static void hang(const hn_scene *scene, hn_tree *tree, int body, int parent, int index,
                 int reversed) {
    const hn_joint *joint = &scene->joints[index];
    const hn_primitive *chain;
    const int n = hn_joint_primitives(joint->type, &chain);

    // axes at both ends of the chain, the near one first
    double own[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, ends[2][3][3];
    joint_triad(joint->parent_axis, joint->parent_ref, ends[reversed]);
    joint_triad(joint->child_axis, joint->child_ref, ends[!reversed]);

    // a virtual link for each primitive but the last, which is the body
    for (int k = 0; k < n; k++) {
        const hn_primitive *primitive = &chain[reversed ? n - 1 - k : k];
        const int last = k == n - 1, at = last ? body : tree->n_links++;

        hn_link *link = &tree->links[at];
        link->joint = index;
        link->body = body;
        link->is_first = k == 0;
        link->is_virtual = !last;
        link->reversed = reversed;
        link->type = primitive->type;
        link->part = primitive->part;
        link->n_speeds = primitive->type == HN_JOINT_SPHERICAL ? 3
                         : primitive->type == HN_JOINT_FIXED   ? 0
                                                               : 1;

        // the near and the far end have the joint's axes, virtual links their own
        primitive_triad(k == 0 ? ends[0] : own, primitive->along, link->here);
        primitive_triad(last ? ends[1] : own, primitive->along, link->there);
        hang_link(tree, at, parent);
        parent = at;
    }
}

/// Joints that touch each link, in scene order: list[start[l]] .. list[start[l + 1] - 1].
static bool collect_incident(const hn_scene *scene, const hn_tree *tree, hn_arena *arena,
                             int **start, int **list) {
    *start = hn_arena_ints(arena, (size_t)tree->ground + 3);
    *list = hn_arena_ints(arena, 2 * (size_t)scene->n_joints + 1);
    if (!*start || !*list) {
        return false;
    }

    // count the joints of each link, then list them
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < scene->n_joints; j++) {
            int ends[2] = {hn_tree_link(tree, scene->joints[j].parent),
                           hn_tree_link(tree, scene->joints[j].child)};
            for (int e = 0; e < 2; e++) {
                // counts to first places
                if (pass == 0) {
                    (*start)[ends[e] + 2]++;
                } else {
                    (*list)[(*start)[ends[e] + 1]++] = j;
                }
            }
        }
        if (pass == 0) {
            for (int l = 0; l <= tree->ground + 1; l++) {
                (*start)[l + 1] += (*start)[l];
            }
        }
    }
    return true;
}

static hn_status span(const hn_scene *scene, hn_arena *arena, hn_tree *tree, hn_diags *diags) {
    int *start, *list;
    int *queue = hn_arena_ints(arena, (size_t)tree->ground + 1);
    if (!queue || !collect_incident(scene, tree, arena, &start, &list)) {
        return HN_ERR_MEMORY;
    }

    // breadth first from the ground
    int n_queue = 0;
    queue[n_queue++] = tree->ground;
    for (int at = 0; at < n_queue; at++) {
        int here = queue[at];
        for (int k = start[here]; k < start[here + 1]; k++) {
            const hn_joint *joint = &scene->joints[list[k]];
            int reversed = hn_tree_link(tree, joint->parent) != here;
            int there = hn_tree_link(tree, reversed ? joint->parent : joint->child);
            if (joint->cut || there == tree->ground || tree->links[there].joint >= 0) {
                continue;
            }
            hang(scene, tree, there, here, list[k], reversed);
            queue[n_queue++] = there;
        }
    }

    // every body must hang by some joint
    for (int b = 0; b < tree->ground; b++) {
        if (tree->links[b].joint < 0) {
            return hn_diags_add(
                diags, HN_ERR_INPUT, scene->bodies[b].pointer,
                "mark another joint of its loop as the cut",
                "all joints of body '%s' are marked \"cut\", so no joint carries it",
                scene->bodies[b].name);
        }
    }
    return HN_OK;
}

/// The link of a joint's freedom `part`, or -1 where the joint is cut. `body_of` per joint: the
/// body it carries, or -1.
static int link_of_part(const hn_tree *tree, const int *body_of, int joint, int part) {
    for (int l = body_of[joint]; l >= 0 && tree->links[l].joint == joint;
         l = tree->links[l].parent) {
        const hn_link *link = &tree->links[l];
        if (part >= link->part && part < link->part + link->n_speeds) {
            return l;
        }
    }
    return -1;
}

/// Coordinates follow the order of the scene's own.
static void number_coordinates(const hn_scene *scene, hn_tree *tree) {
    int *body_of = tree->joint_cut; // borrowed until the cuts are listed
    for (int j = 0; j < scene->n_joints; j++) {
        body_of[j] = -1;
    }
    for (int b = 0; b < tree->ground; b++) {
        body_of[tree->links[b].joint] = b;
    }

    // velocities in the order of the scene's coordinates
    for (int i = 0; i < scene->n_coordinates; i++) {
        const hn_coordinate *c = &scene->coordinates[i];
        const int at = c->joint >= 0 ? link_of_part(tree, body_of, c->joint, c->part) : -1;
        if (at < 0) {
            continue;
        }
        hn_link *link = &tree->links[at];
        const int n = tree->n_coordinates++;
        tree->user[n] = i;
        tree->link_of[n] = at;
        tree->position[n] = link->n_speeds == 1 ? tree->n_positions : -1;
        if (c->part == link->part) {
            link->coordinate = n;
            link->position = tree->n_positions;
            tree->n_positions += link->n_speeds == 3 ? 4 : 1;
        }
    }

    // joints that carry no body close loops
    for (int j = 0; j < scene->n_joints; j++) {
        int is_cut = body_of[j] < 0;
        tree->joint_cut[j] = is_cut ? tree->n_cut : -1;
        if (is_cut) {
            tree->cut[tree->n_cut++] = j;
        }
    }
}

/// Links that the joints' chains add at most: a body hangs by one joint, whichever.
static size_t count_virtual(const hn_scene *scene) {
    size_t n = 0;
    for (int j = 0; j < scene->n_joints; j++) {
        const hn_primitive *chain;
        n += (size_t)(hn_joint_primitives(scene->joints[j].type, &chain) - 1);
    }
    return n;
}

static hn_status allocate(const hn_scene *scene, hn_arena *arena, hn_tree *tree) {
    const size_t nb = (size_t)scene->n_bodies, nj = (size_t)scene->n_joints;
    const size_t nl = nb + 1 + count_virtual(scene), nu = (size_t)scene->n_coordinates + 1;
    memset(tree, 0, sizeof *tree);
    tree->n_links = scene->n_bodies + 1;
    tree->ground = scene->n_bodies;

    tree->links = hn_arena_get(arena, nl * sizeof *tree->links);
    tree->groups = hn_arena_get(arena, (nl + 1) * sizeof *tree->groups);
    tree->order = hn_arena_ints(arena, nl);
    tree->cut = hn_arena_ints(arena, nj + 1);
    tree->joint_cut = hn_arena_ints(arena, nj + 1);
    tree->user = hn_arena_ints(arena, nu);
    tree->link_of = hn_arena_ints(arena, nu);
    tree->position = hn_arena_ints(arena, nu);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // links that hang nowhere yet
    for (size_t l = 0; l < nl; l++) {
        hn_link *link = &tree->links[l];
        link->body = link->position = -1;
        link->parent = link->joint = link->first_child = link->next_sibling = link->last_child = -1;
        link->coordinate = link->angle = link->angle_ref = -1;
        link->sign = 1;
        link->root = tree->ground;
        for (int i = 0; i < 3; i++) {
            link->C[i][i] = 1;
        }
    }
    return HN_OK;
}

static hn_status check_cuts(const hn_scene *scene, const hn_tree *tree, hn_diags *diags) {
    for (int k = 0; k < tree->n_cut; k++) {
        const hn_joint *joint = &scene->joints[tree->cut[k]];
        if (joint->type == HN_JOINT_FREE) {
            return hn_diags_add(
                diags, HN_ERR_INPUT, joint->pointer, "leave it out",
                "the free joint '%s' has no effect: other joints already carry both its bodies",
                joint->name);
        }
    }
    return HN_OK;
}

hn_status hn_tree_build(const hn_scene *scene, bool align, hn_arena *arena, hn_tree *tree,
                        hn_diags *diags) {
    HN_TRY(allocate(scene, arena, tree));
    HN_TRY(span(scene, arena, tree, diags));
    hn_tree_choose_ground_frame(scene, tree);
    number_coordinates(scene, tree);
    hn_tree_place_links(scene, tree, align);
    return check_cuts(scene, tree, diags);
}
