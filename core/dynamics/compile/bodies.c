// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/bodies.h"

#include "dynamics/compile/bias.h"
#include "dynamics/compile/constraints.h"
#include "dynamics/compile/lagrangian.h"
#include "dynamics/compile/loads.h"
#include "dynamics/compile/loops.h"
#include "dynamics/compile/relate.h"
#include "dynamics/compile/system_build.h"
#include "dynamics/compile/tree_build.h"
#include "expr/construct.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// ---- symbols ----

/// 1 if the system coordinate is the scene's own.
static bool is_own(const hn_link *l) {
    return l->type != HN_JOINT_REVOLUTE || (l->angle_ref < 0 && l->sign > 0 && l->offset == 0);
}

static bool scene_knows(const hn_scene *scene, const char *name) {
    for (int i = 0; i < scene->n_coordinates; i++) {
        if (!strcmp(scene->coordinates[i].name, name) ||
            !strcmp(scene->coordinates[i].rate, name)) {
            return true;
        }
    }
    return hn_scene_find_param(scene, name) >= 0;
}

/// "theta_coupler" for the absolute angle of body "coupler".
static const char *angle_name(hn_system *sys, const char *stem, const char *body) {
    char name[96];
    int n = snprintf(name, sizeof name - 8, "%s_%s", stem, body);
    n = n > (int)sizeof name - 9 ? (int)sizeof name - 9 : n;
    for (int i = 0; i < n; i++) {
        if (!isalnum((unsigned char)name[i])) {
            name[i] = '_';
        }
    }
    while (scene_knows(sys->scene, name) && n < (int)sizeof name - 1) {
        name[n++] = '_';
        name[n] = 0;
    }
    return hn_arena_strdup(sys->arena, name);
}

static hn_status make_symbols(hn_system *sys) {
    const char **names = hn_arena_get(sys->arena, ((size_t)sys->nq + 1) * sizeof *names);
    const char **rates = hn_arena_get(sys->arena, ((size_t)sys->nv + 1) * sizeof *rates);
    if (!names || !rates) {
        return HN_ERR_MEMORY;
    }

    // the scene's names where the coordinate is its own, else the body's
    static const char *const entries[4] = {"e0", "e1", "e2", "e3"};
    for (int i = 0; i < sys->nv; i++) {
        int link = sys->tree.link_of[i];
        const hn_coordinate *c = &sys->scene->coordinates[sys->tree.user[i]];
        const hn_link *l = &sys->tree.links[link];
        const char *body = sys->scene->bodies[l->body].name;
        int own = is_own(l);
        rates[i] = own ? c->rate : angle_name(sys, "omega", body);
        if (l->n_speeds == 1) {
            names[l->position] = own ? c->name : angle_name(sys, "theta", body);
        }
        for (int k = 0; k < 4 && l->n_speeds == 3; k++) {
            names[l->position + k] = angle_name(sys, entries[k], body);
        }
    }

    // a name that could not be made is missing memory
    for (int i = 0; i < sys->nq; i++) {
        if (!names[i]) {
            return HN_ERR_MEMORY;
        }
    }
    for (int i = 0; i < sys->nv; i++) {
        if (!rates[i]) {
            return HN_ERR_MEMORY;
        }
    }
    return hn_system_make_symbols(sys, names, rates);
}

/// The scene's coordinates of tree joints in terms of the system's.
static void express_user_coordinates(hn_system *sys) {
    for (int i = 0; i < sys->nv; i++) {
        const hn_link *l = &sys->tree.links[sys->tree.link_of[i]];
        int user = sys->tree.user[i];
        hn_ex v = sys->v[i];
        if (l->n_speeds ==
            3) { // three entries of a rotation vector have no formula that is finite at every pose
            sys->user_v[user] = v;
            sys->user_known[user] = HN_KNOWN_RATE;
            continue;
        }
        hn_ex q = sys->q[l->position];
        if (l->angle_ref >= 0) {
            q = hn_sub(sys->g, q, sys->q[sys->tree.position[l->angle_ref]]);
            v = hn_sub(sys->g, v, sys->v[l->angle_ref]);
        }
        sys->user_q[user] = hn_scale(l->sign, hn_sub(sys->g, q, hn_num(l->offset)));
        sys->user_v[user] = hn_scale(l->sign, v);
        sys->user_known[user] = HN_KNOWN_BOTH;
    }
}

// ---- loops and points ----

static void name_loops(hn_system *sys) {
    for (int k = 0; k < sys->tree.n_cut; k++) {
        const hn_joint *joint = &sys->scene->joints[sys->tree.cut[k]];
        sys->loops[k] = (hn_loop){.joint = sys->tree.cut[k],
                                  .name = joint->name,
                                  .constraint = -1,
                                  .tear = k,
                                  .why = joint->cut ? "the scene asks for it"
                                                    : "both its bodies are already in the tree"};
    }
    hn_constraints_name_loops(sys);
}

static void put_point(hn_system *sys, int at, hn_vec3 p) {
    for (int i = 0; i < 3; i++) {
        sys->points[3 * at + i] = p.x[i];
    }
}

static hn_status trace_point(hn_mech *m, int at, int body, const hn_quantity *place) {
    int link = hn_tree_link(m->tree, body);
    hn_vec3 arm;
    HN_TRY(hn_mech_arm_of(m, link, place, &arm));
    put_point(m->sys, at, hn_mech_world(m, link, arm));
    return HN_OK;
}

static hn_status trace_points(hn_mech *m) {
    hn_system *sys = m->sys;
    const hn_scene *scene = sys->scene;
    int n = 0;

    // the scene's own points
    for (; n < scene->n_points; n++) {
        HN_TRY(trace_point(m, n, scene->points[n].body, scene->points[n].at));
    }

    // the two halves of every cut joint
    for (int k = 0; k < sys->tree.n_cut; k++) {
        const hn_joint *joint = &scene->joints[sys->tree.cut[k]];
        HN_TRY(trace_point(m, n++, joint->parent, joint->parent_at));
        HN_TRY(trace_point(m, n++, joint->child, joint->child_at));
    }

    // where the points of constraints should be
    for (int k = 0; k < scene->n_constraints; k++) {
        hn_vec3 foot;
        if (hn_constraint_has_points(&scene->constraints[k])) {
            HN_TRY(hn_mech_constraint_foot(m, &scene->constraints[k], &foot));
            put_point(sys, n++, foot);
        }
    }
    return HN_OK;
}

// ---- loads ----

/// Relates point p to point q, or to the ground where q < 0.
static hn_status get_span(hn_mech *m, int p, int q, hn_relative *rel) {
    const hn_point *points = m->sys->scene->points;
    int a = hn_tree_link(m->tree, points[p].body);
    int b = q >= 0 ? hn_tree_link(m->tree, points[q].body) : m->tree->ground;
    hn_vec3 arm_a, arm_b = hn_vec3_zero();
    HN_TRY(hn_mech_arm_of(m, a, points[p].at, &arm_a));
    if (q >= 0) {
        HN_TRY(hn_mech_arm_of(m, b, points[q].at, &arm_b));
    }
    return hn_mech_relate(m, hn_tree_common(m->tree, a, b), a, arm_a, b, arm_b, rel);
}

static void add_levers(hn_mech *m, const hn_reach *end, double sign, const hn_mat3 *turn,
                       hn_span *out) {
    for (int k = 0; k < end->n; k++) {
        hn_vec3 c = hn_vec3_scale(m->g, hn_num(sign), hn_lever_coefficient(m->g, &end->levers[k]));
        c = turn ? hn_mat3_apply(m->g, turn, c) : c;
        int at = 0;
        while (at < out->n && out->coordinate[at] != end->levers[k].coordinate) {
            at++;
        }
        if (at == out->n) {
            out->coordinate[out->n] = end->levers[k].coordinate;
            out->coefficient[out->n++] = c;
        } else {
            out->coefficient[at] = hn_vec3_add(m->g, out->coefficient[at], c);
        }
    }
}

static hn_status span_of_points(void *self, int p, int q, hn_span *out) {
    hn_mech *m = self;
    hn_relative rel;
    HN_TRY(get_span(m, p, q, &rel));

    // room for every lever of both ends
    size_t cap = (size_t)(rel.a.n + rel.b.n) + 1;
    out->n = 0;
    out->coordinate = hn_arena_ints(m->sys->arena, cap);
    out->coefficient = hn_arena_get(m->sys->arena, cap * sizeof *out->coefficient);
    if (!out->coordinate || !out->coefficient) {
        return HN_ERR_MEMORY;
    }

    // in the loop's frame, or in world axes where the scene's origin is the other end
    hn_mat3 to_world = hn_mat3_identity();
    const hn_mat3 *turn = NULL;
    out->delta = hn_vec3_sub(m->g, rel.a.pos, rel.b.pos);
    if (q < 0 && !rel.aligned) {
        to_world = hn_mat3_num(rel.to_world);
        turn = &to_world;
        out->delta = hn_mat3_apply(m->g, turn, out->delta);
    }
    add_levers(m, &rel.a, 1, turn, out);
    add_levers(m, &rel.b, -1, turn, out);
    return HN_OK;
}

/// Finds how the rates turn the body of a point, in world axes.
static hn_status spin_of_body(void *self, int p, hn_span *out) {
    hn_mech *m = self;
    hn_relative rel;
    HN_TRY(get_span(m, p, -1, &rel));
    size_t cap = (size_t)rel.a.n + 1;
    out->n = 0;
    out->coordinate = hn_arena_ints(m->sys->arena, cap);
    out->coefficient = hn_arena_get(m->sys->arena, cap * sizeof *out->coefficient);
    if (!out->coordinate || !out->coefficient) {
        return HN_ERR_MEMORY;
    }
    hn_mat3 to_world = hn_mat3_num(rel.to_world);
    for (int k = 0; k < rel.a.n; k++) {
        const hn_lever *lever = &rel.a.levers[k];
        if (lever->open) {
            out->coordinate[out->n] = lever->coordinate;
            out->coefficient[out->n++] = hn_mat3_apply(m->g, &to_world, lever->axis);
        }
    }
    return HN_OK;
}

// ---- the whole ----

static hn_status make_mech(hn_system *sys, hn_mech *m) {
    const hn_tree *tree = &sys->tree;
    size_t nl = (size_t)tree->n_links, ng = (size_t)tree->n_groups;
    *m = (hn_mech){.sys = sys, .g = sys->g, .tree = tree};
    m->at = hn_arena_get(sys->arena, nl * sizeof *m->at);
    m->base_w = hn_arena_get(sys->arena, ng * sizeof *m->base_w);
    m->base_al = hn_arena_get(sys->arena, ng * sizeof *m->base_al);
    m->group_X = hn_arena_get(sys->arena, ng * sizeof *m->group_X);
    m->to_world = hn_arena_get(sys->arena, ng * sizeof *m->to_world);
    m->position = hn_arena_get(sys->arena, nl * sizeof *m->position);
    m->path = hn_arena_ints(sys->arena, nl);
    m->place_row = hn_arena_ints(sys->arena, (size_t)tree->n_cut + 1);
    m->passed = hn_arena_ints(sys->arena, nl);
    return hn_arena_failed(sys->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Entries that M and J may have: beyond that the equations outgrow any tape, and writing them down
/// would take minutes.
enum {
    MAX_MASS_ENTRIES = 60000,
    MAX_CLOSURE_ENTRIES = 300000,
    ROWS_PER_JOINT = 6,
    ROWS_PER_CONSTRAINT = 2
};

/// The mass matrix couples each body to all that carry it; a closure row touches every body on its
/// two paths.
static hn_status check_size(const hn_mech *m) {
    const hn_tree *tree = m->tree;
    const hn_scene *scene = m->sys->scene;
    long long mass = 0, closure = 0;

    // the mass matrix couples each body to all that carry it
    for (int j = 0; j < tree->n_coordinates; j++) {
        mass += tree->links[tree->link_of[j]].depth;
    }

    // a closure row touches every body on its two paths
    for (int k = 0; k < tree->n_cut; k++) {
        const hn_joint *joint = &scene->joints[tree->cut[k]];
        const int a = hn_tree_link(tree, joint->parent), b = hn_tree_link(tree, joint->child);
        const int common = hn_tree_common(tree, a, b);
        closure += ROWS_PER_JOINT * ((long long)tree->links[a].depth + tree->links[b].depth -
                                     2LL * tree->links[common].depth);
    }

    if (mass > MAX_MASS_ENTRIES || closure > MAX_CLOSURE_ENTRIES) {
        return hn_diags_add(hn_system_faults(m->sys), HN_ERR_LIMIT, "/bodies",
                            "long chains grow with the square of their length: shorten them",
                            "the equations would have %lld mass entries and %lld closure entries; "
                            "%d and %d are compiled at most",
                            mass, closure, MAX_MASS_ENTRIES, MAX_CLOSURE_ENTRIES);
    }
    return HN_OK;
}

static hn_status trace_terms(hn_mech *m) {
    HN_TRY(check_size(m));
    HN_TRY(hn_mech_trace_geometry(m));
    HN_TRY(hn_mech_cut_coordinates(m));
    hn_mech_trace_composites(m);
    hn_mech_trace_mass(m);
    hn_mech_trace_bias(m);
    hn_mech_trace_energy(m);
    if (m->sys->scene->has_formulas) {
        HN_TRY(hn_lagrangian_add_energies(m->sys));
    }
    HN_TRY(hn_mech_trace_loops(m));
    HN_TRY(hn_mech_trace_constraints(m));
    hn_geometry geometry = {.self = m, .span = span_of_points, .spin = spin_of_body};
    HN_TRY(hn_loads_compile(m->sys, &geometry));
    HN_TRY(trace_points(m));
    // for solving, not for reading
    return m->sys->opts.symbolic_params ? HN_OK : hn_mech_trace_legs(m);
}

/// In the order of their velocities.
static hn_status list_balls(hn_system *sys) {
    const hn_tree *tree = &sys->tree;
    sys->balls = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *sys->balls);
    if (!sys->balls) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < sys->nv; i++) {
        const hn_link *l = &tree->links[tree->link_of[i]];
        if (l->n_speeds == 3 && l->coordinate == i) {
            sys->balls[sys->n_balls++] = (hn_ball){l->position, i};
        }
    }
    return HN_OK;
}

/// Constraints that have a point where they should be.
static int count_feet(const hn_scene *scene) {
    int n = 0;
    for (int i = 0; i < scene->n_constraints; i++) {
        n += hn_constraint_has_points(&scene->constraints[i]);
    }
    return n;
}

hn_status hn_bodies_compile(hn_system *sys) {
    const hn_scene *scene = sys->scene;
    hn_mech *m = hn_arena_get(sys->arena, sizeof *m);
    if (!m) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_tree_build(scene, !sys->opts.symbolic_params, sys->arena, &sys->tree, sys->diags));
    const int n_cut = sys->tree.n_cut, more = scene->n_constraints;
    HN_TRY(hn_system_allocate(sys, sys->tree.n_positions, sys->tree.n_coordinates,
                              ROWS_PER_JOINT * n_cut + ROWS_PER_CONSTRAINT * more, n_cut + more,
                              scene->n_points + 2 * n_cut + count_feet(scene)));
    HN_TRY(list_balls(sys));
    HN_TRY(make_symbols(sys));
    express_user_coordinates(sys);
    name_loops(sys);
    HN_TRY(make_mech(sys, m));
    sys->mech = m;
    HN_TRY(trace_terms(m));
    return hn_system_make_drawing(sys, sys->tree.n_cut + count_feet(scene));
}
