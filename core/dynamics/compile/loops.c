// SPDX-License-Identifier: GPL-3.0-or-later
// Loop closures. A cut joint is written as rows between its two halves, relative to the lowest
// common ancestor of its bodies and in that loop's frame (relate.c):
//
//     revolute     position 3,  x_B . z_A,  y_B . z_A           universal  position 3,  x_B . z_A
//     prismatic    position 2 across the axis,  x_B . y_A,  x_B . z_A,  y_B . z_A
//     cylindrical  position 2 across the axis,  x_B . z_A,  y_B . z_A
//     planar       position 1 along the axis,  x_B . z_A,  y_B . z_A
//     spherical    position 3                                   fixed      position 3, as prismatic
//
// J comes as coefficients on the path's coordinates (axis x lever arm), gamma from the same
// recursion for accelerations: (p . r)'' = p''. r + 2 p'. r' + p . r''. Differentiating phi instead
// would cost more operations. Rows that vanish identically drop out when they are added, so a
// planar loop keeps two, whatever plane it lies in.
#include "dynamics/compile/loops.h"

#include "dynamics/compile/closure.h"
#include "dynamics/compile/leg.h"
#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct loop {
    hn_closure c; ///< end a: the joint's parent, b: its child
    const hn_joint *joint;
} loop;

static hn_status begin_loop(hn_mech *m, int index, loop *out) {
    const hn_joint *joint = &m->sys->scene->joints[m->tree->cut[index]];
    HN_TRY(hn_closure_begin(m, index, hn_tree_link(m->tree, joint->parent), joint->parent_at,
                            hn_tree_link(m->tree, joint->child), joint->child_at, &out->c));
    out->joint = joint;
    out->c.name = joint->name;
    out->c.pointer = joint->pointer;
    return HN_OK;
}

static int count_open(const hn_reach *end) {
    int n = 0;
    for (int k = 0; k < end->n; k++) {
        n += end->levers[k].open;
    }
    return n;
}

/// The rows of a type, in their order. Places: 3 along the loop's own axes, or where the joint lets
/// the halves move apart, along axes of the joint (bits: 1 x, 2 y, 4 z), taken on the half that
/// turns less: both halves must share the directions that these bits name. Turns: the pairs that
/// stay perpendicular.
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

hn_joint_ties hn_joint_ties_of(hn_joint_type type) {
    const int turns = CLOSINGS[type].turns, tilts = TILT_1 | TILT_2;
    return (hn_joint_ties){.axes = (turns & tilts) == tilts, .refs = (turns & TURN) != 0};
}

/// Axes of the joint on both sides: x, y, z in their bodies.
static void joint_axes(loop *l, hn_direction parent[3], hn_direction child[3]) {
    const hn_joint *joint = l->joint;
    double yA[3], yB[3];
    hn_num3_cross(joint->parent_axis, joint->parent_ref, yA);
    hn_num3_cross(joint->child_axis, joint->child_ref, yB);
    const double *const A[3] = {joint->parent_ref, yA, joint->parent_axis};
    const double *const B[3] = {joint->child_ref, yB, joint->child_axis};
    for (int i = 0; i < 3; i++) {
        parent[i] = hn_closure_direction(&l->c, 0, A[i]);
        child[i] = hn_closure_direction(&l->c, 1, B[i]);
    }
}

/// The gap along axes of the joint, on the side that turns less.
static hn_status measured_rows(loop *l, int along_bits, const hn_direction *parent,
                               const hn_direction *child) {
    static const char *const names[3] = {"across 1", "across 2", "along"};
    const hn_direction *axes = count_open(&l->c.rel.b) < count_open(&l->c.rel.a) ? child : parent;
    hn_closure_collect_rate(&l->c);
    for (int i = 0; i < 3; i++) {
        if (along_bits & (1 << i)) {
            hn_measured row = hn_closure_along(&l->c, &axes[i]);
            HN_TRY(hn_closure_add_row(&l->c, names[i], 1, row.value, row.gamma, row.n));
        }
    }
    return HN_OK;
}

static hn_status turn_rows(loop *l, int turns, const hn_direction *parent,
                           const hn_direction *child) {
    static const struct {
        int bit, parent, child;
        const char *name;
    } rows[] = {{TURN, 1, 0, "turn"},
                {CROSS, 2, 0, "cross"},
                {TILT_1, 2, 0, "tilt 1"},
                {TILT_2, 2, 1, "tilt 2"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        if (turns & rows[k].bit) {
            HN_TRY(hn_closure_perpendicular_row(&l->c, rows[k].name, &parent[rows[k].parent],
                                                &child[rows[k].child]));
        }
    }
    return HN_OK;
}

static hn_status close_joint(loop *l) {
    const closing *rule = &CLOSINGS[l->joint->type];
    hn_direction parent[3], child[3];
    const int first = l->c.m->sys->nc;
    for (int i = 0; i < 3 && rule->all_places; i++) {
        HN_TRY(hn_closure_position_row(&l->c, i));
    }
    l->c.m->place_row[l->c.index] = l->c.m->sys->nc == first + 3 ? first : -1;
    joint_axes(l, parent, child);
    if (rule->along) {
        HN_TRY(measured_rows(l, rule->along, parent, child));
    }
    return turn_rows(l, rule->turns, parent, child);
}

// ---- coordinates of cut joints ----

/// Constant part of a link's orientation in a group's frame, if the link belongs to it or does not
/// rotate in its base.
static bool constant_in_group(const hn_tree *tree, int link, int group, double C[3][3]) {
    const hn_link *l = &tree->links[link];
    double back[3][3], own[3][3];
    memcpy(own, l->C, sizeof own);
    if (l->group == group) {
        memcpy(C, own, sizeof own);
        return true;
    }
    double X[3][3];
    memcpy(X, tree->groups[group].X, sizeof X);
    hn_num3_transpose(X, back);
    hn_num3_compose(back, own, C);
    return hn_tree_is_still(tree, link) && tree->groups[group].base == tree->ground;
}

/// Between links of one group: Rz(angle) = D Rz(theta_B - theta_A + delta_B - delta_A) D with D the
/// identity or a half turn, so the angle is the difference of two absolute angles, up to a sign and
/// a constant.
bool hn_mech_relative_turn(hn_mech *m, int a, const double axis[3], const double ref_a[3], int b,
                           const double ref_b[3], hn_turn *out) {
    const hn_tree *tree = m->tree;
    int group = tree->links[tree->links[a].angle >= 0 ? a : b].group;
    double Ca[3][3], Cb[3][3], za[3], xa[3], xb[3];
    if (!constant_in_group(tree, a, group, Ca) || !constant_in_group(tree, b, group, Cb)) {
        return false;
    }

    // both references seen in the group's frame
    for (int i = 0; i < 3; i++) {
        za[i] = hn_num3_dot(Ca[i], axis);
        xa[i] = hn_num3_dot(Ca[i], ref_a);
        xb[i] = hn_num3_dot(Cb[i], ref_b);
    }

    // the axis is the group's, and no reference lies along it
    if (fabs(fabs(za[2]) - 1) > 1e-12 || hypot(xa[0], xa[1]) < 1e-6 || hypot(xb[0], xb[1]) < 1e-6) {
        return false;
    }

    double offset = remainder(atan2(xb[1], xb[0]) - atan2(xa[1], xa[0]), 2 * M_PI);
    hn_system *sys = m->sys;
    int ia = tree->links[a].angle, ib = tree->links[b].angle;
    hn_ex zero = hn_num(0);

    // theta_b - theta_a, and its rate
    hn_ex angle =
        hn_sub(m->g, ib >= 0 ? hn_mech_q(m, ib) : zero, ia >= 0 ? hn_mech_q(m, ia) : zero);
    hn_ex rate = hn_sub(m->g, ib >= 0 ? sys->v[ib] : zero, ia >= 0 ? sys->v[ia] : zero);

    out->sign = za[2] > 0 ? 1 : -1;
    out->speed[0] = ia;
    out->speed[1] = ib;
    out->angle = hn_scale(out->sign, hn_add(m->g, angle, hn_num(offset)));
    out->rate = hn_scale(out->sign, rate);
    return true;
}

static bool revolute_coordinate(hn_mech *m, const hn_joint *joint, int index) {
    hn_turn turn;
    if (!hn_mech_relative_turn(m, hn_tree_link(m->tree, joint->parent), joint->parent_axis,
                               joint->parent_ref, hn_tree_link(m->tree, joint->child),
                               joint->child_ref, &turn)) {
        return false;
    }
    m->sys->user_q[index] = turn.angle;
    m->sys->user_v[index] = turn.rate;
    return true;
}

static hn_status prismatic_coordinate(hn_mech *m, int loop_index, const hn_joint *joint,
                                      int index) {
    loop l;
    HN_TRY(begin_loop(m, loop_index, &l));
    hn_closure_collect(&l.c);
    hn_closure_collect_rate(&l.c);
    hn_direction axis = hn_closure_direction(&l.c, 0, joint->parent_axis);
    hn_measured gap =
        hn_closure_along(&l.c, &axis); // parent minus child: the coordinate is its negative
    m->sys->user_q[index] = hn_neg(gap.value);
    hn_ex rate = hn_num(0);
    for (int k = 0; k < gap.n; k++) {
        rate = hn_add(m->g, rate, hn_mul(m->g, l.c.entries[k].e, m->sys->v[l.c.entries[k].col]));
    }
    m->sys->user_v[index] = hn_neg(rate);
    m->sys->user_gamma[index] = hn_neg(gap.gamma);
    return HN_OK;
}

hn_status hn_mech_cut_coordinates(hn_mech *m) {
    for (int k = 0; k < m->tree->n_cut; k++) {
        const hn_joint *joint = &m->sys->scene->joints[m->tree->cut[k]];
        int index = joint->coordinate;
        if (joint->type == HN_JOINT_PRISMATIC) {
            m->sys->user_known[index] = HN_KNOWN_BOTH;
            HN_TRY(prismatic_coordinate(m, k, joint, index));
        } else if (joint->type == HN_JOINT_REVOLUTE && revolute_coordinate(m, joint, index)) {
            m->sys->user_known[index] = HN_KNOWN_BOTH;
        }
    }
    return HN_OK;
}

hn_status hn_mech_trace_loops(hn_mech *m) {
    for (int k = 0; k < m->tree->n_cut; k++) {
        loop l;
        HN_TRY(begin_loop(m, k, &l));
        hn_closure_collect(&l.c);
        HN_TRY(close_joint(&l));
    }
    return HN_OK;
}

hn_status hn_mech_trace_legs(hn_mech *m) {
    const int before = hn_graph_size(m->g);
    hn_leg_count_passes(m);
    for (int k = 0; k < m->tree->n_cut; k++) {
        loop l;
        if (m->place_row[k] >= 0) {
            HN_TRY(begin_loop(m, k, &l));
            HN_TRY(hn_leg_trace(&l.c, m->place_row[k]));
        }
    }
    m->sys->leg_nodes[0] += hn_graph_size(m->g) - before;
    return HN_OK;
}
