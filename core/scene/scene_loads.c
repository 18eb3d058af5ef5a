// Springs, dampers, torques and forces of a scene of bodies and joints. Each entry of "loads" is an object with one
// member that names the kind, and perhaps a name.

#include "scene/reader.h"

#include <stdio.h>
#include <string.h>

static int add_load(hn_reader *r, const hn_load *load) {
    hn_scene *s = r->scene;
    hn_load *loads = hn_rd_grow(r, s->loads, s->n_loads, sizeof *loads, HN_RD_MAX_LOADS, "loads");
    if (!loads) {
        return 0;
    }
    s->loads = loads;
    loads[s->n_loads++] = *load;
    return 1;
}

/// A point under `key`.
static int read_end(hn_reader *r, const cJSON *node, const char *key) {
    const cJSON *point = hn_rd_get(node, key);
    if (!point) {
        hn_rd_fault(r,
                    "a point: a name of draw.points, {\"body\": .., \"at\": [..]} or a fixed place "
                    "[x, y, z]",
                    "the field '%s' is missing", key);
        return -1;
    }
    size_t mark = hn_rd_enter(r, key);
    int p = hn_rd_point(r, point, HN_GROUND);
    hn_rd_leave(r, mark);
    return p;
}

/// Stiffness, rest value and damping; never negative, and not both absent.
static int read_spring_numbers(hn_reader *r, const cJSON *node, hn_load *load) {
    int ok = hn_rd_member(r, node, "stiffness", 0, 0, &load->stiffness, HN_RD_CONST);
    ok &= hn_rd_member(r, node, "rest", 0, 0, &load->rest, HN_RD_CONST);
    ok &= hn_rd_member(r, node, "damping", 0, 0, &load->damping, HN_RD_CONST);
    if (!hn_rd_get(node, "stiffness") && !hn_rd_get(node, "damping")) {
        return hn_rd_fault(r, NULL, "a spring needs 'stiffness', 'damping' or both");
    }
    if (ok && load->stiffness.value < 0) {
        return hn_rd_fault_at(r, "stiffness", NULL, "a stiffness of %g is negative",
                              load->stiffness.value);
    }
    if (ok && load->damping.value < 0) {
        return hn_rd_fault_at(r, "damping", NULL, "a damping of %g is negative",
                              load->damping.value);
    }
    return ok;
}

static int read_spring(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"from", "to", "stiffness", "rest", "damping"};
    load->kind = HN_LOAD_SPRING;
    if (!hn_rd_object(r, node, "a spring", fields, 5)) {
        return 0;
    }
    load->p = read_end(r, node, "from");
    load->q = read_end(r, node, "to");
    int ok = read_spring_numbers(r, node, load);
    if (ok && load->rest.value < 0) {
        return hn_rd_fault_at(r, "rest", NULL, "a rest length of %g m is negative",
                              load->rest.value);
    }
    if (ok && load->p >= 0 && load->p == load->q) {
        return hn_rd_fault(r, NULL, "the spring's two ends are the same point");
    }
    return ok && load->p >= 0 && load->q >= 0;
}

/// The coordinate of "joint" (a joint's name) or "coordinate".
static int read_target(hn_reader *r, const cJSON *node) {
    enum { ROOM = 256 };
    const hn_scene *s = r->scene;
    if (!hn_rd_get(node, "joint") == !hn_rd_get(node, "coordinate")) {
        hn_rd_fault(r, NULL, "expected either 'joint' or 'coordinate', found %s",
                    hn_rd_get(node, "joint") ? "both" : "neither");
        return -1;
    }
    const char *key = hn_rd_get(node, "joint") ? "joint" : "coordinate";
    const char *name = hn_rd_name(r, node, key, 1);
    if (!name) {
        return -1;
    }
    if (key[0] == 'c') {
        size_t mark = hn_rd_enter(r, key);
        int k = hn_rd_coordinate(r, name, 0);
        hn_rd_leave(r, mark);
        return k;
    }
    const char *names[ROOM];
    for (int i = 0; i < s->n_joints; i++) {
        if (strcmp(s->joints[i].name, name) == 0) {
            return s->joints[i].coordinate;
        }
        names[i < ROOM ? i : ROOM - 1] = s->joints[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, s->n_joints < ROOM ? s->n_joints : ROOM);
    hn_rd_fault_at(r, key, hint, "there is no joint named '%s'", name);
    return -1;
}

static int read_joint_spring(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"joint", "coordinate", "stiffness", "rest", "damping"};
    load->kind = HN_LOAD_JOINT_SPRING;
    if (!hn_rd_object(r, node, "a joint spring", fields, 5)) {
        return 0;
    }
    load->coordinate = read_target(r, node);
    return read_spring_numbers(r, node, load) && load->coordinate >= 0;
}

static int read_joint_load(hn_reader *r, const cJSON *node, hn_load *load, const char *what,
                           hn_unit_kind kind) {
    static const char *const fields[] = {"joint", "coordinate", "value"};
    load->kind = HN_LOAD_COORDINATE;
    if (!hn_rd_object(r, node, what, fields, 3)) {
        return 0;
    }
    load->coordinate = read_target(r, node);
    int ok =
        hn_rd_member(r, node, "value", 1, 0, &load->value[0], HN_RD_STATE) && load->coordinate >= 0;
    if (ok && r->scene->coordinates[load->coordinate].kind != kind) {
        return hn_rd_fault(r,
                           kind == HN_ANGLE ? "use 'force' for a prismatic joint"
                                            : "use 'torque' for a revolute joint",
                           "%s cannot act along '%s'", what,
                           r->scene->coordinates[load->coordinate].name);
    }
    return ok;
}

static int read_torque(hn_reader *r, const cJSON *node, hn_load *load) {
    return read_joint_load(r, node, load, "a torque", HN_ANGLE);
}

/// A force along a prismatic joint, or at a point in world axes.
static int read_force(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"at", "value"};
    if (hn_rd_get(node, "joint") || hn_rd_get(node, "coordinate")) {
        return read_joint_load(r, node, load, "a force", HN_LENGTH);
    }
    load->kind = HN_LOAD_FORCE;
    if (!hn_rd_object(r, node, "a force", fields, 2)) {
        return 0;
    }
    load->p = read_end(r, node, "at");
    const cJSON *value = hn_rd_get(node, "value");
    size_t mark = hn_rd_enter(r, "value");
    int ok = value ? hn_rd_vector(r, value, load->value, HN_RD_STATE)
                   : hn_rd_fault(r, "as in [0, \"-F\", 0]", "the force has no 'value'");
    hn_rd_leave(r, mark);
    return ok && load->p >= 0;
}

static const struct {
    const char *name;
    int (*read)(hn_reader *, const cJSON *, hn_load *);
} KINDS[] = {{"spring", read_spring},
             {"joint_spring", read_joint_spring},
             {"torque", read_torque},
             {"force", read_force}};
enum { N_KINDS = sizeof KINDS / sizeof KINDS[0] };

static void read_load(hn_reader *r, const cJSON *node, const char *key) {
    const char *fields[N_KINDS + 2] = {"name", "for"};
    (void)key;
    int kind = -1, n = 0;
    for (int k = 0; k < N_KINDS; k++) {
        fields[k + 2] = KINDS[k].name;
        if (hn_rd_get(node, KINDS[k].name)) {
            kind = k;
            n++;
        }
    }
    int faults = r->n_faults;
    if (!hn_rd_object(r, node, "a load", fields, N_KINDS + 2)) {
        return;
    }
    if (n != 1) {
        if (r->n_faults == faults) {
            hn_rd_fault(r, "allowed: spring, joint_spring, torque, force",
                        "expected one kind of load, found %d", n);
        }
        return;
    }
    hn_load load = {.name = hn_rd_name(r, node, "name", 0),
                    .pointer = hn_rd_pointer(r),
                    .p = -1,
                    .q = -1,
                    .coordinate = -1};
    load.name = load.name ? load.name : KINDS[kind].name;
    size_t mark = hn_rd_enter(r, KINDS[kind].name);
    if (KINDS[kind].read(r, hn_rd_get(node, KINDS[kind].name), &load)) {
        add_load(r, &load);
    }
    hn_rd_leave(r, mark);
}

void hn_rd_loads(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "loads");
    size_t mark = hn_rd_enter(r, "loads");
    if (node && r->scene->is_lagrangian) {
        hn_rd_fault(r, "springs belong in 'potential', other forces in 'lagrangian.forces'",
                    "a Lagrangian scene has no 'loads'");
    } else if (node && !cJSON_IsArray(node)) {
        hn_rd_fault(r, NULL, "expected a list of loads, found %s", hn_rd_kind(node));
    } else {
        hn_rd_each(r, node, read_load);
    }
    hn_rd_leave(r, mark);
}
