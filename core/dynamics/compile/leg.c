// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/leg.h"

#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double Z[3] = {0, 0, 1};

typedef struct lever {
    int coordinate;
    int group;     ///< of the turn, -1: a slide
    bool open;     ///< still turns what comes
    bool is_own;   ///< nothing has turned since: the present link moves with it as one body
    hn_vec3 local; ///< axis in E of the link that it turns, while is_own
    hn_vec3 axis;  ///< the same in the frame
    hn_vec3 moved; ///< d pos / d u so far
} lever;

/// A walk from the common ancestor to an end, in one frame.
typedef struct walk {
    hn_mech *m;
    int n;
    int *path;               ///< n links, the ancestor's child first
    hn_mat3 U;               ///< E of the present link to the frame
    const hn_mat3 *E, *F;    ///< per link of the path, known already; NULL: found on the way
    hn_mat3 G;               ///< F of the present group to the frame
    hn_vec3 base_w, base_al; ///< of the present group
    hn_vec3 w, al;
    hn_mat3 B;
    hn_vec3 pos, acc;
    int n_levers;
    lever *levers;
} walk;

// ---- paths ----

static int list_path(const hn_tree *tree, int common, int link, int *path) {
    int n = 0;
    for (int l = link; l != common; l = tree->links[l].parent) {
        n++;
    }
    int at = n;
    for (int l = link; l != common; l = tree->links[l].parent) {
        path[--at] = l;
    }
    return n;
}

void hn_leg_count_passes(hn_mech *m) {
    const hn_tree *tree = m->tree;
    for (int k = 0; k < tree->n_cut; k++) {
        const hn_joint *joint = &m->sys->scene->joints[tree->cut[k]];
        const int ends[2] = {hn_tree_link(tree, joint->parent), hn_tree_link(tree, joint->child)};
        const int common = hn_tree_common(tree, ends[0], ends[1]);
        for (int e = 0; e < 2; e++) {
            for (int l = ends[e]; l != common; l = tree->links[l].parent) {
                m->passed[l]++;
            }
        }
    }
}

/// Links on the way to an end that other closures pass too.
static int count_shared(const hn_closure *c, int end) {
    const hn_tree *tree = c->m->tree;
    int n = 0;
    for (int l = c->link[end]; l != c->rel.common; l = tree->links[l].parent) {
        n += c->m->passed[l] > 1;
    }
    return n;
}

/// Returns whether an angle on the way to an end counts from the base of the ancestor's own group.
static bool has_common_angle(const hn_closure *c, int end) {
    const hn_tree *tree = c->m->tree;
    int first = -1;
    for (int l = c->link[end]; l != c->rel.common; l = tree->links[l].parent) {
        const hn_joint_type type = tree->links[l].type;
        first = type == HN_JOINT_REVOLUTE || type == HN_JOINT_SPHERICAL ? l : first;
    }
    return first >= 0 && tree->links[first].carry == HN_CARRY_GROUP;
}

/// The end whose last body is the leg, -1: the loop has none.
static int choose_end(const hn_closure *c) {
    if (has_common_angle(c, 0) || has_common_angle(c, 1)) {
        return -1;
    }
    const bool spatial[2] = {!hn_mech_is_planar(c->m, c->link[0]) && c->rel.a.n > 0,
                             !hn_mech_is_planar(c->m, c->link[1]) && c->rel.b.n > 0};
    if (!spatial[0] || !spatial[1]) {
        return spatial[0] ? 0 : spatial[1] ? 1 : -1;
    }
    return count_shared(c, 1) < count_shared(c, 0) ? 1 : 0;
}

// ---- frames of the leg's path, from its last body inward ----

static hn_mat3 transposed(const hn_mat3 *a) {
    hn_mat3 out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.x[i][j] = a->x[j][i];
        }
    }
    return out;
}

static hn_mat3 times_turn(hn_mech *m, const hn_mat3 *a, hn_ex c, hn_ex s) {
    const hn_mat3 R = hn_mat3_turn_z(c, s);
    return hn_mat3_mul(m->g, a, &R);
}

/// A constant turn M as M' Rz(-angle), M' with as few entries as there can be: the angle joins that
/// of the turn about z behind it.
static double split_turn(double M[3][3]) {
    for (int i = 0; i < 3; i++) {
        if (fabs(M[i][2]) > HN_NUM3_SNAP || M[i][0] == 0 || M[i][1] == 0) {
            continue;
        }
        const double angle = atan2(M[i][1], M[i][0]), c = cos(angle), s = sin(angle);
        double Rz[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, fewer[3][3];
        hn_num3_compose(M, Rz, fewer);
        hn_num3_snap(fewer, HN_NUM3_SNAP);
        memcpy(M, fewer, sizeof fewer);
        return angle;
    }
    return 0;
}

/// The frames of a path as seen from the leg.
typedef struct frames {
    hn_mat3 *E, *F; ///< E of each link to the leg's axes; F of the group of each that turns
    hn_mat3 root;   ///< E of the ancestor
    hn_mat3 start;  ///< the axes that the other end is written in
} frames;

/// a Rz(-(theta + angle)) of a link.
static hn_mat3 turned_back(hn_mech *m, const hn_mat3 *a, int link, double angle) {
    hn_graph *g = m->g;
    const hn_ex c = m->at[link].c, s = m->at[link].s;
    if (angle == 0) {
        return times_turn(m, a, c, hn_neg(s));
    }
    const hn_ex cos_both = hn_sub(g, hn_scale(cos(angle), c), hn_scale(sin(angle), s));
    const hn_ex sin_both = hn_add(g, hn_scale(sin(angle), c), hn_scale(cos(angle), s));
    return times_turn(m, a, cos_both, hn_neg(sin_both));
}

/// Finds the frames; `start` (numbers) takes E of the ancestor to the axes of the other end.
static void find_frames(hn_mech *m, const int *path, int n, double start[3][3], frames *out) {
    const hn_link *links = m->tree->links;
    hn_mat3 next = hn_mat3_identity(); // E of the link, seen from the leg
    hn_mat3 fewer = next;              // the same but for a turn by `angle` about its z
    double back[3][3], angle = 0;
    hn_num3_transpose(start, back);
    for (int k = n - 1; k >= 0; k--) {
        const hn_link *l = &links[path[k]];
        out->E[k] = out->F[k] = next;
        if (l->carry == HN_CARRY_RIGID) {
            continue;
        }
        out->F[k] = turned_back(m, &fewer, path[k], angle);
        angle = 0;
        if (l->carry == HN_CARRY_GROUP) {
            next = times_turn(m, &out->F[k], m->at[l->parent].c, m->at[l->parent].s);
        } else if (l->type != HN_JOINT_REVOLUTE) {
            const hn_mat3 X = transposed(&m->group_X[l->group]);
            next = hn_mat3_mul(m->g, &out->F[k], &X);
        } else {
            double X[3][3], M[3][3];
            memcpy(X, m->tree->groups[l->group].X, sizeof X);
            hn_num3_transpose(X, M);
            hn_mat3 constant = hn_mat3_num(M);
            next = hn_mat3_mul(m->g, &out->F[k], &constant);
            if (k == 0) { // both constant turns at once
                double both[3][3];
                hn_num3_compose(M, back, both);
                hn_num3_snap(both, HN_NUM3_SNAP);
                constant = hn_mat3_num(both);
                out->root = next;
                out->start = hn_mat3_mul(m->g, &out->F[k], &constant);
                return;
            }
            if (links[path[k - 1]].type == HN_JOINT_REVOLUTE) {
                angle = split_turn(M);
                constant = hn_mat3_num(M);
                fewer = hn_mat3_mul(m->g, &out->F[k], &constant);
                continue;
            }
        }
        fewer = next;
    }
    const hn_mat3 constant = hn_mat3_num(back);
    out->root = next;
    out->start = hn_mat3_mul(m->g, &next, &constant);
}

/// The axes of the first joint on the way to an end: takes E of the ancestor to them.
static void axes_of_first(const hn_mech *m, int common, int first, double out[3][3]) {
    const hn_link *l = &m->tree->links[first];
    double axes[3][3];
    if (l->type == HN_JOINT_REVOLUTE) {
        memcpy(axes, m->tree->groups[l->group].X, sizeof axes);
    } else {
        double here[3][3], C[3][3];
        memcpy(here, l->here, sizeof here);
        memcpy(C, m->tree->links[common].C, sizeof C);
        hn_num3_compose(C, here, axes);
    }
    hn_num3_transpose(axes, out);
    hn_num3_snap(out, HN_NUM3_SNAP);
}

// ---- outward ----

static void push(walk *w, int coordinate, int group, hn_vec3 local, hn_vec3 axis) {
    w->levers[w->n_levers++] = (lever){.coordinate = coordinate,
                                       .group = group,
                                       .open = group >= 0,
                                       .is_own = group >= 0,
                                       .local = local,
                                       .axis = axis,
                                       .moved = group >= 0 ? hn_vec3_zero() : axis};
}

/// Moves the point by an arm fixed to the present link.
static void extend(walk *w, hn_vec3 arm) {
    hn_graph *g = w->m->g;
    const hn_vec3 r = hn_mat3_apply(g, &w->U, arm);
    w->pos = hn_vec3_add(g, w->pos, r);
    w->acc = hn_vec3_add(g, w->acc, hn_mat3_apply(g, &w->B, r));
    for (int k = 0; k < w->n_levers; k++) {
        lever *l = &w->levers[k];
        if (l->open) {
            const hn_vec3 part = l->is_own
                                     ? hn_mat3_apply(g, &w->U, hn_vec3_cross(g, l->local, arm))
                                     : hn_vec3_cross(g, l->axis, r);
            l->moved = hn_vec3_add(g, l->moved, part);
        }
    }
}

static void slide_along(walk *w, int link) {
    hn_mech *m = w->m;
    const int coordinate = m->tree->links[link].coordinate;
    const hn_vec3 d = hn_mat3_apply(m->g, &w->U, m->at[link].slide);
    const hn_vec3 gone = hn_vec3_scale(m->g, m->sys->v[coordinate], d);
    const hn_vec3 turned = hn_vec3_cross(m->g, w->w, gone);
    w->acc = hn_vec3_add(m->g, w->acc, hn_vec3_scale(m->g, hn_num(2), turned));
    push(w, coordinate, -1, hn_vec3_zero(), d);
}

/// The frame of a ball's group: where the way so far is numbers, they and those of the joint make
/// one constant turn.
static hn_mat3 frame_of_group(const walk *w, int link) {
    const hn_mech *m = w->m;
    const hn_link *l = &m->tree->links[link];
    double U[3][3], X[3][3], both[3][3];
    for (int i = 0; i < 9; i++) {
        if (l->type != HN_JOINT_SPHERICAL ||
            !hn_is_number(w->U.x[i / 3][i % 3], &U[i / 3][i % 3])) {
            return hn_mat3_mul(m->g, &w->U, &m->group_X[l->group]);
        }
    }
    memcpy(X, m->tree->groups[l->group].X, sizeof X);
    hn_num3_compose(U, X, both);
    hn_num3_snap(both, HN_NUM3_SNAP);
    const hn_mat3 constant = hn_mat3_num(both);
    return hn_mat3_mul(m->g, &constant, &m->at[link].turned);
}

/// The levers turned so far become the base of the next group; none remain at a group's last angle.
static void close_levers(walk *w, const hn_link *l) {
    for (int k = 0; k < w->n_levers; k++) {
        w->levers[k].is_own = false;
        w->levers[k].open &= l->carry == HN_CARRY_NEW || w->levers[k].group != l->group;
    }
}

static void turn_at(walk *w, int k) {
    hn_mech *m = w->m;
    const int link = w->path[k];
    const hn_link *l = &m->tree->links[link];
    const bool is_ball = l->type == HN_JOINT_SPHERICAL;
    close_levers(w, l);
    if (l->carry == HN_CARRY_NEW) {
        w->base_w = w->w;
        w->base_al = w->al;
    }

    // the frame of the group, and of the link itself
    if (w->F) {
        w->G = w->F[k];
    } else if (l->carry == HN_CARRY_NEW) {
        w->G = frame_of_group(w, link);
        hn_mat3_snap(&w->G);
    }
    w->U = w->E ? w->E[k] : times_turn(m, &w->G, m->at[link].c, m->at[link].s);

    // about one axis, or three
    hn_vec3 omega = hn_vec3_zero();
    for (int part = 0; part < l->n_speeds; part++) {
        const hn_vec3 local = is_ball ? hn_mat3_column(&m->at[link].spin, part) : hn_vec3_num(Z);
        const hn_vec3 axis = hn_mat3_apply(m->g, &w->G, local);
        const hn_vec3 turned = hn_vec3_scale(m->g, m->sys->v[l->coordinate + part], axis);
        omega = hn_vec3_add(m->g, omega, turned);
        push(w, l->coordinate + part, l->group, local, axis);
    }
    w->w = hn_vec3_add(m->g, w->base_w, omega);
    w->al = hn_vec3_add(m->g, w->base_al, hn_vec3_cross(m->g, w->base_w, omega));
    w->B = hn_mat3_accel(m->g, w->w, w->al);
}

/// Walks to the end; `skip_first`: the arm on the ancestor is left to the other end.
static void walk_to(walk *w, bool skip_first, hn_vec3 arm) {
    const hn_mech *m = w->m;
    for (int k = 0; k < w->n; k++) {
        const hn_link *l = &m->tree->links[w->path[k]];
        if (k > 0 || !skip_first) {
            extend(w, m->at[w->path[k]].arm);
        }
        if (l->type == HN_JOINT_PRISMATIC) {
            slide_along(w, w->path[k]);
        } else if (l->type != HN_JOINT_FIXED) {
            turn_at(w, k);
        }
    }
    extend(w, arm);
}

static hn_status begin_walk(hn_mech *m, int common, int link, walk *out) {
    hn_arena *arena = m->sys->arena;
    *out = (walk){.m = m, .path = hn_arena_ints(arena, (size_t)m->tree->n_links + 1)};
    if (!out->path) {
        return HN_ERR_MEMORY;
    }
    out->n = list_path(m->tree, common, link, out->path);
    out->levers = hn_arena_get(arena, (3 * (size_t)out->n + 1) * sizeof *out->levers);
    out->U = hn_mat3_identity();
    return out->levers ? HN_OK : HN_ERR_MEMORY;
}

// ---- the leg ----

static int add_entries(hn_mech *m, const walk *w, double sign, const hn_mat3 *turn, int n,
                       int *coordinate, hn_vec3 *entry) {
    for (int k = 0; k < w->n_levers; k++) {
        hn_vec3 e = hn_vec3_scale(m->g, hn_num(sign), w->levers[k].moved);
        coordinate[n] = w->levers[k].coordinate;
        entry[n++] = turn ? hn_mat3_apply(m->g, turn, e) : e;
    }
    return n;
}

static bool list_entries(hn_leg *leg, int row, int n, const int *coordinate, const hn_vec3 *entry) {
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < n; k++) {
            hn_entries_add(&leg->J, row + i, coordinate[k], entry[k].x[i]);
        }
    }
    hn_entries_sort(&leg->J);
    return !leg->J.failed;
}

/// The rows with the leg's end `own` and the other, both walked; `turn` takes the axes of the
/// other's first joint to the leg's.
static hn_status make_rows(const hn_closure *c, int end, const walk *own, const walk *other,
                           const hn_mat3 *turn, hn_leg *leg) {
    hn_mech *m = c->m;
    const double sign = end ? -1 : 1; // the gap is end a minus end b
    const size_t cap = (size_t)(own->n_levers + other->n_levers) + 1;
    int *coordinate = hn_arena_ints(m->sys->arena, cap);
    hn_vec3 *entry = hn_arena_get(m->sys->arena, cap * sizeof *entry);
    if (!coordinate || !entry) {
        return HN_ERR_MEMORY;
    }
    const hn_vec3 pos = hn_vec3_sub(m->g, own->pos, hn_mat3_apply(m->g, turn, other->pos));
    const hn_vec3 acc = hn_vec3_sub(m->g, own->acc, hn_mat3_apply(m->g, turn, other->acc));
    for (int i = 0; i < 3; i++) {
        leg->phi[i] = hn_scale(sign, pos.x[i]);
        leg->gamma[i] = hn_scale(sign, acc.x[i]);
    }
    int n = add_entries(m, own, sign, NULL, 0, coordinate, entry);
    n = add_entries(m, other, -sign, turn, n, coordinate, entry);
    return list_entries(leg, leg->row, n, coordinate, entry) ? HN_OK : HN_ERR_MEMORY;
}

static hn_status trace(const hn_closure *c, int end, hn_leg *leg) {
    hn_mech *m = c->m;
    const int common = c->rel.common;
    walk own, other;
    HN_TRY(begin_walk(m, common, c->link[end], &own));
    HN_TRY(begin_walk(m, common, c->link[!end], &other));
    frames seen = {.E = hn_arena_get(m->sys->arena, (size_t)own.n * sizeof *seen.E),
                   .F = hn_arena_get(m->sys->arena, (size_t)own.n * sizeof *seen.F)};
    if (!seen.E || !seen.F) {
        return HN_ERR_MEMORY;
    }

    // the other end in the axes of its own first joint, less the leg's place on the ancestor
    double start[3][3];
    axes_of_first(m, common, other.n > 0 ? other.path[0] : own.path[0], start);
    other.U = hn_mat3_num(start);
    const hn_vec3 place = hn_mat3_apply(m->g, &other.U, m->at[own.path[0]].arm);
    other.pos = hn_vec3_scale(m->g, hn_num(-1), place);
    walk_to(&other, false, c->arm[!end]);

    // the leg in its own
    find_frames(m, own.path, own.n, start, &seen);
    own.U = seen.root;
    own.E = seen.E;
    own.F = seen.F;
    walk_to(&own, true, c->arm[end]);
    leg->turn = end ? c->rel.b.U : c->rel.a.U;
    return make_rows(c, end, &own, &other, &seen.start, leg);
}

hn_status hn_leg_trace(const hn_closure *c, int first_row) {
    hn_system *sys = c->m->sys;
    const int end = choose_end(c);
    if (end < 0) {
        return HN_OK;
    }
    hn_leg *leg = &sys->legs[sys->n_legs++];
    *leg = (hn_leg){.row = first_row};
    return trace(c, end, leg);
}
