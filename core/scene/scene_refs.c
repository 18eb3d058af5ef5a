// SPDX-License-Identifier: GPL-3.0-or-later
// References by name to what a scene holds: coordinates, the coordinate of a joint, points.

#include "scene/scene_refs.h"

#include <string.h>

int hn_rd_coordinate(hn_reader *r, const char *name, int rates) {
    enum { ROOM = 512 };
    const hn_scene *s = r->scene;
    const char *names[ROOM];
    int n = 0;
    int k;
    hn_rd_meaning meaning = hn_rd_find_name(r, name, &k);
    if (meaning == HN_RD_COORDINATE || (rates && meaning == HN_RD_RATE)) {
        return k;
    }
    for (int i = 0; i < s->n_coordinates && n < ROOM; i++) {
        names[n++] = s->coordinates[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, n);
    hn_rd_fault(r, hint, "there is no coordinate named '%.60s'", name);
    return -1;
}

int hn_rd_end(hn_reader *r, const cJSON *node, const char *key) {
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

/// The one coordinate of a joint, or -1 after a fault.
static int only_coordinate(hn_reader *r, const hn_joint *j) {
    if (j->n_coordinates != 1) {
        hn_rd_fault_at(r, "joint", j->n_coordinates > 1 ? "name one with 'coordinate'" : NULL,
                       "the joint '%s' has %d coordinates", j->name, j->n_coordinates);
        return -1;
    }
    return j->coordinate;
}

static int find_joint(hn_reader *r, const char *name) {
    enum { ROOM = 256 };
    const hn_scene *s = r->scene;
    const char *names[ROOM];
    for (int i = 0; i < s->n_joints; i++) {
        if (strcmp(s->joints[i].name, name) == 0) {
            return only_coordinate(r, &s->joints[i]);
        }
        names[i < ROOM ? i : ROOM - 1] = s->joints[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, s->n_joints < ROOM ? s->n_joints : ROOM);
    hn_rd_fault_at(r, "joint", hint, "there is no joint named '%s'", name);
    return -1;
}

int hn_rd_target(hn_reader *r, const cJSON *node, int position) {
    if (!hn_rd_get(node, "joint") == !hn_rd_get(node, "coordinate")) {
        hn_rd_fault(r, NULL, "expected either 'joint' or 'coordinate', found %s",
                    hn_rd_get(node, "joint") ? "both" : "neither");
        return -1;
    }

    // a joint with one coordinate, or a coordinate by its own name
    const char *key = hn_rd_get(node, "joint") ? "joint" : "coordinate";
    const char *name = hn_rd_name(r, node, key, 1);
    if (!name) {
        return -1;
    }
    if (key[0] == 'j') {
        return find_joint(r, name);
    }
    size_t mark = hn_rd_enter(r, key);
    int k = hn_rd_coordinate(r, name, 0);
    if (k >= 0 && position && !hn_rd_check_no_turn(r, k)) {
        k = -1;
    }
    hn_rd_leave(r, mark);
    return k;
}
