// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/tree.h"

#include "dynamics/compile/vec3.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// |sin| of the angle between axes that count as parallel [-]
static const double PARALLEL = 1e-12;
/// a component this small against the vector counts as zero [-]
static const double ALIGNED = 1e-12;

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

// ---- the tree itself ----

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
                "body '%s' hangs on joints marked \"cut\" only, so nothing carries it",
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

// ---- frames ----

static void apply(double m[3][3], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = hn_num3_dot(m[i], v);
    }
}

static void unit(double v[3]) {
    double length = sqrt(hn_num3_dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

/// A frame with z along `axis` (its sign chosen so that the largest component is positive). Its x
/// axis: for an axis along a coordinate axis the next coordinate axis; else perpendicular to
/// `prefer` if that is given and not parallel, such that the part of `prefer` across the axis lies
/// along -y (gravity then has one component); else any.
static void frame_about(const double axis[3], const double *prefer, double R[3][3]) {
    int big = 0;
    for (int i = 1; i < 3; i++) {
        big = fabs(axis[i]) >= fabs(axis[big]) - ALIGNED ? i : big;
    }

    // z along the axis
    double z[3], x[3] = {0, 0, 0}, y[3];
    for (int i = 0; i < 3; i++) {
        z[i] = axis[big] < 0 ? -axis[i] : axis[i];
    }

    // the part of `prefer` across the axis
    double across[3];
    double length = 0;
    if (prefer) {
        double along = hn_num3_dot(prefer, z);
        for (int i = 0; i < 3; i++) {
            across[i] = prefer[i] - along * z[i];
        }
        length = sqrt(hn_num3_dot(across, across) / fmax(hn_num3_dot(prefer, prefer), 1e-300));
    }

    // x by the rule above
    if (fabs(z[big] - 1) < ALIGNED || length < 1e-6) {
        x[(big + 1) % 3] = 1;
        double along = hn_num3_dot(x, z);
        for (int i = 0; i < 3; i++) {
            x[i] -= along * z[i];
        }
    } else {
        hn_num3_cross(z, across, x); // -across = y, so x = y x z = z x across
    }

    // y completes the frame
    unit(x);
    hn_num3_cross(z, x, y);
    for (int i = 0; i < 3; i++) {
        R[i][0] = x[i];
        R[i][1] = y[i];
        R[i][2] = z[i];
    }
    hn_num3_snap(R, HN_NUM3_SNAP);
}

static bool parallel(const double a[3], const double b[3]) {
    double c[3];
    hn_num3_cross(a, b, c);
    return hn_num3_dot(c, c) < PARALLEL * PARALLEL;
}

/// The group of `base` about `axis` (in the base's body axes), made if it is new.
static int find_group(const hn_scene *scene, hn_tree *tree, int base, const double axis[3]) {
    for (int k = 0; k < tree->n_groups; k++) {
        hn_group *group = &tree->groups[k];
        double z[3] = {group->R[0][2], group->R[1][2], group->R[2][2]};
        if (group->ball < 0 && group->base == base && parallel(z, axis)) {
            return k;
        }
    }

    // a new group
    hn_group *group = &tree->groups[tree->n_groups];
    group->base = base;
    group->ball = -1;
    group->moving = base != tree->ground;

    double gravity[3], own[3];
    for (int i = 0; i < 3; i++) {
        gravity[i] = scene->gravity[i].value;
        own[i] = tree->links[base].C[2][i]; // the base's own axis in its body axes
    }

    frame_about(axis, group->moving ? own : gravity, group->R);
    if (tree->n_groups == 0) { // the ground's own vectors use the first ground group's frame
        hn_num3_transpose(group->R, tree->links[tree->ground].C);
    }
    hn_num3_compose(tree->links[base].C, group->R, group->X);
    return tree->n_groups++;
}

/// The first arm of the body across the axis, in the frame that D gives: other joints first, then
/// the centre of mass.
static bool main_arm(const hn_scene *scene, int body, int joint, double D[3][3],
                     const hn_quantity *own, double arm[2]) {
    for (int j = -1; j < scene->n_joints; j++) {
        int k = j + 1 < scene->n_joints ? j + 1 : -1; // the joints, and the centre of mass last

        const hn_quantity *at = scene->bodies[body].com;
        if (k >= 0) {
            const hn_joint *other = &scene->joints[k];
            if (k == joint || (other->parent != body && other->child != body)) {
                continue;
            }
            at = other->parent == body ? other->parent_at : other->child_at;
        }

        // from the link's own joint, in the frame that D gives
        double r[3], v[3];
        for (int i = 0; i < 3; i++) {
            r[i] = at[i].value - own[i].value;
        }
        apply(D, r, v);
        if (hypot(v[0], v[1]) > 1e-9) {
            arm[0] = v[0];
            arm[1] = v[1];
            return true;
        }
    }
    return false;
}

static bool is_aligned(const double arm[2], double turned) {
    double x = fabs(cos(turned) * arm[0] - sin(turned) * arm[1]);
    double y = fabs(sin(turned) * arm[0] + cos(turned) * arm[1]);
    return fmin(x, y) < ALIGNED * fmax(x, y);
}

/// Where the link's angle counts from. theta = theta(ref) + sigma q + offset, C = Rz(delta -
/// offset) D.
static void choose_offset(const hn_scene *scene, hn_link *link, int body, double delta,
                          double D[3][3], int align) {
    double arm[2];
    link->offset = 0;
    if (!align || link->is_virtual ||
        !main_arm(scene, body, link->joint, D, hn_link_at_own(scene, link), arm) ||
        is_aligned(arm, delta)) {
        return;
    }
    if (is_aligned(arm, 0)) {
        link->offset = delta; // the angle of the body's own axes
    } else {
        link->offset = remainder(delta + atan2(arm[1], arm[0]), 2 * M_PI);
    }
}

/// Orientation of a revolute link in its group's frame: N Rz(s q) Ch' with N = Rz(delta) D0, D0 the
/// identity or a half turn about x (which reverses the sense of q).
static void place_revolute(const hn_scene *scene, hn_link *link, int body, double N[3][3],
                           double child[3][3], int align) {
    double sigma = N[2][2] < 0 ? -1 : 1;
    double delta = atan2(N[1][0], N[0][0]);
    double D0[3][3] = {{1, 0, 0}, {0, sigma, 0}, {0, 0, sigma}}, back[3][3], D[3][3];
    hn_num3_transpose(child, back);
    hn_num3_compose(D0, back, D);
    link->sign = sigma * (link->reversed ? -1 : 1);
    choose_offset(scene, link, body, delta, D, align);
    double turn = delta - link->offset;
    double Rz[3][3] = {{cos(turn), -sin(turn), 0}, {sin(turn), cos(turn), 0}, {0, 0, 1}};
    hn_num3_snap(Rz, HN_NUM3_SNAP);
    hn_num3_compose(Rz, D, link->C);
}

/// A link that turns as its parent does; N is the primitive's axes in the parent's theta-free
/// frame.
static void place_rigid(hn_tree *tree, hn_link *link, double N[3][3]) {
    const hn_link *parent = &tree->links[link->parent];
    double back[3][3];
    link->carry = HN_CARRY_RIGID;
    link->angle_ref = -1;
    link->angle = parent->angle;
    link->group = parent->group;
    link->root = parent->root;
    hn_num3_transpose(link->there, back);
    hn_num3_compose(N, back, link->C);
}

/// A ball: a group of its own, in the joint's axes on the link.
static void place_ball(hn_tree *tree, int index, double N[3][3]) {
    hn_link *link = &tree->links[index];
    link->carry = HN_CARRY_NEW;
    link->angle = link->angle_ref = -1;
    link->root = index;
    link->group = tree->n_groups++;
    hn_group *group = &tree->groups[link->group];
    *group = (hn_group){.base = index, .moving = 1, .ball = index, .n_links = 1};
    memcpy(group->R, link->there, sizeof group->R);
    memcpy(group->X, N, sizeof group->X);
    hn_num3_transpose(link->there, link->C);
}

static void place_link(const hn_scene *scene, hn_tree *tree, int index, int align) {
    hn_link *link = &tree->links[index], *parent = &tree->links[link->parent];
    double N[3][3], back[3][3];
    hn_num3_compose(parent->C, link->here, N);

    // primitives that do not revolve
    if (link->type == HN_JOINT_PRISMATIC || link->type == HN_JOINT_FIXED) {
        place_rigid(tree, link, N);
        return;
    }
    if (link->type == HN_JOINT_SPHERICAL) {
        place_ball(tree, index, N);
        return;
    }

    double axis[3] = {N[0][2], N[1][2], N[2][2]};
    static const double Z[3] = {0, 0, 1};

    // the parent's group if the axis is parallel, else one on the parent's base
    link->root = index;
    link->angle = link->coordinate;
    if (parent->angle >= 0 && parallel(axis, Z)) {
        link->carry = HN_CARRY_GROUP;
        link->group = parent->group;
        link->angle_ref = parent->angle;
    } else {
        link->carry = HN_CARRY_NEW;
        link->angle_ref = -1;

        // the axis as the base sees it
        double in_base[3], to_base[3][3];
        hn_num3_transpose(tree->links[parent->root].C, to_base);
        apply(to_base, axis, in_base);
        link->group = find_group(scene, tree, parent->root, in_base);

        // the primitive's axes in the group's frame
        double turned[3][3];
        hn_num3_transpose(tree->groups[link->group].X, back);
        hn_num3_compose(parent->C, link->here, N); // the ground's C may just have been chosen
        hn_num3_compose(back, N, turned);
        memcpy(N, turned, sizeof turned);
    }

    tree->groups[link->group].n_links++;
    place_revolute(scene, link, link->body, N, link->there, align);
}

/// The frame of everything that does not rotate: that of the first revolute axis that hangs on it.
static void choose_ground_frame(const hn_scene *scene, hn_tree *tree) {
    for (int k = 0; k < tree->n_order; k++) {
        int index = tree->order[k];
        hn_link *link = &tree->links[index], *parent = &tree->links[link->parent];
        if (parent->root != tree->ground || link->type == HN_JOINT_SPHERICAL) {
            link->root = index; // behind a ball
            continue;
        }
        if (link->type == HN_JOINT_REVOLUTE) {
            double N[3][3]; // C is the world orientation so far
            hn_num3_compose(parent->C, link->here, N);
            double axis[3] = {N[0][2], N[1][2], N[2][2]};
            (void)find_group(scene, tree, tree->ground, axis);
            return;
        }
        place_link(scene, tree, index, 0);
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
                "a free joint closes nothing, and both bodies of '%s' hang on other "
                "joints already",
                joint->name);
        }
    }
    return HN_OK;
}

hn_status hn_tree_build(const hn_scene *scene, int align, hn_arena *arena, hn_tree *tree,
                        hn_diags *diags) {
    HN_TRY(allocate(scene, arena, tree));
    HN_TRY(span(scene, arena, tree, diags));
    choose_ground_frame(scene, tree);
    number_coordinates(scene, tree);
    if (tree->n_groups == 0) { // nothing revolves: the world's own axes
        static const double Z[3] = {0, 0, 1};
        (void)find_group(scene, tree, tree->ground, Z);
    }
    for (int k = 0; k < tree->n_order; k++) {
        place_link(scene, tree, tree->order[k], align);
    }
    return check_cuts(scene, tree, diags);
}
