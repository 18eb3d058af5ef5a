#include "dynamics/tree.h"
#include "dynamics/vec3.h"

#include <math.h>
#include <string.h>

static const double PARALLEL =
    1e-12; ///< |sin| of the angle between axes that count as parallel [-]
static const double ALIGNED =
    1e-12; ///< a component this small against the vector counts as zero [-]

const hn_quantity *hn_link_at_own(const hn_scene *scene, const hn_link *link) {
    const hn_joint *joint = &scene->joints[link->joint];
    return link->reversed ? joint->parent_at : joint->child_at;
}

const hn_quantity *hn_link_at_parent(const hn_scene *scene, const hn_link *link) {
    const hn_joint *joint = &scene->joints[link->joint];
    return link->reversed ? joint->child_at : joint->parent_at;
}

const double *hn_link_parent_axis(const hn_scene *scene, const hn_link *link) {
    const hn_joint *joint = &scene->joints[link->joint];
    return link->reversed ? joint->child_axis : joint->parent_axis;
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

// the tree itself ------------------------------------------------------------------------------------------

static void hang(hn_tree *tree, int child, int parent, int joint, int reversed,
                 hn_joint_type type) {
    hn_link *link = &tree->links[child];
    link->parent = parent;
    link->joint = joint;
    link->reversed = reversed;
    link->type = type;
    link->depth = tree->links[parent].depth + 1;
    if (tree->links[parent].last_child < 0) {
        tree->links[parent].first_child = child;
    } else {
        tree->links[tree->links[parent].last_child].next_sibling = child;
    }
    tree->links[parent].last_child = child;
}

/// Joints that touch each link, in scene order: list[start[l]] .. list[start[l + 1] - 1].
static int collect_incident(const hn_scene *scene, const hn_tree *tree, hn_arena *arena,
                            int **start, int **list) {
    *start = hn_arena_ints(arena, (size_t)tree->n_links + 2);
    *list = hn_arena_ints(arena, 2 * (size_t)scene->n_joints + 1);
    if (!*start || !*list) {
        return 0;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < scene->n_joints; j++) {
            int ends[2] = {hn_tree_link(tree, scene->joints[j].parent),
                           hn_tree_link(tree, scene->joints[j].child)};
            for (int e = 0; e < 2; e++) {
                if (pass == 0) {
                    (*start)[ends[e] + 2]++;
                } else {
                    (*list)[(*start)[ends[e] + 1]++] = j;
                }
            }
        }
        if (pass == 0) {
            for (int l = 0; l <= tree->n_links; l++) {
                (*start)[l + 1] += (*start)[l];
            }
        }
    }
    return 1;
}

static hn_status span(const hn_scene *scene, hn_arena *arena, hn_tree *tree, hn_diags *diags) {
    int *start, *list;
    int *queue = hn_arena_ints(arena, (size_t)tree->n_links);
    if (!queue || !collect_incident(scene, tree, arena, &start, &list)) {
        return HN_ERR_MEMORY;
    }
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
            hang(tree, there, here, list[k], reversed, joint->type);
            tree->order[n_queue - 1] = there;
            queue[n_queue++] = there;
        }
    }
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

/// Coordinates follow the order of the scene's own.
static void number_coordinates(const hn_scene *scene, hn_tree *tree) {
    int *link_of_joint = tree->joint_cut; // borrowed until the cuts are listed
    for (int j = 0; j < scene->n_joints; j++) {
        link_of_joint[j] = -1;
    }
    for (int b = 0; b < tree->ground; b++) {
        link_of_joint[tree->links[b].joint] = b;
    }
    int n = 0;
    for (int i = 0; i < scene->n_coordinates; i++) {
        int joint = scene->coordinates[i].joint;
        if (joint >= 0 && link_of_joint[joint] >= 0) {
            tree->user[n] = i;
            tree->link_of[n] = link_of_joint[joint];
            tree->links[link_of_joint[joint]].coordinate = n;
            n++;
        }
    }
    tree->n_coordinates = n;
    for (int j = 0; j < scene->n_joints; j++) {
        int is_cut = link_of_joint[j] < 0;
        tree->joint_cut[j] = is_cut ? tree->n_cut : -1;
        if (is_cut) {
            tree->cut[tree->n_cut++] = j;
        }
    }
}

// frames ---------------------------------------------------------------------------------------------------

/// Axes of a joint on one side as columns: ref, axis x ref, axis.
static void joint_triad(const double axis[3], const double ref[3], double out[3][3]) {
    double y[3];
    hn_num3_cross(axis, ref, y);
    for (int i = 0; i < 3; i++) {
        out[i][0] = ref[i];
        out[i][1] = y[i];
        out[i][2] = axis[i];
    }
    hn_num3_snap(out);
}

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

/// A frame with z along `axis` (its sign chosen so that the largest component is positive). Its x axis: for an axis along a
/// coordinate axis the next coordinate axis; else perpendicular to `prefer` if that is given and not parallel, such
/// that the part of `prefer` across the axis lies along -y (gravity then has one component); else any.
static void frame_about(const double axis[3], const double *prefer, double R[3][3]) {
    int big = 0;
    for (int i = 1; i < 3; i++) {
        big = fabs(axis[i]) >= fabs(axis[big]) - ALIGNED ? i : big;
    }
    double z[3], x[3] = {0, 0, 0}, y[3];
    for (int i = 0; i < 3; i++) {
        z[i] = axis[big] < 0 ? -axis[i] : axis[i];
    }
    double across[3];
    double length = 0;
    if (prefer) {
        double along = hn_num3_dot(prefer, z);
        for (int i = 0; i < 3; i++) {
            across[i] = prefer[i] - along * z[i];
        }
        length = sqrt(hn_num3_dot(across, across) / fmax(hn_num3_dot(prefer, prefer), 1e-300));
    }
    if (fabs(z[big] - 1) < ALIGNED || length < 1e-6) {
        x[(big + 1) % 3] = 1;
        double along = hn_num3_dot(x, z);
        for (int i = 0; i < 3; i++) {
            x[i] -= along * z[i];
        }
    } else {
        hn_num3_cross(z, across, x); // -across = y, so x = y x z = z x across
    }
    unit(x);
    hn_num3_cross(z, x, y);
    for (int i = 0; i < 3; i++) {
        R[i][0] = x[i];
        R[i][1] = y[i];
        R[i][2] = z[i];
    }
    hn_num3_snap(R);
}

static int parallel(const double a[3], const double b[3]) {
    double c[3];
    hn_num3_cross(a, b, c);
    return hn_num3_dot(c, c) < PARALLEL * PARALLEL;
}

/// The group of `base` about `axis` (in the base's body axes), made if it is new.
static int find_group(const hn_scene *scene, hn_tree *tree, int base, const double axis[3]) {
    for (int k = 0; k < tree->n_groups; k++) {
        hn_group *group = &tree->groups[k];
        double z[3] = {group->R[0][2], group->R[1][2], group->R[2][2]};
        if (group->base == base && parallel(z, axis)) {
            return k;
        }
    }
    hn_group *group = &tree->groups[tree->n_groups];
    group->base = base;
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
    hn_num3_mul(tree->links[base].C, group->R, group->X);
    return tree->n_groups++;
}

/// The first arm of the body across the axis, in the frame that D gives: other joints first, then the centre of mass.
static int main_arm(const hn_scene *scene, int body, int joint, double D[3][3],
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
        double r[3], v[3];
        for (int i = 0; i < 3; i++) {
            r[i] = at[i].value - own[i].value;
        }
        apply(D, r, v);
        if (hypot(v[0], v[1]) > 1e-9) {
            arm[0] = v[0];
            arm[1] = v[1];
            return 1;
        }
    }
    return 0;
}

static int is_aligned(const double arm[2], double turned) {
    double x = fabs(cos(turned) * arm[0] - sin(turned) * arm[1]);
    double y = fabs(sin(turned) * arm[0] + cos(turned) * arm[1]);
    return fmin(x, y) < ALIGNED * fmax(x, y);
}

/// Where the link's angle counts from. theta = theta(ref) + sigma q + offset, C = Rz(delta - offset) D.
static void choose_offset(const hn_scene *scene, hn_link *link, int body, double delta,
                          double D[3][3], int align) {
    double arm[2];
    link->offset = 0;
    if (!align || !main_arm(scene, body, link->joint, D, hn_link_at_own(scene, link), arm) ||
        is_aligned(arm, delta)) {
        return;
    }
    if (is_aligned(arm, 0)) {
        link->offset = delta; // the angle of the body's own axes
    } else {
        link->offset = remainder(delta + atan2(arm[1], arm[0]), 2 * M_PI);
    }
}

/// Orientation of a revolute link in its group's frame: N Rz(s q) Ch' with N = Rz(delta) D0, D0 the identity or a half turn
/// about x (which reverses the sense of q).
static void place_revolute(const hn_scene *scene, hn_link *link, int body, double N[3][3],
                           double child[3][3], int align) {
    double sigma = N[2][2] < 0 ? -1 : 1;
    double delta = atan2(N[1][0], N[0][0]);
    double D0[3][3] = {{1, 0, 0}, {0, sigma, 0}, {0, 0, sigma}}, back[3][3], D[3][3];
    hn_num3_transpose(child, back);
    hn_num3_mul(D0, back, D);
    link->sign = sigma * (link->reversed ? -1 : 1);
    choose_offset(scene, link, body, delta, D, align);
    double turn = delta - link->offset;
    double Rz[3][3] = {{cos(turn), -sin(turn), 0}, {sin(turn), cos(turn), 0}, {0, 0, 1}};
    hn_num3_snap(Rz);
    hn_num3_mul(Rz, D, link->C);
}

static void place_link(const hn_scene *scene, hn_tree *tree, int index, int align) {
    hn_link *link = &tree->links[index], *parent = &tree->links[link->parent];
    const hn_joint *joint = &scene->joints[link->joint];
    double P[3][3], Ch[3][3], N[3][3], back[3][3];
    joint_triad(joint->parent_axis, joint->parent_ref, link->reversed ? Ch : P);
    joint_triad(joint->child_axis, joint->child_ref, link->reversed ? P : Ch);
    hn_num3_mul(parent->C, P, N);

    if (link->type == HN_JOINT_PRISMATIC) {
        link->carry = HN_CARRY_RIGID;
        link->angle_ref = -1;
        link->angle = parent->angle;
        link->group = parent->group;
        link->root = parent->root;
        hn_num3_transpose(Ch, back);
        hn_num3_mul(N, back, link->C);
        return;
    }
    double axis[3] = {N[0][2], N[1][2], N[2][2]};
    static const double Z[3] = {0, 0, 1};
    link->root = index;
    link->angle = link->coordinate;
    if (parent->angle >= 0 && parallel(axis, Z)) {
        link->carry = HN_CARRY_GROUP;
        link->group = parent->group;
        link->angle_ref = parent->angle;
    } else {
        link->carry = HN_CARRY_NEW;
        link->angle_ref = -1;
        double in_base[3], to_base[3][3];
        hn_num3_transpose(tree->links[parent->root].C, to_base);
        apply(to_base, axis, in_base);
        link->group = find_group(scene, tree, parent->root, in_base);
        double turned[3][3];
        hn_num3_transpose(tree->groups[link->group].X, back);
        hn_num3_mul(parent->C, P, N); // the ground's C may just have been chosen
        hn_num3_mul(back, N, turned);
        memcpy(N, turned, sizeof turned);
    }
    tree->groups[link->group].n_links++;
    place_revolute(scene, link, index, N, Ch, align);
}

/// The frame of everything that does not rotate: that of the first revolute axis that hangs on it.
static void choose_ground_frame(const hn_scene *scene, hn_tree *tree) {
    for (int k = 0; k < tree->ground; k++) {
        int index = tree->order[k];
        hn_link *link = &tree->links[index], *parent = &tree->links[link->parent];
        if (parent->angle >= 0) {
            continue;
        }
        if (link->type == HN_JOINT_REVOLUTE) {
            double axis[3];
            apply(parent->C, hn_link_parent_axis(scene, link),
                  axis); // C is the world orientation so far
            (void)find_group(scene, tree, tree->ground, axis);
            return;
        }
        place_link(scene, tree, index, 0);
    }
}

static hn_status allocate(const hn_scene *scene, hn_arena *arena, hn_tree *tree) {
    size_t nb = (size_t)scene->n_bodies, nj = (size_t)scene->n_joints;
    memset(tree, 0, sizeof *tree);
    tree->n_links = scene->n_bodies + 1;
    tree->ground = scene->n_bodies;
    tree->links = hn_arena_get(arena, (nb + 1) * sizeof *tree->links);
    tree->groups = hn_arena_get(arena, (nb + 1) * sizeof *tree->groups);
    tree->order = hn_arena_ints(arena, nb + 1);
    tree->cut = hn_arena_ints(arena, nj + 1);
    tree->joint_cut = hn_arena_ints(arena, nj + 1);
    tree->user = hn_arena_ints(arena, nb + 1);
    tree->link_of = hn_arena_ints(arena, nb + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    for (int l = 0; l < tree->n_links; l++) {
        hn_link *link = &tree->links[l];
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

static hn_status check_types(const hn_scene *scene, hn_diags *diags) {
    for (int j = 0; j < scene->n_joints; j++) {
        const hn_joint *joint = &scene->joints[j];
        if (joint->type != HN_JOINT_REVOLUTE && joint->type != HN_JOINT_PRISMATIC) {
            return hn_diags_add(diags, HN_ERR_UNSUPPORTED, joint->pointer,
                                "write it as revolute and prismatic joints",
                                "a %s joint cannot be compiled", hn_joint_type_name(joint->type));
        }
    }
    return HN_OK;
}

hn_status hn_tree_build(const hn_scene *scene, int align, hn_arena *arena, hn_tree *tree,
                        hn_diags *diags) {
    hn_status status = check_types(scene, diags);
    if (status == HN_OK) {
        status = allocate(scene, arena, tree);
    }
    if (status == HN_OK) {
        status = span(scene, arena, tree, diags);
    }
    if (status != HN_OK) {
        return status;
    }
    choose_ground_frame(scene, tree);
    number_coordinates(scene, tree);
    if (tree->n_groups == 0) { // nothing revolves: the world's own axes
        static const double Z[3] = {0, 0, 1};
        (void)find_group(scene, tree, tree->ground, Z);
    }
    for (int k = 0; k < tree->ground; k++) {
        place_link(scene, tree, tree->order[k], align);
    }
    return HN_OK;
}
