// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints beside the joints, as rows. D = p - q, seen from the common ancestor of the two
// bodies; d, u, n fixed to q's body.
//     distance  (D . D - L^2) / (2 L) [m].  Not |D| - L: its gradient D / |D| is undefined where
//               the points meet, and a square root would be in every derivative; to first order
//               both measure the same gap.
//     line      e1 . D,  e2 . D        e1, e2 across d
//     plane     n . D - value
//     gear      x + ratio y - value    constant J, gamma = 0 between coordinates of the tree
//     rolling   u . D - r,   d . D + r theta    theta: the wheel's angle against q's body about
//               d x u; zero velocity at the touching point D = way d + r u is d . D' = -r theta'.
//               theta = 0 where the wheel's own direction lies along d.
//     formula   phi(x, t), x the scene's coordinates:   J = sum phi_x dx'/du,
//               gamma = x'' phi_xx x' + 2 phi_xt x' + phi_tt + sum phi_x x'' at zero u-dot
#include "dynamics/compile/constraints.h"

#include "dynamics/compile/closure.h"
#include "dynamics/compile/formula.h"
#include "dynamics/compile/loops.h"
#include "dynamics/compile/system_build.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// ---- between points ----

static hn_status add_distance(hn_closure *c, const hn_constraint *k) {
    hn_graph *g = c->m->g;
    hn_ex length;
    HN_TRY(hn_system_quantity(c->m->sys, &k->value, &length));
    hn_closure_collect_rate(c);
    hn_vec3 e = hn_vec3_scale(g, hn_div(g, hn_num(1), length), c->delta);
    int n = 0;
    for (int i = 0; i < c->n; i++) {
        n = hn_closure_add_entry(c, n, c->coordinate[i], hn_vec3_dot(g, e, c->coefficient[i]));
    }
    hn_ex phi = hn_scale(0.5, hn_sub(g, hn_vec3_dot(g, c->delta, e), length)); // (D.D/L - L) / 2
    hn_ex speed2 = hn_vec3_dot(g, c->delta_rate, c->delta_rate);
    hn_ex gamma = hn_add(g, hn_div(g, speed2, length), hn_vec3_dot(g, e, c->delta_acc));
    c->wrench.force = hn_vec3_scale(g, hn_num(-1), e);
    c->wrench.moment_a = c->wrench.moment_b = hn_vec3_zero();
    return hn_closure_add_row(c, "distance", 1, phi, gamma, n);
}

static hn_status add_across(hn_closure *c, const char *what, const double v[3], hn_ex value) {
    hn_direction p = hn_closure_direction(c, 1, v);
    hn_measured row = hn_closure_along(c, &p);
    return hn_closure_add_row(c, what, 1, hn_sub(c->m->g, row.value, value), row.gamma, row.n);
}

/// Two unit directions across d; axes where d is one, so that rows of planar scenes vanish.
static void make_across(const double d[3], double e1[3], double e2[3]) {
    int least = 0;
    for (int i = 1; i < 3; i++) {
        least = fabs(d[i]) <= fabs(d[least]) ? i : least; // of equals the last: z in a plane scene
    }
    double axis[3] = {0, 0, 0};
    axis[least] = 1;
    hn_num3_cross(axis, d, e1);
    const double size = sqrt(hn_num3_dot(e1, e1));
    for (int i = 0; i < 3; i++) {
        e1[i] /= size;
    }
    hn_num3_cross(d, e1, e2);
}

static hn_status add_line(hn_closure *c, const hn_constraint *k) {
    double e1[3], e2[3];
    make_across(k->direction, e1, e2);
    hn_closure_collect_rate(c);
    HN_TRY(add_across(c, "across 1", e1, hn_num(0)));
    return add_across(c, "across 2", e2, hn_num(0));
}

static hn_status add_plane(hn_closure *c, const hn_constraint *k) {
    hn_ex value;
    HN_TRY(hn_system_quantity(c->m->sys, &k->value, &value));
    hn_closure_collect_rate(c);
    return add_across(c, "height", k->direction, value);
}

/// The wheel's angle against the body of the line, if both turn about the axle's direction only.
static hn_status find_wheel_turn(hn_closure *c, const hn_constraint *k, const double axle[3],
                                 hn_turn *turn) {
    // the wheel's own direction with the same numbers marks its zero, or `up` where that one lies
    // along the axle
    const double *marks[2] = {k->direction, k->up};
    for (int i = 0; i < 2; i++) {
        if (hn_mech_relative_turn(c->m, c->link[1], axle, marks[i], c->link[0], marks[i], turn)) {
            return HN_OK;
        }
    }
    return hn_diags_add(hn_system_faults(c->m->sys), HN_ERR_UNSUPPORTED, k->pointer,
                        "hang the wheel by a revolute joint about 'direction' cross 'up'",
                        "the wheel of '%s' cannot roll: its body and that of the line do not turn "
                        "about parallel axes along its axle",
                        k->name);
}

static hn_status add_rolling(hn_closure *c, const hn_constraint *k) {
    hn_graph *g = c->m->g;
    hn_ex radius;
    hn_turn turn;
    double axle[3];
    hn_num3_cross(k->direction, k->up, axle);
    HN_TRY(hn_system_quantity(c->m->sys, &k->value, &radius));
    HN_TRY(find_wheel_turn(c, k, axle, &turn));

    // the wheel's centre stays at the radius from the line
    hn_closure_collect_rate(c);
    HN_TRY(add_across(c, "radius", k->up, radius));

    // and moves along it as far as the wheel turns
    hn_direction d = hn_closure_direction(c, 1, k->direction), a = hn_closure_direction(c, 1, axle);
    hn_measured way = hn_closure_along(c, &d);
    for (int i = 0; i < 2; i++) {
        if (turn.speed[i] >= 0) {
            hn_ex e = hn_scale((i ? 1 : -1) * turn.sign, radius);
            way.n = hn_closure_add_entry(c, way.n, turn.speed[i], e);
        }
    }

    // the multiplier's force acts at the touching point: its moment about p
    hn_vec3 moment = hn_vec3_scale(g, radius, a.v); // of the force at the touching point about p
    c->wrench.moment_a = hn_vec3_add(g, c->wrench.moment_a, moment);
    c->wrench.moment_b = hn_vec3_sub(g, c->wrench.moment_b, moment);
    hn_ex phi = hn_add(g, way.value, hn_mul(g, radius, turn.angle));
    return hn_closure_add_row(c, "way", 1, phi, way.gamma, way.n);
}

typedef hn_status (*point_adder)(hn_closure *c, const hn_constraint *k);
static const point_adder POINT_ADDERS[HN_CONSTRAINT_FORMULA + 1] = {
    [HN_CONSTRAINT_DISTANCE] = add_distance,
    [HN_CONSTRAINT_LINE] = add_line,
    [HN_CONSTRAINT_PLANE] = add_plane,
    [HN_CONSTRAINT_ROLLING] = add_rolling,
};

static hn_status add_between_points(hn_mech *m, int index, const hn_constraint *k) {
    const hn_point *p = &m->sys->scene->points[k->p], *q = &m->sys->scene->points[k->q];
    hn_closure c;
    HN_TRY(hn_closure_begin(m, index, hn_tree_link(m->tree, p->body), p->at,
                            hn_tree_link(m->tree, q->body), q->at, &c));
    c.name = k->name;
    c.pointer = k->pointer;
    hn_closure_collect(&c);
    return POINT_ADDERS[k->kind](&c, k);
}

// ---- between coordinates ----

/// A row phi(x, t) of the scene's coordinates, with symbols in their place while it is
/// differentiated.
typedef struct coordinate_row {
    int n;        ///< scene coordinates, and t behind them
    int *symbols; ///< n + 1
    hn_ex *x, *gradient, *seeds, *along;
} coordinate_row;

static hn_status begin_coordinates(hn_system *sys, coordinate_row *row) {
    const int n = sys->scene->n_coordinates;
    const size_t room = (size_t)n + 1;
    *row = (coordinate_row){.n = n, .symbols = hn_arena_ints(sys->arena, room)};
    row->x = hn_arena_get(sys->arena, room * sizeof *row->x);
    row->gradient = hn_arena_get(sys->arena, room * sizeof *row->gradient);
    row->seeds = hn_arena_get(sys->arena, room * sizeof *row->seeds);
    row->along = hn_arena_get(sys->arena, ((size_t)sys->nv + 1) * sizeof *row->along);
    if (hn_arena_failed(sys->arena)) {
        return HN_ERR_MEMORY;
    }
    hn_system_stand_ins(sys, "coordinate", row->x, row->symbols);
    memcpy(row->seeds, sys->user_v, (size_t)n * sizeof *row->seeds);
    row->x[n] = sys->t;
    row->symbols[n] = sys->t_symbol;
    row->seeds[n] = hn_num(1);
    return HN_OK;
}

/// Puts the coordinates' own expressions back.
static hn_ex put_back(hn_system *sys, const coordinate_row *row, hn_ex e) {
    hn_ex out;
    hn_substitute(sys->g, &e, 1, row->symbols, sys->user_q, row->n, &out);
    return out;
}

static int collect_entries(hn_system *sys, coordinate_row *row, hn_entry *entries) {
    for (int j = 0; j < sys->nv; j++) {
        entries[j] = (hn_entry){0, j, hn_num(0)};
    }
    for (int i = 0; i < row->n; i++) {
        if (hn_is_zero(row->gradient[i])) {
            continue;
        }
        hn_diff_reverse(sys->g, sys->user_v[i], sys->v_symbols, sys->nv, row->along);
        for (int j = 0; j < sys->nv; j++) {
            entries[j].e =
                hn_add(sys->g, entries[j].e, hn_mul(sys->g, row->gradient[i], row->along[j]));
        }
    }
    return sys->nv;
}

static hn_status add_coordinate_row(hn_system *sys, coordinate_row *row, hn_ex phi,
                                    const hn_constraint *k, int index, bool is_length) {
    hn_graph *g = sys->g;
    hn_entry *entries = hn_arena_get(sys->arena, ((size_t)sys->nv + 1) * sizeof *entries);
    hn_ex rate, gamma, phi_t;
    if (!entries) {
        return HN_ERR_MEMORY;
    }

    // phi_x and phi_t; the derivative along the motion, twice
    hn_diff_reverse(g, phi, row->symbols, row->n + 1, row->gradient);
    hn_diff_forward(g, &phi, 1, row->symbols, row->seeds, row->n + 1, &rate);
    hn_diff_forward(g, &rate, 1, row->symbols, row->seeds, row->n + 1, &gamma);

    // in the system's coordinates
    phi_t = put_back(sys, row, row->gradient[row->n]);
    gamma = put_back(sys, row, gamma);
    for (int i = 0; i < row->n; i++) {
        row->gradient[i] = put_back(sys, row, row->gradient[i]);
        gamma = hn_add(g, gamma, hn_mul(g, row->gradient[i], sys->user_gamma[i]));
    }

    // the row, and what its multiplier does along the scene's coordinates
    const int before = sys->nc;
    hn_new_row made = {.name = k->name,
                       .loop = index,
                       .is_length = is_length,
                       .phi = put_back(sys, row, phi),
                       .phi_t = phi_t,
                       .gamma = gamma,
                       .J = entries,
                       .n_J = collect_entries(sys, row, entries),
                       .pointer = k->pointer};
    HN_TRY(hn_system_add_row(sys, &made));
    for (int i = 0; i < row->n && sys->nc > before; i++) {
        hn_entries_add(&sys->efforts, before, i, row->gradient[i]);
    }
    return HN_OK;
}

static hn_status add_formula(hn_system *sys, int index, const hn_constraint *k) {
    coordinate_row row;
    hn_ex phi;
    HN_TRY(begin_coordinates(sys, &row));
    HN_TRY(hn_system_quantity_of(sys, &k->value, row.x, sys->user_v, &phi));
    return add_coordinate_row(sys, &row, phi, k, index, 0);
}

static hn_status refuse_unknown(hn_system *sys, const hn_constraint *k, int coordinate) {
    return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, k->pointer,
                        "cut another joint of its loop",
                        "the gear '%s' cannot hold '%s': its joint is cut between bodies that do "
                        "not turn about parallel axes, or it is an entry of an orientation",
                        k->name, sys->scene->coordinates[coordinate].name);
}

static hn_status add_gear(hn_system *sys, int index, const hn_constraint *k) {
    coordinate_row row;
    hn_ex ratio, value;
    for (int i = 0; i < 2; i++) {
        if (sys->user_known[k->coordinate[i]] != HN_KNOWN_BOTH) {
            return refuse_unknown(sys, k, k->coordinate[i]);
        }
    }
    HN_TRY(begin_coordinates(sys, &row));
    HN_TRY(hn_system_quantity(sys, &k->ratio, &ratio));
    HN_TRY(hn_system_quantity(sys, &k->value, &value));
    hn_ex second = hn_mul(sys->g, ratio, row.x[k->coordinate[1]]);
    hn_ex phi = hn_sub(sys->g, hn_add(sys->g, row.x[k->coordinate[0]], second), value);
    const int is_length = sys->scene->coordinates[k->coordinate[0]].kind == HN_LENGTH;
    return add_coordinate_row(sys, &row, phi, k, index, is_length);
}

// ---- all ----

bool hn_constraint_has_points(const hn_constraint *k) {
    return k->kind != HN_CONSTRAINT_GEAR && k->kind != HN_CONSTRAINT_FORMULA;
}

void hn_constraints_name_loops(hn_system *sys) {
    int tear = sys->tree.n_cut;
    for (int i = 0; i < sys->scene->n_constraints; i++) {
        const hn_constraint *k = &sys->scene->constraints[i];
        sys->loops[sys->tree.n_cut + i] =
            (hn_loop){.name = k->name,
                      .joint = -1,
                      .constraint = i,
                      .tear = hn_constraint_has_points(k) ? tear++ : -1,
                      .why = "a constraint of the scene"};
    }
}

hn_status hn_mech_trace_constraints(hn_mech *m) {
    hn_system *sys = m->sys;
    for (int i = 0; i < sys->scene->n_constraints; i++) {
        const hn_constraint *k = &sys->scene->constraints[i];
        const int index = m->tree->n_cut + i;
        if (hn_constraint_has_points(k)) {
            HN_TRY(add_between_points(m, index, k));
        } else {
            HN_TRY(k->kind == HN_CONSTRAINT_GEAR ? add_gear(sys, index, k)
                                                 : add_formula(sys, index, k));
        }
    }
    return HN_OK;
}

// ---- where the point of a constraint should be ----

static hn_status locate(hn_mech *m, int point, hn_vec3 *out) {
    const hn_point *p = &m->sys->scene->points[point];
    const int link = hn_tree_link(m->tree, p->body);
    hn_vec3 arm;
    HN_TRY(hn_mech_arm_of(m, link, p->at, &arm));
    *out = hn_mech_world(m, link, arm);
    return HN_OK;
}

/// A direction in the axes of a body, in the world.
static hn_vec3 turn_to_world(hn_mech *m, int body, const double v[3]) {
    const int link = hn_tree_link(m->tree, body);
    hn_mat3 C = hn_mat3_num(m->tree->links[link].C);
    hn_vec3 end = hn_mech_world(m, link, hn_mat3_apply(m->g, &C, hn_vec3_num(v)));
    return hn_vec3_sub(m->g, end, m->position[link]);
}

hn_status hn_mech_constraint_foot(hn_mech *m, const hn_constraint *k, hn_vec3 *out) {
    hn_graph *g = m->g;
    hn_vec3 p, q;
    hn_ex value;
    HN_TRY(locate(m, k->p, &p));
    HN_TRY(locate(m, k->q, &q));
    HN_TRY(hn_system_quantity(m->sys, &k->value, &value));

    // on the sphere round q
    hn_vec3 D = hn_vec3_sub(g, p, q);
    if (k->kind == HN_CONSTRAINT_DISTANCE) {
        hn_ex size = hn_sqrt(g, hn_vec3_dot(g, D, D));
        *out = hn_vec3_add(g, q, hn_vec3_scale(g, hn_div(g, value, size), D));
        return HN_OK;
    }

    // on the plane, or on the line, which a wheel's centre follows at its radius
    hn_vec3 d = turn_to_world(m, m->sys->scene->points[k->q].body, k->direction);
    hn_ex way = hn_vec3_dot(g, d, D);
    if (k->kind == HN_CONSTRAINT_PLANE) {
        *out = hn_vec3_sub(g, p, hn_vec3_scale(g, hn_sub(g, way, value), d));
        return HN_OK;
    }
    *out = hn_vec3_add(g, q, hn_vec3_scale(g, way, d));
    if (k->kind == HN_CONSTRAINT_ROLLING) {
        hn_vec3 u = turn_to_world(m, m->sys->scene->points[k->q].body, k->up);
        *out = hn_vec3_add(g, *out, hn_vec3_scale(g, value, u));
    }
    return HN_OK;
}
