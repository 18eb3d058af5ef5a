// SPDX-License-Identifier: GPL-3.0-or-later
// Bias forces h (what the joints must give at zero u-dot, gravity included) and energy, by
// recursion.
//
// Out: a_c = a_i + B_i r_c (+ 2 w x d q'), with -g at the root, so that gravity needs no term of
// its own. In: the force of a subtree is its mass times the acceleration of its joint point plus a
// LOCAL REST
//          f_i = m_i a_i + gf_i,  gf_i = B_i s_i + pf_i,  pf_i = sum of gf_c over revolute children
//      so no m a is pushed down and rotated up again; moments about the joint point likewise
//          n_own = I al + w x I w + s x a + sum r_c x gf_c      (s, I: composite B of mech.h)
//      and the moments of children that the link's rotation carries (n_new) or of all (n_all).
#include "dynamics/compile/bias.h"

#include "dynamics/compile/formula.h"
#include "expr/construct.h"

static const double Z[3] = {0, 0, 1};

// ---- outward ----

/// Angular velocity and acceleration of a group's base, in the group's frame.
static void trace_base(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    const hn_link_trace *parent = &m->at[l->parent];
    if (l->carry != HN_CARRY_NEW) {
        return;
    }
    const hn_mat3 *X = &m->group_X[l->group];
    hn_vec3 w = hn_mech_work_to_E(m, l->parent, parent->w);
    hn_vec3 al = hn_mech_work_to_E(m, l->parent, parent->al);
    m->base_w[l->group] = w = hn_mat3_apply_transposed(m->g, X, w);
    m->base_al[l->group] = al = hn_mat3_apply_transposed(m->g, X, al);
    if (l->type == HN_JOINT_SPHERICAL) { // the frame turns with the link itself
        const hn_vec3 own = {
            {m->sys->v[l->coordinate], m->sys->v[l->coordinate + 1], m->sys->v[l->coordinate + 2]}};
        const hn_vec3 omega = hn_mat3_apply(m->g, &m->at[link].spin, own);
        m->base_w[l->group] = hn_vec3_add(m->g, w, omega);
        m->base_al[l->group] = hn_vec3_add(m->g, al, hn_vec3_cross(m->g, w, omega));
    }
}

static void trace_rotation(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    hn_link_trace *at = &m->at[link];

    // turns as its parent does
    if (l->carry == HN_CARRY_RIGID) {
        at->w = m->at[l->parent].w;
        at->al = m->at[l->parent].al;
        at->B = m->at[l->parent].B;
        return;
    }

    // the base first: what carries the group
    trace_base(m, link);

    // a ball's frame is its link's own
    if (l->type == HN_JOINT_SPHERICAL) {
        at->w = m->base_w[l->group];
        at->al = m->base_al[l->group];
        at->B = hn_mat3_accel(m->g, at->w, at->al);
        return;
    }

    // the base's motion plus the link's own turn about z
    hn_vec3 uz = hn_vec3_scale(m->g, m->sys->v[l->coordinate], hn_vec3_num(Z));
    hn_vec3 w = hn_vec3_add(m->g, m->base_w[l->group], uz);
    hn_vec3 al =
        hn_vec3_add(m->g, m->base_al[l->group], hn_vec3_cross(m->g, m->base_w[l->group], uz));

    // into the work frame
    if (!hn_mech_is_planar(m, link)) { // into E
        hn_mat3 R = hn_mat3_turn_z(at->c, at->s);
        w = hn_mat3_apply_transposed(m->g, &R, w);
        al = hn_mat3_apply_transposed(m->g, &R, al);
    }
    at->w = w;
    at->al = al;
    at->B = hn_mat3_accel(m->g, w, al);
}

static void trace_motion(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    const hn_link_trace *parent = &m->at[l->parent];
    hn_link_trace *at = &m->at[link];
    hn_vec3 a = hn_vec3_add(m->g, parent->a, hn_mat3_apply(m->g, &parent->B, at->r));
    at->kappa = hn_vec3_zero();
    if (l->type == HN_JOINT_PRISMATIC) {
        hn_vec3 gone = hn_vec3_scale(m->g, m->sys->v[l->coordinate], hn_mech_slide(m, link));
        at->kappa = hn_vec3_scale(m->g, hn_num(2), hn_vec3_cross(m->g, parent->w, gone));
        a = hn_vec3_add(m->g, a, at->kappa);
    }
    at->a = hn_mech_down(m, link, a);
    at->gravity = hn_mech_down(m, link, parent->gravity);
    trace_rotation(m, link);
}

// ---- inward ----

static void close_link(hn_mech *m, int link) {
    hn_link_trace *at = &m->at[link];
    hn_vec3 s = hn_mech_E_to_work(m, link, at->sB);
    at->gf = hn_vec3_add(m->g, hn_mat3_apply(m->g, &at->B, s), at->pf);
    at->f = hn_vec3_add(m->g, hn_vec3_scale(m->g, at->m, at->a), at->gf);
    at->n_own = hn_vec3_add(m->g, hn_mech_moment(m, link, s, at->a), at->n_rest);
    if (!hn_mech_is_planar(m, link)) {
        hn_vec3 spin = hn_vec3_cross(m->g, at->w, hn_sym3_apply(m->g, &at->IB, at->w));
        hn_vec3 turned = hn_sym3_apply(m->g, &at->IB, at->al);
        at->n_own = hn_vec3_add(m->g, at->n_own, hn_vec3_add(m->g, turned, spin));
    }
}

static void hand_inward(hn_mech *m, int link) {
    const hn_link *l = &m->tree->links[link];
    const hn_link_trace *at = &m->at[link];
    hn_link_trace *p = &m->at[l->parent];
    int moves = !hn_mech_is_planar(m, link);

    hn_vec3 rest;

    // the child's rest, and the moments that its rotation carries
    if (l->carry == HN_CARRY_RIGID) {
        // its own B s stands in the parent's composite already
        rest = hn_vec3_add(m->g, hn_vec3_scale(m->g, at->m, at->kappa), at->pf);
        hn_vec3 s = hn_mech_E_to_work(m, link, at->sB);
        hn_vec3 n = hn_vec3_add(m->g, hn_mech_moment(m, link, s, at->kappa), at->n_rest);
        p->n_rest = hn_vec3_add(m->g, p->n_rest, n);
        p->n_new = hn_vec3_add(m->g, p->n_new, at->n_new);
        p->n_all = hn_vec3_add(m->g, p->n_all, at->n_all);
    } else {
        rest = hn_mech_up(m, link, at->gf);
        if (moves) { // a base that does not rotate has no use for the moment
            hn_vec3 n = hn_mech_up(m, link, hn_vec3_add(m->g, at->n_own, at->n_all));
            p->n_all = hn_vec3_add(m->g, p->n_all, n);
            if (l->carry == HN_CARRY_NEW) {
                p->n_new = hn_vec3_add(m->g, p->n_new, n);
            }
        }
    }

    // both at the parent's joint point
    p->pf = hn_vec3_add(m->g, p->pf, rest);
    p->n_rest = hn_vec3_add(m->g, p->n_rest, hn_mech_moment(m, l->parent, at->r, rest));
}

static hn_ex joint_force(hn_mech *m, int link, int part) {
    const hn_link_trace *at = &m->at[link];
    if (m->tree->links[link].type == HN_JOINT_PRISMATIC) {
        return hn_vec3_dot(m->g, hn_mech_slide(m, link), at->f);
    }
    if (m->tree->links[link].type == HN_JOINT_SPHERICAL) {
        hn_vec3 n = hn_vec3_add(m->g, at->n_own, at->n_new);
        return hn_vec3_dot(m->g, hn_mat3_column(&at->spin, part), n);
    }
    return hn_add(m->g, at->n_own.x[2], at->n_new.x[2]);
}

static hn_vec3 scene_gravity(hn_mech *m) {
    hn_vec3 g;
    if (hn_system_vector(m->sys, m->sys->scene->gravity, &g) != HN_OK) {
        return hn_vec3_zero(); // told when the scene's gravity was first read
    }
    hn_mat3 C = hn_mat3_num(m->tree->links[m->tree->ground].C);
    return hn_mat3_apply(m->g, &C, g);
}

void hn_mech_trace_bias(hn_mech *m) {
    const hn_tree *tree = m->tree;
    hn_link_trace *ground = &m->at[tree->ground];
    hn_vec3 none = hn_vec3_zero();

    // the ground stands still, seen from free fall
    ground->gravity = scene_gravity(m);
    ground->a = hn_vec3_sub(m->g, none, ground->gravity);
    ground->w = ground->al = none;
    ground->B = hn_mat3_accel(m->g, none, none);

    // nothing is handed inward yet
    for (int l = 0; l < tree->n_links; l++) {
        hn_link_trace *at = &m->at[l];
        at->pf = at->n_rest = at->n_new = at->n_all = none;
    }

    // outward: motion
    for (int k = 0; k < tree->n_order; k++) {
        trace_motion(m, tree->order[k]);
    }

    // inward: forces
    for (int k = tree->n_order - 1; k >= 0; k--) {
        int link = tree->order[k];
        close_link(m, link);
        for (int part = 0; part < tree->links[link].n_speeds; part++) {
            hn_ex *f = &m->sys->f[tree->links[link].coordinate + part];
            *f = hn_sub(m->g, *f, joint_force(m, link, part));
        }
        if (tree->links[link].parent != tree->ground) {
            hand_inward(m, link);
        }
    }
}

// ---- energy ----

static hn_ex sum_list(hn_mech *m, const hn_entries *list) {
    hn_ex *terms = malloc(((size_t)list->n + 1) * sizeof *terms);
    if (!terms) {
        m->sys->M.failed = 1; // read as memory failure by the compiler
        return hn_num(0);
    }
    for (int k = 0; k < list->n; k++) {
        terms[k] = list->at[k].e;
    }
    hn_ex sum = hn_sum(m->g, terms, list->n);
    free(terms);
    return sum;
}

void hn_mech_trace_energy(hn_mech *m) {
    const hn_tree *tree = m->tree;
    const hn_ex *u = m->sys->v;
    hn_entries terms = {0};
    for (int k = 0; k < m->sys->M.n; k++) {
        const hn_entry *M = &m->sys->M.at[k];
        hn_ex uu = hn_mul(m->g, u[M->row], u[M->col]);
        hn_entries_add(&terms, 0, 0, hn_scale(M->row == M->col ? 0.5 : 1, hn_mul(m->g, M->e, uu)));
    }
    m->sys->kinetic = sum_list(m, &terms);

    // of gravity: -g . (own first moment + mass of every child at its joint point), link by link
    terms.n = 0;
    for (int l = 0; l < tree->n_links; l++) {
        hn_link_trace *at = &m->at[l];
        hn_vec3 s = l == tree->ground ? hn_vec3_zero() : hn_mech_E_to_work(m, l, at->s_own);
        for (int c = tree->links[l].first_child; c >= 0; c = tree->links[c].next_sibling) {
            s = hn_vec3_add(m->g, s, hn_vec3_scale(m->g, m->at[c].m, m->at[c].r));
        }
        hn_entries_add(&terms, 0, 0, hn_neg(hn_vec3_dot(m->g, at->gravity, s)));
    }
    m->sys->potential = hn_add(m->g, m->sys->potential, sum_list(m, &terms));
    m->sys->M.failed |= terms.failed;
    hn_entries_reset(&terms);
}
