// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as a plain list.

#include "scene/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- bodies ----

bool hn_rd_check_new_name(hn_reader *r, const char *name, const char *taken_by) {
    return taken_by ? hn_rd_fault_at(r, "name", NULL, "the name '%s' is used twice (also at %s)",
                                     name, taken_by)
                    : 1;
}

/// The tensor about the centre of mass. zz alone means a thin rod along the body's x: xx = 0, yy =
/// zz.
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

    // the name, which no other body has
    int faults = r->n_faults;
    hn_body b = {.name = hn_rd_name(r, node, "name", 1), .pointer = hn_rd_pointer(r)};
    hn_rd_text(r, node, "about", 0);
    if (b.name && strcmp(b.name, "ground") == 0) {
        hn_rd_fault_at(r, "name", NULL, "'ground' is the fixed world and cannot be a body's name");
    } else if (b.name) {
        int other = hn_scene_find_body(s, b.name);
        hn_rd_check_new_name(r, b.name, other >= 0 ? s->bodies[other].pointer : NULL);
    }

    // mass, centre of mass and inertia
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

    // a fault above would only be repeated
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

void hn_rd_bodies(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "bodies");
    int faults = r->n_faults;
    size_t mark = hn_rd_enter(r, "bodies");
    if (hn_rd_is_list(r, node, "bodies")) {
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
