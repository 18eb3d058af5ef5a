// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/mechanism.h"

#include "scene/joint_freedoms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double random_signed(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 23) - 1;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    memcpy(out, c, sizeof c);
}

static void add_scaled(double out[3], double k, const double a[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] += k * a[i];
    }
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

static void transpose(double a[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[i][j] = a[j][i];
        }
    }
}

static void apply(double R[3][3], const double v[3], double out[3]) {
    double c[3] = {dot(R[0], v), dot(R[1], v), dot(R[2], v)};
    memcpy(out, c, sizeof c);
}

static void apply_back(double R[3][3], const double v[3], double out[3]) {
    double T[3][3];
    transpose(R, T);
    apply(T, v, out);
}

static void values_of(const hn_quantity *q, double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = q[i].value;
    }
}

static void triad(const double axis[3], const double ref[3], double out[3][3]) {
    double y[3];
    cross(axis, ref, y);
    for (int i = 0; i < 3; i++) {
        out[i][0] = ref[i];
        out[i][1] = y[i];
        out[i][2] = axis[i];
    }
}

// ---- motion ----

void mechanism_point(const body_motion *bodies, int body, const hn_quantity *at, double x[3],
                     double v[3], double a[3]) {
    double r[3], t[3];
    values_of(at, x);
    for (int i = 0; i < 3; i++) {
        v[i] = a[i] = 0;
    }
    if (body == HN_GROUND) {
        return;
    }
    body_motion b = bodies[body];
    apply(b.R, x, r);
    memcpy(x, b.p, sizeof b.p);
    add_scaled(x, 1, r);
    memcpy(v, b.v, sizeof b.v);
    cross(b.w, r, t);
    add_scaled(v, 1, t);
    memcpy(a, b.a, sizeof b.a);
    cross(b.w, t, t);
    add_scaled(a, 1, t);
    cross(b.al, r, t);
    add_scaled(a, 1, t);
}

/// The child's half of a joint seen from the parent's, in the parent's joint axes: turn, place, and
/// their derivatives at zero second derivatives of the coordinates.
typedef struct relative_motion {
    double R[3][3], d[3], w[3], v[3], al[3], a[3];
} relative_motion;

static void turn_about(double axis_angle[3], double R[3][3]) {
    double angle = sqrt(dot(axis_angle, axis_angle)), c = cos(angle), s = sin(angle);
    double n[3] = {1, 0, 0};
    for (int i = 0; i < 3 && angle > 0; i++) {
        n[i] = axis_angle[i] / angle;
    }
    double cross_n[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            R[i][j] = (i == j) * c + (1 - c) * n[i] * n[j] + s * cross_n[i][j];
        }
    }
}

static void relative_of(hn_joint_type type, const double *q, const double *qd, relative_motion *m) {
    double turn[3] = {0, 0, 0}, x[3], y[3], z[3] = {0, 0, 1}, second[3] = {0, 0, 0}, Rx[3][3];
    *m = (relative_motion){.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    switch (type) {
    case HN_JOINT_REVOLUTE:
    case HN_JOINT_CYLINDRICAL:
    case HN_JOINT_UNIVERSAL:
        turn[2] = q[0];
        m->w[2] = qd[0];
        break;
    case HN_JOINT_PRISMATIC:
        m->d[2] = q[0];
        m->v[2] = qd[0];
        break;
    case HN_JOINT_SPHERICAL:
        memcpy(turn, q, sizeof turn);
        break;
    case HN_JOINT_PLANAR:
        turn[2] = q[2];
        m->w[2] = qd[2];
        memcpy(m->d, q, 2 * sizeof *q);
        memcpy(m->v, qd, 2 * sizeof *q);
        break;
    case HN_JOINT_FREE:
        memcpy(turn, q + 3, sizeof turn);
        memcpy(m->d, q, 3 * sizeof *q);
        memcpy(m->v, qd, 3 * sizeof *q);
        break;
    default:
        break;
    }
    turn_about(turn, m->R);
    if (type == HN_JOINT_CYLINDRICAL) {
        m->d[2] = q[1];
        m->v[2] = qd[1];
    }
    if (type == HN_JOINT_UNIVERSAL) {
        for (int i = 0; i < 3; i++) {
            x[i] = m->R[i][0];
        }
        second[0] = q[1];
        turn_about(second, Rx);
        multiply(m->R, Rx, m->R);
        cross(z, x, y);
        add_scaled(m->w, qd[1], x);
        add_scaled(m->al, qd[0] * qd[1], y);
    }
    if (type == HN_JOINT_SPHERICAL || type == HN_JOINT_FREE) {
        apply(m->R, qd + (type == HN_JOINT_FREE ? 3 : 0), m->w);
    }
}

/// The same seen from the child.
static void reverse(relative_motion *m) {
    relative_motion out;
    double t[3], u[3];
    transpose(m->R, out.R);
    for (int i = 0; i < 3; i++) {
        t[i] = -m->w[i];
        u[i] = -m->al[i];
    }
    apply(out.R, t, out.w);
    apply(out.R, u, out.al);
    for (int i = 0; i < 3; i++) {
        t[i] = -m->d[i];
    }
    apply(out.R, t, out.d);
    cross(m->w, m->d, t); // v - w x d
    for (int i = 0; i < 3; i++) {
        u[i] = t[i] - m->v[i];
    }
    apply(out.R, u, out.v);
    double a[3] = {-m->a[0], -m->a[1], -m->a[2]};
    cross(m->w, m->v, u);
    add_scaled(a, 2, u);
    cross(m->al, m->d, u);
    add_scaled(a, 1, u);
    cross(m->w, t, u);
    add_scaled(a, -1, u);
    apply(out.R, a, out.a);
    *m = out;
}

static void move_body(const hn_scene *scene, int body, const double *q, const double *qd,
                      body_motion *all) {
    const hn_joint *j = &scene->joints[body];
    int reversed = j->child != body, base = reversed ? j->child : j->parent;
    body_motion ground = {.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    body_motion B = base == HN_GROUND ? ground : all[base], out;
    double here[3][3], there[3][3], back[3][3];
    triad(j->parent_axis, j->parent_ref, reversed ? there : here);
    triad(j->child_axis, j->child_ref, reversed ? here : there);
    multiply(B.R, here, here);
    relative_motion rel;
    relative_of(j->type, q, qd, &rel);
    if (reversed) {
        reverse(&rel);
    }
    double *const in_world[5] = {rel.d, rel.w, rel.v, rel.al, rel.a};
    for (int i = 0; i < 5; i++) {
        apply(here, in_world[i], in_world[i]);
    }
    // the joint's point on the base, then on the body, seen from the base
    double x[3], v[3], a[3], t[3], u[3];
    mechanism_point(all, base, reversed ? j->child_at : j->parent_at, x, v, a);
    memcpy(out.w, B.w, sizeof out.w);
    memcpy(out.al, B.al, sizeof out.al);
    add_scaled(out.w, 1, rel.w);
    add_scaled(out.al, 1, rel.al);
    cross(B.w, rel.w, t);
    add_scaled(out.al, 1, t);
    add_scaled(x, 1, rel.d);
    cross(B.w, rel.d, t);
    add_scaled(v, 1, t);
    add_scaled(v, 1, rel.v);
    cross(B.w, t, t);
    add_scaled(a, 1, t);
    cross(B.al, rel.d, t);
    add_scaled(a, 1, t);
    cross(B.w, rel.v, t);
    add_scaled(a, 2, t);
    add_scaled(a, 1, rel.a);
    multiply(here, rel.R, here);
    transpose(there, back);
    multiply(here, back, out.R);
    // from the joint's point to the body's origin
    double r[3];
    values_of(reversed ? j->parent_at : j->child_at, r);
    apply(out.R, r, r);
    memcpy(out.p, x, sizeof x);
    memcpy(out.v, v, sizeof v);
    memcpy(out.a, a, sizeof a);
    add_scaled(out.p, -1, r);
    cross(out.w, r, t);
    add_scaled(out.v, -1, t);
    cross(out.w, t, u);
    add_scaled(out.a, -1, u);
    cross(out.al, r, u);
    add_scaled(out.a, -1, u);
    all[body] = out;
}

int mechanism_coordinates(const hn_scene *scene) {
    int n = 0;
    for (int b = 0; b < scene->n_bodies; b++) {
        n += scene->joints[b].n_coordinates;
    }
    return n;
}

void mechanism_move(const hn_scene *scene, const double *q, const double *qd, body_motion *out) {
    for (int b = 0, at = 0; b < scene->n_bodies; b++) {
        move_body(scene, b, q + at, qd + at, out);
        at += scene->joints[b].n_coordinates;
    }
}

static void world_inertia(const hn_body *body, double R[3][3], double out[3][3]) {
    const hn_quantity *I = body->inertia;
    double own[3][3] = {{I[0].value, I[3].value, I[4].value},
                        {I[3].value, I[1].value, I[5].value},
                        {I[4].value, I[5].value, I[2].value}};
    double back[3][3];
    transpose(R, back);
    multiply(R, own, out);
    multiply(out, back, out);
}

void mechanism_terms(const hn_scene *scene, const double *q, const double *qd, double *M, double *h,
                     double *kinetic, double *potential) {
    const int n = mechanism_coordinates(scene), nb = scene->n_bodies;
    body_motion *now = calloc((size_t)nb * (size_t)(n + 1), sizeof *now), *unit = now + nb;
    double *e = calloc((size_t)n + 1, sizeof *e);
    mechanism_move(scene, q, qd, now);
    for (int i = 0; i < n; i++) {
        e[i] = 1;
        mechanism_move(scene, q, e, unit + i * nb);
        e[i] = 0;
    }
    double g[3];
    values_of(scene->gravity, g);
    *kinetic = *potential = 0;
    memset(M, 0, (size_t)(n * n) * sizeof *M);
    memset(h, 0, (size_t)n * sizeof *h);
    for (int b = 0; b < nb; b++) {
        const hn_body *body = &scene->bodies[b];
        double m = body->mass.value, I[3][3], x[3], v[3], a[3], Iw[3], Ial[3], gyro[3];
        world_inertia(body, now[b].R, I);
        mechanism_point(now, b, body->com, x, v, a);
        apply(I, now[b].w, Iw);
        apply(I, now[b].al, Ial);
        cross(now[b].w, Iw, gyro);
        add_scaled(Ial, 1, gyro);
        *kinetic += 0.5 * (m * dot(v, v) + dot(now[b].w, Iw));
        *potential -= m * dot(g, x);
        add_scaled(a, -1, g);
        for (int i = 0; i < n; i++) {
            double xi[3], vi[3], ai[3], Iwi[3];
            const body_motion *ui = unit + i * nb;
            mechanism_point(ui, b, body->com, xi, vi, ai);
            apply(I, ui[b].w, Iwi);
            h[i] += m * dot(vi, a) + dot(ui[b].w, Ial);
            for (int j = 0; j < n; j++) {
                double vj[3];
                mechanism_point(unit + j * nb, b, body->com, xi, vj, ai);
                M[i * n + j] += m * dot(vi, vj) + dot(Iwi, (unit + j * nb)[b].w);
            }
        }
    }
    free(e);
    free(now);
}

// ---- random mechanisms ----

static void random_vector(unsigned *seed, double v[3]) {
    for (int i = 0; i < 3; i++) {
        v[i] = random_signed(seed);
    }
}

static void normalise(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

/// A unit vector across the axis.
static void random_ref(unsigned *seed, const double axis[3], double ref[3]) {
    random_vector(seed, ref);
    add_scaled(ref, -dot(ref, axis), axis);
    normalise(ref);
    add_scaled(ref, -dot(ref, axis), axis);
    normalise(ref);
}

static void set_values(hn_quantity *q, const double v[3], int planar) {
    for (int i = 0; i < 3; i++) {
        q[i].value = planar && i == 2 ? 0 : v[i];
    }
}

static void random_axis(unsigned *seed, const mechanism_opts *o, int prismatic, double axis[3]) {
    random_vector(seed, axis);
    if (o->planar) {
        axis[0] = prismatic ? axis[0] : 0;
        axis[1] = prismatic ? axis[1] : 0;
        axis[2] = prismatic ? 0 : axis[2];
    }
    normalise(axis);
}

static void random_body(unsigned *seed, const mechanism_opts *o, hn_body *body) {
    double com[3], d[3], r[3];
    body->mass.value = 1.5 + random_signed(seed);
    random_vector(seed, com);
    set_values(body->com, com, o->planar);
    // of two point masses and a ball: positive definite, with all products
    random_vector(seed, d);
    random_vector(seed, r);
    for (int i = 0; i < 3; i++) {
        body->inertia[i].value = 0.1 + dot(d, d) + dot(r, r) - d[i] * d[i] - r[i] * r[i];
        int a = i == 2 ? 1 : 0, b = i == 0 ? 1 : 2;
        body->inertia[3 + i].value = -d[a] * d[b] - r[a] * r[b];
    }
}

/// Room for as many coordinates as the type has, numbered on.
static void add_coordinates(hn_scene *s, hn_joint *j, int joint) {
    (void)hn_joint_freedoms(j->type, &j->n_coordinates);
    j->coordinate = j->n_coordinates ? s->n_coordinates : -1;
    const int first_turn = j->type == HN_JOINT_FREE ? 3 : j->type == HN_JOINT_SPHERICAL ? 0 : 6;
    for (int k = 0; k < j->n_coordinates; k++) {
        hn_coordinate *c = &s->coordinates[s->n_coordinates];
        char text[32];
        snprintf(text, sizeof text, "c%d", s->n_coordinates);
        c->name = hn_arena_strdup(s->arena, text);
        snprintf(text, sizeof text, "d_c%d", s->n_coordinates++);
        c->rate = hn_arena_strdup(s->arena, text);
        c->joint = joint;
        c->part = k;
        c->turn = k >= first_turn ? k - first_turn : -1;
    }
}

/// Any type but the last `without`.
static hn_joint_type random_type(unsigned *seed, int without) {
    const int n = HN_JOINT_TYPE_COUNT - without;
    const int type = (int)((random_signed(seed) + 1) * 0.5 * n);
    return (hn_joint_type)(type < n ? type : n - 1);
}

static void make_tree_joint(hn_scene *s, const mechanism_opts *o, unsigned *seed, int i) {
    hn_joint *j = &s->joints[i];
    int base = i == 0 ? HN_GROUND : (int)((random_signed(seed) + 1) * 0.5 * (i + 1)) - 1;
    base = base >= i ? i - 1 : base;
    int reversed = random_signed(seed) > 0.5,
        prismatic = (random_signed(seed) + 1) * 0.5 < o->prismatic;
    j->type = prismatic ? HN_JOINT_PRISMATIC : HN_JOINT_REVOLUTE;
    if (o->mixed > 0 && (random_signed(seed) + 1) * 0.5 < o->mixed) {
        j->type = random_type(seed, 0);
    }
    add_coordinates(s, j, i);
    j->parent = reversed ? i : base;
    j->child = reversed ? base : i;
    double *base_axis = reversed ? j->child_axis : j->parent_axis,
           *own_axis = reversed ? j->parent_axis : j->child_axis;
    random_axis(seed, o, prismatic, base_axis);
    random_axis(seed, o, prismatic, own_axis);
    if ((random_signed(seed) + 1) * 0.5 < o->parallel && base != HN_GROUND && !prismatic) {
        const hn_joint *below =
            &s->joints[base]; // the axis by which the base itself hangs, one way or the other
        const double *axis = below->child == base ? below->child_axis : below->parent_axis;
        double sense = random_signed(seed) > 0 ? 1 : -1;
        for (int k = 0; k < 3; k++) {
            base_axis[k] = sense * axis[k];
        }
    }
    random_ref(seed, j->parent_axis, j->parent_ref);
    random_ref(seed, j->child_axis, j->child_ref);
    double at[3];
    random_vector(seed, at);
    set_values(j->parent_at, at, o->planar);
    random_vector(seed, at);
    set_values(j->child_at, at, o->planar);
}

/// A joint between two bodies that is closed in the pose given: its half on the child is worked out
/// from the parent's.
static void make_cut_joint(hn_scene *s, const mechanism_opts *o, unsigned *seed, int i,
                           const body_motion *pose) {
    hn_joint *j = &s->joints[i];
    int k = i - s->n_bodies;
    j->type =
        (random_signed(seed) + 1) * 0.5 < o->prismatic ? HN_JOINT_PRISMATIC : HN_JOINT_REVOLUTE;
    if (o->mixed > 0 && (random_signed(seed) + 1) * 0.5 < o->mixed) {
        j->type = random_type(seed, 1);
    }
    add_coordinates(s, j, i);
    j->parent = s->n_bodies - 1 - k % s->n_bodies;
    j->child = k % 2 || s->n_bodies < 3 ? HN_GROUND : (j->parent + 1 + k) % s->n_bodies;
    j->cut = 1;
    double at[3], x[3], v[3], a[3], q[6] = {0};
    const double none[6] = {0};
    random_axis(seed, o, j->type == HN_JOINT_PRISMATIC, j->parent_axis);
    random_ref(seed, j->parent_axis, j->parent_ref);
    random_vector(seed, at);
    set_values(j->parent_at, at, o->planar);
    mechanism_point(pose, j->parent, j->parent_at, x, v, a);
    double Rp[3][3], Rc[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, axis[3], ref[3];
    memcpy(Rp, pose[j->parent].R, sizeof Rp);
    apply(Rp, j->parent_axis, axis);
    apply(Rp, j->parent_ref, ref);
    if (j->type == HN_JOINT_PRISMATIC) { // anywhere along the axis
        q[0] = random_signed(seed);
        add_scaled(x, q[0], axis);
    } else if (j->type != HN_JOINT_REVOLUTE) { // anywhere at all
        relative_motion rel;
        double world[3][3];
        for (int k2 = 0; k2 < j->n_coordinates; k2++) {
            q[k2] = random_signed(seed);
        }
        relative_of(j->type, q, none, &rel);
        triad(axis, ref, world);
        apply(world, rel.d, rel.d);
        add_scaled(x, 1, rel.d);
        multiply(world, rel.R, world);
        for (int i2 = 0; i2 < 3; i2++) {
            ref[i2] = world[i2][0];
            axis[i2] = world[i2][2];
        }
    }
    if (j->child != HN_GROUND) {
        memcpy(Rc, pose[j->child].R, sizeof Rc);
        add_scaled(x, -1, pose[j->child].p);
    }
    apply_back(Rc, x, x);
    set_values(j->child_at, x, 0);
    apply_back(Rc, axis, j->child_axis);
    apply_back(Rc, ref, j->child_ref);
    for (int k2 = 0; k2 < j->n_coordinates; k2++) {
        s->coordinates[j->coordinate + k2].q0 = q[k2];
    }
}

static char *name_of(hn_arena *arena, const char *stem, int i) {
    char text[32];
    snprintf(text, sizeof text, "%s%d", stem, i);
    return hn_arena_strdup(arena, text);
}

hn_scene *mechanism_random(hn_arena *arena, const mechanism_opts *o) {
    unsigned seed = o->seed * 2654435761u + 12345u;
    hn_scene *s = hn_arena_get(arena, sizeof *s);
    s->arena = arena;
    s->n_bodies = o->n_bodies;
    s->n_joints = o->n_bodies + o->n_cuts;
    const size_t room = 6 * (size_t)s->n_joints;
    s->bodies = hn_arena_get(arena, (size_t)s->n_bodies * sizeof *s->bodies);
    s->joints = hn_arena_get(arena, (size_t)s->n_joints * sizeof *s->joints);
    s->coordinates = hn_arena_get(arena, room * sizeof *s->coordinates);
    double *q = hn_arena_doubles(arena, room), *rest = hn_arena_doubles(arena, room);
    double g[3];
    random_vector(&seed, g);
    for (int i = 0; i < 3; i++) {
        s->gravity[i].value = 9.81 * g[i];
    }
    for (int i = 0; i < s->n_joints; i++) {
        s->joints[i].name = name_of(arena, "J", i);
        s->joints[i].pointer = "";
    }
    for (int i = 0; i < s->n_bodies; i++) {
        s->bodies[i].name = name_of(arena, "body", i);
        s->bodies[i].pointer = "";
        random_body(&seed, o, &s->bodies[i]);
        make_tree_joint(s, o, &seed, i);
        for (int k = s->n_coordinates - s->joints[i].n_coordinates; k < s->n_coordinates; k++) {
            q[k] = s->coordinates[k].q0 = random_signed(&seed);
        }
    }
    body_motion *pose = hn_arena_get(arena, (size_t)s->n_bodies * sizeof *pose);
    mechanism_move(s, q, rest, pose);
    for (int i = s->n_bodies; i < s->n_joints; i++) {
        make_cut_joint(s, o, &seed, i, pose);
    }
    return s;
}
