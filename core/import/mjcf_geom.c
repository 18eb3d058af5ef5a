// SPDX-License-Identifier: GPL-3.0-or-later
// Mass of bodies: an `inertial` element, or the geoms as homogeneous solids.
#include "import/mjcf.h"

#include "linalg/small3.h"

#include <math.h>
#include <string.h>

static const double WATER = 1000; ///< density of geoms that say nothing else [kg/m^3]

static const struct {
    const char *name;
    hn_im_solid solid;
    int n_sizes, n_sizes_fromto; ///< 0: no ends
    int squares;                 ///< ends leave the second size: like the first
} SOLIDS[] = {{"sphere", HN_IM_SPHERE, 1, 0, 0},
              {"capsule", HN_IM_CAPSULE, 2, 1, 0},
              {"cylinder", HN_IM_CYLINDER, 2, 1, 0},
              {"ellipsoid", HN_IM_ELLIPSOID, 3, 1, 1},
              {"box", HN_IM_BOX, 3, 1, 1}};
enum { N_SOLIDS = sizeof SOLIDS / sizeof *SOLIDS };

static int find_solid(const char *type) {
    for (int k = 0; k < N_SOLIDS; k++) {
        if (strcmp(SOLIDS[k].name, type) == 0) {
            return k;
        }
    }
    return -1;
}

/// Two ends on the z axis give centre, direction and the size along it.
static bool place_between(hn_mj *m, const hn_mj_element *e, int kind, const double ends[6],
                          double size[3], hn_im_frame *at) {
    // the axis and the middle
    double z[3], x[3], y[3];
    for (int i = 0; i < 3; i++) {
        z[i] = ends[i + 3] - ends[i];
        at->p[i] = (ends[i] + ends[i + 3]) / 2;
    }
    double half = hn_num3_norm(z) / 2;
    if (!hn_im_normalise(z)) {
        return hn_im_fault(m->b, e->node, "fromto", NULL, "the two ends are the same point");
    }

    // the half length along it, twice where a solid has a square section
    size[1] = SOLIDS[kind].squares ? size[0] : half;
    size[2] = SOLIDS[kind].squares ? half : size[2];

    // any directions across will do: the solids are round
    hn_im_across(z, x);
    hn_num3_cross(z, x, y);
    for (int i = 0; i < 3; i++) {
        at->R[i][0] = x[i];
        at->R[i][1] = y[i];
        at->R[i][2] = z[i];
    }
    hn_im_snap(at->R);
    return true;
}

static bool read_shape(hn_mj *m, const hn_mj_element *e, int kind, double size[3],
                       hn_im_frame *at) {
    double ends[6];
    int given = hn_mj_numbers(m, e, "size", 1, 3, size);
    int n_ends = hn_mj_numbers(m, e, "fromto", 6, 6, ends);
    if (given < 0 || n_ends < 0 || !hn_mj_frame(m, e, at)) {
        return false;
    }
    int between = n_ends && SOLIDS[kind].n_sizes_fromto > 0;
    int needed = between ? SOLIDS[kind].n_sizes_fromto : SOLIDS[kind].n_sizes;
    if (given < needed) {
        return hn_im_fault(m->b, e->node, given ? "size" : NULL, NULL,
                           "a %s needs %d sizes, found %d", SOLIDS[kind].name, needed, given);
    }
    for (int i = 0; i < needed; i++) {
        if (!(size[i] > 0)) {
            return hn_im_fault(m->b, e->node, "size", NULL, "a size of %g m is not positive",
                               size[i]);
        }
    }
    return !between || place_between(m, e, kind, ends, size, at);
}

static bool read_mass(hn_mj *m, const hn_mj_element *e, int kind, const double size[3],
                      double *mass) {
    double density;
    if (!hn_mj_number(m, e, "density", WATER, &density) || !hn_mj_number(m, e, "mass", -1, mass)) {
        return false;
    }
    int by_mass = hn_mj_attr(m, e, "mass") != NULL;
    if (!by_mass) {
        *mass = density * hn_im_volume(SOLIDS[kind].solid, size);
    }
    return (*mass >= 0 && isfinite(*mass)) ||
           hn_im_fault(m->b, e->node, by_mass ? "mass" : "density", NULL, "a %s of %g is negative",
                       by_mass ? "mass" : "density", by_mass ? *mass : density);
}

/// 1 when the geom's group is among those that have mass.
static bool has_mass(hn_mj *m, const hn_mj_element *e) {
    double group;
    return hn_mj_number(m, e, "group", 0, &group) && group >= m->groups[0] && group <= m->groups[1];
}

void hn_mj_geom(hn_mj *m, const xmlNode *node, const xmlNode *childclass, const hn_im_frame *at,
                int body, int needed, hn_im_mass *sum) {
    const bool on_ground = body == HN_GROUND;
    hn_mj_element e = hn_mj_look(m, node, childclass);
    double size[3] = {0, 0, 0}, mass;
    hn_im_frame own;
    hn_mj_check(m, node);
    if (!e.node) {
        return;
    }

    // the kind of solid, if it is one
    if (!hn_mj_add_geom(m, &e, body)) {
        return;
    }
    const char *type = hn_mj_attr(m, &e, "type");
    type = type ? type : hn_mj_attr(m, &e, "mesh") ? "mesh" : "sphere";
    int kind = find_solid(type);
    if (kind < 0) {
        hn_im_note(m->b, needed && !on_ground ? HN_IMPORT_REFUSED : HN_IMPORT_IGNORED, node, NULL,
                   needed && !on_ground
                       ? "a geom of type '%.40s' has no mass here: give the body an 'inertial'"
                       : "a geom of type '%.40s' affects appearance and contacts only",
                   type);
        return;
    }

    // mass only where the body needs it
    if (!read_shape(m, &e, kind, size, &own) || !read_mass(m, &e, kind, size, &mass) || on_ground ||
        !needed || !has_mass(m, &e)) {
        return;
    }
    if (hn_mj_flag(m, &e, "shellinertia", 0)) {
        hn_im_note(m->b, HN_IMPORT_APPROXIMATED, node, "shellinertia",
                   "a shell of %g kg is taken as a solid of that mass", mass);
    }

    // its share of the body
    hn_im_mass solid = hn_im_solid_mass(SOLIDS[kind].solid, size, mass);
    hn_im_frame place = hn_im_frame_mul(at, &own);
    hn_im_mass moved = hn_im_mass_moved(&solid, &place);
    *sum = hn_im_mass_sum(sum, &moved);
}

bool hn_mj_inertial(hn_mj *m, const xmlNode *node, hn_im_mass *out) {
    hn_mj_element e = hn_mj_look(m, node, NULL);
    hn_im_mass own = {.m = 0};
    hn_im_frame at;
    double mass;
    hn_mj_check(m, node);
    if (!e.node || !hn_mj_frame(m, &e, &at) || !hn_mj_number(m, &e, "mass", -1, &mass)) {
        return false;
    }
    if (!hn_im_attr(m->b, node, "mass") || mass < 0) {
        return hn_im_fault(m->b, node, hn_im_attr(m->b, node, "mass") ? "mass" : NULL, NULL,
                           "an 'inertial' needs a mass that is not negative");
    }

    // about its principal axes, or with products of inertia
    int diagonal = hn_mj_numbers(m, &e, "diaginertia", 3, 3, own.I);
    if (diagonal > 0 && hn_im_attr(m->b, node, "fullinertia")) {
        return hn_im_fault(m->b, node, "fullinertia", "keep one of them",
                           "the inertia is given as 'diaginertia' too");
    }
    // both orders are xx yy zz xy xz yz
    int full = diagonal > 0 ? 0 : hn_mj_numbers(m, &e, "fullinertia", 6, 6, own.I);
    if (diagonal < 0 || full < 0) {
        return false;
    }
    own.m = mass;
    *out = hn_im_mass_moved(&own, &at);
    return true;
}
