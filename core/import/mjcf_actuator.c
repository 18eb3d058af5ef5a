// SPDX-License-Identifier: GPL-3.0-or-later
// Drives of joints: force = gear (gain u + b0 + b1 gear q + b2 gear v), u the control, which
// becomes a parameter.
#include "import/mjcf.h"

#include <math.h>
#include <string.h>

typedef struct drive {
    double gear, gain, bias[3]; ///< bias: constant, by length, by velocity
    int clamped;
    double least, most; ///< force before the gear
    const hn_im_joint *joint;
    const char *control;
} drive;

static bool is_word(const char *text, const char *word) {
    return !text || strcmp(text, word) == 0;
}

/// `general`: only gains and biases that are fixed or affine, without dynamics of their own. 1, or
/// 0 after a note or fault.
static bool read_general(hn_mj *m, const hn_mj_element *e, drive *d) {
    double gain[10] = {1}, bias[10] = {0};
    const char *type = hn_mj_attr(m, e, "biastype");
    if (!is_word(hn_mj_attr(m, e, "gaintype"), "fixed") ||
        !is_word(hn_mj_attr(m, e, "dyntype"), "none") ||
        (type && strcmp(type, "none") != 0 && strcmp(type, "affine") != 0)) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, e->node, NULL,
                   "a drive with a gain, bias or dynamics of its own kind is not in the scene");
        return false;
    }
    if (hn_mj_numbers(m, e, "gainprm", 1, 10, gain) < 0 ||
        hn_mj_numbers(m, e, "biasprm", 1, 10, bias) < 0) {
        return false;
    }
    d->gain = gain[0];
    for (int k = 0; k < 3 && type && strcmp(type, "affine") == 0; k++) {
        d->bias[k] = bias[k];
    }
    return true;
}

static bool read_law(hn_mj *m, const hn_mj_element *e, drive *d) {
    double kp, kv;
    bool velocity = hn_im_is(e->node, "velocity");
    if (hn_im_is(e->node, "general")) {
        return read_general(m, e, d);
    }

    // gains of their own names
    if (!hn_mj_number(m, e, "kp", 1, &kp) || !hn_mj_number(m, e, "kv", velocity, &kv)) {
        return false;
    }
    if (kp < 0 || kv < 0) {
        return hn_im_fault(m->b, e->node, kp < 0 ? "kp" : "kv", NULL, "a gain of %g is negative",
                           kp < 0 ? kp : kv);
    }

    // force = gain u + bias, in the terms of MuJoCo
    d->gain = 1;
    if (hn_im_is(e->node, "position")) {
        d->gain = kp;
        d->bias[1] = -kp;
        d->bias[2] = -kv;
    } else if (velocity) {
        d->gain = kv;
        d->bias[2] = -kv;
    }
    return true;
}

static bool read_drive(hn_mj *m, const hn_mj_element *e, drive *d) {
    double gear[6] = {1, 0, 0, 0, 0, 0}, force[2] = {0, 0};
    if (hn_mj_numbers(m, e, "gear", 1, 6, gear) < 0 || !read_law(m, e, d)) {
        return false;
    }
    d->gear = gear[0];
    d->clamped = hn_mj_is_limited(m, e, "forcelimited", "forcerange");
    if (d->clamped && hn_mj_numbers(m, e, "forcerange", 2, 2, force) < 0) {
        return false;
    }
    d->least = force[0];
    d->most = force[1];
    return !d->clamped || d->least < d->most ||
           hn_im_fault(m->b, e->node, "forcerange", NULL, "the range from %g to %g is empty",
                       d->least, d->most);
}

static int add_control(hn_mj *m, const hn_mj_element *e, const char *name) {
    double range[2] = {-HUGE_VAL, HUGE_VAL};
    if (hn_mj_is_limited(m, e, "ctrllimited", "ctrlrange") &&
        hn_mj_numbers(m, e, "ctrlrange", 2, 2, range) < 0) {
        return -1;
    }
    if (!(range[0] < range[1])) {
        hn_im_fault(m->b, e->node, "ctrlrange", NULL, "the range from %g to %g is empty", range[0],
                    range[1]);
        return -1;
    }
    hn_im_param p = {
        .about = hn_im_text(m->b, "control of the %s '%.40s'", (const char *)e->node->name, name),
        .min = range[0],
        .max = range[1],
        .value = fmin(fmax(0, range[0]), range[1])};
    return hn_im_add_param(m->b, e->node, &p, hn_im_text(m->b, "u_%.40s", name));
}

/// A follower says the same as a position drive, and its limit is the same both ways.
static bool is_follower(const hn_mj_element *e, const drive *d) {
    return hn_im_is(e->node, "position") && d->gain > 0 && d->gear != 0 &&
           (!d->clamped || (d->most > 0 && d->least == -d->most));
}

static void put_follower(hn_mj *m, hn_strbuf *o, const drive *d) {
    hn_json_key(o, "follow");
    hn_json_object(o);
    hn_json_put_string(o, "coordinate", d->joint->coordinate[0]);
    hn_json_put_number(o, "stiffness", d->gain * d->gear * d->gear);
    if (d->bias[2] != 0) {
        hn_json_put_number(o, "damping", -d->bias[2] * d->gear * d->gear);
    }
    hn_json_put_string(o, "target",
                       d->gear == 1
                           ? d->control
                           : hn_im_text(m->b, "%s/%s", d->control, hn_im_number(m->b, d->gear)));
    if (d->clamped) {
        hn_json_put_number(o, "limit", d->most * fabs(d->gear));
    }
    hn_json_end_object(o);
}

static void put_force(hn_mj *m, hn_strbuf *o, const drive *d) {
    hn_strbuf f;
    hn_strbuf_init(&f);
    hn_strbuf_printf(&f, "%s*%s", hn_im_number(m->b, d->gain), d->control);

    // the law of the drive, with its coordinate and rate by name
    const char *of[3] = {NULL, d->joint->coordinate[0], d->joint->rate[0]};
    for (int k = 0; k < 3; k++) {
        if (d->bias[k] != 0 && !of[k]) {
            hn_strbuf_printf(&f, " + %s", hn_im_number(m->b, d->bias[k]));
        } else if (d->bias[k] != 0) {
            hn_strbuf_printf(&f, " + %s*%s", hn_im_number(m->b, d->bias[k] * d->gear), of[k]);
        }
    }

    // as a load on the coordinate, bounded where the drive is
    hn_json_key(o, d->joint->type == HN_JOINT_PRISMATIC ? "force" : "torque");
    hn_json_object(o);
    hn_json_put_string(o, "coordinate", d->joint->coordinate[0]);
    hn_strbuf whole;
    hn_strbuf_init(&whole);
    if (d->clamped) {
        hn_strbuf_printf(&whole, "%s*min(max(%s, %s), %s)", hn_im_number(m->b, d->gear),
                         hn_strbuf_text(&f), hn_im_number(m->b, d->least),
                         hn_im_number(m->b, d->most));
    } else {
        hn_strbuf_printf(&whole, "%s*(%s)", hn_im_number(m->b, d->gear), hn_strbuf_text(&f));
    }
    hn_json_put_string(o, "value", hn_strbuf_text(&whole));
    o->failed |= f.failed | whole.failed;
    hn_strbuf_reset(&f);
    hn_strbuf_reset(&whole);
    hn_json_end_object(o);
}

static void add_load(hn_mj *m, const hn_mj_element *e, const drive *d, const char *name) {
    hn_strbuf o;
    hn_strbuf_init(&o);
    hn_json_object(&o);
    hn_json_put_string(&o, "name", hn_im_text(m->b, "%.50s", name));
    if (is_follower(e, d)) {
        put_follower(m, &o, d);
    } else {
        put_force(m, &o, d);
    }
    hn_json_end_object(&o);
    (void)hn_im_add_text(m->b, &m->b->loads, &o);
}

static void remember_control(hn_mj *m, int param) {
    int *controls =
        hn_im_grow(m->b, m->controls, m->n_controls, &m->cap_controls, sizeof *controls);
    if (controls) {
        m->controls = controls;
        controls[m->n_controls++] = param;
    }
}

/// The joint a drive acts on; -1 after a note or fault.
static int find_target(hn_mj *m, const hn_mj_element *e) {
    const char *name = hn_im_attr(m->b, e->node, "joint");
    int joint = name ? hn_im_find_joint(m->b, name) : -1;
    if (!name) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, e->node, NULL,
                   "only drives of joints are in the scene");
    } else if (joint < 0) {
        hn_im_fault(m->b, e->node, "joint", NULL, "there is no joint named '%.60s'", name);
    } else if (m->b->joints[joint].n != 1) {
        hn_im_note(m->b, HN_IMPORT_REFUSED, e->node, "joint",
                   "only drives of hinge and slide joints are in the scene");
        joint = -1;
    }
    return joint;
}

static void read_actuator(hn_mj *m, const xmlNode *c) {
    static const char known[] = "motor position velocity general";
    drive d = {.gear = 1};
    int control = -1;

    // kinds that are not in a scene leave a hole in the order of the controls
    if (!hn_im_lists(known, (const char *)c->name)) {
        hn_im_skip(m->b, HN_IMPORT_REFUSED, c, "this kind of drive is not in the scene");
        remember_control(m, -1);
        return;
    }

    // the joint it drives
    hn_mj_element e = hn_mj_look(m, c, NULL);
    hn_mj_check(m, c);
    const char *name = hn_im_attr(m->b, c, "name");
    int joint = e.node ? find_target(m, &e) : -1;
    if (joint >= 0 && m->no_actuation) {
        hn_im_note(m->b, HN_IMPORT_IGNORED, c, NULL, "switched off in the model");
    } else if (joint >= 0 && read_drive(m, &e, &d)) {
        name = name ? name : m->b->joints[joint].name;
        control = add_control(m, &e, name);
    }
    remember_control(m, control);

    // the control is a parameter
    if (control >= 0) {
        m->b->joints[joint].actuated = 1;
        d.joint = &m->b->joints[joint];
        d.control = m->b->params[control].name;
        add_load(m, &e, &d, name);
    }
}

void hn_mj_actuators(hn_mj *m, const xmlNode *section) {
    hn_mj_check(m, section);
    for (const xmlNode *c = hn_im_first(section); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        read_actuator(m, c);
    }
}
