// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/closure.h"

#include "dynamics/compile/system_build.h"
#include "expr/construct.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

hn_status hn_closure_begin(hn_mech *m, int index, int a, const hn_quantity *at_a, int b,
                           const hn_quantity *at_b, hn_closure *out) {
    hn_arena *arena = m->sys->arena;
    memset(out, 0, sizeof *out);
    out->m = m;
    out->index = index;
    out->link[0] = a;
    out->link[1] = b;
    hn_vec3 arm_a, arm_b;
    HN_TRY(hn_mech_arm_of(m, a, at_a, &arm_a));
    HN_TRY(hn_mech_arm_of(m, b, at_b, &arm_b));
    out->arm[0] = arm_a;
    out->arm[1] = arm_b;
    HN_TRY(hn_mech_relate(m, hn_tree_common(m->tree, a, b), a, arm_a, b, arm_b, &out->rel));
    size_t cap = (size_t)(out->rel.a.n + out->rel.b.n) + 1;
    out->coordinate = hn_arena_ints(arena, cap);
    out->coefficient = hn_arena_get(arena, cap * sizeof *out->coefficient);
    out->entries = hn_arena_get(arena, 2 * cap * sizeof *out->entries);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static void add_coefficient(hn_closure *c, int coordinate, hn_vec3 v) {
    for (int k = 0; k < c->n; k++) {
        if (c->coordinate[k] == coordinate) {
            c->coefficient[k] = hn_vec3_add(c->m->g, c->coefficient[k], v);
            return;
        }
    }
    c->coordinate[c->n] = coordinate;
    c->coefficient[c->n++] = v;
}

void hn_closure_collect(hn_closure *c) {
    hn_graph *g = c->m->g;
    for (int k = 0; k < c->rel.a.n; k++) {
        add_coefficient(c, c->rel.a.levers[k].coordinate,
                        hn_lever_coefficient(g, &c->rel.a.levers[k]));
    }
    for (int k = 0; k < c->rel.b.n; k++) {
        hn_vec3 v = hn_lever_coefficient(g, &c->rel.b.levers[k]);
        add_coefficient(c, c->rel.b.levers[k].coordinate, hn_vec3_scale(g, hn_num(-1), v));
    }
    c->delta = hn_vec3_sub(g, c->rel.a.pos, c->rel.b.pos);
    c->delta_acc = hn_vec3_sub(g, c->rel.a.acc, c->rel.b.acc);
}

void hn_closure_collect_rate(hn_closure *c) {
    hn_graph *g = c->m->g;
    c->delta_rate = hn_vec3_zero();
    for (int k = 0; k < c->n; k++) {
        hn_vec3 part = hn_vec3_scale(g, c->m->sys->v[c->coordinate[k]], c->coefficient[k]);
        c->delta_rate = hn_vec3_add(g, c->delta_rate, part);
    }
}

hn_direction hn_closure_direction(const hn_closure *c, int end, const double v[3]) {
    hn_mech *m = c->m;
    hn_direction d = {.end = end ? &c->rel.b : &c->rel.a};
    double in_E[3][3], column[3][3] = {{v[0], 0, 0}, {v[1], 0, 0}, {v[2], 0, 0}};
    hn_num3_compose(m->tree->links[c->link[end]].C, column, in_E);
    d.v = hn_mat3_apply(m->g, &d.end->U,
                        hn_vec3_num((double[3]){in_E[0][0], in_E[1][0], in_E[2][0]}));
    d.d1 = hn_vec3_cross(m->g, d.end->w, d.v);
    d.d2 = hn_mat3_apply(m->g, &d.end->B, d.v);
    return d;
}

hn_status hn_closure_add_row(hn_closure *c, const char *what, bool is_length, hn_ex phi,
                             hn_ex gamma, int n) {
    hn_system *sys = c->m->sys;
    char name[160];
    snprintf(name, sizeof name, "%s: %s", c->name, what);
    c->wrench.turn = c->rel.b.U;
    hn_new_row row = {.name = hn_arena_strdup(sys->arena, name),
                      .loop = c->index,
                      .is_length = is_length,
                      .phi = phi,
                      .phi_t = hn_num(0),
                      .gamma = gamma,
                      .J = c->entries,
                      .n_J = n,
                      .pointer = c->pointer,
                      .wrench = &c->wrench};
    return hn_system_add_row(sys, &row);
}

static const char *axis_name(const hn_closure *c, int i) {
    static const char *const world[3] = {"x", "y", "z"}, *const own[3] = {"1st axis", "2nd axis",
                                                                          "3rd axis"};
    return c->rel.aligned ? world[i] : own[i];
}

hn_status hn_closure_position_row(hn_closure *c, int i) {
    int n = 0;
    for (int k = 0; k < c->n; k++) {
        c->entries[n++] = (hn_entry){0, c->coordinate[k], c->coefficient[k].x[i]};
    }
    c->wrench.force = c->wrench.moment_a = c->wrench.moment_b = hn_vec3_zero();
    c->wrench.force.x[i] = hn_num(-1);
    return hn_closure_add_row(c, axis_name(c, i), 1, c->delta.x[i], c->delta_acc.x[i], n);
}

static bool is_open(const hn_reach *end, int coordinate) {
    for (int k = 0; k < end->n; k++) {
        if (end->levers[k].open && end->levers[k].coordinate == coordinate) {
            return true;
        }
    }
    return false;
}

int hn_closure_add_entry(hn_closure *c, int n, int coordinate, hn_ex e) {
    for (int k = 0; k < n; k++) {
        if (c->entries[k].col == coordinate) {
            c->entries[k].e = hn_add(c->m->g, c->entries[k].e, e);
            return n;
        }
    }
    c->entries[n] = (hn_entry){0, coordinate, e};
    return n + 1;
}

/// Adds d(p . r)/du for what turns p, to the row's entries.
static int turning_entries(hn_closure *c, const hn_direction *p, hn_vec3 r, const hn_reach *other,
                           int n) {
    hn_graph *g = c->m->g;
    for (int k = 0; k < p->end->n; k++) {
        const hn_lever *lever = &p->end->levers[k];
        if (!lever->open || (other && is_open(other, lever->coordinate))) {
            continue; // what turns both ends alike changes nothing
        }
        hn_ex e = hn_vec3_dot(g, hn_vec3_cross(g, lever->axis, p->v), r);
        n = hn_closure_add_entry(c, n, lever->coordinate, e);
    }
    return n;
}

/// (p . r)' = (w_a - w_b) . (p x r): the multiplier turns a about p x r and b against it.
hn_status hn_closure_perpendicular_row(hn_closure *c, const char *what, const hn_direction *p,
                                       const hn_direction *r) {
    hn_graph *g = c->m->g;
    int n = turning_entries(c, p, r->v, r->end, 0);
    n = turning_entries(c, r, p->v, p->end, n);
    hn_ex terms[3] = {hn_vec3_dot(g, p->d2, r->v), hn_scale(2, hn_vec3_dot(g, p->d1, r->d1)),
                      hn_vec3_dot(g, p->v, r->d2)};
    c->wrench.force = hn_vec3_zero();
    c->wrench.moment_a = hn_vec3_cross(g, p->v, r->v);
    c->wrench.moment_b = hn_vec3_scale(g, hn_num(-1), c->wrench.moment_a);
    return hn_closure_add_row(c, what, 0, hn_vec3_dot(g, p->v, r->v), hn_sum(g, terms, 3), n);
}

/// (p . delta)' = p . delta' + (w x p) . delta with w of the end that carries p: beside the forces
/// along p at the two points a moment p x delta on that end's body.
hn_measured hn_closure_along(hn_closure *c, const hn_direction *p) {
    hn_graph *g = c->m->g;
    hn_measured out = {.n = 0};
    for (int k = 0; k < c->n; k++) {
        c->entries[out.n++] =
            (hn_entry){0, c->coordinate[k], hn_vec3_dot(g, p->v, c->coefficient[k])};
    }
    out.n = turning_entries(c, p, c->delta, NULL, out.n);
    hn_ex terms[3] = {hn_vec3_dot(g, p->d2, c->delta),
                      hn_scale(2, hn_vec3_dot(g, p->d1, c->delta_rate)),
                      hn_vec3_dot(g, p->v, c->delta_acc)};
    out.value = hn_vec3_dot(g, p->v, c->delta);
    out.gamma = hn_sum(g, terms, 3);
    hn_vec3 moment = hn_vec3_cross(g, p->v, c->delta);
    c->wrench.force = hn_vec3_scale(g, hn_num(-1), p->v);
    c->wrench.moment_a = p->end == &c->rel.a ? moment : hn_vec3_zero();
    c->wrench.moment_b = p->end == &c->rel.b ? moment : hn_vec3_zero();
    return out;
}
