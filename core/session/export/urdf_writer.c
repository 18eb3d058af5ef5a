// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/urdf_writer.h"

#include "session/export/xml_attribute.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GROUND_LINK "world"

/// A slide of URDF needs a range: one that no mechanism leaves [m].
static const double ENDLESS = 1e9;
/// Gravity that readers of URDF take [m/s^2].
static const double GRAVITY[3] = {0, 0, -9.81};

typedef struct urdf {
    const hn_model *model;
    const hn_scene *scene;
    hn_start_poses poses;
    hn_im_frame *link; ///< by body: the frame of its link in the axes of the body
    hn_strbuf *out, *loops, *left_out;
} urdf;

/// Angles about the fixed axes x, y and z, one after the other; where y is a right angle the others
/// are one turn, given to z.
static void find_angles(double R[3][3], double rpy[3]) {
    static const double UPRIGHT = 1e-9;
    const double level = hypot(R[0][0], R[1][0]);
    rpy[1] = atan2(-R[2][0], level);
    if (level > UPRIGHT) {
        rpy[0] = atan2(R[2][1], R[2][2]);
        rpy[2] = atan2(R[1][0], R[0][0]);
    } else {
        rpy[0] = 0;
        rpy[2] = atan2(-R[0][1], R[1][1]);
    }
}

static void put_origin(urdf *u, hn_im_frame *at) {
    double rpy[3];
    find_angles(at->R, rpy);
    hn_strbuf_add(u->out, "<origin");
    hn_xml_put_numbers(u->out, "xyz", at->p, 3);
    hn_xml_put_numbers(u->out, "rpy", rpy, 3);
    hn_strbuf_add(u->out, "/>");
}

// ---- links ----

static hn_im_frame link_of(const urdf *u, int body) {
    return body == HN_GROUND ? hn_im_frame_unit() : u->link[body];
}

static const char *name_of(const urdf *u, int body) {
    return body == HN_GROUND ? GROUND_LINK : u->scene->bodies[body].name;
}

/// Returns where a joint sits in a body, in the axes of the body's link.
static hn_im_frame side_in_link(const urdf *u, const hn_joint *j, int side) {
    const hn_im_frame link = link_of(u, side ? j->child : j->parent);
    const hn_im_frame back = hn_im_frame_inverse(&link), at = hn_joint_side(j, side);
    return hn_im_frame_mul(&back, &at);
}

static void put_link(urdf *u, int body) {
    static const char *const names[] = {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};
    const hn_body *b = &u->scene->bodies[body];
    hn_im_frame at = hn_im_frame_unit();
    for (int i = 0; i < 3; i++) {
        at.p[i] = b->com[i].value;
    }
    hn_strbuf_add(u->out, "  <link");
    hn_xml_put_text(u->out, "name", b->name, "");
    if (!(b->mass.value > 0)) {
        hn_strbuf_add(u->out, "/>\n");
        return;
    }

    // mass at its centre, with the axes of the body
    const hn_im_frame back = hn_im_frame_inverse(&u->link[body]);
    hn_im_frame inertial = hn_im_frame_mul(&back, &at);
    hn_strbuf_add(u->out, ">\n    <inertial>");
    put_origin(u, &inertial);
    hn_strbuf_add(u->out, "<mass");
    hn_xml_put_numbers(u->out, "value", &b->mass.value, 1);
    hn_strbuf_add(u->out, "/><inertia");
    for (int k = 0; k < 6; k++) {
        hn_xml_put_numbers(u->out, names[k], &b->inertia[k].value, 1);
    }
    hn_strbuf_add(u->out, "/></inertial>\n  </link>\n");
}

// ---- joints of the tree ----

/// One joint of URDF; `part` of `n` says which links it is between.
typedef struct piece {
    const char *type;
    int coordinate; ///< of the scene, -1: none
    int part, n;
    hn_im_frame origin;
    double axis[3];
} piece;

/// The damping of a coordinate: of all its dampers that are numbers.
static double damping_of(const urdf *u, int coordinate) {
    double sum = 0;
    for (int i = 0; i < u->scene->n_loads; i++) {
        const hn_load *l = &u->scene->loads[i];
        if (l->kind == HN_LOAD_JOINT_SPRING && l->coordinate == coordinate && !l->damping.varies &&
            l->damping.value > 0) {
            sum += l->damping.value;
        }
    }
    return sum;
}

/// A link between the joints of one body, or the ends of the chain.
static void put_side(urdf *u, const char *key, int body, int between) {
    char suffix[24] = "";
    if (between > 0) {
        snprintf(suffix, sizeof suffix, " carrier %d", between);
    }
    hn_strbuf_printf(u->out, "<%s", key);
    hn_xml_put_text(u->out, "link", name_of(u, body), suffix);
    hn_strbuf_add(u->out, "/>");
}

static void put_limit(urdf *u, const piece *p) {
    const hn_coordinate *c = &u->scene->coordinates[p->coordinate];
    const bool is_limited = isfinite(c->min) && isfinite(c->max);
    const double none = 0, low = is_limited ? c->min : -ENDLESS,
                 high = is_limited ? c->max : ENDLESS;
    if (strcmp(p->type, "continuous") == 0) {
        return;
    }
    hn_strbuf_add(u->out, "<limit");
    hn_xml_put_numbers(u->out, "lower", &low, 1);
    hn_xml_put_numbers(u->out, "upper", &high, 1);
    hn_xml_put_numbers(u->out, "effort", &none, 1);
    hn_xml_put_numbers(u->out, "velocity", &none, 1);
    hn_strbuf_add(u->out, "/>");
}

/// The gear whose first coordinate is this one: x = value - ratio y.
static const hn_constraint *find_gear(const urdf *u, int coordinate) {
    for (int i = 0; i < u->scene->n_constraints; i++) {
        const hn_constraint *c = &u->scene->constraints[i];
        if (c->kind == HN_CONSTRAINT_GEAR && c->coordinate[0] == coordinate) {
            return c;
        }
    }
    return NULL;
}

/// Returns whether a coordinate is a joint of its own in the tree.
static bool is_single(const urdf *u, int coordinate) {
    const int joint = u->scene->coordinates[coordinate].joint;
    return joint >= 0 && u->scene->joints[joint].type != HN_JOINT_FREE &&
           !hn_system_joint_is_cut(hn_model_system(u->model), joint);
}

static bool is_mimic(const urdf *u, const hn_constraint *c) {
    return c->kind == HN_CONSTRAINT_GEAR && is_single(u, c->coordinate[0]) &&
           is_single(u, c->coordinate[1]) && find_gear(u, c->coordinate[0]) == c &&
           c->ratio.value != 0;
}

static void put_piece(urdf *u, int body, const hn_joint *j, piece *p) {
    hn_strbuf_add(u->out, "  <joint");
    hn_xml_put_text(u->out, "name",
                    p->coordinate < 0 ? j->name : u->scene->coordinates[p->coordinate].name, "");
    hn_strbuf_printf(u->out, " type=\"%s\">", p->type);
    put_origin(u, &p->origin);
    put_side(u, "parent", p->part ? body : u->poses.body[body].parent, p->part);
    put_side(u, "child", body, p->part < p->n - 1 ? p->part + 1 : 0);
    if (p->coordinate >= 0) {
        hn_strbuf_add(u->out, "<axis");
        hn_xml_put_numbers(u->out, "xyz", p->axis, 3);
        hn_strbuf_add(u->out, "/>");
        put_limit(u, p);
        const double damping = damping_of(u, p->coordinate);
        const hn_constraint *gear = find_gear(u, p->coordinate);
        if (damping > 0) {
            hn_strbuf_add(u->out, "<dynamics");
            hn_xml_put_numbers(u->out, "damping", &damping, 1);
            hn_strbuf_add(u->out, "/>");
        }
        if (gear && is_mimic(u, gear)) {
            const double multiplier = -gear->ratio.value;
            hn_strbuf_add(u->out, "<mimic");
            hn_xml_put_text(u->out, "joint", u->scene->coordinates[gear->coordinate[1]].name, "");
            hn_xml_put_numbers(u->out, "multiplier", &multiplier, 1);
            hn_xml_put_numbers(u->out, "offset", &gear->value.value, 1);
            hn_strbuf_add(u->out, "/>");
        }
    }
    hn_strbuf_add(u->out, "</joint>\n");
}

static const char *type_of(const urdf *u, hn_pose_kind kind, int coordinate) {
    const hn_coordinate *c = &u->scene->coordinates[coordinate];
    return kind == HN_POSE_SLIDE                  ? "prismatic"
           : isfinite(c->min) && isfinite(c->max) ? "revolute"
                                                  : "continuous";
}

/// The joints of a body, from its parent outwards. All coordinates are 0, so that the frames of the
/// joint in both bodies are one; seen from the child its freedoms come in the other order and go
/// the other way.
static void put_joints(urdf *u, int body) {
    const hn_joint *j = &u->scene->joints[u->poses.body[body].joint];
    const bool reversed = j->child != body;
    const hn_im_frame inner = side_in_link(u, j, reversed);
    const hn_im_frame outer = side_in_link(u, j, !reversed), to_link = hn_im_frame_inverse(&outer);
    int n;
    const hn_joint_step *steps = hn_joint_steps(j->type, &n);
    const bool is_whole = j->type == HN_JOINT_FREE || n == 0;
    n = is_whole ? 1 : n;
    for (int k = 0; k < n; k++) {
        const hn_joint_step *s = &steps[reversed ? n - 1 - k : k];
        piece p = {.type = n == 1 && j->type == HN_JOINT_FREE ? "floating" : "fixed",
                   .coordinate = -1,
                   .part = k,
                   .n = n,
                   .origin = k ? hn_im_frame_unit() : inner};
        if (!is_whole) {
            p.coordinate = j->coordinate + (int)(s - steps);
            p.type = type_of(u, s->kind, p.coordinate);
            p.axis[s->axis] = reversed ? -1 : 1;
        }
        if (k == n - 1) {
            // the last one stands in the link of the body
            p.origin = hn_im_frame_mul(&p.origin, &to_link);
            hn_im_turn(&outer, p.axis, p.axis);
        } else {
            hn_strbuf_add(u->out, "  <link");
            char suffix[24];
            snprintf(suffix, sizeof suffix, " carrier %d", k + 1);
            hn_xml_put_text(u->out, "name", name_of(u, body), suffix);
            hn_strbuf_add(u->out, "/>\n");
        }
        put_piece(u, body, j, &p);
    }
}

// ---- the loop file ----

static void put_directions(urdf *u, const hn_joint *j, const hn_im_frame *at) {
    const char *second = j->type == HN_JOINT_UNIVERSAL ? "axis2" : "ref";
    hn_json_put_numbers(u->loops, "axis", (double[]){at->R[0][2], at->R[1][2], at->R[2][2]}, 3);
    hn_json_put_numbers(u->loops, second, (double[]){at->R[0][0], at->R[1][0], at->R[2][0]}, 3);
}

/// Names that the coordinates of a cut joint have in the scene.
static void put_coordinates(urdf *u, const hn_joint *j) {
    const char *names[6];
    for (int k = 0; k < j->n_coordinates; k++) {
        names[k] = u->scene->coordinates[j->coordinate + k].name;
    }
    if (j->n_coordinates == 1) {
        hn_json_put_string(u->loops, "coordinate", names[0]);
    } else if (j->n_coordinates > 1) {
        hn_json_key(u->loops, "coordinates");
        hn_json_strings(u->loops, names, (size_t)j->n_coordinates);
    }
}

/// A joint as a scene has it: directions in the parent are its own, those in the child its side's.
static void put_loop(urdf *u, const hn_joint *j) {
    hn_im_frame side[2];
    hn_json_object(u->loops);
    hn_json_put_string(u->loops, "name", j->name);
    hn_json_put_string(u->loops, "type", hn_joint_type_name(j->type));
    for (int k = 0; k < 2; k++) {
        const int body = k ? j->child : j->parent;
        side[k] = side_in_link(u, j, k);
        hn_json_key(u->loops, k ? "child" : "parent");
        hn_json_object(u->loops);
        hn_json_put_string(u->loops, "body",
                           body == HN_GROUND ? "ground" : u->scene->bodies[body].name);
        hn_json_put_numbers(u->loops, "at", side[k].p, 3);
        if (k) {
            put_directions(u, j, &side[k]);
        }
        hn_json_end_object(u->loops);
    }
    put_directions(u, j, &side[0]);
    put_coordinates(u, j);
    hn_json_end_object(u->loops);
}

/// Values of the start by joint of the URDF: a number, or a list for a floating joint.
static void put_values(urdf *u, const char *key, const double *x) {
    hn_json_key(u->loops, key);
    hn_json_object(u->loops);
    for (int i = 0; i < u->scene->n_joints; i++) {
        const hn_joint *j = &u->scene->joints[i];
        if (hn_system_joint_is_cut(hn_model_system(u->model), i) || j->n_coordinates == 0) {
            continue;
        }
        if (j->type == HN_JOINT_FREE) {
            hn_json_put_numbers(u->loops, j->name, x + j->coordinate, 6);
            continue;
        }
        for (int k = 0; k < j->n_coordinates; k++) {
            hn_json_put_number(u->loops, u->scene->coordinates[j->coordinate + k].name,
                               x[j->coordinate + k]);
        }
    }
    hn_json_end_object(u->loops);
}

static void put_loop_file(urdf *u) {
    double gravity[3];
    for (int i = 0; i < 3; i++) {
        gravity[i] = u->scene->gravity[i].value;
    }
    hn_json_object(u->loops);
    hn_json_put_int(u->loops, "holonom_loops", 1);
    hn_json_put_string(u->loops, "about",
                       "the parts of the mechanism that the URDF file cannot hold");
    hn_json_key(u->loops, "joints");
    hn_json_array(u->loops);
    for (int i = 0; i < u->scene->n_joints; i++) {
        if (hn_system_joint_is_cut(hn_model_system(u->model), i)) {
            put_loop(u, &u->scene->joints[i]);
        }
    }
    hn_json_end_array(u->loops);
    hn_json_put_numbers(u->loops, "gravity", gravity, 3);
    hn_json_key(u->loops, "start");
    hn_json_object(u->loops);
    put_values(u, "positions", u->poses.q);
    put_values(u, "rates", u->poses.v);
    hn_json_end_object(u->loops);
    hn_json_end_object(u->loops);
    hn_strbuf_add(u->loops, "\n");
}

// ---- what is left out ----

static void name_loads(urdf *u) {
    for (int i = 0; i < u->scene->n_loads; i++) {
        const hn_load *l = &u->scene->loads[i];
        const bool is_damper = l->kind == HN_LOAD_JOINT_SPRING && !l->damping.varies &&
                               !l->stiffness.varies && is_single(u, l->coordinate) &&
                               l->damping.value >= 0;
        if (!is_damper) {
            hn_xml_leave_out(u->left_out, "load", l->name, "URDF holds dampers of joints only");
        } else if (l->stiffness.value != 0) {
            hn_xml_leave_out(u->left_out, "stiffness of load", l->name,
                             "URDF holds dampers of joints only");
        }
    }
}

/// Names the content that only a loop file can hold, where none is written.
static void name_loops(urdf *u) {
    bool is_at_zero = true, has_gravity = true;
    for (int i = 0; i < u->scene->n_joints; i++) {
        if (hn_system_joint_is_cut(hn_model_system(u->model), i)) {
            hn_xml_leave_out(u->left_out, "joint", u->scene->joints[i].name,
                             "it closes a loop, and a URDF is a tree: the option loops of holonom "
                             "export writes it "
                             "to a second file");
        }
    }
    for (int i = 0; i < u->scene->n_coordinates; i++) {
        is_at_zero &= u->poses.q[i] == 0 && u->poses.v[i] == 0;
    }
    for (int i = 0; i < 3; i++) {
        has_gravity &= u->scene->gravity[i].value == GRAVITY[i];
    }
    if (!is_at_zero) {
        hn_xml_leave_out(
            u->left_out, "start", NULL,
            "a URDF starts at 0 and at rest: the option loops of holonom export writes the "
            "start to a second file");
    }
    if (!has_gravity) {
        hn_xml_leave_out(u->left_out, "gravity", NULL,
                         "programs that read URDF take 9.81 m/s^2 along -z: the option loops of "
                         "holonom export writes gravity to a second file");
    }
}

static void name_the_rest(urdf *u) {
    name_loads(u);
    for (int i = 0; i < u->scene->n_constraints; i++) {
        if (!is_mimic(u, &u->scene->constraints[i])) {
            hn_xml_leave_out(u->left_out, "constraint", u->scene->constraints[i].name,
                             "URDF holds gears between joints of one coordinate only");
        }
    }
    if (u->scene->has_formulas) {
        hn_xml_leave_out(u->left_out, "lagrangian", NULL, "energies written as formulas");
    }
    if (!u->loops) {
        name_loops(u);
    }
}

static hn_status prepare(urdf *u, hn_arena *arena, hn_diags *diags) {
    const hn_scene *scene = u->scene;
    const hn_status status = hn_start_poses_find(u->model, arena, &u->poses);
    if (status == HN_ERR_UNSUPPORTED) {
        return hn_diags_add(diags, status, "/joints", "let the free joint begin at the ground",
                            "this URDF has floating joints of the world only");
    }
    HN_TRY(status);
    u->link = hn_arena_get(arena, ((size_t)scene->n_bodies + 1) * sizeof *u->link);
    if (!u->link) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < scene->n_bodies; i++) {
        const hn_joint *j = &scene->joints[u->poses.body[i].joint];
        if (j->type == HN_JOINT_SPHERICAL) {
            return hn_diags_add(diags, HN_ERR_UNSUPPORTED, j->pointer, "--format mjcf",
                                "URDF has no ball joint, and '%.60s' carries the body '%.60s'",
                                j->name, scene->bodies[i].name);
        }

        // a floating joint has no axis: its link takes the axes of the joint
        const hn_im_frame side = hn_joint_side(j, j->child == i);
        u->link[i] = side;
        if (j->type != HN_JOINT_FREE) {
            u->link[i] = hn_im_frame_unit();
            memcpy(u->link[i].p, side.p, sizeof side.p);
        }
    }
    return HN_OK;
}

hn_status hn_urdf_write(hn_strbuf *out, hn_strbuf *loops, hn_strbuf *left_out,
                        const hn_model *model, hn_arena *arena, hn_diags *diags) {
    urdf u = {.model = model,
              .scene = hn_model_scene(model),
              .out = out,
              .loops = loops,
              .left_out = left_out};
    HN_TRY(prepare(&u, arena, diags));

    // the ground, then each body with what carries it
    hn_strbuf_add(out, "<?xml version=\"1.0\"?>\n<robot");
    hn_xml_put_text(u.out, "name", u.scene->name, "");
    hn_strbuf_add(out, ">\n  <link name=\"" GROUND_LINK "\"/>\n");
    for (int i = 0; i < u.scene->n_bodies; i++) {
        put_link(&u, i);
        put_joints(&u, i);
    }
    hn_strbuf_add(out, "</robot>\n");
    if (loops) {
        put_loop_file(&u);
        out->failed |= loops->failed;
    }
    name_the_rest(&u);
    return HN_OK;
}
