// SPDX-License-Identifier: GPL-3.0-or-later
// A Lagrangian scene: coordinates, energies, constraints and generalised forces as formulas. Beside
// bodies each of its own coordinates is carried by a body without mass on a joint of its own, so
// that everything knows it as any other.

#include "scene/reader.h"
#include "scene/scene_refs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// The body and joint that carry the coordinate of that index, which is the scene's last.
static void carry(hn_reader *r, int k) {
    hn_scene *s = r->scene;
    hn_body *bodies =
        hn_rd_grow(r, s->bodies, s->n_bodies, sizeof *bodies, HN_SCENE_MAX_BODIES, "bodies");
    hn_joint *joints =
        hn_rd_grow(r, s->joints, s->n_joints, sizeof *joints, HN_SCENE_MAX_JOINTS, "joints");

    // body and joint have the same name, which no other body may have
    const hn_coordinate *c = &s->coordinates[k];
    char name[HN_RD_MAX_NAME + 16];
    snprintf(name, sizeof name, "coordinate %s", c->name);
    const char *kept = hn_rd_keep(r, name), *pointer = hn_rd_pointer(r);
    if (!bodies || !joints || !kept || !pointer) {
        return;
    }
    if (hn_scene_find_body(s, kept) >= 0) {
        hn_rd_fault(r, "give the body or the coordinate another name",
                    "the name '%s' is needed for a coordinate, and a body has it", kept);
        return;
    }

    // both lists grow together
    s->bodies = bodies;
    s->joints = joints;
    joints[s->n_joints++] =
        (hn_joint){.name = kept,
                   .pointer = pointer,
                   .type = c->kind == HN_ANGLE ? HN_JOINT_REVOLUTE : HN_JOINT_PRISMATIC,
                   .parent = HN_GROUND,
                   .child = s->n_bodies,
                   .parent_axis = {0, 0, 1},
                   .child_axis = {0, 0, 1},
                   .parent_ref = {1, 0, 0},
                   .child_ref = {1, 0, 0},
                   .coordinate = k,
                   .n_coordinates = 1,
                   .is_formal = true};
    bodies[s->n_bodies++] = (hn_body){.name = kept, .pointer = pointer};
}

static void read_coordinate(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"name", "rate", "unit", "actuated", "about", "for"};
    static const char *const units[] = {"rad", "m", "1"};
    static const hn_unit_kind kinds[] = {HN_ANGLE, HN_LENGTH, HN_OTHER};
    (void)key;
    if (!hn_rd_object(r, node, "a coordinate", fields, 6)) {
        return;
    }

    // the unit says whether it is an angle or a length
    const char *name = hn_rd_name(r, node, "name", 1), *rate = hn_rd_name(r, node, "rate", 0),
               *unit = hn_rd_text(r, node, "unit", 0);
    hn_rd_text(r, node, "about", 0);
    hn_unit_kind kind = HN_ANGLE;
    if (unit) {
        int k = 0;
        while (k < 3 && strcmp(unit, units[k]) != 0) {
            k++;
        }
        if (k == 3) {
            hn_rd_fault_at(r, "unit", "allowed: rad, m, 1",
                           "a coordinate cannot have the unit '%.40s'", unit);
        } else {
            kind = kinds[k];
        }
    }

    // beside bodies the coordinate gets a body that carries it
    size_t mark = hn_rd_enter(r, "name");
    const bool mixed = r->scene->has_formulas;
    const int k = hn_rd_add_coordinate(r, name, rate, kind, mixed ? r->scene->n_joints : -1,
                                       hn_rd_flag(r, node, "actuated"));
    if (mixed && k >= 0) {
        carry(r, k);
    }
    hn_rd_leave(r, mark);
}

static void read_constraint(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"name", "formula", "for"};
    hn_lagrangian *l = &r->scene->lagrangian;
    hn_quantity q = {0};
    const char *name = NULL;
    (void)key;

    // an object with a name, or a bare formula
    if (cJSON_IsObject(node)) {
        hn_rd_object(r, node, "a constraint", fields, 3);
        name = hn_rd_name(r, node, "name", 0);
        hn_rd_member(r, node, "formula", 1, 0, &q, HN_RD_POSE);
    } else {
        hn_rd_quantity(r, node, &q, HN_RD_POSE);
    }
    if (q.formula && !q.varies && q.value != 0) {
        hn_rd_fault(r, NULL, "this constraint is the constant %g and can never be 0", q.value);
    }

    // beside bodies it is one of the scene's own constraints
    if (r->scene->has_formulas) {
        hn_rd_formula_constraint(r, name, &q);
        return;
    }
    if (!name) {
        char made[32];
        snprintf(made, sizeof made, "constraint %d", l->n_constraints + 1);
        name = hn_rd_keep(r, made);
    }

    // both lists grow together
    hn_quantity *all = hn_rd_grow(r, l->constraints, l->n_constraints, sizeof *all,
                                  HN_SCENE_MAX_JOINTS, "constraints");
    const char **names = all ? hn_rd_grow(r, l->constraint_names, l->n_constraints, sizeof *names,
                                          HN_SCENE_MAX_JOINTS, "constraints")
                             : NULL;
    if (!names || !name) {
        return;
    }
    l->constraints = all;
    l->constraint_names = names;
    all[l->n_constraints] = q;
    names[l->n_constraints++] = name;
}

/// Member of "forces": the coordinate's name and a formula.
static void read_force(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"value", "for"};
    hn_scene *s = r->scene;
    const char *name = hn_rd_fill(r, key);
    int coordinate = name ? hn_rd_coordinate(r, name, 0) : -1;
    hn_load load = {.name = name,
                    .pointer = hn_rd_pointer(r),
                    .kind = HN_LOAD_COORDINATE,
                    .p = -1,
                    .q = -1,
                    .coordinate = coordinate};
    int ok = cJSON_IsObject(node)
                 ? hn_rd_object(r, node, "a generalised force", fields, 2) &&
                       hn_rd_member(r, node, "value", 1, 0, &load.value[0], HN_RD_STATE)
                 : hn_rd_quantity(r, node, &load.value[0], HN_RD_STATE);
    hn_load *loads = hn_rd_grow(r, s->loads, s->n_loads, sizeof *loads, HN_RD_MAX_LOADS, "loads");
    if (loads && ok && coordinate >= 0) {
        s->loads = loads;
        loads[s->n_loads++] = load;
    }
}

void hn_rd_lagrangian(hn_reader *r, const cJSON *root) {
    static const char *const fields[] = {"coordinates", "kinetic", "potential", "constraints",
                                         "forces"};
    const cJSON *node = hn_rd_get(root, "lagrangian");
    hn_lagrangian *l = &r->scene->lagrangian;
    size_t mark = hn_rd_enter(r, "lagrangian");
    if (hn_rd_object(r, node, "a lagrangian", fields, 5)) {
        const bool mixed = r->scene->has_formulas;

        // coordinates first: the formulas use them
        hn_rd_list(r, node, "coordinates", 0, read_coordinate);
        if (r->scene->n_coordinates == 0 && r->n_faults == 0) {
            hn_rd_fault(r, "as in [{\"name\": \"th1\", \"rate\": \"w1\", \"unit\": \"rad\"}]",
                        "'coordinates' is missing or empty");
        }

        // energies, constraints and forces
        if (r->n_faults == 0) {
            hn_rd_member(r, node, "kinetic", !mixed, 0, &l->kinetic, HN_RD_STATE);
            hn_rd_member(r, node, "potential", 0, 0, &l->potential, HN_RD_POSE);
            hn_rd_list(r, node, "constraints", 0, read_constraint);
            hn_rd_list(r, node, "forces", 1, read_force);
        }

        // a Lagrangian that says nothing, or has no masses
        if (r->n_faults == 0 && mixed && !node->child) {
            hn_rd_fault(r, "it adds 'kinetic', 'potential', 'constraints', 'forces' to the bodies",
                        "this lagrangian is empty");
        }
        if (r->n_faults == 0 && !l->kinetic.varies && (!mixed || hn_rd_get(node, "kinetic"))) {
            hn_rd_fault_at(r, "kinetic", "it holds the masses: m*v^2/2",
                           "the kinetic energy does not depend on any rate");
        }
    }
    hn_rd_leave(r, mark);
}
