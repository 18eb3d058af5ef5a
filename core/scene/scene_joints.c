// SPDX-License-Identifier: GPL-3.0-or-later
// Joints as a plain list: what they join, where, along which axes, and the names of their
// coordinates.

#include "scene/reader.h"

#include <string.h>

// ---- place and directions ----

/// A reference direction must be perpendicular to the axis; what rounding left of the axis in it is
/// taken out.
static void read_ref(hn_reader *r, const cJSON *object, const char *key, const double axis[3],
                     double ref[3]) {
    if (hn_rd_direction(r, object, key, ref)) {
        hn_rd_make_normal(r, key, axis, ref);
    }
}

/// "parent" or "child": which body, and where on it.
static int read_side(hn_reader *r, const cJSON *joint, const char *key, hn_quantity at[3]) {
    static const char *const fields[] = {"body", "at", "axis", "ref", "axis2"};
    const cJSON *node = hn_rd_get(joint, key);
    int body = -2;
    if (!node) {
        hn_rd_fault(r, "as in {\"body\": \"ground\", \"at\": [0, 0, 0]}",
                    "the field '%s' is missing", key);
        return body;
    }

    // only the child may have directions of its own
    size_t mark = hn_rd_enter(r, key);
    if (hn_rd_object(r, node, "a side of a joint", fields, strcmp(key, "child") == 0 ? 5 : 2)) {
        body = hn_rd_body(r, node, "body");
        const cJSON *where = hn_rd_get(node, "at");
        size_t inner = hn_rd_enter(r, "at");
        if (where) {
            hn_rd_vector(r, where, at, HN_RD_CONST);
        }
        hn_rd_leave(r, inner);
    }
    hn_rd_leave(r, mark);
    return body;
}

/// Types whose axis goes without saying: z.
static bool has_default_axis(hn_joint_type type) {
    return type != HN_JOINT_PRISMATIC && type != HN_JOINT_CYLINDRICAL && type != HN_JOINT_UNIVERSAL;
}

/// The second direction of one side under `key`; `found`: made from the axis where it is left out.
static void read_second(hn_reader *r, const cJSON *side, const char *key, const double axis[3],
                        int found, double ref[3]) {
    if (hn_rd_get(side, key)) {
        read_ref(r, side, key, axis, ref);
    } else if (found) {
        hn_rd_default_normal(axis, ref);
    }
}

/// Axis and reference direction in both bodies. A universal joint calls the latter 'axis2': it
/// turns about it too.
static void read_frames(hn_reader *r, const cJSON *node, hn_joint *j) {
    static const double z[3] = {0, 0, 1};
    const cJSON *child = hn_rd_get(node, "child");
    bool universal = j->type == HN_JOINT_UNIVERSAL;
    const char *second = universal ? "axis2" : "ref";

    // the axis, which some types need not say
    if (hn_rd_get(node, "axis")) {
        hn_rd_direction(r, node, "axis", j->parent_axis);
    } else if (has_default_axis(j->type)) {
        memcpy(j->parent_axis, z, sizeof z);
    } else {
        hn_rd_fault(r, "as in [1, 0, 0]", "a %s joint needs its 'axis'",
                    hn_joint_type_name(j->type));
        return;
    }
    if (universal && !hn_rd_get(node, second)) {
        hn_rd_fault(r, "as in [0, 1, 0], perpendicular to 'axis'",
                    "a universal joint needs its 'axis2'");
        return;
    }

    // the second direction; the child has the parent's unless it says otherwise
    read_second(r, node, second, j->parent_axis, 1, j->parent_ref);
    memcpy(j->child_axis, j->parent_axis, sizeof j->child_axis);
    memcpy(j->child_ref, j->parent_ref, sizeof j->child_ref);
    size_t mark = hn_rd_enter(r, "child");
    bool own = hn_rd_get(child, "axis") && hn_rd_direction(r, child, "axis", j->child_axis);
    if (own && universal && !hn_rd_get(child, second)) {
        hn_rd_fault(r, "as in [0, 1, 0], perpendicular to 'axis'",
                    "a universal joint whose child has its own 'axis' needs the child's 'axis2'");
    } else {
        read_second(r, child, second, j->child_axis, own, j->child_ref);
    }
    hn_rd_leave(r, mark);

    // universal joints have two axes, the others an axis and a reference direction
    const char *wrong = universal ? "ref" : "axis2";
    if (hn_rd_get(node, wrong) || hn_rd_get(child, wrong)) {
        hn_rd_fault(r, universal ? "write 'axis2'" : "write 'ref'", "a %s joint has no '%s'",
                    hn_joint_type_name(j->type), wrong);
    }
}

static bool read_type(hn_reader *r, const cJSON *node, hn_joint_type *type) {
    const char *names[HN_JOINT_TYPE_COUNT];
    const char *name = hn_rd_text(r, node, "type", 1);
    for (int k = 0; k < HN_JOINT_TYPE_COUNT; k++) {
        names[k] = hn_joint_type_name((hn_joint_type)k);
        if (name && strcmp(name, names[k]) == 0) {
            *type = (hn_joint_type)k;
            return true;
        }
    }
    if (name) {
        char hint[HN_DIAG_HINT];
        hn_rd_suggest(hint, sizeof hint, name, names, HN_JOINT_TYPE_COUNT);
        hn_rd_fault_at(r, "type", hint, "unknown joint type '%.60s'", name);
    }
    return false;
}

static void check_joint_name(hn_reader *r, const hn_joint *j) {
    for (int i = 0; i < r->scene->n_joints && j->name; i++) {
        if (strcmp(r->scene->joints[i].name, j->name) == 0) {
            hn_rd_check_new_name(r, j->name, r->scene->joints[i].pointer);
            return;
        }
    }
}

/// Reads whether the joint is cut to close a loop.
static void read_cut(hn_reader *r, const cJSON *node, hn_joint *j) {
    j->cut = hn_rd_flag(r, node, "cut");
    if (j->cut && j->type == HN_JOINT_FREE) {
        hn_rd_fault_at(r, "cut", "leave the joint or its 'cut' out",
                       "a free joint closes no loop, so it cannot be cut");
    }
}

static void read_joint(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {
        "name",       "about",       "type", "parent", "child", "axis",     "axis2",  "ref",
        "coordinate", "coordinates", "rate", "rates",  "cut",   "actuated", "limits", "for"};
    (void)key;
    hn_scene *s = r->scene;
    if (!hn_rd_object(r, node, "a joint", fields, sizeof fields / sizeof *fields)) {
        return;
    }

    // its name and type
    int faults = r->n_faults;
    hn_joint j = {.name = hn_rd_name(r, node, "name", 1), .pointer = hn_rd_pointer(r)};
    hn_rd_text(r, node, "about", 0);
    check_joint_name(r, &j);
    bool typed = read_type(r, node, &j.type);

    // what it joins
    j.parent = read_side(r, node, "parent", j.parent_at);
    j.child = read_side(r, node, "child", j.child_at);
    if (j.parent != -2 && j.parent == j.child) {
        hn_rd_fault_at(r, "child", NULL, "the joint joins '%s' to itself",
                       j.parent == HN_GROUND ? "ground" : s->bodies[j.parent].name);
    }

    // directions, cut and coordinates depend on the type
    if (typed) {
        read_frames(r, node, &j);
        read_cut(r, node, &j);
        hn_rd_joint_coordinates(r, node, &j);
    }
    if (r->n_faults > faults || j.parent == -2 || j.child == -2) {
        return;
    }
    hn_joint *joints =
        hn_rd_grow(r, s->joints, s->n_joints, sizeof *joints, HN_SCENE_MAX_JOINTS, "joints");
    if (joints && !r->oom) {
        s->joints = joints;
        joints[s->n_joints++] = j;
    }
}

void hn_rd_joints(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "joints");
    size_t mark = hn_rd_enter(r, "joints");
    if (hn_rd_is_list(r, node, "joints")) {
        hn_rd_each(r, node, read_joint);
    }
    hn_rd_leave(r, mark);
}
