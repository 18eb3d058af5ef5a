// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reactions/reactions.h"

#include "dynamics/compile/constraints.h"
#include "dynamics/compile/relate.h"
#include "dynamics/reactions/reactions_balance.h"
#include "dynamics/reactions/reactions_efforts.h"
#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// A smaller part of a wrench per unit of a multiplier that is free does not make it undetermined
/// [-].
static const double TOUCHED = 1e-6;
/// Rows dependent to this count as redundant, as in the saddle solve [-].
static const double RANK_TOL = 1e-10;

// ---- the tape ----

typedef struct output_list {
    hn_ex *at;
    int n;
} output_list;

static void put3(output_list *list, hn_vec3 v) {
    for (int i = 0; i < 3; i++) {
        list->at[list->n++] = v.x[i];
    }
}

/// U, x, a0, w, al0, then c and z of each lever.
static void put_body(output_list *list, hn_graph *g, const hn_reach *reach) {
    const hn_mat3 *B = &reach->B; // [al x] + w w' - w^2: al is its skew part
    hn_vec3 al = {{hn_scale(0.5, hn_sub(g, B->x[2][1], B->x[1][2])),
                   hn_scale(0.5, hn_sub(g, B->x[0][2], B->x[2][0])),
                   hn_scale(0.5, hn_sub(g, B->x[1][0], B->x[0][1]))}};
    for (int j = 0; j < 3; j++) {
        put3(list, hn_mat3_column(&reach->U, j));
    }
    put3(list, reach->pos);
    put3(list, reach->acc);
    put3(list, reach->w);
    put3(list, al);
    for (int k = 0; k < reach->n; k++) {
        put3(list, hn_lever_coefficient(g, &reach->levers[k]));
        put3(list, reach->levers[k].open ? reach->levers[k].axis : hn_vec3_zero());
    }
}

static void put_row(output_list *list, hn_graph *g, const hn_row_wrench *w) {
    put3(list, hn_mat3_apply_transposed(g, &w->turn, w->force));
    put3(list, hn_mat3_apply_transposed(g, &w->turn, w->moment_a));
    put3(list, hn_mat3_apply_transposed(g, &w->turn, w->moment_b));
}

/// Quantities that are reported beside the terms of the system.
typedef struct terms {
    hn_relative *bodies;
    hn_ex *energies; ///< r->n_energies, in the arena
    hn_entries inertia;
} terms;

static hn_status relate_bodies(hn_reactions *r, hn_arena *arena, hn_relative *rel) {
    if (r->n_bodies == 0) {
        return HN_OK;
    }

    hn_mech own = *r->sys->mech, *m = &own;
    for (int b = 0; b < r->n_bodies; b++) {
        hn_reaction_body *body = &r->bodies[b];

        // the centre of mass as seen from the ground
        const int link = hn_tree_link(m->tree, b);
        hn_vec3 arm;
        HN_TRY(hn_mech_arm_of(m, link, r->scene->bodies[b].com, &arm));
        HN_TRY(hn_mech_relate(m, m->tree->ground, link, arm, m->tree->ground, hn_vec3_zero(),
                              &rel[b]));

        // the coordinates that move it
        body->n = rel[b].a.n;
        body->coordinate = hn_arena_ints(arena, (size_t)body->n + 1);
        if (!body->coordinate) {
            return HN_ERR_MEMORY;
        }
        for (int k = 0; k < body->n; k++) {
            body->coordinate[k] = rel[b].a.levers[k].coordinate;
        }

        memcpy(body->to_world, rel[b].to_world, sizeof body->to_world);
    }
    return HN_OK;
}

static size_t count_outputs(const hn_reactions *r) {
    size_t n = (size_t)r->n_energies + (size_t)r->n_inertia +
               HN_REACTION_LOAD * (size_t)r->scene->n_loads + HN_REACTION_ROW * (size_t)r->nc +
               (size_t)r->sys->efforts.n + (size_t)r->sys->J.n;
    for (int b = 0; b < r->n_bodies; b++) {
        n += HN_REACTION_POSE + HN_REACTION_LEVER * (size_t)r->bodies[b].n;
    }
    return n;
}

static void put_energies(hn_reactions *r, const terms *t, output_list *list) {
    r->first_energy = list->n;
    for (int i = 0; i < r->n_energies; i++) {
        list->at[list->n++] = t->energies[i];
    }
    r->first_inertia = list->n;
    for (int k = 0; k < t->inertia.n; k++) {
        list->at[list->n++] = t->inertia.at[k].e;
    }
}

static void put_all(hn_reactions *r, const terms *t, output_list *list) {
    const hn_system *sys = r->sys;
    for (int b = 0; b < r->n_bodies; b++) {
        r->bodies[b].first = list->n;
        put_body(list, sys->g, &t->bodies[b].a);
    }

    // values of loads
    r->first_load = list->n;
    for (int k = 0; k < r->scene->n_loads; k++) {
        put3(list, (hn_vec3){{sys->load_values[k].x[0], sys->load_values[k].x[1],
                              sys->load_values[k].x[2]}});
    }

    // wrenches of rows
    r->first_row = list->n;
    for (int i = 0; i < r->nc; i++) {
        put_row(list, sys->g, &sys->rows[i].wrench);
    }

    // efforts of rows, energies
    r->first_effort = list->n;
    for (int k = 0; k < sys->efforts.n; k++) {
        list->at[list->n++] = sys->efforts.at[k].e;
    }
    put_energies(r, t, list);

    // J, for what is not determined
    r->first_jacobian = list->n;
    for (int k = 0; k < sys->J.n; k++) {
        list->at[list->n++] = sys->J.at[k].e;
    }
}

static hn_status compile(hn_reactions *r, hn_arena *arena) {
    terms t = {.bodies = malloc(((size_t)r->n_bodies + 1) * sizeof *t.bodies)};
    output_list list = {0};
    hn_status status = t.bodies ? relate_bodies(r, arena, t.bodies) : HN_ERR_MEMORY;
    if (status == HN_OK && r->scene->has_formulas) {
        status = hn_reaction_derive_energies(r, arena, &t.energies, &t.inertia);
    }
    if (status == HN_OK) {
        list.at = malloc((count_outputs(r) + 1) * sizeof *list.at);
        status = list.at ? HN_OK : HN_ERR_MEMORY;
    }
    if (status == HN_OK) {
        put_all(r, &t, &list);
        // only the graph of the system grows
        status = hn_inputs_compile(r->sys, list.at, list.n, arena, &r->in);
    }
    free(list.at);
    hn_entries_reset(&t.inertia);
    free(t.bodies);
    return status;
}

static void list_order(hn_reactions *r) {
    const hn_tree *tree = &r->sys->tree;
    int n = 0;
    for (int k = 0; k < tree->n_order; k++) {
        if (!tree->links[tree->order[k]].is_virtual) {
            r->order[n++] = tree->order[k];
        }
    }
    HN_ASSERT(n == r->n_bodies);
}

hn_status hn_reactions_create(const hn_system *sys, hn_arena *arena, hn_reactions **out,
                              hn_diag *diag) {
    *out = NULL;
    hn_reactions *r = hn_arena_get(arena, sizeof *r);
    hn_status status = HN_ERR_MEMORY;

    // memory
    if (r) {
        *r = (hn_reactions){.sys = sys, .scene = sys->scene, .n_bodies = sys->scene->n_bodies};
        r->nc = sys->nc;
        r->nv = sys->nv;
        r->bodies = hn_arena_get(arena, ((size_t)r->n_bodies + 1) * sizeof *r->bodies);
        r->order = hn_arena_ints(arena, (size_t)r->n_bodies + 1);
        r->joints = hn_arena_get(arena, ((size_t)sys->scene->n_joints + 1) * sizeof *r->joints);
        r->places = hn_arena_get(arena, ((size_t)sys->scene->n_joints + 1) * sizeof *r->places);
        r->tau = hn_arena_doubles(arena, (size_t)sys->scene->n_coordinates + 1);
        r->lambda = hn_arena_doubles(arena, (size_t)r->nc + 1);
        r->constraints =
            hn_arena_get(arena, ((size_t)sys->scene->n_constraints + 1) * sizeof *r->constraints);

        // the tape, and the list of efforts
        const int made = hn_qr_init(&r->qr, arena, r->nv, r->nc ? r->nc : 1);
        if (made && !hn_arena_failed(arena)) {
            list_order(r);
            status = compile(r, arena);
        }
        HN_THEN(status, hn_reaction_list_efforts(r, arena));
    }

    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }
    *out = r;
    return HN_OK;
}

void hn_reactions_free(hn_reactions *r) {
    if (r) {
        hn_inputs_free(&r->in);
    }
}

// ---- motion and inertia ----

/// out += to_world (3 outputs at k).
static void add_turned(const hn_reactions *r, const hn_reaction_body *b, int k, double factor,
                       double out[3]) {
    double v[3];
    hn_reaction_values3(r, k, v);
    hn_reaction_apply((const double(*)[3])b->to_world, v, v);
    hn_reaction_add_scaled(out, factor, v);
}

static void read_axes(const hn_reactions *r, hn_reaction_body *b, int link) {
    const hn_link *l = &r->sys->tree.links[link];
    double E[3][3], C[3][3];
    for (int j = 0; j < 3; j++) {
        double column[3] = {0, 0, 0};
        add_turned(r, b, b->first + 3 * j, 1, column);
        for (int i = 0; i < 3; i++) {
            E[i][j] = column[i];
        }
    }
    memcpy(C, l->C, sizeof C);
    hn_num3_compose(E, C, b->R);
}

/// I v with the body's own inertia, in the world.
static void apply_inertia(const hn_reactions *r, int body, const double v[3], double out[3]) {
    const hn_quantity *I = r->scene->bodies[body].inertia;
    const double xx = I[0].value, yy = I[1].value, zz = I[2].value, xy = I[3].value,
                 xz = I[4].value, yz = I[5].value;
    const double m[3][3] = {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
    double own[3];
    hn_reaction_apply_transposed((const double(*)[3])r->bodies[body].R, v, own);
    hn_reaction_apply(m, own, own);
    hn_reaction_apply((const double(*)[3])r->bodies[body].R, own, out);
}

static void read_body(hn_reactions *r, int body, const double *a) {
    hn_reaction_body *b = &r->bodies[body];
    const double mass = r->scene->bodies[body].mass.value;
    double acc[3] = {0, 0, 0}, w[3] = {0, 0, 0}, al[3] = {0, 0, 0}, spin[3], turned[3];

    // pose and motion at zero accelerations
    read_axes(r, b, hn_tree_link(&r->sys->tree, body));
    memset(b->x, 0, sizeof b->x);
    add_turned(r, b, b->first + 9, 1, b->x);
    add_turned(r, b, b->first + 12, 1, acc);
    add_turned(r, b, b->first + 15, 1, w);
    add_turned(r, b, b->first + 18, 1, al);

    // what the accelerations add
    for (int k = 0; k < b->n; k++) {
        const int lever = b->first + HN_REACTION_POSE + HN_REACTION_LEVER * k;
        add_turned(r, b, lever, a[b->coordinate[k]], acc);
        add_turned(r, b, lever + 3, a[b->coordinate[k]], al);
    }

    // F = m a - m g, N = I al + w x I w
    apply_inertia(r, body, w, spin);
    apply_inertia(r, body, al, turned);
    b->inertial = (hn_reaction_wrench){0};
    b->force = b->moment = 0;
    hn_reaction_add_scaled(b->inertial.n, 1, turned);
    hn_reaction_add_cross(b->inertial.n, 1, w, spin);

    for (int i = 0; i < 3; i++) {
        b->inertial.f[i] = mass * (acc[i] - r->scene->gravity[i].value);
        b->force = fmax(b->force, mass * (fabs(acc[i]) + fabs(r->scene->gravity[i].value)));
        b->moment = fmax(b->moment, fabs(turned[i]) + fabs(b->inertial.n[i] - turned[i]));
    }
}

// ---- what is not determined ----

static void factor_rows(hn_reactions *r) {
    memset(r->qr.a, 0, (size_t)r->nv * (size_t)r->nc * sizeof *r->qr.a);
    for (int k = 0; k < r->sys->J.n; k++) {
        const hn_entry *e = &r->sys->J.at[k];
        r->qr.a[(size_t)e->row * (size_t)r->nv + (size_t)e->col] =
            hn_reaction_value(r, r->first_jacobian + k);
    }
    hn_qr_factor(&r->qr, r->nv, r->nc, RANK_TOL);
}

/// Multipliers that give no generalised force at all: of J' P = Q [R11 R12], column k of R12
/// against R11.
static void free_combination(hn_reactions *r, int k) {
    const hn_qr *qr = &r->qr;
    memset(r->lambda, 0, (size_t)r->nc * sizeof *r->lambda);
    for (int i = 0; i < qr->rank; i++) {
        qr->work[i] = qr->a[(size_t)k * (size_t)qr->m + (size_t)i];
    }
    hn_qr_solve_r(qr, qr->work);
    for (int i = 0; i < qr->rank; i++) {
        r->lambda[qr->perm[i]] = -qr->work[i];
    }
    r->lambda[qr->perm[k]] = 1;
}

static bool touches(const hn_reaction_wrench *w, double scale) {
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        largest = fmax(largest, fmax(fabs(w->f[i]), fabs(w->n[i])));
    }
    return largest > TOUCHED * scale;
}

static void find_undetermined(hn_reactions *r, hn_wrench *joints, hn_wrench *constraints) {
    hn_reaction_wrench *scratch = r->constraints;

    factor_rows(r);
    for (int k = r->qr.rank; k < r->nc; k++) {
        // multipliers that give no generalised force: one free combination for each lost row
        double scale = 0;
        free_combination(r, k);
        for (int i = 0; i < r->nc; i++) {
            scale = fmax(scale, fabs(r->lambda[i]));
        }

        // joints, constraints and efforts that it touches are not determined
        memset(scratch, 0, (size_t)r->scene->n_constraints * sizeof *scratch);
        hn_reaction_balance(r, r->lambda, 1, scratch);
        for (int j = 0; j < r->scene->n_joints; j++) {
            joints[j].determined &= !touches(&r->joints[j], scale);
        }
        for (int j = 0; j < r->scene->n_constraints && constraints; j++) {
            constraints[j].determined &= !touches(&scratch[j], scale);
        }
        for (int j = 0; j < r->sys->efforts.n; j++) {
            const double effort =
                r->lambda[r->efforts[j].row] * hn_reaction_value(r, r->first_effort + j);
            r->efforts[j].determined &= fabs(effort) <= TOUCHED * scale;
        }
    }
}

// ---- what is handed out ----

static void hand_out(hn_wrench *out, int body, const hn_reaction_wrench *w, const double place[3],
                     const double axes[3][3]) {
    out->body = body;
    memcpy(out->force, w->f, sizeof out->force);
    memcpy(out->moment, w->n, sizeof out->moment);
    memcpy(out->place, place, sizeof out->place);
    hn_reaction_apply(axes, w->f, out->in_joint_force);
    hn_reaction_apply(axes, w->n, out->in_joint_moment);
    out->determined = 1;
}

/// x (ref), y, z (axis) of a joint on its parent, in the world.
static void axes_of(const hn_reactions *r, const hn_joint *joint, double axes[3][3]) {
    double y[3];
    hn_num3_cross(joint->parent_axis, joint->parent_ref, y);
    hn_reaction_to_world(r, joint->parent, joint->parent_ref, axes[0]);
    hn_reaction_to_world(r, joint->parent, y, axes[1]);
    hn_reaction_to_world(r, joint->parent, joint->parent_axis, axes[2]);
}

/// A constraint between points, in the world's axes. The balance has the wrench on the body of its
/// first point; a distance is handed out at its second.
static void hand_out_constraint(hn_reactions *r, int k, hn_wrench *out) {
    static const double world[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const hn_constraint *c = &r->scene->constraints[k];
    hn_reaction_wrench w = r->constraints[k];
    *out = (hn_wrench){.body = HN_GROUND, .determined = 1};
    if (!hn_constraint_has_points(c)) {
        return;
    }
    const int at_second = c->kind == HN_CONSTRAINT_DISTANCE;
    const hn_point *p = &r->scene->points[at_second ? c->q : c->p];
    double place[3];
    for (int i = 0; i < 3 && at_second; i++) {
        w.f[i] = -w.f[i];
        w.n[i] = -w.n[i]; // a rod gives none
    }
    hn_reaction_place_of(r, p->body, p->at, place);
    hand_out(out, p->body, &w, place, world);
}

static int is_finite_state(const hn_reactions *r, const hn_wrench *joints) {
    double sum = r->defect;
    for (int k = 0; k < r->n_efforts; k++) {
        sum += r->efforts[k].value;
    }
    for (int j = 0; j < r->scene->n_joints; j++) {
        for (int i = 0; i < 3; i++) {
            sum += joints[j].force[i] + joints[j].moment[i] + joints[j].place[i];
        }
    }
    return isfinite(sum);
}

hn_status hn_reactions_eval(hn_reactions *r, double t, const double *q, const double *v,
                            const double *a, const double *lambda, hn_wrench *joints,
                            hn_wrench *constraints) {
    const hn_scene *scene = r->scene;

    // poses, motion, efforts at this state
    hn_inputs_set(&r->in, t, q, v, 0, 0);
    hn_tape_run(r->in.tape, r->in.x);
    hn_reaction_read_energies(r, a);
    hn_reaction_read_efforts(r, lambda);
    for (int b = 0; b < r->n_bodies; b++) {
        read_body(r, b, a);
    }
    for (int j = 0; j < scene->n_joints; j++) {
        hn_reaction_place_of(r, scene->joints[j].child, scene->joints[j].child_at, r->places[j]);
    }

    // the balance
    memset(r->constraints, 0, (size_t)scene->n_constraints * sizeof *r->constraints);
    hn_reaction_balance(r, lambda, 0, r->constraints);

    // in world axes and in the joint's own
    for (int j = 0; j < scene->n_joints; j++) {
        double axes[3][3];
        axes_of(r, &scene->joints[j], axes);
        hand_out(&joints[j], scene->joints[j].child, &r->joints[j], r->places[j],
                 (const double(*)[3])axes);
    }
    for (int k = 0; k < scene->n_constraints && constraints; k++) {
        hand_out_constraint(r, k, &constraints[k]);
    }

    r->defect = hn_reaction_calc_defect(r);
    if (!is_finite_state(r, joints)) {
        return HN_ERR_DIVERGED;
    }
    find_undetermined(r, joints, constraints);
    return HN_OK;
}

double hn_reactions_defect(const hn_reactions *r) {
    return r->defect;
}

// ---- efforts ----

int hn_reactions_effort_count(const hn_reactions *r) {
    return r->n_efforts;
}

hn_effort hn_reactions_effort(const hn_reactions *r, int k) {
    HN_ASSERT(k >= 0 && k < r->n_efforts);
    return r->efforts[k];
}

bool hn_reactions_has_place(const hn_reactions *r, int constraint) {
    return hn_constraint_has_points(&r->scene->constraints[constraint]);
}
