// SPDX-License-Identifier: GPL-3.0-or-later
// Joints of MJCF: they act one after the other, the first next to the parent, with a body without
// mass between two of them.
#include "import/mjcf.h"

#include "base/suggest.h"
#include "linalg/small3.h"

#include <math.h>
#include <string.h>

typedef struct chain {
    int parent, body;  ///< the body that hangs, and from what
    int at;            ///< body the next joint starts from
    int n, done;       ///< joints, and how many are made
    hn_im_frame local; ///< of what hangs in `at`
    const char *body_name;
} chain;

typedef struct joint_type {
    const char *name;
    hn_joint_type type;
} joint_type;

static const joint_type TYPES[] = {{"hinge", HN_JOINT_REVOLUTE},
                                   {"slide", HN_JOINT_PRISMATIC},
                                   {"ball", HN_JOINT_SPHERICAL},
                                   {"free", HN_JOINT_FREE}};
enum { N_TYPES = sizeof TYPES / sizeof *TYPES };

static bool read_type(hn_mj *m, const hn_mj_element *e, hn_joint_type *type) {
    const char *word = hn_im_is(e->node, "freejoint") ? "free" : hn_mj_attr(m, e, "type");
    const char *names[N_TYPES];
    *type = HN_JOINT_REVOLUTE;
    for (int k = 0; k < N_TYPES; k++) {
        names[k] = TYPES[k].name;
        if (!word || strcmp(word, TYPES[k].name) == 0) {
            *type = TYPES[k].type;
            return true;
        }
    }
    char hint[HN_DIAG_HINT];
    return hn_im_fault(m->b, e->node, "type",
                       hn_suggest(hint, word, names, N_TYPES, "hinge, slide, ball or free"),
                       "unknown joint type '%.40s'", word);
}

/// Anchor and axis of the joint in its body, at the zero configuration.
static bool read_place(hn_mj *m, const hn_mj_element *e, const hn_im_frame *at, int ball,
                       hn_im_frame *out) {
    double pos[3] = {0, 0, 0}, axis[3] = {0, 0, 1};
    if (hn_mj_numbers(m, e, "pos", 3, 3, pos) < 0 || hn_mj_numbers(m, e, "axis", 3, 3, axis) < 0) {
        return false;
    }
    if (!hn_im_normalise(axis)) {
        return hn_im_fault(m->b, e->node, "axis", NULL, "an axis of length 0");
    }
    hn_im_place(at, pos, pos);
    hn_im_turn(at, axis, axis);
    if (ball) {
        *out = hn_im_frame_unit();
        memcpy(out->p, pos, sizeof pos);
    } else {
        *out = hn_im_axis_frame(pos, axis);
    }
    return true;
}

static bool read_limits(hn_mj *m, const hn_mj_element *e, hn_im_joint *j, double unit) {
    double range[2] = {0, 0};
    if (m->no_limits || !hn_mj_is_limited(m, e, "limited", "range")) {
        return true;
    }

    // a ball joint's limit is a cone, which a scene has not
    if (hn_mj_numbers(m, e, "range", 2, 2, range) < 0) {
        return false;
    }
    if (j->type == HN_JOINT_SPHERICAL) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, e->node, "range",
                   "the angle of a ball joint has no limit in the scene");
        return true;
    }

    // in radians or metres
    if (!(range[0] < range[1])) {
        return hn_im_fault(m->b, e->node, "range", NULL, "the range from %g to %g is empty",
                           range[0], range[1]);
    }
    j->limited = 1;
    j->min = range[0] * unit;
    j->max = range[1] * unit;
    return true;
}

/// Coordinates mean what qpos means: `ref` in the pose in which the model is written.
static bool set_zero(hn_mj *m, const hn_mj_element *e, hn_im_joint *j, double unit,
                     hn_im_frame *in_parent, hn_im_frame *in_child) {
    double ref, turn[3][3];
    if (!hn_mj_number(m, e, "ref", 0, &ref)) {
        return false;
    }
    j->zero = j->q0[0] = ref * unit;
    if (j->type == HN_JOINT_REVOLUTE && ref != 0) {
        hn_im_rotation((double[]){0, 0, 1}, j->zero, turn);
        hn_num3_mul(in_child->R, turn, in_child->R);
        hn_im_snap(in_child->R);
    } else if (j->type == HN_JOINT_PRISMATIC) {
        for (int i = 0; i < 3; i++) {
            in_parent->p[i] -= j->zero * in_parent->R[i][2];
        }
    }
    return true;
}

static void add_spring(hn_mj *m, const char *coordinate, double stiffness, double rest,
                       double damping) {
    hn_strbuf o;
    hn_strbuf_init(&o);
    hn_json_object(&o);
    hn_json_key(&o, "joint_spring");
    hn_json_object(&o);
    hn_json_put_string(&o, "coordinate", coordinate);
    if (stiffness != 0) {
        hn_json_put_number(&o, "stiffness", stiffness);
        hn_json_put_number(&o, "rest", rest);
    }
    if (damping != 0) {
        hn_json_put_number(&o, "damping", damping);
    }
    hn_json_end_object(&o);
    hn_json_end_object(&o);
    (void)hn_im_add_text(m->b, &m->b->loads, &o);
}

/// Force -stiffness (q - springref) - damping v. A ball or free joint has only damping along
/// coordinates.
static void read_springs(hn_mj *m, const hn_mj_element *e, int joint, double unit) {
    double stiffness, damping, rest;
    const hn_im_joint *j = &m->b->joints[joint];
    if (hn_im_is(e->node, "freejoint") || !hn_mj_number(m, e, "stiffness", 0, &stiffness) ||
        !hn_mj_number(m, e, "damping", 0, &damping) || !hn_mj_number(m, e, "springref", 0, &rest)) {
        return;
    }

    // springs and dampers push back
    if (stiffness < 0 || damping < 0) {
        const char *which = stiffness < 0 ? "stiffness" : "damping";
        hn_im_fault(m->b, e->node, which, NULL, "a %s of %g is negative", which,
                    stiffness < 0 ? stiffness : damping);
        return;
    }

    // orientations have no spring in a scene
    if (stiffness != 0 && j->n > 1) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, e->node, "stiffness",
                   "a spring on the orientation of a %s joint is not in the scene",
                   hn_joint_type_name(j->type));
        stiffness = 0;
    }

    // one load for each coordinate
    stiffness = m->no_springs ? 0 : stiffness;
    damping = m->no_dampers ? 0 : damping;
    for (int k = 0; k < j->n && (stiffness != 0 || damping != 0); k++) {
        add_spring(m, j->coordinate[k], stiffness, rest * unit, damping);
        j = &m->b->joints[joint];
    }
}

/// The body the joint moves: the hanging one after the last joint, one without mass before.
static int next_body(hn_mj *m, chain *c, const xmlNode *node, const char *joint_name) {
    if (c->done == c->n - 1) {
        return c->body;
    }
    const hn_im_frame world = m->b->bodies[c->body].world;
    const char *name = hn_im_text(m->b, "%.40s.%d", c->body_name, c->done + 1);
    int body = hn_im_add_body(m->b, node, NULL, &world);
    if (body >= 0 && name) {
        m->b->bodies[body].name = name;
        m->b->bodies[body].is_carrier = 1;
        m->b->bodies[body].about = hn_im_text(
            m->b, "without mass: what the joint %.40s of %.40s moves", joint_name, c->body_name);
    }
    return body;
}

static void remember_moving(hn_mj *m, int joint) {
    int *moving = hn_im_grow(m->b, m->moving, m->n_moving, &m->cap_moving, sizeof *moving);
    if (moving) {
        m->moving = moving;
        moving[m->n_moving++] = joint;
    }
}

static bool start_free(hn_mj *m, const hn_mj_element *e, const chain *c, hn_im_joint *j) {
    if (c->parent != HN_GROUND || c->n > 1) {
        return hn_im_fault(m->b, e->node, NULL, NULL,
                           c->n > 1 ? "a free joint is the only joint of its body"
                                    : "a free joint is allowed only on children of worldbody");
    }
    double R[3][3];
    memcpy(R, c->local.R, sizeof R);
    memcpy(j->q0, c->local.p, sizeof c->local.p);
    hn_im_rotation_vector(R, j->q0 + 3);
    return true;
}

static void add_joint(hn_mj *m, const xmlNode *node, const xmlNode *childclass,
                      const hn_im_frame *at, chain *c) {
    hn_mj_element e = hn_mj_look(m, node, childclass);
    hn_im_joint j = {.source = hn_im_attr(m->b, node, "name")};
    hn_im_frame in_child;
    hn_mj_check(m, node);
    if (!e.node || !read_type(m, &e, &j.type)) {
        return;
    }

    // a name of its own
    double unit = j.type == HN_JOINT_PRISMATIC ? 1 : m->per_angle;
    if (j.source && hn_im_find_joint(m->b, j.source) >= 0) {
        hn_im_fault(m->b, node, "name", NULL, "two joints have the name '%.60s'", j.source);
        return;
    }

    // where it sits in child and parent
    bool whole = j.type == HN_JOINT_SPHERICAL || j.type == HN_JOINT_FREE;
    if (!read_place(m, &e, at, whole, &in_child) || !read_limits(m, &e, &j, unit)) {
        return;
    }
    hn_im_frame in_parent = hn_im_frame_mul(&c->local, &in_child);
    if (j.type == HN_JOINT_FREE) {
        in_parent = in_child = hn_im_frame_unit();
        if (!start_free(m, &e, c, &j)) {
            return;
        }
    } else if (!whole && !set_zero(m, &e, &j, unit, &in_parent, &in_child)) {
        return;
    }

    // the body it carries: the next without mass, or the body itself
    const char *wanted = j.source    ? j.source
                         : c->n == 1 ? c->body_name
                                     : hn_im_text(m->b, "%.40s_%d", c->body_name, c->done + 1);
    j.parent = c->at;
    j.child = next_body(m, c, node, wanted ? wanted : "");
    if (j.child < 0) {
        return;
    }

    // the joint, and what acts along it
    hn_im_set_sides(&j, &in_parent, &in_child);
    int joint = hn_im_add_joint(m->b, node, &j, wanted);
    if (joint >= 0) {
        remember_moving(m, joint);
        read_springs(m, &e, joint, unit);
        c->at = j.child;
        c->local = hn_im_frame_unit();
        c->done++;
    }
}

static bool is_joint(const xmlNode *node) {
    return hn_im_is(node, "joint") || hn_im_is(node, "freejoint");
}

static int count_joints(const xmlNode *node) {
    int n = 0;
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        n += is_joint(c) ? 1 : hn_im_is(c, "frame") ? count_joints(c) : 0;
    }
    return n;
}

/// Joints may be inside <frame> elements, whose faults were reported when they were read.
static void walk_joints(hn_mj *m, const xmlNode *node, const xmlNode *childclass,
                        const hn_im_frame *at, chain *links) {
    for (const xmlNode *c = hn_im_first(node); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        if (is_joint(c)) {
            add_joint(m, c, childclass, at, links);
        } else if (hn_im_is(c, "frame")) {
            bool ok = 1;
            hn_mj_element e = {.node = c};
            const xmlNode *inner = hn_mj_class(m, c, "childclass", childclass, &ok);
            hn_im_frame own;
            if (ok && hn_mj_frame(m, &e, &own)) {
                own = hn_im_frame_mul(at, &own);
                walk_joints(m, c, inner, &own, links);
            }
        }
    }
}

void hn_mj_join(hn_mj *m, const xmlNode *body_node, const xmlNode *childclass, int parent, int body,
                const hn_im_frame *local) {
    hn_im_frame unit = hn_im_frame_unit();
    chain c = {.parent = parent,
               .body = body,
               .at = parent,
               .n = count_joints(body_node),
               .local = *local,
               .body_name = m->b->bodies[body].name};
    if (c.n > 0) {
        walk_joints(m, body_node, childclass, &unit, &c);
        return;
    }
    hn_im_joint j = {.type = HN_JOINT_FIXED, .parent = parent, .child = body};
    hn_im_set_sides(&j, local, &unit);
    (void)hn_im_add_joint(m->b, body_node, &j, hn_im_text(m->b, "%.40s_mount", c.body_name));
}
