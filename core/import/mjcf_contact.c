// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the geoms of MJCF that can touch one another: their bits match, and MuJoCo does not pass
// over their bodies. It passes over a body and itself, bodies without a joint between them, and a
// body and its parent unless that stands still.
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

/// Facts about each body, found once, so that no pair of geoms walks the tree.
typedef struct touch {
    const hn_mj *m;
    const hn_im_joint **carrier; ///< the joint that carries the body, NULL: none
    int *part;                   ///< the body that it is fixed to, or itself; HN_GROUND: it stands
    int *below;                  ///< the part that carries its part
    unsigned *contype, *conaffinity; ///< of all its geoms together
    bool *excluded;                  ///< n x n
    int n;                           ///< bodies and the ground, which is the last
} touch;

static int index_of(const touch *t, int body) {
    return body == HN_GROUND ? t->n - 1 : body;
}

/// The body that this one is fixed to, or itself; the ground for all that stands still.
static int rigid_part(const touch *t, int body) {
    while (body != HN_GROUND) {
        const hn_im_joint *joint = t->carrier[body];
        if (!joint || joint->type != HN_JOINT_FIXED) {
            break;
        }
        body = joint->parent;
    }
    return body;
}

/// The rigid part that carries a rigid part; the carriers between several joints are none.
static int part_below(const touch *t, int part) {
    const hn_build *b = t->m->b;
    const hn_im_joint *joint = part == HN_GROUND ? NULL : t->carrier[part];
    int body = joint ? joint->parent : HN_GROUND;
    while (body != HN_GROUND && b->bodies[body].is_carrier) {
        joint = t->carrier[body];
        body = joint ? joint->parent : HN_GROUND;
    }
    return rigid_part(t, body);
}

/// Marks the pairs of bodies that the section <contact> takes out.
static void read_excluded(touch *t) {
    hn_build *b = t->m->b;
    for (const xmlNode *s = hn_im_first(t->m->root); s; s = hn_im_next(s)) {
        for (const xmlNode *x = hn_im_is(s, "contact") ? hn_im_first(s) : NULL; x;
             x = hn_im_next(x)) {
            const char *one = hn_im_attr(b, x, "body1"), *two = hn_im_attr(b, x, "body2");
            if (!hn_im_is(x, "exclude") || !one || !two) {
                continue;
            }
            const int i = hn_im_find_body(b, one), k = hn_im_find_body(b, two);
            if (i >= 0 && k >= 0) {
                t->excluded[i * t->n + k] = t->excluded[k * t->n + i] = true;
            }
        }
    }
}

static bool allocate(touch *t) {
    hn_arena *arena = t->m->b->arena;
    const size_t n = (size_t)t->n;
    t->carrier = hn_arena_get(arena, n * sizeof *t->carrier);
    t->part = hn_arena_ints(arena, n);
    t->below = hn_arena_ints(arena, n);
    t->contype = hn_arena_get(arena, n * sizeof *t->contype);
    t->conaffinity = hn_arena_get(arena, n * sizeof *t->conaffinity);
    t->excluded = hn_arena_get(arena, n * n * sizeof *t->excluded);
    return !hn_arena_failed(arena);
}

static void look_at_bodies(touch *t) {
    const hn_mj *m = t->m;

    // who carries whom
    for (int i = m->b->n_joints - 1; i >= 0; i--) { // the first of several is the one
        const hn_im_joint *joint = &m->b->joints[i];
        if (!joint->cut && joint->child != HN_GROUND) {
            t->carrier[joint->child] = joint;
        }
    }
    for (int i = 0; i < t->n; i++) {
        t->part[i] = rigid_part(t, i == t->n - 1 ? HN_GROUND : i);
        t->below[i] = part_below(t, t->part[i]);
    }

    // what the geoms of each can touch
    for (int i = 0; i < m->n_geoms; i++) {
        const int at = index_of(t, m->geoms[i].body);
        t->contype[at] |= m->geoms[i].contype;
        t->conaffinity[at] |= m->geoms[i].conaffinity;
    }
    read_excluded(t);
}

/// Returns whether a geom can touch one of the geoms of body k.
static bool can_touch(const touch *t, const hn_mj_geom_bits *x, int k) {
    const int i = index_of(t, x->body), a = t->part[i], c = t->part[k];
    const bool bits = (x->contype & t->conaffinity[k]) || (t->contype[k] & x->conaffinity);
    if (!bits || a == c) {
        return false;
    }
    const bool both_move = a != HN_GROUND && c != HN_GROUND;
    const bool neighbours = t->below[i] == c || t->below[k] == a;
    return !(both_move && neighbours && !t->m->keep_parents) && !t->excluded[i * t->n + k];
}

void hn_mj_tell_contacts(hn_mj *m) {
    touch t = {.m = m, .n = m->b->n_bodies + 1};
    if (m->no_contact || m->n_geoms < 2) {
        return;
    }
    if (!allocate(&t)) {
        hn_im_out_of_memory(m->b);
        return;
    }
    look_at_bodies(&t);

    const hn_mj_geom_bits *first = NULL;
    int n = 0;
    for (int i = 0; i < m->n_geoms; i++) {
        bool touches = false;
        for (int k = 0; k < t.n && !touches; k++) {
            touches = can_touch(&t, &m->geoms[i], k);
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
