// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/tree_frames.h"

#include "dynamics/compile/vec3.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// |sin| of the angle between axes that count as parallel [-]
static const double PARALLEL = 1e-12;
/// a component this small against the vector counts as zero [-]
static const double ALIGNED = 1e-12;

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

/// Finds where the link's angle counts from. theta = theta(ref) + sigma q + offset, C = Rz(delta -
/// offset) D.
static void choose_offset(const hn_scene *scene, hn_link *link, int body, double delta,
                          double D[3][3], bool align) {
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
                           double child[3][3], bool align) {
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

static void place_link(const hn_scene *scene, hn_tree *tree, int index, bool align) {
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

void hn_tree_choose_ground_frame(const hn_scene *scene, hn_tree *tree) {
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

void hn_tree_place_links(const hn_scene *scene, hn_tree *tree, bool align) {
    // where nothing revolves, the world's own axes
    if (tree->n_groups == 0) {
        static const double Z[3] = {0, 0, 1};
        (void)find_group(scene, tree, tree->ground, Z);
    }

    for (int k = 0; k < tree->n_order; k++) {
        place_link(scene, tree, tree->order[k], align);
    }
}
