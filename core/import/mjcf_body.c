// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of bodies of MJCF.
#include "import/mjcf.h"

#include <string.h>

/// The place in the tree: a body, a frame in it, the default class for elements without their own.
typedef struct place {
    int body;
    hn_im_frame at;
    const xmlNode *childclass;
    int needs_geoms; ///< geoms give the body its mass
    hn_im_mass mass; ///< gathered from geoms
} place;

static void read_children(hn_mj *m, const xmlNode *node, place *p);

static void add_site(hn_mj *m, const xmlNode *node, const place *p) {
    hn_mj_element e = hn_mj_look(m, node, p->childclass);
    hn_im_frame own;
    hn_mj_check(m, node);
    if (!e.node || !hn_mj_frame(m, &e, &own)) {
        return;
    }
    hn_mj_site *sites = hn_im_grow(m->b, m->sites, m->n_sites, &m->cap_sites, sizeof *sites);
    if (sites) {
        m->sites = sites;
        sites[m->n_sites++] = (hn_mj_site){.name = hn_im_attr(m->b, node, "name"),
                                           .body = p->body,
                                           .at = hn_im_frame_mul(&p->at, &own)};
    }
}

/// Mass by `inertial` unless geoms are to be asked always.
static bool read_inertial(hn_mj *m, const xmlNode *node, int body, int *needs_geoms) {
    const xmlNode *inertial = hn_im_child(node, "inertial");
    hn_im_mass mass;
    *needs_geoms = m->from_geoms == HN_MJ_ALWAYS || (m->from_geoms == HN_MJ_AUTO && !inertial);
    if (!inertial) {
        return true;
    }
    if (!hn_mj_inertial(m, inertial, &mass)) {
        return false;
    }
    if (*needs_geoms) {
        hn_im_note(m->b, HN_IMPORT_IGNORED, inertial, NULL,
                   "inertiafromgeom=\"true\": the geoms give the mass");
    } else {
        m->b->bodies[body].mass = mass;
        m->b->bodies[body].has_mass = 1;
    }
    return true;
}

static void check_static(hn_mj *m, const xmlNode *node) {
    const char *mocap = hn_im_attr(m->b, node, "mocap");
    if (mocap && strcmp(mocap, "true") == 0) {
        hn_im_note(m->b, HN_IMPORT_APPROXIMATED, node, "mocap",
                   "a body moved from outside is fixed at its place");
    }
}

static void read_body(hn_mj *m, const xmlNode *node, const place *around) {
    hn_mj_element e = {.node = node};
    place p = {.at = hn_im_frame_unit()};
    hn_im_frame own, local, world;
    bool ok = 1;

    // its place, in the class of the bodies around it
    hn_mj_check(m, node);
    check_static(m, node);
    p.childclass = hn_mj_class(m, node, "childclass", around->childclass, &ok);
    if (!ok || !hn_mj_frame(m, &e, &own)) {
        return;
    }

    // names are unique
    const char *name = hn_im_attr(m->b, node, "name");
    if (name && (hn_im_find_body(m->b, name) >= 0 || strcmp(name, "world") == 0)) {
        hn_im_fault(m->b, node, "name", NULL, "two bodies have the name '%.60s'", name);
        return;
    }

    // in its parent, and in the world
    local = hn_im_frame_mul(&around->at, &own);
    world = around->body == HN_GROUND ? local
                                      : hn_im_frame_mul(&m->b->bodies[around->body].world, &local);
    p.body = hn_im_add_body(m->b, node, name, &world);
    if (p.body < 0 || !read_inertial(m, node, p.body, &p.needs_geoms)) {
        return;
    }

    // joints first, then what hangs on it
    hn_mj_join(m, node, p.childclass, around->body, p.body, &local);
    read_children(m, node, &p);
    if (p.needs_geoms) {
        m->b->bodies[p.body].mass = p.mass;
        m->b->bodies[p.body].has_mass = p.mass.m > 0;
    }
}

static void read_frame(hn_mj *m, const xmlNode *node, place *around) {
    hn_mj_element e = {.node = node};
    place inner = *around;
    hn_im_frame own;
    bool ok = 1;
    hn_mj_check(m, node);
    inner.childclass = hn_mj_class(m, node, "childclass", around->childclass, &ok);
    if (ok && hn_mj_frame(m, &e, &own)) {
        inner.at = hn_im_frame_mul(&around->at, &own);
        read_children(m, node, &inner);
        around->mass = inner.mass;
    }
}

static void read_child(hn_mj *m, const xmlNode *c, place *p) {
    static const char looks[] = "camera light";
    static const char joints[] = "joint freejoint inertial";
    const char *name = (const char *)c->name;
    if (strcmp(name, "body") == 0) {
        read_body(m, c, p);
    } else if (strcmp(name, "frame") == 0) {
        read_frame(m, c, p);
    } else if (strcmp(name, "geom") == 0) {
        hn_mj_geom(m, c, p->childclass, &p->at, p->body, p->needs_geoms, &p->mass);
    } else if (strcmp(name, "site") == 0) {
        add_site(m, c, p);
    } else if (hn_im_lists(looks, name)) {
        hn_im_skip(m->b, HN_IMPORT_IGNORED, c, "affects the appearance only");
    } else if (!hn_im_lists(joints, name)) {
        hn_im_skip(m->b, HN_IMPORT_REFUSED, c,
                   "the parts that this element generates are not in the scene");
    } else if (p->body == HN_GROUND) {
        hn_im_fault(m->b, c, NULL, "put it into a body", "the world has no '%s'", name);
    }
}

static void read_children(hn_mj *m, const xmlNode *node, place *p) {
    for (const xmlNode *c = hn_im_first(node); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        read_child(m, c, p);
    }
}

void hn_mj_world(hn_mj *m, const xmlNode *section) {
    place p = {.body = HN_GROUND, .at = hn_im_frame_unit()};
    hn_mj_check(m, section);
    read_children(m, section, &p);
}
