// SPDX-License-Identifier: GPL-3.0-or-later
// Which geoms of MJCF can touch one another: their bits match, and MuJoCo does not pass over their
// bodies. It passes over a body and itself, bodies without a joint between them, and a body and its
// parent unless that stands still.
// Source: MuJoCo documentation, "Computation", section "Collision detection, selection".
#include "import/mjcf.h"

bool hn_mj_add_geom(hn_mj *m, const hn_mj_element *e, int body) {
    double type, affinity;
    if (!hn_mj_number(m, e, "contype", 1, &type) ||
        !hn_mj_number(m, e, "conaffinity", 1, &affinity)) {
        return false;
    }
    if (type == 0 && affinity == 0) {
        return true;
    }
    hn_mj_geom_bits *geoms =
        hn_im_grow(m->b, m->geoms, m->n_geoms, &m->cap_geoms, sizeof *m->geoms);
    if (!geoms) {
        return false;
    }
    m->geoms = geoms;
    geoms[m->n_geoms++] = (hn_mj_geom_bits){.node = e->node,
                                            .body = body,
                                            .contype = (unsigned)type,
                                            .conaffinity = (unsigned)affinity};
    return true;
}

/// The joint that carries a body in the tree, or NULL for the ground.
static const hn_im_joint *joint_below(const hn_build *b, int body) {
    for (int i = 0; i < b->n_joints; i++) {
        if (b->joints[i].child == body && !b->joints[i].cut) {
            return &b->joints[i];
        }
    }
    return NULL;
}

/// The body that this one is fixed to, or itself; the ground for all that stands still.
static int rigid_part(const hn_build *b, int body) {
    while (body != HN_GROUND) {
        const hn_im_joint *joint = joint_below(b, body);
        if (!joint || joint->type != HN_JOINT_FIXED) {
            break;
        }
        body = joint->parent;
    }
    return body;
}

/// The rigid part that carries a rigid part; the carriers between several joints are none.
static int part_below(const hn_build *b, int part) {
    const hn_im_joint *joint = joint_below(b, part);
    int body = joint ? joint->parent : HN_GROUND;
    while (body != HN_GROUND && b->bodies[body].is_carrier) {
        joint = joint_below(b, body);
        body = joint ? joint->parent : HN_GROUND;
    }
    return rigid_part(b, body);
}

/// Does the section <contact> take the two bodies out?
static bool is_excluded(const hn_mj *m, int a, int c) {
    for (const xmlNode *s = hn_im_first(m->root); s; s = hn_im_next(s)) {
        for (const xmlNode *x = hn_im_is(s, "contact") ? hn_im_first(s) : NULL; x;
             x = hn_im_next(x)) {
            const char *one = hn_im_attr(m->b, x, "body1"), *two = hn_im_attr(m->b, x, "body2");
            if (!hn_im_is(x, "exclude") || !one || !two) {
                continue;
            }
            const int i = hn_im_find_body(m->b, one), k = hn_im_find_body(m->b, two);
            if ((i == a && k == c) || (i == c && k == a)) {
                return true;
            }
        }
    }
    return false;
}

static bool can_touch(const hn_mj *m, const hn_mj_geom_bits *x, const hn_mj_geom_bits *y) {
    const int a = rigid_part(m->b, x->body), c = rigid_part(m->b, y->body);
    const bool bits = (x->contype & y->conaffinity) || (y->contype & x->conaffinity);
    if (!bits || a == c) {
        return false;
    }
    const bool both_move = a != HN_GROUND && c != HN_GROUND;
    const bool neighbours = part_below(m->b, a) == c || part_below(m->b, c) == a;
    return !(both_move && neighbours && !m->keep_parents) && !is_excluded(m, x->body, y->body);
}

void hn_mj_tell_contacts(hn_mj *m) {
    const hn_mj_geom_bits *first = NULL;
    int n = 0;
    for (int i = 0; i < m->n_geoms && !m->no_contact; i++) {
        bool touches = false;
        for (int k = 0; k < m->n_geoms && !touches; k++) {
            touches = k != i && can_touch(m, &m->geoms[i], &m->geoms[k]);
        }
        first = touches && !first ? &m->geoms[i] : first;
        n += touches;
    }
    if (first) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, first->node, NULL,
                   "this geom and %d more can touch one another in MuJoCo; contacts are not in the "
                   "scene, and bodies pass through each other",
                   n - 1);
    }
}
