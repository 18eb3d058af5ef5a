// Loop closures. A cut joint is written as rows between its two halves, relative to the lowest common ancestor of its bodies
// and in that loop's frame (relate.c):
//     revolute     position 3,  x_B . z_A,  y_B . z_A               universal  position 3,  x_B . z_A
//     prismatic    position 2 across the axis,  x_B . y_A,  x_B . z_A,  y_B . z_A
//     cylindrical  position 2 across the axis,  x_B . z_A,  y_B . z_A
//     planar       position 1 along the axis,  x_B . z_A,  y_B . z_A
//     spherical    position 3                                       fixed      position 3, turns as prismatic
// J comes as coefficients on the path's coordinates (axis x lever arm), gamma from the same recursion for accelerations:
// (p . r)'' = p''. r + 2 p'. r' + p . r''. Differentiating phi instead would cost more operations. Rows that vanish
// identically drop out when they are added, so a planar loop keeps two, whatever plane it lies in.
#include "dynamics/mech.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A direction fixed to one end of the loop, with its first derivative and the second at zero u-dot, in the loop's frame.
typedef struct direction {
    const hn_reach *end;
    double sign; ///< +1: the parent's side, -1: the child's
    hn_vec3 v, d1, d2;
} direction;

typedef struct loop {
    hn_mech *m;
    int index, joint;
    hn_relative rel;
    hn_vec3 delta, delta_rate, delta_acc; ///< parent side minus child side
    int n;                                ///< coordinates met, those of side a first
    int *coordinate;
    hn_vec3 *coefficient; ///< d delta / d u
    hn_entry *entries;    ///< scratch of a row, n
} loop;

static hn_status begin_loop(hn_mech *m, int index, loop *out) {
    hn_arena *arena = m->sys->arena;
    const hn_joint *joint = &m->sys->scene->joints[m->tree->cut[index]];
    int a = hn_tree_link(m->tree, joint->parent), b = hn_tree_link(m->tree, joint->child);
    memset(out, 0, sizeof *out);
    out->m = m;
    out->index = index;
    out->joint = m->tree->cut[index];
    hn_vec3 arm_a, arm_b;
    hn_status status = hn_mech_arm_of(m, a, joint->parent_at, &arm_a);
    if (status == HN_OK) {
        status = hn_mech_arm_of(m, b, joint->child_at, &arm_b);
    }
    if (status == HN_OK) {
        status = hn_mech_relate(m, hn_tree_common(m->tree, a, b), a, arm_a, b, arm_b, &out->rel);
    }
    if (status != HN_OK) {
        return status;
    }
    size_t cap = (size_t)(out->rel.a.n + out->rel.b.n) + 1;
    out->coordinate = hn_arena_ints(arena, cap);
    out->coefficient = hn_arena_get(arena, cap * sizeof *out->coefficient);
    out->entries = hn_arena_get(arena, 2 * cap * sizeof *out->entries);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static void add_coefficient(loop *l, int coordinate, hn_vec3 c) {
    for (int k = 0; k < l->n; k++) {
        if (l->coordinate[k] == coordinate) {
            l->coefficient[k] = hn_vec3_add(l->m->g, l->coefficient[k], c);
            return;
        }
    }
    l->coordinate[l->n] = coordinate;
    l->coefficient[l->n++] = c;
}

static void collect_coefficients(loop *l) {
    hn_graph *g = l->m->g;
    for (int k = 0; k < l->rel.a.n; k++) {
        add_coefficient(l, l->rel.a.levers[k].coordinate,
                        hn_lever_coefficient(g, &l->rel.a.levers[k]));
    }
    for (int k = 0; k < l->rel.b.n; k++) {
        hn_vec3 c = hn_lever_coefficient(g, &l->rel.b.levers[k]);
        add_coefficient(l, l->rel.b.levers[k].coordinate, hn_vec3_scale(g, hn_num(-1), c));
    }
    l->delta = hn_vec3_sub(g, l->rel.a.pos, l->rel.b.pos);
    l->delta_acc = hn_vec3_sub(g, l->rel.a.acc, l->rel.b.acc);
}

/// Only where something needs it: rows of a revolute joint do not.
static void collect_rate(loop *l) {
    hn_graph *g = l->m->g;
    l->delta_rate = hn_vec3_zero();
    for (int k = 0; k < l->n; k++) {
        hn_vec3 part = hn_vec3_scale(g, l->m->sys->v[l->coordinate[k]], l->coefficient[k]);
        l->delta_rate = hn_vec3_add(g, l->delta_rate, part);
    }
}

/// `v` in the axes of the body at that end.
static direction fixed_direction(loop *l, int on_child, const double v[3]) {
    hn_mech *m = l->m;
    const hn_joint *joint = &m->sys->scene->joints[l->joint];
    int link = hn_tree_link(m->tree, on_child ? joint->child : joint->parent);
    direction d = {.end = on_child ? &l->rel.b : &l->rel.a, .sign = on_child ? -1 : 1};
    double in_E[3][3], column[3][3] = {{v[0], 0, 0}, {v[1], 0, 0}, {v[2], 0, 0}};
    hn_num3_mul(m->tree->links[link].C, column, in_E);
    d.v = hn_mat3_apply(m->g, &d.end->U,
                        hn_vec3_num((double[3]){in_E[0][0], in_E[1][0], in_E[2][0]}));
    d.d1 = hn_vec3_cross(m->g, d.end->w, d.v);
    d.d2 = hn_mat3_apply(m->g, &d.end->B, d.v);
    return d;
}

static hn_status add_row(loop *l, const char *what, int is_length, hn_ex phi, hn_ex gamma, int n) {
    hn_system *sys = l->m->sys;
    const hn_joint *joint = &sys->scene->joints[l->joint];
    char name[160];
    snprintf(name, sizeof name, "%s: %s", joint->name, what);
    hn_new_row row = {
        .name = hn_arena_strdup(sys->arena, name), .loop = l->index, .is_length = is_length};
    row.phi = phi;
    row.phi_t = hn_num(0);
    row.gamma = gamma;
    row.J = l->entries;
    row.n_J = n;
    row.pointer = joint->pointer;
    return hn_system_add_row(sys, &row);
}

static const char *axis_name(const loop *l, int i) {
    static const char *const world[3] = {"x", "y", "z"}, *const own[3] = {"1st axis", "2nd axis",
                                                                          "3rd axis"};
    return l->rel.aligned ? world[i] : own[i];
}

/// One component of the position gap along a fixed axis of the frame.
static hn_status position_row(loop *l, int i) {
    int n = 0;
    for (int k = 0; k < l->n; k++) {
        l->entries[n++] = (hn_entry){0, l->coordinate[k], l->coefficient[k].x[i]};
    }
    return add_row(l, axis_name(l, i), 1, l->delta.x[i], l->delta_acc.x[i], n);
}

static int is_open(const hn_reach *end, int coordinate) {
    for (int k = 0; k < end->n; k++) {
        if (end->levers[k].open && end->levers[k].coordinate == coordinate) {
            return 1;
        }
    }
    return 0;
}

/// Adds d(p . r)/du for what turns p, to the row's entries.
static int turning_entries(loop *l, const direction *p, hn_vec3 r, const hn_reach *other, int n) {
    hn_graph *g = l->m->g;
    for (int k = 0; k < p->end->n; k++) {
        const hn_lever *lever = &p->end->levers[k];
        if (!lever->open || (other && is_open(other, lever->coordinate))) {
            continue; // what turns both ends alike changes nothing
        }
        hn_ex e = hn_vec3_dot(g, hn_vec3_cross(g, lever->axis, p->v), r);
        int at = 0;
        while (at < n && l->entries[at].col != lever->coordinate) {
            at++;
        }
        if (at == n) {
            l->entries[n++] = (hn_entry){0, lever->coordinate, e};
        } else {
            l->entries[at].e = hn_add(g, l->entries[at].e, e);
        }
    }
    return n;
}

/// p on the parent's side stays perpendicular to r on the child's.
static hn_status perpendicular_row(loop *l, const char *what, const direction *p,
                                   const direction *r) {
    hn_graph *g = l->m->g;
    int n = turning_entries(l, p, r->v, r->end, 0);
    n = turning_entries(l, r, p->v, p->end, n);
    hn_ex terms[3] = {hn_vec3_dot(g, p->d2, r->v), hn_scale(2, hn_vec3_dot(g, p->d1, r->d1)),
                      hn_vec3_dot(g, p->v, r->d2)};
    return add_row(l, what, 0, hn_vec3_dot(g, p->v, r->v), hn_sum(g, terms, 3), n);
}

typedef struct measured {
    hn_ex value, gamma;
    int n; ///< of l->entries
} measured;

/// The gap measured along a direction that moves with one end.
static measured along(loop *l, const direction *p) {
    hn_graph *g = l->m->g;
    measured out = {.n = 0};
    for (int k = 0; k < l->n; k++) {
        l->entries[out.n++] =
            (hn_entry){0, l->coordinate[k], hn_vec3_dot(g, p->v, l->coefficient[k])};
    }
    out.n = turning_entries(l, p, l->delta, NULL, out.n);
    hn_ex terms[3] = {hn_vec3_dot(g, p->d2, l->delta),
                      hn_scale(2, hn_vec3_dot(g, p->d1, l->delta_rate)),
                      hn_vec3_dot(g, p->v, l->delta_acc)};
    out.value = hn_vec3_dot(g, p->v, l->delta);
    out.gamma = hn_sum(g, terms, 3);
    return out;
}

static int count_open(const hn_reach *end) {
    int n = 0;
    for (int k = 0; k < end->n; k++) {
        n += end->levers[k].open;
    }
    return n;
}

/// The rows of a type, in their order. Places: 3 along the loop's own axes, or where the joint lets the halves move apart, along
/// axes of the joint (bits: 1 x, 2 y, 4 z). Turns: the pairs that stay perpendicular.
enum { TURN = 1, TILT_1 = 2, TILT_2 = 4, CROSS = 8 };
typedef struct closing {
    int all_places, along, turns;
} closing;

static const closing CLOSINGS[HN_JOINT_TYPE_COUNT] = {
    [HN_JOINT_REVOLUTE] = {1, 0, TILT_1 | TILT_2},
    [HN_JOINT_PRISMATIC] = {0, 1 | 2, TURN | TILT_1 | TILT_2},
    [HN_JOINT_CYLINDRICAL] = {0, 1 | 2, TILT_1 | TILT_2},
    [HN_JOINT_UNIVERSAL] = {1, 0, CROSS},
    [HN_JOINT_SPHERICAL] = {1, 0, 0},
    [HN_JOINT_PLANAR] = {0, 4, TILT_1 | TILT_2},
    [HN_JOINT_FIXED] = {1, 0, TURN | TILT_1 | TILT_2},
};

/// Axes of the joint on both sides: x, y, z in their bodies.
static void joint_axes(loop *l, direction parent[3], direction child[3]) {
    const hn_joint *joint = &l->m->sys->scene->joints[l->joint];
    double yA[3], yB[3];
    hn_num3_cross(joint->parent_axis, joint->parent_ref, yA);
    hn_num3_cross(joint->child_axis, joint->child_ref, yB);
    const double *const A[3] = {joint->parent_ref, yA, joint->parent_axis};
    const double *const B[3] = {joint->child_ref, yB, joint->child_axis};
    for (int i = 0; i < 3; i++) {
        parent[i] = fixed_direction(l, 0, A[i]);
        child[i] = fixed_direction(l, 1, B[i]);
    }
}

/// The gap along axes of the joint, on the side that turns less.
static hn_status measured_rows(loop *l, int along_bits, const direction *parent,
                               const direction *child) {
    static const char *const names[3] = {"across 1", "across 2", "along"};
    const direction *axes = count_open(&l->rel.b) < count_open(&l->rel.a) ? child : parent;
    hn_status status = HN_OK;
    collect_rate(l);
    for (int i = 0; i < 3 && status == HN_OK; i++) {
        if (along_bits & (1 << i)) {
            measured row = along(l, &axes[i]);
            status = add_row(l, names[i], 1, row.value, row.gamma, row.n);
        }
    }
    return status;
}

static hn_status turn_rows(loop *l, int turns, const direction *parent, const direction *child) {
    static const struct {
        int bit, parent, child;
        const char *name;
    } rows[] = {{TURN, 1, 0, "turn"},
                {CROSS, 2, 0, "cross"},
                {TILT_1, 2, 0, "tilt 1"},
                {TILT_2, 2, 1, "tilt 2"}};
    hn_status status = HN_OK;
    for (size_t k = 0; k < sizeof rows / sizeof *rows && status == HN_OK; k++) {
        if (turns & rows[k].bit) {
            status =
                perpendicular_row(l, rows[k].name, &parent[rows[k].parent], &child[rows[k].child]);
        }
    }
    return status;
}

static hn_status close_joint(loop *l) {
    const closing *rule = &CLOSINGS[l->m->sys->scene->joints[l->joint].type];
    direction parent[3], child[3];
    hn_status status = HN_OK;
    for (int i = 0; i < 3 && rule->all_places && status == HN_OK; i++) {
        status = position_row(l, i);
    }
    joint_axes(l, parent, child);
    if (status == HN_OK && rule->along) {
        status = measured_rows(l, rule->along, parent, child);
    }
    return status == HN_OK ? turn_rows(l, rule->turns, parent, child) : status;
}

// coordinates of cut joints ------------------------------------------------------------------------------------

/// Constant part of a link's orientation in a group's frame, if the link belongs to it or does not rotate in its base.
static int constant_in_group(const hn_tree *tree, int link, int group, double C[3][3]) {
    const hn_link *l = &tree->links[link];
    double back[3][3], own[3][3];
    memcpy(own, l->C, sizeof own);
    if (l->group == group) {
        memcpy(C, own, sizeof own);
        return 1;
    }
    double X[3][3];
    memcpy(X, tree->groups[group].X, sizeof X);
    hn_num3_transpose(X, back);
    hn_num3_mul(back, own, C);
    return hn_tree_is_still(tree, link) && tree->groups[group].base == tree->ground;
}

/// A revolute joint between links of one group: Rz(q) = D Rz(theta_B - theta_A + delta_B - delta_A) D with D the identity or
/// a half turn, so q is the difference of two absolute angles, up to a sign and a constant.
static int revolute_coordinate(hn_mech *m, const hn_joint *joint, int index) {
    const hn_tree *tree = m->tree;
    int a = hn_tree_link(tree, joint->parent), b = hn_tree_link(tree, joint->child);
    int group = tree->links[tree->links[a].angle >= 0 ? a : b].group;
    double Ca[3][3], Cb[3][3], za[3], xa[3], xb[3];
    if (!constant_in_group(tree, a, group, Ca) || !constant_in_group(tree, b, group, Cb)) {
        return 0;
    }
    for (int i = 0; i < 3; i++) {
        za[i] = hn_num3_dot(Ca[i], joint->parent_axis);
        xa[i] = hn_num3_dot(Ca[i], joint->parent_ref);
        xb[i] = hn_num3_dot(Cb[i], joint->child_ref);
    }
    if (fabs(fabs(za[2]) - 1) > 1e-12) {
        return 0;
    }
    double sign = za[2] > 0 ? 1 : -1;
    double offset = remainder(atan2(xb[1], xb[0]) - atan2(xa[1], xa[0]), 2 * M_PI);
    hn_system *sys = m->sys;
    int ia = tree->links[a].angle, ib = tree->links[b].angle;
    hn_ex zero = hn_num(0);
    hn_ex angle =
        hn_sub(m->g, ib >= 0 ? hn_mech_q(m, ib) : zero, ia >= 0 ? hn_mech_q(m, ia) : zero);
    hn_ex rate = hn_sub(m->g, ib >= 0 ? sys->v[ib] : zero, ia >= 0 ? sys->v[ia] : zero);
    sys->user_q[index] = hn_scale(sign, hn_add(m->g, angle, hn_num(offset)));
    sys->user_v[index] = hn_scale(sign, rate);
    return 1;
}

static hn_status prismatic_coordinate(hn_mech *m, int loop_index, const hn_joint *joint,
                                      int index) {
    loop l;
    hn_status status = begin_loop(m, loop_index, &l);
    if (status != HN_OK) {
        return status;
    }
    collect_coefficients(&l);
    collect_rate(&l);
    direction axis = fixed_direction(&l, 0, joint->parent_axis);
    measured gap = along(&l, &axis); // parent minus child: the coordinate is its negative
    m->sys->user_q[index] = hn_neg(gap.value);
    hn_ex rate = hn_num(0);
    for (int k = 0; k < gap.n; k++) {
        rate = hn_add(m->g, rate, hn_mul(m->g, l.entries[k].e, m->sys->v[l.entries[k].col]));
    }
    m->sys->user_v[index] = hn_neg(rate);
    return HN_OK;
}

hn_status hn_mech_cut_coordinates(hn_mech *m) {
    for (int k = 0; k < m->tree->n_cut; k++) {
        const hn_joint *joint = &m->sys->scene->joints[m->tree->cut[k]];
        int index = joint->coordinate;
        if (joint->type == HN_JOINT_PRISMATIC) {
            m->sys->user_known[index] = HN_KNOWN_BOTH;
            hn_status status = prismatic_coordinate(m, k, joint, index);
            if (status != HN_OK) {
                return status;
            }
        } else if (joint->type == HN_JOINT_REVOLUTE && revolute_coordinate(m, joint, index)) {
            m->sys->user_known[index] = HN_KNOWN_BOTH;
        }
    }
    return HN_OK;
}

hn_status hn_mech_trace_loops(hn_mech *m) {
    for (int k = 0; k < m->tree->n_cut; k++) {
        loop l;
        hn_status status = begin_loop(m, k, &l);
        if (status != HN_OK) {
            return status;
        }
        collect_coefficients(&l);
        status = close_joint(&l);
        if (status != HN_OK) {
            return status;
        }
    }
    return HN_OK;
}
