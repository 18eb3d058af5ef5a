// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/mech.h"

#include "dynamics/compile/formula.h"
#include "expr/construct.h"

#include <stdbool.h>

bool hn_mech_is_planar(const hn_mech *m, int link) {
    return !m->tree->groups[m->tree->links[link].group].moving;
}

static hn_vec3 turn(const hn_mech *m, int link, hn_vec3 v, int back) {
    const hn_link_trace *at = &m->at[link];
    hn_mat3 R = hn_mat3_turn_z(at->c, back ? hn_neg(at->s) : at->s);
    return hn_mat3_apply(m->g, &R, v);
}

hn_vec3 hn_mech_E_to_work(const hn_mech *m, int link, hn_vec3 v) {
    return hn_mech_is_planar(m, link) ? turn(m, link, v, 0) : v;
}

hn_vec3 hn_mech_work_to_E(const hn_mech *m, int link, hn_vec3 v) {
    return hn_mech_is_planar(m, link) ? turn(m, link, v, 1) : v;
}

static hn_vec3 work_to_F(const hn_mech *m, int link, hn_vec3 v) {
    return hn_mech_is_planar(m, link) ? v : turn(m, link, v, 0);
}

static hn_vec3 F_to_work(const hn_mech *m, int link, hn_vec3 v) {
    return hn_mech_is_planar(m, link) ? v : turn(m, link, v, 1);
}

hn_vec3 hn_mech_up(const hn_mech *m, int link, hn_vec3 v) {
    const hn_link *l = &m->tree->links[link];
    if (l->carry == HN_CARRY_RIGID) {
        return v;
    }
    v = work_to_F(m, link, v);
    if (l->carry == HN_CARRY_GROUP) {
        return F_to_work(m, l->parent, v);
    }
    return hn_mech_E_to_work(m, l->parent, hn_mat3_apply(m->g, &m->group_X[l->group], v));
}

hn_vec3 hn_mech_down(const hn_mech *m, int link, hn_vec3 v) {
    const hn_link *l = &m->tree->links[link];
    if (l->carry == HN_CARRY_RIGID) {
        return v;
    }
    if (l->carry == HN_CARRY_GROUP) {
        return F_to_work(m, link, work_to_F(m, l->parent, v));
    }
    v = hn_mat3_apply_transposed(m->g, &m->group_X[l->group], hn_mech_work_to_E(m, l->parent, v));
    return F_to_work(m, link, v);
}

hn_vec3 hn_mech_moment(const hn_mech *m, int link, hn_vec3 r, hn_vec3 f) {
    if (!hn_mech_is_planar(m, link)) {
        return hn_vec3_cross(m->g, r, f);
    }
    return (hn_vec3){{hn_num(0), hn_num(0), hn_vec3_cross_z(m->g, r, f)}};
}

hn_ex hn_mech_q(const hn_mech *m, int coordinate) {
    return m->sys->q[m->tree->position[coordinate]];
}

hn_vec3 hn_mech_slide(const hn_mech *m, int link) {
    return hn_mech_E_to_work(m, m->tree->links[link].parent, m->at[link].slide);
}

hn_status hn_mech_arm_of(const hn_mech *m, int link, const hn_quantity *at, hn_vec3 *out) {
    const hn_link *l = &m->tree->links[link];
    hn_vec3 v, own;
    HN_TRY(hn_system_vector(m->sys, at, &v));
    if (l->joint >= 0) {
        HN_TRY(hn_system_vector(m->sys, hn_link_at_own(m->sys->scene, l), &own));
        v = hn_vec3_sub(m->g, v, own);
    }
    hn_mat3 C = hn_mat3_num(m->tree->links[link].C);
    *out = hn_mat3_apply(m->g, &C, v);
    return HN_OK;
}

hn_vec3 hn_mech_world(const hn_mech *m, int link, hn_vec3 arm) {
    hn_vec3 in_F = turn(m, link, arm, 0);
    const hn_mat3 *G = &m->to_world[m->tree->links[link].group];
    return hn_vec3_add(m->g, m->position[link], hn_mat3_apply(m->g, G, in_F));
}

// ---- geometry ----

/// From the parent's joint point to the link's, and which way a prismatic joint moves it.
static hn_status trace_arm(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    hn_link_trace *at = &m->at[link];
    HN_TRY(hn_mech_arm_of(m, l->parent, hn_link_at_parent(m->sys->scene, l), &at->arm));
    at->slide = hn_vec3_zero();
    if (l->type == HN_JOINT_PRISMATIC) {
        // the link's point moves along the axis when the joint's own parent is the link's parent,
        // against it otherwise
        hn_mat3 C = hn_mat3_num(m->tree->links[l->parent].C);
        const double axis[3] = {l->here[0][2], l->here[1][2], l->here[2][2]};
        hn_vec3 d = hn_mat3_apply(m->g, &C, hn_vec3_num(axis));
        at->slide = hn_vec3_scale(m->g, hn_num(l->reversed ? -1 : 1), d);
        hn_vec3 gone = hn_vec3_scale(m->g, hn_mech_q(m, l->coordinate), at->slide);
        at->arm = hn_vec3_add(m->g, at->arm, gone);
    }
    at->r = hn_mech_E_to_work(m, l->parent, at->arm);
    return HN_OK;
}

static hn_status trace_body(hn_mech *m, int link) {
    const hn_body *body = &m->sys->scene->bodies[m->tree->links[link].body];
    hn_link_trace *at = &m->at[link];
    hn_vec3 rho;
    hn_sym3 I;
    if (m->tree->links[link].is_virtual) {
        return HN_OK; // zeroed: no mass
    }
    HN_TRY(hn_system_quantity(m->sys, &body->mass, &at->mass));
    for (int k = 0; k < 6; k++) {
        HN_TRY(hn_system_quantity(m->sys, &body->inertia[k], &I.x[k]));
    }
    HN_TRY(hn_mech_arm_of(m, link, body->com, &rho));
    hn_mat3 C = hn_mat3_num(m->tree->links[link].C);
    I = hn_sym3_rotate(m->g, &C, &I);
    hn_sym3 moved = hn_sym3_shift(m->g, at->mass, hn_vec3_zero(), rho, 0);
    at->s_own = hn_vec3_scale(m->g, at->mass, rho);
    at->I_own = hn_sym3_add(m->g, &I, &moved);
    return HN_OK;
}

/// Frame of a group to the world, set by its first link.
static void trace_world_frame(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    if (l->carry == HN_CARRY_NEW) {
        const hn_link_trace *base = &m->at[l->parent];
        hn_mat3 turned = hn_mat3_turn_z(base->c, base->s);
        turned = hn_mat3_mul(m->g, &turned, &m->group_X[l->group]);
        turned = hn_mat3_mul(m->g, &m->to_world[m->tree->links[l->parent].group], &turned);
        hn_mat3_snap(&turned);
        m->to_world[l->group] = turned;
    }
}

/// The turn R of a unit quaternion (w, x, y, z).
static hn_mat3 turn_of(hn_mech *m, const hn_ex *q) {
    hn_graph *g = m->g;
    hn_ex twice[4][4]; // 2 q_i q_j, i > 0
    for (int i = 1; i < 4; i++) {
        for (int j = 0; j <= i; j++) {
            twice[i][j] = hn_scale(2, hn_mul(g, q[i], q[j]));
        }
    }
    hn_mat3 R;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3; // cyclic: R_ij = 2 (q_i q_j - w q_k)
        const hn_ex ij = twice[i > j ? i + 1 : j + 1][i > j ? j + 1 : i + 1];
        hn_ex diagonal[3] = {hn_num(1), hn_neg(twice[j + 1][j + 1]), hn_neg(twice[k + 1][k + 1])};
        R.x[i][i] = hn_sum(g, diagonal, 3);
        R.x[i][j] = hn_sub(g, ij, twice[k + 1][0]);
        R.x[j][i] = hn_add(g, ij, twice[k + 1][0]);
    }
    return R;
}

static hn_mat3 transposed(const hn_mat3 *a) {
    hn_mat3 out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.x[i][j] = a->x[j][i];
        }
    }
    return out;
}

/// Finds where a ball's frame stands in its parent's, and the axes of its velocities. A joint whose
/// parent is the link itself turns back: its child's axes, in which the velocities are, are then
/// those on the link's parent, and its child turns the other way.
static void trace_ball(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    hn_mat3 here = hn_mat3_num(m->tree->groups[l->group].X);
    hn_mat3 R = turn_of(m, m->sys->q + l->position);
    m->at[link].spin = hn_mat3_identity();
    if (l->reversed) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                m->at[link].spin.x[i][j] = hn_neg(R.x[i][j]);
            }
        }
        R = transposed(&R);
    }
    m->at[link].turned = R;
    m->group_X[l->group] = hn_mat3_mul(m->g, &here, &R);
}

hn_status hn_mech_trace_geometry(hn_mech *m) {
    const hn_tree *tree = m->tree;
    hn_link_trace *ground = &m->at[tree->ground];
    ground->c = hn_num(1);
    ground->s = hn_num(0);
    m->position[tree->ground] = hn_vec3_zero();

    // frames of groups; those on the ground are final
    for (int k = 0; k < tree->n_groups; k++) {
        m->group_X[k] = hn_mat3_num(tree->groups[k].X);
        m->to_world[k] = hn_mat3_num(tree->groups[k].R); // right for groups of the ground
    }

    // outward, link by link
    for (int k = 0; k < tree->n_order; k++) {
        int link = tree->order[k];
        hn_link_trace *at = &m->at[link];
        int angle = tree->links[link].angle;
        at->c = angle >= 0 ? hn_cos(m->g, hn_mech_q(m, angle)) : hn_num(1);
        at->s = angle >= 0 ? hn_sin(m->g, hn_mech_q(m, angle)) : hn_num(0);

        if (tree->links[link].type == HN_JOINT_SPHERICAL) {
            trace_ball(m, link);
        }

        // where its joint point stands, and its own body
        HN_TRY(trace_arm(m, link));
        HN_TRY(trace_body(m, link));

        if (tree->groups[tree->links[link].group].moving) {
            trace_world_frame(m, link);
        }
        m->position[link] = hn_mech_world(m, tree->links[link].parent, at->arm);
    }
    return HN_OK;
}

// ---- composites ----

/// First moment and inertia of a set with mass mass, seen from a point from which its own lies at
/// r.
static void move_set(hn_mech *m, hn_ex mass, hn_vec3 *s, hn_sym3 *I, hn_vec3 r, int only_zz) {
    hn_sym3 gain = hn_sym3_shift(m->g, mass, *s, r, only_zz);
    *I = hn_sym3_add(m->g, I, &gain);
    *s = hn_vec3_add(m->g, *s, hn_vec3_scale(m->g, mass, r));
}

static void add_set(hn_mech *m, hn_vec3 *s, hn_sym3 *I, hn_vec3 s_more, hn_sym3 I_more) {
    *s = hn_vec3_add(m->g, *s, s_more);
    *I = hn_sym3_add(m->g, I, &I_more);
}

static hn_sym3 no_inertia(void) {
    hn_ex zero = hn_num(0);
    return (hn_sym3){{zero, zero, zero, zero, zero, zero}};
}

static void add_moved(hn_mech *m, hn_vec3 *s, hn_sym3 *I, hn_ex mass, hn_vec3 s_more,
                      hn_sym3 I_more, hn_vec3 r, int only_zz) {
    move_set(m, mass, &s_more, &I_more, r, only_zz);
    add_set(m, s, I, s_more, I_more);
}

/// The full composite of a child in E of its parent.
static void full_in_parent(hn_mech *m, int child, hn_vec3 *s, hn_sym3 *I) {
    const hn_link *l = &m->tree->links[child];
    const hn_link_trace *at = &m->at[child], *parent = &m->at[l->parent];
    *s = at->sF;
    *I = at->IF;
    if (l->carry == HN_CARRY_RIGID) {
        return;
    }
    *s = turn(m, child, *s, 0);
    *I = hn_sym3_turn_z(m->g, at->c, at->s, I);
    if (l->carry == HN_CARRY_GROUP) {
        *s = turn(m, l->parent, *s, 1);
        *I = hn_sym3_turn_z(m->g, parent->c, hn_neg(parent->s), I);
        return;
    }
    *s = hn_mat3_apply(m->g, &m->group_X[l->group], *s);
    *I = hn_sym3_rotate(m->g, &m->group_X[l->group], I);
}

/// Adds a child to its parent's composites (all in E of the parent).
static void add_child(hn_mech *m, int parent, int child) {
    const hn_link *l = &m->tree->links[child];
    hn_link_trace *p = &m->at[parent], *c = &m->at[child];
    int planar = hn_mech_is_planar(m, parent);
    hn_vec3 none = hn_vec3_zero();
    p->m = hn_add(m->g, p->m, c->m);

    // the child's full composite in E of the parent, where the child's group moves
    hn_vec3 s_full = none;
    hn_sym3 I_full = no_inertia();
    int child_moves = m->tree->groups[l->group].moving;
    if (child_moves) {
        full_in_parent(m, child, &s_full, &I_full);
    }

    // what turns with the parent
    if (l->carry == HN_CARRY_RIGID) {
        add_moved(m, &p->sK, &p->IK, c->m, c->sK, c->IK, c->arm, planar);
        add_moved(m, &p->sB, &p->IB, c->m, c->sB, c->IB, c->arm, planar);
        hn_vec3 zr = hn_vec3_cross(m->g, hn_vec3_num((double[3]){0, 0, 1}), c->arm);
        p->sigma = hn_vec3_add(m->g, p->sigma, c->sigma);
        p->eta =
            hn_vec3_add(m->g, p->eta, hn_vec3_add(m->g, c->eta, hn_vec3_cross(m->g, c->sigma, zr)));
    } else {
        int carried = l->carry == HN_CARRY_NEW && child_moves;
        add_moved(m, &p->sK, &p->IK, c->m, carried ? s_full : none, carried ? I_full : no_inertia(),
                  c->arm, planar);
        add_moved(m, &p->sB, &p->IB, c->m, none, no_inertia(), c->arm, planar);
        if (l->carry == HN_CARRY_GROUP && !planar) {
            hn_vec3 zr = hn_vec3_cross(m->g, hn_vec3_num((double[3]){0, 0, 1}), c->arm);
            p->sigma = hn_vec3_add(m->g, p->sigma, s_full);
            p->eta = hn_vec3_add(m->g, p->eta, hn_vec3_cross(m->g, s_full, zr));
        }
    }

    // the full composite of the parent
    if (!planar) {
        add_moved(m, &p->sF, &p->IF, c->m, s_full, I_full, c->arm, 0);
    }
}

void hn_mech_trace_composites(hn_mech *m) {
    for (int link = 0; link < m->tree->n_links; link++) {
        hn_link_trace *at = &m->at[link];
        at->m = at->mass;
        at->sK = at->sB = at->sF = at->s_own;
        at->IK = at->IB = at->IF = at->I_own;
        at->sigma = at->eta = hn_vec3_zero();
    }
    for (int k = m->tree->n_order - 1; k >= 0; k--) {
        int link = m->tree->order[k], parent = m->tree->links[link].parent;
        if (parent != m->tree->ground) {
            add_child(m, parent, link);
        }
    }
}

// ---- mass matrix ----

/// The wrench of a column on its way from its own link to the root, in work frames.
typedef struct wrench {
    hn_vec3 f, nK, nF;
} wrench;

/// Turning about `axis` (E) with what hangs on a ball: it has no group children, so everything
/// turns.
static wrench ball_wrench(hn_mech *m, int link, hn_vec3 axis) {
    const hn_link_trace *at = &m->at[link];
    wrench w;
    w.f = hn_vec3_cross(m->g, axis, at->sK);
    w.nK = w.nF = hn_sym3_apply(m->g, &at->IK, axis);
    return w;
}

/// Returns the wrench of a unit force or moment along the link's velocity number `part`.
static wrench unit_wrench(hn_mech *m, int link, int part) {
    const hn_link_trace *at = &m->at[link];
    int planar = hn_mech_is_planar(m, link);

    if (m->tree->links[link].type == HN_JOINT_SPHERICAL) {
        return ball_wrench(m, link, hn_mat3_column(&at->spin, part));
    }

    // a unit slide pushes the whole composite along its axis
    hn_vec3 s = hn_mech_E_to_work(m, link, at->sK);
    wrench w;
    if (m->tree->links[link].type == HN_JOINT_PRISMATIC) {
        hn_vec3 d = hn_mech_slide(m, link);
        w.f = hn_vec3_scale(m->g, at->m, d);
        w.nK = hn_mech_moment(m, link, s, d);
        w.nF = planar ? hn_vec3_zero() : hn_vec3_cross(m->g, at->sF, d);
        return w;
    }

    // a unit turn about z
    w.f = hn_vec3_cross(m->g, hn_vec3_num((double[3]){0, 0, 1}), s);
    w.nK = hn_vec3_zero();
    w.nK.x[2] = at->IK.x[2];
    w.nF = hn_vec3_zero();
    if (!planar) {
        w.nK.x[0] = at->IK.x[4];
        w.nK.x[1] = at->IK.x[5];
        w.nF = hn_vec3_add(m->g, w.nK, at->eta);
    }
    return w;
}

static wrench wrench_up(hn_mech *m, int child, wrench w) {
    const hn_link *l = &m->tree->links[child];
    int parent = l->parent;
    wrench up;
    up.f = hn_mech_up(m, child, w.f);
    hn_vec3 rf = hn_mech_moment(m, parent, m->at[child].r, up.f);
    int child_moves = !hn_mech_is_planar(m, child);
    hn_vec3 nF = child_moves ? hn_mech_up(m, child, w.nF) : hn_vec3_zero();
    up.nK = rf;
    if (l->carry == HN_CARRY_RIGID) {
        up.nK = hn_vec3_add(m->g, rf, w.nK);
    } else if (l->carry == HN_CARRY_NEW) {
        up.nK = hn_vec3_add(m->g, rf, nF);
    }
    up.nF = hn_mech_is_planar(m, parent) ? hn_vec3_zero() : hn_vec3_add(m->g, rf, nF);
    return up;
}

static hn_ex project_wrench(hn_mech *m, int link, int part, const wrench *w) {
    if (m->tree->links[link].type == HN_JOINT_PRISMATIC) {
        return hn_vec3_dot(m->g, hn_mech_slide(m, link), w->f);
    }
    if (m->tree->links[link].type == HN_JOINT_SPHERICAL) {
        return hn_vec3_dot(m->g, hn_mat3_column(&m->at[link].spin, part), w->nK);
    }
    return w->nK.x[2];
}

void hn_mech_trace_mass(hn_mech *m) {
    const hn_tree *tree = m->tree;

    // column j: the wrench of a unit velocity, handed down to the root
    for (int j = 0; j < tree->n_coordinates; j++) {
        const int own = tree->link_of[j];
        int link = own;
        wrench w = unit_wrench(m, link, j - tree->links[link].coordinate);

        // projected on every joint on the way
        for (int i = link; i != tree->ground; i = tree->links[i].parent) {
            if (i != link) {
                w = wrench_up(m, link, w);
                link = i;
            }

            const int first = tree->links[i].coordinate;
            for (int part = 0; part < tree->links[i].n_speeds; part++) {
                const int row = first + part;
                if (i == own && row > j) {
                    continue; // the block of a ball itself: one triangle
                }
                hn_entries_add(&m->sys->M, row > j ? row : j, row > j ? j : row,
                               project_wrench(m, i, part, &w));
            }
        }
    }
}
