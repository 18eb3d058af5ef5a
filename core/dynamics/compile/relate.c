// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of two points relative to a common ancestor of their links, in ONE frame of that
// ancestor's: closure rows and loads are
// written in the frame of their loop, never in the world by default.
//
// The frame. If a path leaves the ancestor through an axis parallel to the ancestor's own group,
// absolute angles count from that group's base, so the frame is the group's (and the ancestor's own
// angle takes part). Otherwise the frame is fixed in the ancestor and agrees with the first group
// met, whose links then stand in it by their absolute angle alone.
#include "dynamics/compile/relate.h"

#include "expr/construct.h"

static const double Z[3] = {0, 0, 1};

typedef struct walk {
    hn_mech *m;
    int common, fixed; ///< fixed: the frame is fixed in the ancestor
    int group;         ///< group whose frame this is, -1: the theta-free frame of the ancestor
    hn_reach *out;
    hn_mat3 W; ///< F of the present group to the frame
    hn_vec3 base_w, base_al;
    hn_vec3 al;
} walk;

/// Path from the ancestor (exclusive) down to `link`, into m->path; returns its length.
static int list_path(hn_mech *m, int common, int link) {
    int n = 0;
    for (int l = link; l != common; l = m->tree->links[l].parent) {
        n++;
    }
    int at = n;
    for (int l = link; l != common; l = m->tree->links[l].parent) {
        m->path[--at] = l;
    }
    return n;
}

/// The first revolute link on the way down, or -1: none, or a ball comes first and groups behind it
/// say nothing here.
static int first_revolute(hn_mech *m, int common, int link) {
    int n = list_path(m, common, link);
    for (int k = 0; k < n; k++) {
        if (m->tree->links[m->path[k]].type == HN_JOINT_REVOLUTE) {
            return m->path[k];
        }
        if (m->tree->links[m->path[k]].type == HN_JOINT_SPHERICAL) {
            return -1;
        }
    }
    return -1;
}

static void choose_frame(walk *w, int a, int b) {
    int first[2] = {first_revolute(w->m, w->common, a), first_revolute(w->m, w->common, b)};
    const hn_link *links = w->m->tree->links;
    w->fixed = 1;
    w->group = -1;
    for (int side = 0; side < 2; side++) {
        if (first[side] >= 0 && links[first[side]].carry == HN_CARRY_GROUP) {
            w->fixed = 0;
            w->group = links[w->common].group;
            return;
        }
    }
    for (int side = 0; side < 2 && w->group < 0; side++) {
        w->group = first[side] >= 0 ? links[first[side]].group : -1;
    }
    if (w->group < 0 && hn_tree_is_still(w->m->tree, w->common)) {
        w->group = links[w->common].group; // nothing rotates: the ground's own frame
        w->fixed = 0;
    }
}

static void push(walk *w, int coordinate, int group, int is_slide, hn_vec3 axis) {
    w->out->levers[w->out->n++] =
        (hn_lever){coordinate, is_slide, group, !is_slide, axis, hn_vec3_zero()};
}

static void begin(walk *w) {
    hn_mech *m = w->m;
    const hn_link *common = &m->tree->links[w->common];
    const hn_link_trace *at = &m->at[w->common];
    hn_vec3 none = hn_vec3_zero();
    w->out->pos = w->out->acc = none;
    w->out->n = 0;
    w->base_w = w->base_al = w->al = w->out->w = none;
    w->W = hn_mat3_identity();

    // the frame is fixed in the ancestor, or the ancestor's own angle takes part
    if (w->fixed) {
        w->out->U = hn_mat3_identity();
        if (w->group >= 0) {
            double back[3][3];
            hn_num3_transpose(m->tree->groups[w->group].X, back);
            w->out->U = hn_mat3_num(back);
        }
    } else {
        w->out->U = hn_mat3_turn_z(at->c, at->s);
        if (common->angle >= 0) {
            w->out->w = hn_vec3_scale(m->g, m->sys->v[common->angle], hn_vec3_num(Z));
            push(w, common->angle, common->group, 0, hn_vec3_num(Z));
        }
    }

    w->out->B = hn_mat3_accel(m->g, w->out->w, none);
}

/// Moves the point by an arm fixed to the present link.
static void extend(walk *w, hn_vec3 arm) {
    hn_graph *g = w->m->g;
    hn_vec3 r = hn_mat3_apply(g, &w->out->U, arm);
    w->out->pos = hn_vec3_add(g, w->out->pos, r);
    w->out->acc = hn_vec3_add(g, w->out->acc, hn_mat3_apply(g, &w->out->B, r));
    for (int k = 0; k < w->out->n; k++) {
        hn_lever *lever = &w->out->levers[k];
        if (lever->open) {
            lever->lever = hn_vec3_add(g, lever->lever, r);
        }
    }
}

static void slide_along(walk *w, int link) {
    hn_mech *m = w->m;
    int coordinate = m->tree->links[link].coordinate;
    hn_vec3 d = hn_mat3_apply(m->g, &w->out->U, m->at[link].slide);
    hn_vec3 gone = hn_vec3_scale(m->g, m->sys->v[coordinate], d);
    hn_vec3 coriolis = hn_vec3_scale(m->g, hn_num(2), hn_vec3_cross(m->g, w->out->w, gone));
    w->out->acc = hn_vec3_add(m->g, w->out->acc, coriolis);
    push(w, coordinate, -1, 1, d);
}

/// The frame of a new group: fixed in the present link, from which it takes its base's motion.
static void enter_group(walk *w, int group) {
    w->W = group == w->group ? hn_mat3_identity()
                             : hn_mat3_mul(w->m->g, &w->out->U, &w->m->group_X[group]);
    hn_mat3_snap(&w->W);
    w->base_w = w->out->w;
    w->base_al = w->al;
}

static void turn_about(walk *w, int link) {
    hn_mech *m = w->m;
    const hn_link *l = &m->tree->links[link];
    if (l->carry == HN_CARRY_NEW) {
        enter_group(w, l->group);
    } else {
        for (int k = 0; k < w->out->n; k++) { // the group's last angle stops here
            w->out->levers[k].open &= w->out->levers[k].group != l->group;
        }
    }
    hn_mat3 Rz = hn_mat3_turn_z(m->at[link].c, m->at[link].s);
    w->out->U = hn_mat3_mul(m->g, &w->W, &Rz);
    hn_vec3 z = hn_mat3_column(&w->W, 2);
    hn_vec3 uz = hn_vec3_scale(m->g, m->sys->v[l->coordinate], z);
    w->out->w = hn_vec3_add(m->g, w->base_w, uz);
    w->al = hn_vec3_add(m->g, w->base_al, hn_vec3_cross(m->g, w->base_w, uz));
    w->out->B = hn_mat3_accel(m->g, w->out->w, w->al);
    push(w, l->coordinate, l->group, 0, z);
}

/// A ball turns about three axes at once.
static void turn_ball(walk *w, int link) {
    hn_mech *m = w->m;
    const hn_link *l = &m->tree->links[link];
    enter_group(w, l->group);
    w->out->U = w->W;
    hn_vec3 omega = hn_vec3_zero();
    for (int part = 0; part < 3; part++) {
        const hn_vec3 spin = hn_mat3_column(&m->at[link].spin, part);
        const hn_vec3 axis = hn_mat3_apply(m->g, &w->W, spin);
        const hn_vec3 turned = hn_vec3_scale(m->g, m->sys->v[l->coordinate + part], axis);
        omega = hn_vec3_add(m->g, omega, turned);
        push(w, l->coordinate + part, l->group, 0, axis);
    }
    w->out->w = hn_vec3_add(m->g, w->base_w, omega);
    w->al = hn_vec3_add(m->g, w->base_al, hn_vec3_cross(m->g, w->base_w, omega));
    w->out->B = hn_mat3_accel(m->g, w->out->w, w->al);
}

static void step_down(walk *w, int link) {
    switch (w->m->tree->links[link].type) {
    case HN_JOINT_PRISMATIC:
        slide_along(w, link);
        break;
    case HN_JOINT_REVOLUTE:
        turn_about(w, link);
        break;
    case HN_JOINT_SPHERICAL:
        turn_ball(w, link);
        break;
    default: // fixed: nothing moves
        break;
    }
}

static hn_status reach(walk *w, int link, hn_vec3 arm, hn_reach *out) {
    hn_mech *m = w->m;
    int n = list_path(m, w->common, link);
    out->levers = hn_arena_get(m->sys->arena, (3 * (size_t)n + 1) * sizeof *out->levers);
    if (!out->levers) {
        return HN_ERR_MEMORY;
    }
    w->out = out;
    begin(w);
    for (int k = 0; k < n; k++) {
        int next = m->path[k];
        extend(w, m->at[next].arm);
        step_down(w, next);
    }
    extend(w, arm);
    return HN_OK;
}

/// Frame to world, for an ancestor that does not rotate.
static void tell_world(walk *w, hn_relative *out) {
    const hn_tree *tree = w->m->tree;
    out->aligned = 0;
    if (!hn_tree_is_still(tree, w->common)) {
        return;
    }
    const hn_group *group = &tree->groups[w->group >= 0 ? w->group : tree->links[w->common].group];
    out->aligned = 1;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out->to_world[i][j] = group->R[i][j];
            out->aligned &= group->R[i][j] == (i == j ? 1.0 : 0.0);
        }
    }
}

hn_status hn_mech_relate(hn_mech *m, int common, int a, hn_vec3 arm_a, int b, hn_vec3 arm_b,
                         hn_relative *out) {
    walk w = {.m = m, .common = common};
    choose_frame(&w, a, b);
    out->common = common;
    tell_world(&w, out);
    HN_TRY(reach(&w, a, arm_a, &out->a));
    return reach(&w, b, arm_b, &out->b);
}

hn_vec3 hn_lever_coefficient(hn_graph *g, const hn_lever *lever) {
    return lever->is_slide ? lever->axis : hn_vec3_cross(g, lever->axis, lever->lever);
}
