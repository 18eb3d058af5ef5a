// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reactions/reactions_balance.h"

#include "dynamics/compile/constraints.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// ---- what acts ----

/// A force at a place and a moment act on a body: less is left to its tree joint.
static void act(hn_reactions *r, int body, double k, const double force[3], const double place[3],
                const double moment[3]) {
    if (body == HN_GROUND) {
        return;
    }
    hn_reaction_body *b = &r->bodies[body];
    if (force) {
        double arm[3];
        for (int i = 0; i < 3; i++) {
            arm[i] = place[i] - b->x[i];
        }
        hn_reaction_add_scaled(b->rest.f, -k, force);
        hn_reaction_add_cross(b->rest.n, -k, arm, force);
    }
    if (moment) {
        hn_reaction_add_scaled(b->rest.n, -k, moment);
    }
}

/// Finds the part of a joint's wrench that works along one of its coordinates: a unit force or
/// moment on the child, in the world. Returns whether it is a force.
static bool find_freedom(const hn_reactions *r, const hn_joint *joint, int part, double axis[3]) {
    const hn_primitive *chain;
    const int n = hn_joint_primitives(joint->type, &chain);

    // axes of the joint on its parent and on its child
    const double *sides[2][3] = {{joint->parent_ref, NULL, joint->parent_axis},
                                 {joint->child_ref, NULL, joint->child_axis}};
    double y[2][3];
    hn_num3_cross(joint->parent_axis, joint->parent_ref, y[0]);
    hn_num3_cross(joint->child_axis, joint->child_ref, y[1]);
    sides[0][1] = y[0];
    sides[1][1] = y[1];

    // the primitive that has this coordinate
    for (int k = 0; k < n; k++) {
        const int ball = chain[k].type == HN_JOINT_SPHERICAL;
        const int along = ball ? part - chain[k].part : chain[k].along;
        if (part < chain[k].part || part >= chain[k].part + (ball ? 3 : 1)) {
            continue;
        }
        // a turn about x comes after the one about z, so its axis is the child's; so are those of a
        // ball
        const int on_child = ball || (chain[k].type == HN_JOINT_REVOLUTE && along == 0);
        hn_reaction_to_world(r, on_child ? joint->child : joint->parent, sides[on_child][along],
                             axis);
        return chain[k].type == HN_JOINT_PRISMATIC;
    }
    HN_ASSERT(0);
    return false;
}

/// Efforts along coordinates of cut joints act on both bodies, and are part of the joint's wrench;
/// in the tree they are found.
static void act_along_coordinates(hn_reactions *r) {
    for (int k = 0; k < r->sys->tree.n_cut; k++) {
        const int index = r->sys->tree.cut[k];
        const hn_joint *joint = &r->scene->joints[index];
        for (int part = 0; part < joint->n_coordinates; part++) {
            const double tau = r->tau[joint->coordinate + part];
            double axis[3];
            if (tau == 0) {
                continue;
            }
            const int is_force = find_freedom(r, joint, part, axis);
            const double *force = is_force ? axis : NULL, *moment = is_force ? NULL : axis;
            act(r, joint->child, tau, force, r->places[index], moment);
            act(r, joint->parent, -tau, force, r->places[index], moment);
            hn_reaction_add_scaled(is_force ? r->joints[index].f : r->joints[index].n, tau, axis);
        }
    }
}

static void act_loads(hn_reactions *r) {
    const hn_scene *scene = r->scene;
    for (int k = 0; k < scene->n_loads; k++) {
        const hn_load *load = &scene->loads[k];
        double v[3], p[3], q[3], pull[3];

        // a moment on a body
        hn_reaction_values3(r, r->first_load + HN_REACTION_LOAD * k, v);
        if (load->kind == HN_LOAD_MOMENT) {
            act(r, scene->points[load->p].body, 1, NULL, NULL, v);
            continue;
        }

        // along a coordinate
        const bool is_force = load->kind == HN_LOAD_FORCE || load->kind == HN_LOAD_PULL;
        if (!is_force && load->kind != HN_LOAD_SPRING) {
            r->tau[load->coordinate] += v[0];
            continue;
        }

        // a force at a point
        const hn_point *at = &scene->points[load->p];
        hn_reaction_place_of(r, at->body, at->at, p);
        if (is_force) {
            act(r, at->body, 1, v, p, NULL);
            continue;
        }

        // a spring: a force along the line, and its opposite
        const hn_point *to = &scene->points[load->q];
        hn_reaction_place_of(r, to->body, to->at, q);
        for (int i = 0; i < 3; i++) {
            pull[i] = v[0] * (q[i] - p[i]);
        }
        act(r, at->body, 1, pull, p, NULL);
        act(r, to->body, -1, pull, q, NULL);
    }
}

/// Along coordinates, as a motor in their joints would.
static void act_energies(hn_reactions *r) {
    for (int i = 0; i < r->n_energies; i++) {
        r->tau[r->energy_coordinate[i]] += r->energy[i];
    }
}

typedef struct row_ends {
    int body[2];
    const hn_quantity *at[2];
} row_ends;

/// End a and end b of a row between bodies; 0 for gears and formulas.
static bool find_ends(const hn_reactions *r, int row, row_ends *out) {
    const hn_loop *loop = &r->sys->loops[r->sys->rows[row].loop];
    if (loop->constraint >= 0) {
        const hn_constraint *k = &r->scene->constraints[loop->constraint];
        if (!hn_constraint_has_points(k)) {
            return false;
        }
        const hn_point *p = &r->scene->points[k->p], *q = &r->scene->points[k->q];
        *out = (row_ends){{p->body, q->body}, {p->at, q->at}};
        return true;
    }
    const hn_joint *joint = &r->scene->joints[loop->joint];
    *out = (row_ends){{joint->parent, joint->child}, {joint->parent_at, joint->child_at}};
    return true;
}

/// Three outputs in E of end b, in the world.
static void read_row(const hn_reactions *r, int body, int k, double out[3]) {
    const int link = hn_tree_link(&r->sys->tree, body);
    double v[3];
    hn_reaction_values3(r, k, v);
    hn_reaction_apply_transposed((const double(*)[3])r->sys->tree.links[link].C, v, v);
    hn_reaction_to_world(r, body, v, out);
}

/// Applies one row's multiplier to its two bodies, and to the wrench of its joint or constraint
/// that is handed out.
static void act_row(hn_reactions *r, int row, double lambda, hn_reaction_wrench *constraint) {
    const int k = r->first_row + HN_REACTION_ROW * row;
    const hn_loop *loop = &r->sys->loops[r->sys->rows[row].loop];
    double force[3], moment[2][3], place[2][3];
    row_ends ends;
    if (!find_ends(r, row, &ends)) {
        return;
    }

    // force and moments in the world, and where they act
    read_row(r, ends.body[1], k, force);
    for (int e = 0; e < 2; e++) {
        read_row(r, ends.body[1], k + 3 + 3 * e, moment[e]);
        hn_reaction_place_of(r, ends.body[e], ends.at[e], place[e]);
    }

    // on the two bodies
    act(r, ends.body[0], -lambda, force, place[0], NULL);
    act(r, ends.body[0], lambda, NULL, NULL, moment[0]);
    act(r, ends.body[1], lambda, force, place[1], moment[1]);

    // on the child of the joint, or on the body of the constraint's first point
    if (loop->joint >= 0) {
        hn_reaction_add_scaled(r->joints[loop->joint].f, lambda, force);
        hn_reaction_add_scaled(r->joints[loop->joint].n, lambda, moment[1]);
    } else if (constraint) {
        hn_reaction_add_scaled(constraint[loop->constraint].f, -lambda, force);
        hn_reaction_add_scaled(constraint[loop->constraint].n, lambda, moment[0]);
    }
}

static void act_rows(hn_reactions *r, const double *lambda, hn_reaction_wrench *constraint) {
    for (int k = 0; k < r->sys->efforts.n; k++) {
        const hn_entry *e = &r->sys->efforts.at[k];
        r->tau[e->col] += lambda[e->row] * hn_reaction_value(r, r->first_effort + k);
    }
    for (int i = 0; i < r->nc; i++) {
        act_row(r, i, lambda[i], constraint);
    }
}

// ---- leaves first ----

static void hand_down(hn_reactions *r) {
    for (int k = r->n_bodies - 1; k >= 0; k--) {
        const int body = r->order[k];
        const int index = r->sys->tree.links[hn_tree_link(&r->sys->tree, body)].joint;
        const hn_joint *joint = &r->scene->joints[index];
        const int reversed = joint->child != body, below = reversed ? joint->child : joint->parent;
        const hn_reaction_body *b = &r->bodies[body];
        double arm[3], moment[3];
        memcpy(moment, b->rest.n, sizeof moment);
        for (int i = 0; i < 3; i++) {
            arm[i] = b->x[i] - r->places[index][i];
        }
        hn_reaction_add_cross(moment, 1, arm, b->rest.f); // about the joint's place
        act(r, below, -1, b->rest.f, r->places[index], moment);
        for (int i = 0; i < 3; i++) {
            r->joints[index].f[i] = (reversed ? -1 : 1) * b->rest.f[i];
            r->joints[index].n[i] = (reversed ? -1 : 1) * moment[i];
        }
    }
}

void hn_reaction_balance(hn_reactions *r, const double *lambda, int bare,
                         hn_reaction_wrench *constraint) {
    if (r->n_bodies == 0) {
        return; // formulas alone: efforts, but no wrenches
    }
    memset(r->tau, 0, (size_t)r->scene->n_coordinates * sizeof *r->tau);
    memset(r->joints, 0, (size_t)r->scene->n_joints * sizeof *r->joints);
    for (int b = 0; b < r->n_bodies; b++) {
        r->bodies[b].rest = bare ? (hn_reaction_wrench){0} : r->bodies[b].inertial;
    }
    if (!bare) {
        act_loads(r);
        act_energies(r);
    }
    act_rows(r, lambda, constraint);
    act_along_coordinates(r);
    hand_down(r);
}

/// The hn_reaction_wrench of each tree joint along its own degrees of freedom against what is put
/// in there.
double hn_reaction_calc_defect(const hn_reactions *r) {
    double off[2] = {0, 0}, size[2] = {0, 0};

    // sizes of forces and moments
    for (int b = 0; b < r->n_bodies; b++) {
        size[1] = fmax(size[1], r->bodies[b].force);
        size[0] = fmax(size[0], r->bodies[b].moment);
    }

    // work along each joint's own coordinates against what is put in
    for (int j = 0; j < r->scene->n_joints; j++) {
        const hn_joint *joint = &r->scene->joints[j];
        for (int i = 0; i < 3; i++) {
            size[1] = fmax(size[1], fabs(r->joints[j].f[i]));
            size[0] = fmax(size[0], fabs(r->joints[j].n[i]));
        }
        for (int part = 0; part < joint->n_coordinates && r->sys->tree.joint_cut[j] < 0; part++) {
            double axis[3];
            const int is_force = find_freedom(r, joint, part, axis);
            const double along = hn_num3_dot(axis, is_force ? r->joints[j].f : r->joints[j].n);
            const double tau = r->tau[joint->coordinate + part];
            off[is_force] = fmax(off[is_force], fabs(along - tau));
            size[is_force] = fmax(size[is_force], fabs(tau));
        }
    }

    const double arm =
        hn_system_length(r->sys); // a moment is small beside the forces times the arms
    const double force = size[1] > 0 ? off[1] / size[1] : off[1];
    const double moments = fmax(size[0], arm * size[1]);
    return fmax(force, moments > 0 ? off[0] / moments : off[0]);
}
