// SPDX-License-Identifier: GPL-3.0-or-later
// Equalities of MJCF close loops: connect is a ball joint, weld a fixed one, joint a gear or a
// formula of two coordinates.
#include "import/mjcf.h"

#include <math.h>
#include <string.h>

/// Pose of a body (or ground) where the model is written.
static hn_im_frame world_of(const hn_mj *m, int body) {
    return body == HN_GROUND ? hn_im_frame_unit() : m->b->bodies[body].world;
}

/// A body by the name under `attribute`; ground when it is absent and may be, -2 after a fault.
static int find_body(hn_mj *m, const hn_mj_element *e, const char *attribute, int needed) {
    const char *name = hn_im_attr(m->b, e->node, attribute);
    if (!name && !needed) {
        return HN_GROUND;
    }
    if (!name) {
        hn_im_fault(m->b, e->node, NULL, NULL, "the attribute '%s' is missing", attribute);
        return -2;
    }
    int body = strcmp(name, "world") == 0 ? HN_GROUND : hn_im_find_body(m->b, name);
    if (body == -2) {
        hn_im_fault(m->b, e->node, attribute, NULL, "there is no body named '%.60s'", name);
    }
    return body;
}

static const hn_mj_site *find_site(hn_mj *m, const hn_mj_element *e, const char *attribute) {
    const char *name = hn_im_attr(m->b, e->node, attribute);
    for (int i = 0; i < m->n_sites && name; i++) {
        if (m->sites[i].name && strcmp(m->sites[i].name, name) == 0) {
            return &m->sites[i];
        }
    }
    hn_im_fault(m->b, e->node, name ? attribute : NULL, NULL,
                name ? "there is no site named '%.60s'" : "an equality of sites needs both (%s)",
                name ? name : attribute);
    return NULL;
}

typedef struct sides {
    int body[2];
    hn_im_frame at[2]; ///< what coincides, in each body
} sides;

static bool by_sites(hn_mj *m, const hn_mj_element *e, sides *s) {
    static const char *const names[] = {"site1", "site2"};
    for (int k = 0; k < 2; k++) {
        const hn_mj_site *site = find_site(m, e, names[k]);
        if (!site) {
            return false;
        }
        s->body[k] = site->body;
        s->at[k] = site->at;
    }
    return true;
}

/// Both bodies hold the place that they have in common where the model is written.
static bool by_anchor(hn_mj *m, const hn_mj_element *e, sides *s) {
    s->at[0] = hn_im_frame_unit();
    if (!hn_im_attr(m->b, e->node, "anchor")) {
        return hn_im_fault(m->b, e->node, NULL, "or 'site1' and 'site2'",
                           "a connect needs its 'anchor'");
    }
    if (hn_mj_numbers(m, e, "anchor", 3, 3, s->at[0].p) < 0) {
        return false;
    }
    hn_im_frame first = world_of(m, s->body[0]), second = world_of(m, s->body[1]);
    hn_im_frame back = hn_im_frame_inverse(&second);
    hn_im_frame there = hn_im_frame_mul(&first, &s->at[0]);
    s->at[1] = hn_im_frame_mul(&back, &there);
    return true;
}

/// relpose is the second body seen from the first; a quaternion of zeros means the pose the
/// model is written in.
static bool by_pose(hn_mj *m, const hn_mj_element *e, sides *s) {
    double x[7];
    int n = hn_mj_numbers(m, e, "relpose", 7, 7, x);
    if (n < 0) {
        return false;
    }
    s->at[1] = hn_im_frame_unit();
    double size = n ? sqrt(x[3] * x[3] + x[4] * x[4] + x[5] * x[5] + x[6] * x[6]) : 0;
    if (size < 1e-10) {
        hn_im_frame first = world_of(m, s->body[0]), second = world_of(m, s->body[1]);
        hn_im_frame back = hn_im_frame_inverse(&first);
        s->at[0] = hn_im_frame_mul(&back, &second);
        return true;
    }
    memcpy(s->at[0].p, x, sizeof s->at[0].p);
    hn_im_from_quaternion((double[]){x[3] / size, x[4] / size, x[5] / size, x[6] / size},
                          s->at[0].R);
    return true;
}

static bool read_sides(hn_mj *m, const hn_mj_element *e, int weld, sides *s) {
    if (hn_im_attr(m->b, e->node, "site1") || hn_im_attr(m->b, e->node, "site2")) {
        return by_sites(m, e, s);
    }
    s->body[0] = find_body(m, e, "body1", 1);
    s->body[1] = s->body[0] == -2 ? -2 : find_body(m, e, "body2", 0);
    return s->body[1] != -2 && (weld ? by_pose(m, e, s) : by_anchor(m, e, s));
}

static void add_closing_joint(hn_mj *m, const hn_mj_element *e, int weld) {
    sides s;
    if (!read_sides(m, e, weld, &s)) {
        return;
    }
    if (s.body[0] == s.body[1]) {
        hn_im_fault(m->b, e->node, NULL, NULL, "the equality joins a body to itself");
        return;
    }
    hn_im_joint j = {.type = weld ? HN_JOINT_FIXED : HN_JOINT_SPHERICAL,
                     .parent = s.body[0],
                     .child = s.body[1],
                     .cut = 1};
    // the world can only be a parent to be read easily; a ball or fixed joint is the same both ways
    int swap = s.body[1] == HN_GROUND;
    j.parent = s.body[swap];
    j.child = s.body[!swap];
    hn_im_set_sides(&j, &s.at[swap], &s.at[!swap]);
    const char *name = hn_im_attr(m->b, e->node, "name");
    (void)hn_im_add_joint(m->b, e->node, &j, name ? name : (const char *)e->node->name);
}

// ---- joints coupled ----

static int find_joint(hn_mj *m, const hn_mj_element *e, const char *attribute) {
    const char *name = hn_im_attr(m->b, e->node, attribute);
    int joint = name ? hn_im_find_joint(m->b, name) : -1;
    if (joint < 0) {
        hn_im_fault(m->b, e->node, name ? attribute : NULL, NULL,
                    name ? "there is no joint named '%.60s'" : "the attribute '%s' is missing",
                    name ? name : attribute);
    } else if (m->b->joints[joint].n != 1) {
        hn_im_fault(m->b, e->node, attribute, "only hinge and slide joints are coupled",
                    "the joint '%.60s' has %d coordinates", name, m->b->joints[joint].n);
        joint = -1;
    }
    return joint;
}

/// y - y0 = a0 + a1 (x - x0) + ... + a4 (x - x0)^4, y and x the coordinates, y0 and x0 theirs where
/// the model is written.
static void put_polynomial(hn_mj *m, hn_strbuf *o, const hn_im_joint *y, const hn_im_joint *x,
                           const double a[5]) {
    hn_strbuf f;
    hn_strbuf_init(&f);
    hn_strbuf_printf(&f, "%s - %s", y->coordinate[0], hn_im_number(m->b, y->zero + a[0]));
    for (int k = 1; k < 5; k++) {
        if (a[k] != 0) {
            hn_strbuf_printf(&f, " - %s*(%s - %s)^%d", hn_im_number(m->b, a[k]), x->coordinate[0],
                             hn_im_number(m->b, x->zero), k);
        }
    }
    o->failed |= f.failed;
    hn_json_put_string(o, "formula", hn_strbuf_text(&f));
    hn_strbuf_reset(&f);
}

static void put_gear(hn_strbuf *o, const hn_im_joint *y, const hn_im_joint *x, const double a[5]) {
    hn_json_key(o, "gear");
    hn_json_object(o);
    hn_json_key(o, "coordinates");
    hn_json_strings(o, (const char *[]){y->coordinate[0], x->coordinate[0]}, 2);
    hn_json_put_number(o, "ratio", -a[1]);
    hn_json_put_number(o, "phase", y->zero + a[0] - a[1] * x->zero);
    hn_json_end_object(o);
}

static void put_motion(hn_strbuf *o, const hn_im_joint *y, double value) {
    hn_json_key(o, "motion");
    hn_json_object(o);
    hn_json_put_string(o, "coordinate", y->coordinate[0]);
    hn_json_put_number(o, "value", value);
    hn_json_end_object(o);
}

static void couple_joints(hn_mj *m, const hn_mj_element *e) {
    double a[5] = {0, 1, 0, 0, 0};

    // the joints it couples, and the coefficients of the polynomial
    int given = hn_mj_numbers(m, e, "polycoef", 1, 5, a);
    int first = given < 0 ? -1 : find_joint(m, e, "joint1");
    bool alone = !hn_im_attr(m->b, e->node, "joint2");
    int second = first < 0 || alone ? first : find_joint(m, e, "joint2");
    if (second < 0) {
        return;
    }

    // a fixed value, a gear or a formula, by the degree of the polynomial
    const hn_im_joint *y = &m->b->joints[first], *x = &m->b->joints[second];
    const char *name = hn_im_attr(m->b, e->node, "name");
    hn_strbuf o;
    hn_strbuf_init(&o);
    hn_json_object(&o);
    hn_json_put_string(&o, "name",
                       name ? hn_im_text(m->b, "%.50s", name)
                            : hn_im_text(m->b, "coupling %d", m->b->constraints.n + 1));
    if (alone) {
        put_motion(&o, y, y->zero + a[0]);
    } else if (a[1] != 0 && a[2] == 0 && a[3] == 0 && a[4] == 0) {
        put_gear(&o, y, x, a);
    } else {
        put_polynomial(m, &o, y, x, a);
    }
    hn_json_end_object(&o);
    m->b->n_closing += hn_im_add_text(m->b, &m->b->constraints, &o);
}

static void read_equality(hn_mj *m, const xmlNode *c) {
    static const char known[] = "connect weld joint";
    if (!hn_im_lists(known, (const char *)c->name)) {
        hn_im_skip(m->b, HN_IMPORT_REFUSED, c, "this equality is not in the scene");
        return;
    }
    hn_mj_element e = hn_mj_look(m, c, NULL);
    hn_mj_check(m, c);
    if (!e.node) {
        return;
    }
    // defaults have the name of the section
    int active = hn_im_flag(m->b, c, "active", 1);
    if (active <= 0 || m->no_equality) {
        hn_im_note(m->b, HN_IMPORT_IGNORED, c, NULL, "switched off in the model");
    } else if (hn_im_is(c, "joint")) {
        couple_joints(m, &e);
    } else {
        add_closing_joint(m, &e, hn_im_is(c, "weld"));
    }
}

void hn_mj_equality(hn_mj *m, const xmlNode *section) {
    hn_mj_check(m, section);
    for (const xmlNode *c = hn_im_first(section); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        read_equality(m, c);
    }
}
