// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/balance.h"

#include "dynamics/compile/coordinates.h"
#include "expr/construct.h"
#include "expr/parse.h"
#include "support/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TIMES = 5 };

typedef struct pose {
    double R[3][3], x[3]; ///< body axes to world; origin
} pose;

static void cross(const double a[3], const double b[3], double out[3]) {
    const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    memcpy(out, c, sizeof c);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void multiply(double a[3][3], double b[3][3], double out[3][3]) {
    double c[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    memcpy(out, c, sizeof c);
}

/// Rotation by a rotation vector, Rodrigues.
static void rotation(const double r[3], double out[3][3]) {
    const double angle = sqrt(dot(r, r));
    const double s = angle > 1e-6 ? sin(angle) / angle : 1 - angle * angle / 6;
    const double c = angle > 1e-6 ? (1 - cos(angle)) / (angle * angle) : 0.5;
    const double K[3][3] = {{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[i][j] = (i == j) + s * K[i][j];
            for (int k = 0; k < 3; k++) {
                out[i][j] += c * K[i][k] * K[k][j];
            }
        }
    }
}

static void compose(const pose *a, const pose *b, pose *out) {
    pose c;
    memcpy(c.x, a->x, sizeof c.x);
    for (int i = 0; i < 3; i++) {
        c.x[i] += dot(a->R[i], b->x);
    }
    multiply((double(*)[3])a->R, (double(*)[3])b->R, c.R);
    *out = c;
}

static void invert(const pose *a, pose *out) {
    pose c;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            c.R[i][j] = a->R[j][i];
        }
    }
    for (int i = 0; i < 3; i++) {
        c.x[i] = -dot(c.R[i], a->x);
    }
    *out = c;
}

/// The joint's own axes at its place on one of its bodies.
static void joint_frame(const double ref[3], const double axis[3], const hn_quantity *at,
                        pose *out) {
    double y[3];
    cross(axis, ref, y);
    for (int i = 0; i < 3; i++) {
        out->R[i][0] = ref[i];
        out->R[i][1] = y[i];
        out->R[i][2] = axis[i];
        out->x[i] = at[i].value;
    }
}

static void turn(pose *out, int axis, double angle) {
    double r[3] = {0, 0, 0};
    *out = (pose){.x = {0, 0, 0}};
    r[axis] = angle;
    rotation(r, out->R);
}

/// Child against parent in the joint's axes for the values of its coordinates: see hn_joint_type.
static void joint_motion(hn_joint_type type, const double *x, pose *out) {
    pose more;
    turn(out, 2, 0);
    switch (type) {
    case HN_JOINT_REVOLUTE:
        turn(out, 2, x[0]);
        break;
    case HN_JOINT_PRISMATIC:
        out->x[2] = x[0];
        break;
    case HN_JOINT_CYLINDRICAL:
        turn(out, 2, x[0]);
        out->x[2] = x[1];
        break;
    case HN_JOINT_UNIVERSAL:
        turn(out, 2, x[0]);
        turn(&more, 0, x[1]);
        compose(out, &more, out);
        break;
    case HN_JOINT_SPHERICAL:
        rotation(x, out->R);
        break;
    case HN_JOINT_PLANAR:
        turn(out, 2, x[2]);
        memcpy(out->x, x, 2 * sizeof *x);
        break;
    case HN_JOINT_FREE:
        rotation(x + 3, out->R);
        memcpy(out->x, x, 3 * sizeof *x);
        break;
    default:
        assert_int_equal(type, HN_JOINT_FIXED);
    }
}

static void place_body(const hn_system *sys, const double *x, int body, pose *poses, char *done) {
    const hn_scene *scene = hn_system_scene(sys);
    const hn_joint *j = &scene->joints[hn_system_tree_joint(sys, body)];
    const int other = j->child == body ? j->parent : j->child;
    pose base, here, there, motion;
    if (done[body]) {
        return;
    }
    turn(&base, 2, 0);
    if (other != HN_GROUND) {
        place_body(sys, x, other, poses, done);
        base = poses[other];
    }
    joint_frame(j->parent_ref, j->parent_axis, j->parent_at, &here);
    joint_frame(j->child_ref, j->child_axis, j->child_at, &there);
    joint_motion(j->type, j->coordinate >= 0 ? x + j->coordinate : x, &motion);
    invert(&there, &there);
    compose(&here, &motion, &motion);
    compose(&motion, &there, &motion);
    if (j->child != body) {
        invert(&motion, &motion);
    }
    compose(&base, &motion, &poses[body]);
    done[body] = 1;
}

/// Poses of all bodies after the time s of the motion; of a body its centre of mass instead of its
/// origin.
static void place_all(const hn_system *sys, const double *q, const double *v, const double *a,
                      double s, pose *poses) {
    const hn_scene *scene = hn_system_scene(sys);
    const hn_system_info info = hn_system_get_info(sys);
    double *at = calloc((size_t)info.nq + 1, sizeof *at), *way = calloc((size_t)info.nv + 1, 8);
    double *user = calloc((size_t)info.n_user + 1, sizeof *user);
    double *x = calloc((size_t)scene->n_coordinates + 1, sizeof *x);
    char *done = calloc((size_t)scene->n_bodies, 1);
    memcpy(at, q, (size_t)info.nq * sizeof *q);
    for (int i = 0; i < info.nv; i++) {
        way[i] = s * v[i] + 0.5 * s * s * a[i];
    }
    hn_system_move(sys, at, way);
    hn_system_to_user(sys, at, user);
    for (int i = 0; i < info.n_user; i++) {
        x[hn_system_user_coordinate(sys, i)] = user[i];
    }
    for (int b = 0; b < scene->n_bodies; b++) {
        place_body(sys, x, b, poses, done);
    }
    free(at);
    free(way);
    free(user);
    free(x);
    free(done);
}

static void world_point(const pose *poses, int body, const hn_quantity *at, double out[3]) {
    const double arm[3] = {at[0].value, at[1].value, at[2].value};
    for (int i = 0; i < 3; i++) {
        out[i] = body == HN_GROUND ? arm[i] : poses[body].x[i] + dot(poses[body].R[i], arm);
    }
}

/// First and second derivative of five values h apart.
static double first(const double f[TIMES], double h) {
    return (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * h);
}

static double second(const double f[TIMES], double h) {
    return (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (12 * h * h);
}

/// Acceleration of the centre of mass, angular velocity and acceleration from R' R' and R'' R':
/// their skew parts.
static void differentiate(const hn_scene *scene, pose *const poses[TIMES], int body, double h,
                          double acc[3], double w[3], double al[3], double v[3]) {
    double f[TIMES], x[TIMES][3], D[3][3], A[3][3], W[3][3], L[3][3], T[3][3];
    for (int k = 0; k < TIMES; k++) {
        world_point(poses[k], body, scene->bodies[body].com, x[k]);
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < TIMES; k++) {
            f[k] = x[k][i];
        }
        acc[i] = second(f, h);
        v[i] = first(f, h);
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < TIMES; k++) {
                f[k] = poses[k][body].R[i][j];
            }
            D[i][j] = first(f, h);
            A[i][j] = second(f, h);
            T[j][i] = poses[TIMES / 2][body].R[i][j];
        }
    }
    multiply(D, T, W);
    multiply(A, T, L);
    for (int i = 0; i < 3; i++) {
        const int b = (i + 1) % 3, c = (i + 2) % 3;
        w[i] = 0.5 * (W[c][b] - W[b][c]);
        al[i] = 0.5 * (L[c][b] - L[b][c]);
    }
}

/// Describes what a formula of a load may name, by value.
typedef struct names {
    const hn_system *sys;
    double t;
    const double *user_q, *user_v;
} names;

static int find_value(void *self, const char *name, hn_ex *out) {
    const names *s = self;
    const hn_scene *scene = hn_system_scene(s->sys);
    for (int i = 0; i < scene->n_params; i++) {
        if (strcmp(scene->params[i].name, name) == 0) {
            *out = hn_num(scene->params[i].value);
            return 1;
        }
    }
    for (int i = 0; i < hn_system_get_info(s->sys).n_user; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(s->sys, i)];
        if (strcmp(c->name, name) == 0 || strcmp(c->rate, name) == 0) {
            *out = hn_num(strcmp(c->name, name) == 0 ? s->user_q[i] : s->user_v[i]);
            return 1;
        }
    }
    *out = hn_num(s->t);
    return strcmp(name, "t") == 0;
}

static double value_of(const names *s, const hn_quantity *quantity) {
    if (!quantity->varies) {
        return quantity->value;
    }
    hn_graph *g = hn_graph_create();
    hn_parse_opts opts = {.lookup = find_value, .user = (void *)s};
    hn_diag diag = {0};
    hn_ex e;
    double value = 0;
    if (hn_parse(g, quantity->formula, &opts, &e, &diag) != HN_OK || !hn_is_number(e, &value)) {
        fail_msg("%s: %s", quantity->formula, diag.message);
    }
    hn_graph_free(g);
    return value;
}

typedef struct sums {
    const hn_scene *scene;
    const names *names;
    const pose *poses;
    double (*x)[3], (*f)[3],
        (*n)[3]; ///< centre of mass, force, moment about it; per body, the ground last
    balance *out;
} sums;

static void act(sums *s, int body, double k, const double force[3], const double place[3],
                const double *moment) {
    const int at = body == HN_GROUND ? s->scene->n_bodies : body;
    double arm[3], turning[3];
    for (int i = 0; i < 3; i++) {
        arm[i] = place[i] - s->x[at][i];
    }
    cross(arm, force, turning);
    for (int i = 0; i < 3; i++) {
        s->f[at][i] += k * force[i];
        s->n[at][i] += k * (turning[i] + (moment ? moment[i] : 0));
        s->out->largest_force = fmax(s->out->largest_force, fabs(force[i]));
        s->out->largest_moment = fmax(s->out->largest_moment, fabs(turning[i]));
        if (moment) {
            s->out->largest_moment = fmax(s->out->largest_moment, fabs(moment[i]));
        }
    }
}

static void act_wrenches(sums *s, const hn_wrench *joints, const hn_wrench *constraints) {
    for (int j = 0; j < s->scene->n_joints; j++) {
        const hn_wrench *w = &joints[j];
        act(s, s->scene->joints[j].child, 1, w->force, w->place, w->moment);
        act(s, s->scene->joints[j].parent, -1, w->force, w->place, w->moment);
    }
    for (int k = 0; k < s->scene->n_constraints; k++) {
        const hn_constraint *c = &s->scene->constraints[k];
        const hn_wrench *w = &constraints[k];
        if (c->kind != HN_CONSTRAINT_GEAR && c->kind != HN_CONSTRAINT_FORMULA) {
            // on the guided point's body; of a distance, on that of its second point
            const int second = c->kind == HN_CONSTRAINT_DISTANCE;
            const int on = s->scene->points[second ? c->q : c->p].body;
            const int by = s->scene->points[second ? c->p : c->q].body;
            act(s, on, 1, w->force, w->place, w->moment);
            act(s, by, -1, w->force, w->place, w->moment);
        }
    }
    for (int i = 0; i < 3; i++) {
        s->out->on_ground[i] = s->f[s->scene->n_bodies][i];
    }
}

static void act_spring(sums *s, const hn_load *load, pose *const poses[TIMES]) {
    const hn_point *p = &s->scene->points[load->p], *q = &s->scene->points[load->q];
    double a[3], b[3], length[TIMES], pull[3];
    for (int k = 0; k < TIMES; k++) {
        world_point(poses[k], p->body, p->at, a);
        world_point(poses[k], q->body, q->at, b);
        length[k] = sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
    }
    world_point(poses[TIMES / 2], p->body, p->at, a);
    world_point(poses[TIMES / 2], q->body, q->at, b);
    const double l = length[TIMES / 2];
    const double tension = load->stiffness.value * (l - load->rest.value) +
                           load->damping.value * first(length, s->out->step);
    for (int i = 0; i < 3; i++) {
        pull[i] = tension * (b[i] - a[i]) / l;
    }
    act(s, p->body, 1, pull, a, NULL);
    act(s, q->body, -1, pull, b, NULL);
}

static void act_loads(sums *s, pose *const poses[TIMES]) {
    for (int k = 0; k < s->scene->n_loads; k++) {
        const hn_load *load = &s->scene->loads[k];
        if (load->kind == HN_LOAD_SPRING) {
            act_spring(s, load, poses);
        } else if (load->kind == HN_LOAD_FORCE || load->kind == HN_LOAD_MOMENT) {
            const hn_point *p = &s->scene->points[load->p];
            const int is_force = load->kind == HN_LOAD_FORCE;
            double place[3], value[3];
            static const double none[3] = {0, 0, 0};
            world_point(s->poses, p->body, p->at, place);
            for (int i = 0; i < 3; i++) {
                value[i] = value_of(s->names, &load->value[i]);
            }
            act(s, p->body, 1, is_force ? value : none, place, is_force ? NULL : value);
        }
    }
}

static void compare(sums *s, int body, const double acc[3], const double w[3], const double al[3]) {
    const hn_body *b = &s->scene->bodies[body];
    const hn_quantity *I = b->inertia;
    double own[3][3] = {{I[0].value, I[3].value, I[4].value},
                        {I[3].value, I[1].value, I[5].value},
                        {I[4].value, I[5].value, I[2].value}};
    double R[3][3], T[3][3], world[3][3], spin[3], gyro[3];
    memcpy(R, s->poses[body].R, sizeof R);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            T[j][i] = R[i][j];
        }
    }
    multiply(R, own, world);
    multiply(world, T, world);
    for (int i = 0; i < 3; i++) {
        spin[i] = dot(world[i], w);
    }
    cross(w, spin, gyro);
    for (int i = 0; i < 3; i++) {
        const double mass = b->mass.value, g = s->scene->gravity[i].value;
        const double turning = dot(world[i], al) + gyro[i];
        s->out->force = fmax(s->out->force, fabs(mass * (acc[i] - g) - s->f[body][i]));
        s->out->moment = fmax(s->out->moment, fabs(turning - s->n[body][i]));
        s->out->largest_force = fmax(s->out->largest_force, fabs(mass * acc[i]));
        s->out->largest_moment = fmax(s->out->largest_moment, fabs(turning));
        s->out->momentum_rate[i] += mass * acc[i];
        s->out->weight[i] += mass * g;
    }
}

balance balance_of(const hn_system *sys, double t, const double *q, const double *v,
                   const double *a, const hn_wrench *joints, const hn_wrench *constraints) {
    const hn_scene *scene = hn_system_scene(sys);
    const size_t n = (size_t)scene->n_bodies;
    balance out = {0};
    double fastest = 0;
    for (int i = 0; i < hn_system_get_info(sys).nv; i++) {
        fastest = fmax(fastest, fmax(fabs(v[i]), sqrt(fabs(a[i])))); // what turns within a step
    }
    out.step = 1e-3 / (1 + 0.1 * fastest);
    double *user = calloc(2 * (size_t)hn_system_get_info(sys).n_user + 1, sizeof *user);
    double *rates = user + hn_system_get_info(sys).n_user;
    hn_system_to_user(sys, q, user);
    hn_system_rates_to_user(sys, v, rates);
    const names known = {sys, t, user, rates};
    pose *poses[TIMES];
    sums s = {.scene = scene, .out = &out, .names = &known};
    s.x = calloc(n + 1, sizeof *s.x);
    s.f = calloc(n + 1, sizeof *s.f);
    s.n = calloc(n + 1, sizeof *s.n);
    for (int k = 0; k < TIMES; k++) {
        poses[k] = calloc(n, sizeof *poses[k]);
        place_all(sys, q, v, a, (k - TIMES / 2) * out.step, poses[k]);
    }
    s.poses = poses[TIMES / 2];
    for (size_t b = 0; b < n; b++) {
        world_point(s.poses, (int)b, scene->bodies[b].com, s.x[b]);
    }
    act_wrenches(&s, joints, constraints);
    double(*wrench_f)[3] = calloc(n, sizeof *wrench_f),
    (*wrench_n)[3] = calloc(n, sizeof *wrench_n);
    memcpy(wrench_f, s.f, n * sizeof *wrench_f);
    memcpy(wrench_n, s.n, n * sizeof *wrench_n);
    act_loads(&s, poses);
    for (size_t b = 0; b < n; b++) {
        double acc[3], w[3], al[3], speed[3];
        differentiate(scene, poses, (int)b, out.step, acc, w, al, speed);
        compare(&s, (int)b, acc, w, al);
        out.power += dot(wrench_f[b], speed) + dot(wrench_n[b], w);
    }
    for (int k = 0; k < TIMES; k++) {
        free(poses[k]);
    }
    free(wrench_f);
    free(wrench_n);
    free(user);
    free(s.x);
    free(s.f);
    free(s.n);
    return out;
}
