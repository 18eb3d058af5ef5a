// Bodies and joints as a plain list.

#include "scene/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// bodies -------------------------------------------------------------------------------------------

static int check_new_name(hn_reader *r, const char *name, const char *taken_by) {
    return taken_by ? hn_rd_fault_at(r, "name", NULL, "the name '%s' is used twice (also at %s)",
                                     name, taken_by)
                    : 1;
}

/// The tensor about the centre of mass. zz alone means a thin rod along the body's x: xx = 0, yy = zz.
static void read_inertia(hn_reader *r, const cJSON *node, hn_body *b) {
    static const char *const fields[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    if (!node) {
        return;
    }
    size_t mark = hn_rd_enter(r, "inertia");
    if (hn_rd_object(r, node, "an inertia", fields, 6)) {
        int planar = cJSON_GetArraySize(node) == 1 && hn_rd_get(node, "zz");
        for (int k = 0; k < 6; k++) {
            hn_rd_member(r, node, fields[k], k < 3 && !planar, 0, &b->inertia[k], HN_RD_CONST);
        }
        if (planar) {
            b->inertia[1] = b->inertia[2];
        }
    }
    hn_rd_leave(r, mark);
}

static void read_body(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"name", "about", "mass", "com", "inertia", "draw", "for"};
    (void)key;
    hn_scene *s = r->scene;
    if (!hn_rd_object(r, node, "a body", fields, 7)) {
        return;
    }
    int faults = r->n_faults;
    hn_body b = {.name = hn_rd_name(r, node, "name", 1), .pointer = hn_rd_pointer(r)};
    hn_rd_text(r, node, "about", 0);
    if (b.name && strcmp(b.name, "ground") == 0) {
        hn_rd_fault_at(r, "name", NULL, "'ground' is the fixed world and cannot be a body's name");
    } else if (b.name) {
        int other = hn_scene_find_body(s, b.name);
        check_new_name(r, b.name, other >= 0 ? s->bodies[other].pointer : NULL);
    }
    if (hn_rd_member(r, node, "mass", 1, 0, &b.mass, HN_RD_CONST) && b.mass.value < 0) {
        hn_rd_fault_at(r, "mass", NULL, "a mass of %g kg is negative", b.mass.value);
    }
    const cJSON *com = hn_rd_get(node, "com");
    if (com) {
        size_t mark = hn_rd_enter(r, "com");
        hn_rd_vector(r, com, b.com, HN_RD_CONST);
        hn_rd_leave(r, mark);
    }
    read_inertia(r, hn_rd_get(node, "inertia"), &b);
    if (r->n_faults == faults) {
        hn_rd_check_inertia(r, &b);
    }
    hn_body *bodies =
        hn_rd_grow(r, s->bodies, s->n_bodies, sizeof *bodies, HN_SCENE_MAX_BODIES, "bodies");
    if (bodies && b.name) {
        s->bodies = bodies;
        bodies[s->n_bodies++] = b;
    }
}

static int is_list(hn_reader *r, const cJSON *node, const char *what) {
    return !node || cJSON_IsArray(node) ||
           hn_rd_fault(r, NULL, "expected a list of %s, found %s", what, hn_rd_kind(node));
}

void hn_rd_bodies(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "bodies");
    int faults = r->n_faults;
    size_t mark = hn_rd_enter(r, "bodies");
    if (is_list(r, node, "bodies")) {
        hn_rd_each(r, node, read_body);
    }
    r->bodies_faulty = r->n_faults > faults;
    hn_rd_leave(r, mark);
}

int hn_rd_body(hn_reader *r, const cJSON *object, const char *key) {
    enum { ROOM = 256 };
    const char *name = hn_rd_name(r, object, key, 1);
    int body = name ? hn_scene_find_body(r->scene, name) : -2;
    if (!name || body != -2 || r->bodies_faulty) {
        return body;
    }
    const char *names[ROOM + 1] = {"ground"};
    int n = r->scene->n_bodies < ROOM ? r->scene->n_bodies : ROOM;
    for (int i = 0; i < n; i++) {
        names[i + 1] = r->scene->bodies[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, n + 1);
    hn_rd_fault_at(r, key, hint, "there is no body named '%s'", name);
    return -2;
}

// joints -------------------------------------------------------------------------------------------

/// A direction: three numbers of any length but zero, made unit.
static int read_direction(hn_reader *r, const cJSON *object, const char *key, double out[3]) {
    const cJSON *node = hn_rd_get(object, key);
    hn_quantity v[3];
    size_t mark = hn_rd_enter(r, key);
    int ok = hn_rd_vector(r, node, v, HN_RD_CONST);
    if (ok) {
        // hypot-like scaling keeps 1e-200 and 1e200 alive
        double big = fmax(fabs(v[0].value), fmax(fabs(v[1].value), fabs(v[2].value))), length = 0;
        for (int k = 0; k < 3 && big > 0; k++) {
            out[k] = v[k].value / big;
            length += out[k] * out[k];
        }
        ok = big > 0 ? 1 : hn_rd_fault(r, "as in [0, 0, 1]", "a direction of length zero");
        for (int k = 0; k < 3 && ok; k++) {
            // an axis that is unit already keeps its digits
            out[k] = fabs(length * big * big - 1) < 1e-15 ? v[k].value : out[k] / sqrt(length);
        }
    }
    hn_rd_leave(r, mark);
    return ok;
}

/// The reference direction nobody gave: the coordinate axis least aligned with `axis` (x before y before z), made perpendicular.
static void default_ref(const double axis[3], double ref[3]) {
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = fabs(axis[i]) < fabs(axis[k]) - 1e-12 ? i : k;
    }
    double length = sqrt(1 - axis[k] * axis[k]);
    for (int i = 0; i < 3; i++) {
        ref[i] = ((i == k) - axis[k] * axis[i]) / length;
    }
}

/// A reference direction must be perpendicular to the axis; what rounding left of the axis in it is taken out.
static void read_ref(hn_reader *r, const cJSON *object, const double axis[3], double ref[3]) {
    if (!read_direction(r, object, "ref", ref)) {
        return;
    }
    double along = axis[0] * ref[0] + axis[1] * ref[1] + axis[2] * ref[2];
    if (fabs(along) > 1e-6) {
        hn_rd_fault_at(r, "ref", NULL,
                       "the reference direction is not perpendicular to the axis (cosine %.3g)",
                       along);
        return;
    }
    for (int k = 0; k < 3; k++) {
        ref[k] -= along * axis[k];
    }
}

/// "parent" or "child": which body, and where on it.
static int read_side(hn_reader *r, const cJSON *joint, const char *key, hn_quantity at[3]) {
    static const char *const fields[] = {"body", "at", "axis", "ref"};
    const cJSON *node = hn_rd_get(joint, key);
    int body = -2;
    if (!node) {
        hn_rd_fault(r, "as in {\"body\": \"ground\", \"at\": [0, 0, 0]}",
                    "the field '%s' is missing", key);
        return body;
    }
    size_t mark = hn_rd_enter(r, key);
    if (hn_rd_object(r, node, "a side of a joint", fields, strcmp(key, "child") == 0 ? 4 : 2)) {
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

static void read_frames(hn_reader *r, const cJSON *node, hn_joint *j) {
    static const double z[3] = {0, 0, 1};
    const cJSON *child = hn_rd_get(node, "child");
    if (hn_rd_get(node, "axis")) {
        read_direction(r, node, "axis", j->parent_axis);
    } else if (j->type == HN_JOINT_REVOLUTE) {
        memcpy(j->parent_axis, z, sizeof z);
    } else {
        hn_rd_fault(r, "as in [1, 0, 0]", "a %s joint needs its 'axis'",
                    hn_joint_type_name(j->type));
        return;
    }
    if (hn_rd_get(node, "ref")) {
        read_ref(r, node, j->parent_axis, j->parent_ref);
    } else {
        default_ref(j->parent_axis, j->parent_ref);
    }
    memcpy(j->child_axis, j->parent_axis, sizeof j->child_axis);
    memcpy(j->child_ref, j->parent_ref, sizeof j->child_ref);
    size_t mark = hn_rd_enter(r, "child");
    if (hn_rd_get(child, "axis") && read_direction(r, child, "axis", j->child_axis)) {
        default_ref(j->child_axis, j->child_ref);
    }
    if (hn_rd_get(child, "ref")) {
        read_ref(r, child, j->child_axis, j->child_ref);
    }
    hn_rd_leave(r, mark);
}

static int read_type(hn_reader *r, const cJSON *node, hn_joint_type *type) {
    const char *names[HN_JOINT_TYPE_COUNT];
    const char *name = hn_rd_text(r, node, "type", 1);
    for (int k = 0; k < HN_JOINT_TYPE_COUNT; k++) {
        names[k] = hn_joint_type_name((hn_joint_type)k);
        if (name && strcmp(name, names[k]) == 0) {
            *type = (hn_joint_type)k;
            return 1;
        }
    }
    if (name) {
        char hint[HN_DIAG_HINT];
        hn_rd_suggest(hint, sizeof hint, name, names, HN_JOINT_TYPE_COUNT);
        hn_rd_fault_at(r, "type", hint, "unknown joint type '%.60s'", name);
    }
    return 0;
}

int hn_rd_add_coordinate(hn_reader *r, const cJSON *node, const char *name, const char *rate,
                         hn_unit_kind kind, int joint) {
    hn_scene *s = r->scene;
    char made[HN_RD_MAX_NAME + 8];
    if (!name) {
        return -1;
    }
    int ok = hn_rd_check_identifier(r, name);
    if (!rate) {
        snprintf(made, sizeof made, "d_%s", name);
        rate = hn_rd_keep(r, made);
    }
    hn_coordinate *all = hn_rd_grow(r, s->coordinates, s->n_coordinates, sizeof *all,
                                    HN_SCENE_MAX_JOINTS, "coordinates");
    if (!all || !ok || !rate) {
        return -1;
    }
    s->coordinates = all;
    int k = s->n_coordinates++;
    all[k] = (hn_coordinate){.name = name, .rate = rate, .kind = kind, .joint = joint};
    all[k].turn = -1;
    all[k].min = -HUGE_VAL;
    all[k].max = HUGE_VAL;
    all[k].actuated = hn_rd_flag(r, node, "actuated");
    hn_rd_put_name(r, HN_RD_COORDINATE, k);
    ok = hn_rd_check_identifier(r, rate);
    if (ok) {
        hn_rd_put_name(r, HN_RD_RATE, k);
    }
    return ok ? k : -1;
}

static void check_joint_name(hn_reader *r, const hn_joint *j) {
    for (int i = 0; i < r->scene->n_joints && j->name; i++) {
        if (strcmp(r->scene->joints[i].name, j->name) == 0) {
            check_new_name(r, j->name, r->scene->joints[i].pointer);
            return;
        }
    }
}

static void read_joint(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"name", "about",      "type", "parent", "child",    "axis",
                                         "ref",  "coordinate", "rate", "cut",    "actuated", "for"};
    (void)key;
    hn_scene *s = r->scene;
    if (!hn_rd_object(r, node, "a joint", fields, 12)) {
        return;
    }
    int faults = r->n_faults;
    hn_joint j = {.name = hn_rd_name(r, node, "name", 1), .pointer = hn_rd_pointer(r)};
    hn_rd_text(r, node, "about", 0);
    check_joint_name(r, &j);
    int typed = read_type(r, node, &j.type);
    j.parent = read_side(r, node, "parent", j.parent_at);
    j.child = read_side(r, node, "child", j.child_at);
    if (j.parent != -2 && j.parent == j.child) {
        hn_rd_fault_at(r, "child", NULL, "the joint joins '%s' to itself",
                       j.parent == HN_GROUND ? "ground" : s->bodies[j.parent].name);
    }
    if (typed) {
        read_frames(r, node, &j);
    }
    j.cut = hn_rd_flag(r, node, "cut");
    const char *coordinate = hn_rd_name(r, node, "coordinate", 0),
               *rate = hn_rd_name(r, node, "rate", 0);
    coordinate = coordinate || hn_rd_get(node, "coordinate") ? coordinate : j.name;
    size_t mark = hn_rd_enter(r, hn_rd_get(node, "coordinate") ? "coordinate" : "name");
    j.coordinate =
        hn_rd_add_coordinate(r, node, coordinate, rate,
                             j.type == HN_JOINT_PRISMATIC ? HN_LENGTH : HN_ANGLE, s->n_joints);
    j.n_coordinates = 1;
    hn_rd_leave(r, mark);
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
    if (is_list(r, node, "joints")) {
        hn_rd_each(r, node, read_joint);
    }
    hn_rd_leave(r, mark);
}
