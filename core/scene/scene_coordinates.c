// SPDX-License-Identifier: GPL-3.0-or-later
// The coordinates of a joint: how many its type has, how they are called, which are driven, how far
// they may go.

#include "scene/joint_freedoms.h"
#include "scene/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int hn_rd_add_coordinate(hn_reader *r, const char *name, const char *rate, hn_unit_kind kind,
                         int joint, int actuated) {
    hn_scene *s = r->scene;
    char made[HN_RD_MAX_NAME + 8];
    if (!name) {
        return -1;
    }

    // the name of the rate follows from that of the coordinate, unless it is given
    bool ok = hn_rd_check_identifier(r, name);
    if (!rate) {
        snprintf(made, sizeof made, "d_%s", name);
        rate = hn_rd_keep(r, made);
    }
    hn_coordinate *all = hn_rd_grow(r, s->coordinates, s->n_coordinates, sizeof *all,
                                    HN_SCENE_MAX_JOINTS, "coordinates");
    if (!all || !ok || !rate) {
        return -1;
    }

    // no start, no limits: others read them later
    s->coordinates = all;
    int k = s->n_coordinates++;
    all[k] = (hn_coordinate){.name = name, .rate = rate, .kind = kind, .joint = joint};
    all[k].turn = -1;
    all[k].min = -HUGE_VAL;
    all[k].max = HUGE_VAL;
    all[k].actuated = actuated;

    // both names can be used in formulas from here on
    hn_rd_put_name(r, HN_RD_COORDINATE, k);
    ok = hn_rd_check_identifier(r, rate);
    if (ok) {
        hn_rd_put_name(r, HN_RD_RATE, k);
    }
    return ok ? k : -1;
}

// ---- names ----

/// A name of a list: filled in, or NULL after a fault.
static const char *listed_name(hn_reader *r, const cJSON *node) {
    if (!cJSON_IsString(node)) {
        hn_rd_fault(r, NULL, "expected a name in double quotes, found %s", hn_rd_kind(node));
        return NULL;
    }
    return hn_rd_fill(r, node->valuestring);
}

/// The names under `many` (a list, one for each degree of freedom), or for a single one under
/// `one`. Those left out stay NULL.
static bool read_names(hn_reader *r, const cJSON *node, const char *one, const char *many, int n,
                       const char *names[HN_JOINT_FREEDOMS]) {
    const cJSON *list = hn_rd_get(node, many), *single = hn_rd_get(node, one);
    if (list && single) {
        return hn_rd_fault(r, "leave one of them out", "both '%s' and '%s' are given", one, many);
    }

    // a single name serves joints with one coordinate
    if (single && n != 1) {
        char hint[HN_DIAG_HINT];
        snprintf(hint, sizeof hint, "a list '%s' of %d names", many, n);
        return hn_rd_fault_at(r, one, n > 0 ? hint : "leave it out",
                              "this type of joint has %d coordinates", n);
    }
    if (single) {
        names[0] = hn_rd_name(r, node, one, 1);
        return names[0] != NULL;
    }

    // a list names all of them
    if (list && (!cJSON_IsArray(list) || cJSON_GetArraySize(list) != n)) {
        return hn_rd_fault_at(r, many, NULL, "expected a list of %d name%s, found %s%s", n,
                              n == 1 ? "" : "s", hn_rd_kind(list),
                              cJSON_IsArray(list) ? " of another length" : "");
    }
    bool ok = 1;
    size_t mark = hn_rd_enter(r, many);
    for (int i = 0; i < n && list; i++) {
        size_t inner = hn_rd_enter_index(r, i);
        names[i] = listed_name(r, cJSON_GetArrayItem(list, i));
        ok &= names[i] != NULL;
        hn_rd_leave(r, inner);
    }
    hn_rd_leave(r, mark);
    return ok;
}

/// The name a coordinate has when the scene gives none.
static const char *default_name(hn_reader *r, const char *joint, const char *suffix) {
    char made[HN_RD_MAX_NAME + 16];
    snprintf(made, sizeof made, "%s%s", joint, suffix);
    return hn_rd_keep(r, made);
}

// ---- driven, limited ----

/// The joint's own coordinate of that name, or -1 after a fault.
static int own_coordinate(hn_reader *r, const hn_joint *j, const char *name) {
    const char *names[HN_JOINT_FREEDOMS];
    for (int i = 0; i < j->n_coordinates; i++) {
        names[i] = r->scene->coordinates[j->coordinate + i].name;
        if (strcmp(names[i], name) == 0) {
            return j->coordinate + i;
        }
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, j->n_coordinates);
    hn_rd_fault(r, hint, "the joint '%s' has no coordinate named '%.60s'", j->name, name);
    return -1;
}

/// true, false, or the names of those coordinates that are driven.
static void read_actuated(hn_reader *r, const cJSON *node, const hn_joint *j) {
    const cJSON *driven = hn_rd_get(node, "actuated");
    size_t mark = hn_rd_enter(r, "actuated");

    // true or false for all coordinates
    if (cJSON_IsTrue(driven) && j->n_coordinates == 0) {
        hn_rd_fault(r, "leave it out", "a fixed joint has nothing that could be driven");
    }
    for (int i = 0; i < j->n_coordinates; i++) {
        r->scene->coordinates[j->coordinate + i].actuated = cJSON_IsTrue(driven);
    }

    // or a list of those that are driven
    int index = 0;
    for (const cJSON *m = cJSON_IsArray(driven) ? driven->child : NULL; m && !hn_rd_stopped(r);
         m = m->next, index++) {
        size_t inner = hn_rd_enter_index(r, index);
        const char *name = listed_name(r, m);
        int k = name ? own_coordinate(r, j, name) : -1;
        if (k >= 0) {
            r->scene->coordinates[k].actuated = true;
        }
        hn_rd_leave(r, inner);
    }
    if (driven && !cJSON_IsBool(driven) && !cJSON_IsArray(driven)) {
        hn_rd_fault(r, NULL, "expected true, false or a list of coordinates, found %s",
                    hn_rd_kind(driven));
    }
    hn_rd_leave(r, mark);
}

/// [least, most]; null leaves a side open.
static void read_limit(hn_reader *r, const cJSON *node, hn_coordinate *c) {
    double bound[2] = {-HUGE_VAL, HUGE_VAL};

    // an entry of a rotation vector has no limit of its own
    if (c->turn >= 0) {
        hn_rd_fault(r, "limit the coordinates of a universal or revolute joint instead",
                    "'%s' is an entry of a rotation vector and cannot be limited", c->name);
        return;
    }
    if (!cJSON_IsArray(node) || cJSON_GetArraySize(node) != 2) {
        hn_rd_fault(r, "as in [-1, 1]; null leaves a side open",
                    "expected a list of the least and the greatest value, found %s%s",
                    hn_rd_kind(node), cJSON_IsArray(node) ? " of another length" : "");
        return;
    }

    // null leaves a side open
    for (int i = 0; i < 2; i++) {
        const cJSON *item = cJSON_GetArrayItem(node, i);
        size_t mark = hn_rd_enter_index(r, i);
        hn_quantity q;
        if (!cJSON_IsNull(item) && hn_rd_quantity(r, item, &q, HN_RD_CONST)) {
            bound[i] = q.value;
        }
        hn_rd_leave(r, mark);
    }
    if (!(bound[0] < bound[1])) {
        hn_rd_fault(r, NULL, "the lower limit %g of '%s' is not below the upper %g", bound[0],
                    c->name, bound[1]);
        return;
    }
    c->min = bound[0];
    c->max = bound[1];
}

/// A list for the one coordinate, or an object by names of coordinates.
static void read_limits(hn_reader *r, const cJSON *node, const hn_joint *j) {
    const cJSON *limits = hn_rd_get(node, "limits");
    hn_coordinate *all = r->scene->coordinates;
    size_t mark = hn_rd_enter(r, "limits");

    // by the names of its coordinates, or as one pair where there is one coordinate
    if (cJSON_IsObject(limits)) {
        for (const cJSON *m = limits->child; m && !hn_rd_stopped(r); m = m->next) {
            size_t inner = hn_rd_enter(r, m->string);
            const char *name = hn_rd_fill(r, m->string);
            int k = name ? own_coordinate(r, j, name) : -1;
            if (k >= 0) {
                read_limit(r, m, &all[k]);
            }
            hn_rd_leave(r, inner);
        }
    } else if (limits && j->n_coordinates == 1) {
        read_limit(r, limits, &all[j->coordinate]);
    } else if (limits) {
        hn_rd_fault(r, "as in {\"x\": [-1, 1]}, by names of the joint's coordinates",
                    "expected an object of limits, found %s", hn_rd_kind(limits));
    }
    hn_rd_leave(r, mark);
}

// ---- a joint's ----

void hn_rd_joint_coordinates(hn_reader *r, const cJSON *node, hn_joint *j) {
    const char *names[HN_JOINT_FREEDOMS] = {NULL}, *rates[HN_JOINT_FREEDOMS] = {NULL};
    int n, first = r->scene->n_coordinates;
    const hn_freedom *freedoms = hn_joint_freedoms(j->type, &n);
    j->coordinate = -1;
    j->n_coordinates = 0;

    // names that the scene gives
    if (!read_names(r, node, "coordinate", "coordinates", n, names) ||
        !read_names(r, node, "rate", "rates", n, rates) || !j->name) {
        return;
    }

    // a fault of a made-up name is reported at the joint's own
    const char *at = hn_rd_get(node, "coordinate")    ? "coordinate"
                     : hn_rd_get(node, "coordinates") ? "coordinates"
                                                      : "name";
    size_t mark = hn_rd_enter(r, at);
    bool ok = 1;
    for (int i = 0; i < n && ok; i++) {
        const hn_freedom *f = &freedoms[i];
        const char *name = names[i] ? names[i] : default_name(r, j->name, f->suffix);
        int k = hn_rd_add_coordinate(r, name, rates[i], f->kind, r->scene->n_joints, 0);
        ok = k >= 0;
        if (ok) {
            r->scene->coordinates[k].part = i;
            r->scene->coordinates[k].turn = f->turn;
        }
    }
    hn_rd_leave(r, mark);
    if (!ok) {
        return;
    }

    // what drives and limits them needs their names
    j->coordinate = n > 0 ? first : -1;
    j->n_coordinates = n;
    read_actuated(r, node, j);
    read_limits(r, node, j);
}
