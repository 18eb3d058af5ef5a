// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/mjcf_writer.h"

#include "base/shortest.h"
#include "linalg/small3.h"
#include "session/export/xml_attribute.h"

#include <math.h>
#include <string.h>

/// MuJoCo takes no moment of inertia below 1e-15 kg m^2. A moment of 0 becomes this share of the
/// largest one, or this many kg m^2: too little for a motion to show it.
static const double LEAST_SHARE = 1e-10, LEAST_MOMENT = 1e-14;
/// Second ball on the axis of a hinge, as a share of the characteristic length: not farther than
/// the joints are, so that rows which depend on each other do so to the rounding of the first.
static const double ALONG = 0.5;

// ---- attributes ----

static void put_values(hn_strbuf *b, const double *x, int n) {
    for (int i = 0; i < n; i++) {
        char text[HN_SHORTEST_TEXT];
        hn_shortest_write(x[i] + 0.0, text);
        hn_strbuf_printf(b, "%s%s", i || b->n ? " " : "", text);
    }
}

static void put_number(hn_mjcf *m, const char *key, double x) {
    hn_xml_put_numbers(m->out, key, &x, 1);
}

static void begin_line(hn_mjcf *m, int depth, const char *element) {
    hn_strbuf_printf(m->out, "%*s<%s", 2 * depth, "", element);
}

// ---- frames ----

/// The unit quaternion w x y z of a rotation: by the largest of its four entries.
static void find_quaternion(double R[3][3], double q[4]) {
    const double trace = R[0][0] + R[1][1] + R[2][2];
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = R[i][i] > R[k][k] ? i : k;
    }
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    if (trace > R[k][k]) {
        q[0] = 1 + trace;
        q[1] = R[2][1] - R[1][2];
        q[2] = R[0][2] - R[2][0];
        q[3] = R[1][0] - R[0][1];
    } else {
        q[0] = R[b][a] - R[a][b];
        q[1 + k] = 1 + R[k][k] - R[a][a] - R[b][b];
        q[1 + a] = R[a][k] + R[k][a];
        q[1 + b] = R[b][k] + R[k][b];
    }

    // to length 1
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        q[i] /= length;
    }
}

/// A world direction in the axes of a frame.
static void turn_back(const hn_im_frame *frame, const double x[3], double out[3]) {
    const hn_im_frame back = hn_im_frame_inverse(frame);
    hn_im_turn(&back, x, out);
}

/// A world point in the frame of a body.
static void place_back(const hn_im_frame *frame, const double x[3], double out[3]) {
    const hn_im_frame back = hn_im_frame_inverse(frame);
    hn_im_place(&back, x, out);
}

// ---- bodies ----

static void put_inertial(hn_mjcf *m, const hn_body *body, int depth) {
    double c[3], I[6], largest = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = body->com[i].value;
    }
    for (int i = 0; i < 6; i++) {
        I[i] = body->inertia[i].value;
        largest = fmax(largest, I[i]);
    }
    for (int i = 0; i < 3; i++) {
        I[i] = I[i] == 0 ? fmax(LEAST_SHARE * largest, LEAST_MOMENT) : I[i];
    }

    // products only where there are some: the eigenvalues of a diagonal are what is written
    begin_line(m, depth, "inertial");
    hn_xml_put_numbers(m->out, "pos", c, 3);
    put_number(m, "mass", body->mass.value);
    const bool has_products = I[3] != 0 || I[4] != 0 || I[5] != 0;
    hn_xml_put_numbers(m->out, has_products ? "fullinertia" : "diaginertia", I,
                       has_products ? 6 : 3);
    hn_strbuf_add(m->out, "/>\n");
}

/// Stiffness and damping, and the range. A limit of the scene is reported and pushes nothing, so
/// the range is not enforced.
static void put_actions(hn_mjcf *m, int coordinate) {
    const hn_coordinate *c = &m->scene->coordinates[coordinate];
    const hn_mjcf_spring *s = &m->springs[coordinate];
    if (s->stiffness > 0) {
        put_number(m, "stiffness", s->stiffness);
        put_number(m, "springref", s->pull / s->stiffness);
    }
    if (s->damping > 0) {
        put_number(m, "damping", s->damping);
    }
    if (isfinite(c->min) && isfinite(c->max)) {
        hn_xml_put_numbers(m->out, "range", (double[]){c->min, c->max}, 2);
        hn_xml_put_text(m->out, "limited", "false", "");
    }
}

static void put_single(hn_mjcf *m, const hn_pose *pose, const hn_pose_part *p) {
    double at[3], axis[3];
    const double q = m->poses.q[p->coordinate], v = m->poses.v[p->coordinate];
    place_back(&pose->world, p->at, at);
    turn_back(&pose->world, p->axis, axis);
    hn_xml_put_text(m->out, "name", m->scene->coordinates[p->coordinate].name, "");
    hn_xml_put_text(m->out, "type", p->kind == HN_POSE_HINGE ? "hinge" : "slide", "");
    hn_xml_put_numbers(m->out, "pos", at, 3);
    hn_xml_put_numbers(m->out, "axis", axis, 3);
    put_number(m, "ref", q);
    put_actions(m, p->coordinate);
    put_values(&m->qpos, &q, 1);
    put_values(&m->qvel, &v, 1);
}

/// A ball stands at rotation 0 where the model is drawn; a free body at its place in the world.
static void put_whole(hn_mjcf *m, hn_pose *pose, const hn_pose_part *p) {
    static const double unturned[4] = {1, 0, 0, 0};
    double at[3], spin[3], turn[4];
    hn_xml_put_text(m->out, "name", m->scene->joints[pose->joint].name, "");
    turn_back(&pose->world, p->spin, spin);
    if (p->kind == HN_POSE_BALL) {
        place_back(&pose->world, p->at, at);
        hn_xml_put_text(m->out, "type", "ball", "");
        hn_xml_put_numbers(m->out, "pos", at, 3);
        put_values(&m->qpos, unturned, 4);
    } else {
        find_quaternion(pose->world.R, turn);
        put_values(&m->qpos, pose->world.p, 3);
        put_values(&m->qpos, turn, 4);
        put_values(&m->qvel, p->velocity, 3);
    }
    put_values(&m->qvel, spin, 3);
}

static void put_joints(hn_mjcf *m, hn_pose *pose, int depth) {
    for (int k = 0; k < pose->n; k++) {
        const hn_pose_part *p = &pose->part[k];
        begin_line(m, depth, p->kind == HN_POSE_FREE ? "freejoint" : "joint");
        if (p->kind == HN_POSE_HINGE || p->kind == HN_POSE_SLIDE) {
            put_single(m, pose, p);
        } else {
            put_whole(m, pose, p);
        }
        hn_strbuf_add(m->out, "/>\n");
    }
}

/// The bodies that hang on `parent`, each with those that hang on it.
static void put_bodies(hn_mjcf *m, int parent, int depth) {
    const hn_im_frame around = hn_start_poses_world(&m->poses, parent);
    const hn_im_frame back = hn_im_frame_inverse(&around);
    for (int i = 0; i < m->scene->n_bodies; i++) {
        hn_pose *pose = &m->poses.body[i];
        if (pose->parent != parent) {
            continue;
        }

        // its place, its joints, its mass
        double turn[4];
        hn_im_frame local = hn_im_frame_mul(&back, &pose->world);
        find_quaternion(local.R, turn);
        begin_line(m, depth, "body");
        hn_xml_put_text(m->out, "name", m->scene->bodies[i].name, "");
        hn_xml_put_numbers(m->out, "pos", local.p, 3);
        hn_xml_put_numbers(m->out, "quat", turn, 4);
        hn_strbuf_add(m->out, ">\n");
        put_joints(m, pose, depth + 1);
        if (m->scene->bodies[i].mass.value > 0) {
            put_inertial(m, &m->scene->bodies[i], depth + 1);
        }
        put_bodies(m, i, depth + 1);
        hn_strbuf_printf(m->out, "%*s</body>\n", 2 * depth, "");
    }
}

// ---- loops ----

/// A ball between the two bodies of a cut joint, `along` its axis from where it sits.
static void put_connect(hn_mjcf *m, const hn_joint *j, double along, const char *suffix) {
    const bool on_ground = j->parent == HN_GROUND;
    const int first = on_ground ? j->child : j->parent, second = on_ground ? j->parent : j->child;
    const hn_im_frame side = hn_joint_side(j, on_ground);
    double anchor[3];
    for (int i = 0; i < 3; i++) {
        anchor[i] = side.p[i] + along * side.R[i][2];
    }
    hn_strbuf_add(m->out, "    <connect");
    hn_strbuf name;
    hn_strbuf_init(&name);
    hn_strbuf_printf(&name, "%s%s", j->name, suffix);
    hn_xml_put_text(m->out, "name", hn_strbuf_text(&name), "");
    m->out->failed |= name.failed;
    hn_strbuf_reset(&name);
    hn_xml_put_text(m->out, "body1", m->scene->bodies[first].name, "");
    if (second != HN_GROUND) {
        hn_xml_put_text(m->out, "body2", m->scene->bodies[second].name, "");
    }
    hn_xml_put_numbers(m->out, "anchor", anchor, 3);
    hn_strbuf_add(m->out, "/>\n");
}

static void put_weld(hn_mjcf *m, const hn_joint *j) {
    const bool on_ground = j->parent == HN_GROUND;
    hn_strbuf_add(m->out, "    <weld");
    hn_xml_put_text(m->out, "name", j->name, "");
    hn_xml_put_text(m->out, "body1", m->scene->bodies[on_ground ? j->child : j->parent].name, "");
    if (!on_ground) {
        hn_xml_put_text(m->out, "body2", m->scene->bodies[j->child].name, "");
    }
    hn_strbuf_add(m->out, "/>\n");
}

static void put_loop(hn_mjcf *m, const hn_joint *j) {
    if (j->type == HN_JOINT_FIXED) {
        put_weld(m, j);
    } else if (j->type == HN_JOINT_SPHERICAL || j->type == HN_JOINT_REVOLUTE) {
        put_connect(m, j, 0, "");
        if (j->type == HN_JOINT_REVOLUTE && !m->is_planar) {
            put_connect(m, j, ALONG * hn_system_length(hn_model_system(m->model)),
                        " along its axis");
        }
    }
}

/// x + ratio y = value, by differences from where the model is drawn.
static void put_gear(hn_mjcf *m, const hn_constraint *c) {
    const int x = c->coordinate[0], y = c->coordinate[1];
    const double slope = -c->ratio.value;
    const double offset = c->value.value + slope * m->poses.q[y] - m->poses.q[x];
    hn_strbuf_add(m->out, "    <joint");
    hn_xml_put_text(m->out, "name", c->name, "");
    hn_xml_put_text(m->out, "joint1", m->scene->coordinates[x].name, "");
    hn_xml_put_text(m->out, "joint2", m->scene->coordinates[y].name, "");
    hn_xml_put_numbers(m->out, "polycoef", (double[]){offset, slope, 0, 0, 0}, 5);
    hn_strbuf_add(m->out, "/>\n");
}

static void put_equalities(hn_mjcf *m) {
    hn_strbuf_add(m->out, "  <equality>\n");
    for (int i = 0; i < m->scene->n_joints; i++) {
        if (hn_system_joint_is_cut(hn_model_system(m->model), i)) {
            put_loop(m, &m->scene->joints[i]);
        }
    }
    for (int i = 0; i < m->scene->n_constraints; i++) {
        if (m->is_gear[i]) {
            put_gear(m, &m->scene->constraints[i]);
        }
    }
    hn_strbuf_add(m->out, "  </equality>\n");
}

// ---- drives and the start ----

static void put_drive(hn_mjcf *m, const hn_load *l) {
    const bool follows = l->kind == HN_LOAD_FOLLOW;
    hn_strbuf_printf(m->out, "    <%s", follows ? "position" : "motor");
    hn_xml_put_text(m->out, "name", l->name, "");
    hn_xml_put_text(m->out, "joint", m->scene->coordinates[l->coordinate].name, "");
    if (follows) {
        put_number(m, "kp", l->stiffness.value);
        put_number(m, "kv", l->damping.value);
    }
    if (follows && l->value[1].value > 0) {
        hn_xml_put_numbers(m->out, "forcerange", (double[]){-l->value[1].value, l->value[1].value},
                           2);
    }
    hn_strbuf_add(m->out, "/>\n");
}

static void put_start(hn_mjcf *m) {
    hn_strbuf control;
    hn_strbuf_init(&control);
    hn_strbuf_add(m->out, "  <actuator>\n");
    for (int i = 0; i < m->scene->n_loads; i++) {
        if (m->is_drive[i]) {
            put_drive(m, &m->scene->loads[i]);
            put_values(&control, &m->scene->loads[i].value[0].value, 1);
        }
    }

    // controls stand in the keyframe, in the order of the drives
    hn_strbuf_printf(m->out,
                     "  </actuator>\n  <keyframe>\n    <key name=\"start\" qpos=\"%s\" "
                     "qvel=\"%s\"",
                     hn_strbuf_text(&m->qpos), hn_strbuf_text(&m->qvel));
    if (control.n > 0) {
        hn_xml_put_text(m->out, "ctrl", hn_strbuf_text(&control), "");
    }
    hn_strbuf_add(m->out, "/>\n  </keyframe>\n");
    m->out->failed |= control.failed;
    hn_strbuf_reset(&control);
}

void hn_mjcf_write(hn_mjcf *m) {
    const hn_scene *scene = m->scene;
    double gravity[3];
    for (int i = 0; i < 3; i++) {
        gravity[i] = scene->gravity[i].value;
    }
    hn_strbuf_init(&m->qpos);
    hn_strbuf_init(&m->qvel);

    // units are the scene's
    begin_line(m, 0, "mujoco");
    hn_xml_put_text(m->out, "model", scene->name, "");
    hn_strbuf_add(m->out, ">\n  <compiler angle=\"radian\"/>\n  <option");
    hn_xml_put_numbers(m->out, "gravity", gravity, 3);
    if (scene->step > 0) {
        put_number(m, "timestep", scene->step);
    }
    hn_strbuf_add(m->out, " integrator=\"RK4\"/>\n  <worldbody>\n");

    // the tree, what closes its loops, what drives it
    put_bodies(m, HN_GROUND, 2);
    hn_strbuf_add(m->out, "  </worldbody>\n");
    put_equalities(m);
    put_start(m);
    hn_strbuf_add(m->out, "</mujoco>\n");
    m->out->failed |= m->qpos.failed | m->qvel.failed;
    hn_strbuf_reset(&m->qpos);
    hn_strbuf_reset(&m->qvel);
}
