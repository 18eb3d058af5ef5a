// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints beside the joints of a scene of bodies. Each entry of "constraints" is an object with
// one member that names the kind, and perhaps a name.

#include "scene/reader.h"
#include "scene/scene_refs.h"

#include "base/strbuf.h"

#include <stdio.h>
#include <string.h>

/// The value under `key`, which must be a length above 0.
static bool read_length(hn_reader *r, const cJSON *node, const char *key, hn_quantity *out) {
    if (!hn_rd_member(r, node, key, 1, 0, out, HN_RD_CONST)) {
        return false;
    }
    return out->value > 0 ||
           hn_rd_fault_at(r, key, NULL, "a %s of %g m, expected more than 0", key, out->value);
}

/// Both points under their keys, which must not sit on one body.
static bool read_ends(hn_reader *r, const cJSON *node, const char *p, const char *q,
                      hn_constraint *c) {
    c->p = hn_rd_end(r, node, p);
    c->q = hn_rd_end(r, node, q);
    if (c->p < 0 || c->q < 0) {
        return false;
    }
    int body = r->scene->points[c->p].body;
    return body != r->scene->points[c->q].body ||
           hn_rd_fault(r, "one of them may be a fixed place [x, y, z]",
                       "both points belong to %s%s%s: nothing could ever move",
                       body == HN_GROUND ? "" : "the body '",
                       body == HN_GROUND ? "ground" : r->scene->bodies[body].name,
                       body == HN_GROUND ? "" : "'");
}

/// A direction that must be there.
static bool read_required_direction(hn_reader *r, const cJSON *node, const char *key,
                                    double out[3]) {
    return hn_rd_get(node, key)
               ? hn_rd_direction(r, node, key, out)
               : hn_rd_fault(r, "as in [1, 0, 0]", "the field '%s' is missing", key);
}

static bool read_distance(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"from", "to", "length"};
    c->kind = HN_CONSTRAINT_DISTANCE;
    return hn_rd_object(r, node, "a distance", fields, 3) && read_ends(r, node, "from", "to", c) &&
           read_length(r, node, "length", &c->value);
}

static bool read_line(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"point", "through", "direction"};
    c->kind = HN_CONSTRAINT_LINE;
    return hn_rd_object(r, node, "a line", fields, 3) &&
           read_ends(r, node, "point", "through", c) &&
           read_required_direction(r, node, "direction", c->direction);
}

static bool read_plane(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"point", "through", "direction", "offset"};
    c->kind = HN_CONSTRAINT_PLANE;
    return hn_rd_object(r, node, "a plane", fields, 4) &&
           read_ends(r, node, "point", "through", c) &&
           read_required_direction(r, node, "direction", c->direction) &&
           hn_rd_member(r, node, "offset", 0, 0, &c->value, HN_RD_CONST);
}

/// A coordinate whose value is used: by its name.
static int read_coordinate_name(hn_reader *r, const cJSON *node) {
    const char *name = cJSON_IsString(node) ? hn_rd_fill(r, node->valuestring) : NULL;
    if (!cJSON_IsString(node)) {
        hn_rd_fault(r, NULL, "expected the name of a coordinate, found %s", hn_rd_kind(node));
    }
    int k = name ? hn_rd_coordinate(r, name, 0) : -1;
    return k >= 0 && hn_rd_check_no_turn(r, k) ? k : -1;
}

static bool read_gear(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"coordinates", "ratio", "phase"};
    c->kind = HN_CONSTRAINT_GEAR;
    if (!hn_rd_object(r, node, "a gear", fields, 3)) {
        return false;
    }

    // two coordinates, and not the same one twice
    const cJSON *pair = hn_rd_get(node, "coordinates");
    if (!cJSON_IsArray(pair) || cJSON_GetArraySize(pair) != 2) {
        return hn_rd_fault_at(r, "coordinates", "as in [\"th1\", \"th2\"]",
                              "expected two coordinates, found %s%s", hn_rd_kind(pair),
                              cJSON_IsArray(pair) ? " of another length" : "");
    }
    size_t mark = hn_rd_enter(r, "coordinates");
    for (int i = 0; i < 2; i++) {
        size_t inner = hn_rd_enter_index(r, i);
        c->coordinate[i] = read_coordinate_name(r, cJSON_GetArrayItem(pair, i));
        hn_rd_leave(r, inner);
    }
    hn_rd_leave(r, mark);
    if (c->coordinate[0] < 0 || c->coordinate[1] < 0) {
        return false;
    }
    if (c->coordinate[0] == c->coordinate[1]) {
        return hn_rd_fault_at(r, "coordinates", NULL, "a gear couples two different coordinates");
    }

    // x + ratio y = phase
    if (!hn_rd_member(r, node, "ratio", 1, 0, &c->ratio, HN_RD_CONST) ||
        !hn_rd_member(r, node, "phase", 0, 0, &c->value, HN_RD_CONST)) {
        return false;
    }
    return c->ratio.value != 0 ||
           hn_rd_fault_at(r, "ratio", "x + ratio y = phase", "a ratio of 0 couples nothing");
}

static bool read_rolling(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"centre", "through", "direction", "up", "radius"};
    c->kind = HN_CONSTRAINT_ROLLING;
    return hn_rd_object(r, node, "a rolling wheel", fields, 5) &&
           read_ends(r, node, "centre", "through", c) &&
           read_required_direction(r, node, "direction", c->direction) &&
           read_required_direction(r, node, "up", c->up) &&
           hn_rd_make_normal(r, "up", c->direction, c->up) &&
           read_length(r, node, "radius", &c->value);
}

static bool read_formula(hn_reader *r, const cJSON *node, hn_constraint *c) {
    c->kind = HN_CONSTRAINT_FORMULA;
    if (!hn_rd_quantity(r, node, &c->value, HN_RD_POSE)) {
        return false;
    }
    return c->value.varies ||
           hn_rd_fault(r, "as in \"th1 - w*t\"",
                       "this constraint is the constant %g and contains no coordinate",
                       c->value.value);
}

/// coordinate = value over time, kept as the formula coordinate - (value).
static bool read_motion(hn_reader *r, const cJSON *node, hn_constraint *c) {
    static const char *const fields[] = {"joint", "coordinate", "value"};
    hn_quantity value;
    c->kind = HN_CONSTRAINT_FORMULA;
    if (!hn_rd_object(r, node, "a motion", fields, 3)) {
        return false;
    }
    int k = hn_rd_target(r, node, 1);
    if (k < 0 || !hn_rd_member(r, node, "value", 1, 0, &value, HN_RD_TIME)) {
        return false;
    }

    // the text "coordinate - (value)"
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_printf(&text, "%s - (", r->scene->coordinates[k].name);
    if (value.formula) {
        hn_strbuf_add(&text, value.formula);
    } else {
        hn_json_number(&text, value.value);
    }
    hn_strbuf_add(&text, ")");

    // parsed like a formula of the scene's own
    r->oom |= text.failed;
    c->value.pointer = value.pointer;
    c->value.formula = r->oom ? NULL : hn_rd_keep(r, hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
    return c->value.formula && hn_rd_formula(r, c->value.formula, HN_RD_POSE, &c->value);
}

static const struct {
    const char *name;
    bool (*read)(hn_reader *, const cJSON *, hn_constraint *);
} KINDS[] = {{"distance", read_distance}, {"line", read_line},       {"plane", read_plane},
             {"gear", read_gear},         {"rolling", read_rolling}, {"formula", read_formula},
             {"motion", read_motion}};
enum { N_KINDS = sizeof KINDS / sizeof KINDS[0] };

/// The name given, or one made from kind and number; no joint and no other constraint has it.
static const char *read_own_name(hn_reader *r, const cJSON *node, const char *kind) {
    const hn_scene *s = r->scene;
    char made[48];
    snprintf(made, sizeof made, "%s %d", kind, s->n_constraints + 1);
    const char *name = hn_rd_get(node, "name") ? hn_rd_name(r, node, "name", 1) : NULL;
    if (!name) {
        return hn_rd_get(node, "name") ? NULL : hn_rd_keep(r, made);
    }
    const char *by = NULL;
    for (int i = 0; i < s->n_joints && !by; i++) {
        by = strcmp(s->joints[i].name, name) == 0 ? s->joints[i].pointer : NULL;
    }
    for (int i = 0; i < s->n_constraints && !by; i++) {
        by = strcmp(s->constraints[i].name, name) == 0 ? s->constraints[i].pointer : NULL;
    }
    return hn_rd_check_new_name(r, name, by) ? name : NULL;
}

static void add_constraint(hn_reader *r, const hn_constraint *c) {
    hn_scene *s = r->scene;
    hn_constraint *all = hn_rd_grow(r, s->constraints, s->n_constraints, sizeof *all,
                                    HN_SCENE_MAX_JOINTS, "constraints");
    if (all) {
        s->constraints = all;
        all[s->n_constraints++] = *c;
    }
}

void hn_rd_formula_constraint(hn_reader *r, const char *name, const hn_quantity *value) {
    hn_constraint c = {.name = name,
                       .pointer = hn_rd_pointer(r),
                       .kind = HN_CONSTRAINT_FORMULA,
                       .p = -1,
                       .q = -1,
                       .coordinate = {-1, -1},
                       .value = *value};
    char made[32];
    if (!name) {
        snprintf(made, sizeof made, "constraint %d", r->scene->n_constraints + 1);
        c.name = hn_rd_keep(r, made);
    }
    if (c.name && c.pointer) {
        add_constraint(r, &c);
    }
}

static void read_constraint(hn_reader *r, const cJSON *node, const char *key) {
    const char *kinds[N_KINDS];
    (void)key;
    for (int k = 0; k < N_KINDS; k++) {
        kinds[k] = KINDS[k].name;
    }
    const int faults = r->n_faults;
    const int kind = hn_rd_one_kind(r, node, "constraint", kinds, N_KINDS);
    if (kind < 0) {
        return;
    }

    // the kind reads the rest
    hn_constraint c = {.name = read_own_name(r, node, KINDS[kind].name),
                       .pointer = hn_rd_pointer(r),
                       .p = -1,
                       .q = -1,
                       .coordinate = {-1, -1}};
    size_t mark = hn_rd_enter(r, KINDS[kind].name);
    if (KINDS[kind].read(r, hn_rd_get(node, KINDS[kind].name), &c) && c.name &&
        r->n_faults == faults) {
        add_constraint(r, &c);
    }
    hn_rd_leave(r, mark);
}

void hn_rd_constraints(hn_reader *r, const cJSON *root) {
    if (r->scene->is_lagrangian && hn_rd_get(root, "constraints")) {
        hn_rd_fault_at(r, "constraints", "they belong in 'lagrangian.constraints'",
                       "a Lagrangian scene has its constraints as formulas");
        return;
    }
    hn_rd_list(r, root, "constraints", 0, read_constraint);
}
