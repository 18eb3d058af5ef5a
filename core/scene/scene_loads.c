// SPDX-License-Identifier: GPL-3.0-or-later
// Springs, dampers, torques and forces of a scene of bodies and joints. Each entry of "loads" is an
// object with one member that names the kind, and perhaps a name.

#include "scene/reader.h"
#include "scene/scene_refs.h"

#include <stdio.h>
#include <string.h>

static bool add_load(hn_reader *r, const hn_load *load) {
    hn_scene *s = r->scene;
    hn_load *loads = hn_rd_grow(r, s->loads, s->n_loads, sizeof *loads, HN_RD_MAX_LOADS, "loads");
    if (!loads) {
        return false;
    }
    s->loads = loads;
    loads[s->n_loads++] = *load;
    return true;
}

/// Stiffness, rest value and damping; never negative, and not both absent.
static bool read_spring_numbers(hn_reader *r, const cJSON *node, hn_load *load) {
    bool ok = hn_rd_member(r, node, "stiffness", 0, 0, &load->stiffness, HN_RD_CONST);
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

static bool read_spring(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"from", "to", "stiffness", "rest", "damping"};
    load->kind = HN_LOAD_SPRING;
    if (!hn_rd_object(r, node, "a spring", fields, 5)) {
        return false;
    }
    load->p = hn_rd_end(r, node, "from");
    load->q = hn_rd_end(r, node, "to");
    bool ok = read_spring_numbers(r, node, load);
    if (ok && load->rest.value < 0) {
        return hn_rd_fault_at(r, "rest", NULL, "a rest length of %g m is negative",
                              load->rest.value);
    }
    if (ok && load->p >= 0 && load->p == load->q) {
        return hn_rd_fault(r, NULL, "the spring's two ends are the same point");
    }
    return ok && load->p >= 0 && load->q >= 0;
}

static bool read_joint_spring(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"joint", "coordinate", "stiffness", "rest", "damping"};
    load->kind = HN_LOAD_JOINT_SPRING;
    if (!hn_rd_object(r, node, "a joint spring", fields, 5)) {
        return false;
    }
    load->coordinate = hn_rd_target(r, node, hn_rd_get(node, "stiffness") != NULL);
    return read_spring_numbers(r, node, load) && load->coordinate >= 0;
}

static bool read_joint_load(hn_reader *r, const cJSON *node, hn_load *load, const char *what,
                            hn_unit_kind kind) {
    static const char *const fields[] = {"joint", "coordinate", "value"};
    load->kind = HN_LOAD_COORDINATE;
    if (!hn_rd_object(r, node, what, fields, 3)) {
        return false;
    }
    load->coordinate = hn_rd_target(r, node, 0);
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

static bool read_torque(hn_reader *r, const cJSON *node, hn_load *load) {
    return read_joint_load(r, node, load, "a torque", HN_ANGLE);
}

/// A force along a prismatic joint, or at a point in world axes.
static bool read_force(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"at", "value"};
    if (hn_rd_get(node, "joint") || hn_rd_get(node, "coordinate")) {
        return read_joint_load(r, node, load, "a force", HN_LENGTH);
    }
    load->kind = HN_LOAD_FORCE;
    if (!hn_rd_object(r, node, "a force", fields, 2)) {
        return false;
    }
    load->p = hn_rd_end(r, node, "at");
    const cJSON *value = hn_rd_get(node, "value");
    size_t mark = hn_rd_enter(r, "value");
    int ok = value ? hn_rd_vector(r, value, load->value, HN_RD_STATE)
                   : hn_rd_fault(r, "as in [0, \"-F\", 0]", "the force has no 'value'");
    hn_rd_leave(r, mark);
    return ok && load->p >= 0;
}

/// On a whole body, in world axes.
static bool read_moment(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"body", "value"};
    static const hn_quantity origin[3];
    load->kind = HN_LOAD_MOMENT;
    if (!hn_rd_object(r, node, "a moment", fields, 2)) {
        return false;
    }
    int body = hn_rd_body(r, node, "body");
    if (body == HN_GROUND) {
        return hn_rd_fault_at(r, "body", NULL, "a moment on ground does nothing");
    }
    const cJSON *value = hn_rd_get(node, "value");
    size_t mark = hn_rd_enter(r, "value");
    int ok = value ? hn_rd_vector(r, value, load->value, HN_RD_STATE)
                   : hn_rd_fault(r, "as in [0, 0, \"M\"]", "the moment has no 'value'");
    hn_rd_leave(r, mark);
    load->p = ok && body != -2 ? hn_rd_place(r, body, origin) : -1;
    return load->p >= 0;
}

/// An actuator that follows a target over time.
static bool read_follow(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"joint",   "coordinate", "stiffness",
                                         "damping", "target",     "limit"};
    load->kind = HN_LOAD_FOLLOW;
    if (!hn_rd_object(r, node, "a follower", fields, 6)) {
        return false;
    }
    load->coordinate = hn_rd_target(r, node, 1);
    bool ok = read_spring_numbers(r, node, load);
    ok &= hn_rd_member(r, node, "target", 1, 0, &load->value[0], HN_RD_TIME);
    ok &= hn_rd_member(r, node, "limit", 0, 0, &load->value[1], HN_RD_CONST);
    if (ok && hn_rd_get(node, "limit") && !(load->value[1].value > 0)) {
        return hn_rd_fault_at(r, "limit", "leave it out if there is none",
                              "a limit of %g is not positive", load->value[1].value);
    }
    return ok && load->coordinate >= 0;
}

/// Numbers under `key` into the scene's arena; NULL after a fault.
static const double *read_column(hn_reader *r, const cJSON *node, const char *key, int *n) {
    const cJSON *list = hn_rd_get(node, key);
    if (!cJSON_IsArray(list) || !list->child) {
        hn_rd_fault(r, "as in [0, 0.5, 1]", "expected a list of numbers under '%s', found %s%s",
                    key, hn_rd_kind(list), cJSON_IsArray(list) ? " that is empty" : "");
        return NULL;
    }

    // as many numbers as the list has
    *n = cJSON_GetArraySize(list);
    if (*n > HN_RD_MAX_TABLE) {
        hn_rd_limit(r, "a table of %d times, at most %d are allowed", *n, HN_RD_MAX_TABLE);
        return NULL;
    }
    double *column = hn_arena_get(r->arena, (size_t)*n * sizeof *column);
    r->oom |= !column;
    int ok = column != NULL, i = 0;

    // each is a number or a formula in parameters
    size_t mark = hn_rd_enter(r, key);
    for (const cJSON *m = list->child; m && ok && !hn_rd_stopped(r); m = m->next, i++) {
        hn_quantity q;
        size_t inner = hn_rd_enter_index(r, i);
        ok = hn_rd_quantity(r, m, &q, HN_RD_CONST);
        column[i] = q.value;
        hn_rd_leave(r, inner);
    }
    hn_rd_leave(r, mark);
    return ok ? column : NULL;
}

static bool check_times(hn_reader *r, const hn_profile *table) {
    for (int i = 1; i < table->n; i++) {
        if (!(table->t[i] > table->t[i - 1])) {
            char key[24];
            snprintf(key, sizeof key, "%d", i);
            size_t mark = hn_rd_enter(r, "t");
            hn_rd_fault_at(r, key, NULL, "the time %g s does not come after %g s", table->t[i],
                           table->t[i - 1]);
            hn_rd_leave(r, mark);
            return false;
        }
    }
    return true;
}

static bool read_table(hn_reader *r, const cJSON *node, hn_load *load) {
    static const char *const fields[] = {"joint", "coordinate", "t", "value", "steps"};
    load->kind = HN_LOAD_TABLE;
    if (!hn_rd_object(r, node, "a table", fields, 5)) {
        return false;
    }
    int n = 0;
    load->coordinate = hn_rd_target(r, node, 0);
    load->table.t = read_column(r, node, "t", &load->table.n);
    load->table.value = read_column(r, node, "value", &n);
    load->table.steps = hn_rd_flag(r, node, "steps");
    if (!load->table.t || !load->table.value) {
        return false;
    }
    if (n != load->table.n) {
        return hn_rd_fault_at(r, "value", NULL, "%d values for %d times", n, load->table.n);
    }
    return check_times(r, &load->table) && load->coordinate >= 0;
}

static const struct {
    const char *name;
    bool (*read)(hn_reader *, const cJSON *, hn_load *);
} KINDS[] = {{"spring", read_spring}, {"joint_spring", read_joint_spring},
             {"torque", read_torque}, {"force", read_force},
             {"moment", read_moment}, {"follow", read_follow},
             {"table", read_table}};
enum { N_KINDS = sizeof KINDS / sizeof KINDS[0] };

static void read_load(hn_reader *r, const cJSON *node, const char *key) {
    const char *kinds[N_KINDS];
    (void)key;
    for (int k = 0; k < N_KINDS; k++) {
        kinds[k] = KINDS[k].name;
    }
    const int kind = hn_rd_one_kind(r, node, "load", kinds, N_KINDS);
    if (kind < 0) {
        return;
    }

    // the kind reads the rest
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
