// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/picture_angles.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double STRAIGHT = 1e-6; // [rad] that a bar may lean out of the plane it turns in

/// The evaluation of the points at other angles of one joint.
typedef struct trial {
    const hn_system *sys;
    hn_eval *eval;
    double t;
    const double *v; ///< (nv) system velocities
    double *user;    ///< (n_user) user coordinates; one of them is changed
    double *q;       ///< (nq) system coordinates
} trial;

/// The bar of the joint's second body that ends at the joint: *pivot there, *end at its other end.
static bool find_bar(const hn_scene *s, const hn_joint *joint, int *pivot, int *end) {
    for (int i = 0; i < s->n_shapes; i++) {
        const hn_shape *bar = &s->shapes[i];
        const int ends[2] = {bar->p, bar->q};
        for (int k = 0; k < 2 && bar->kind == HN_SHAPE_BAR && bar->body == joint->child; k++) {
            const hn_point *point = &s->points[ends[k]];
            bool here = point->body == joint->child;
            for (int j = 0; j < 3; j++) {
                here = here && point->at[j].value == joint->child_at[j].value;
            }
            if (here) {
                *pivot = ends[k];
                *end = ends[1 - k];
                return true;
            }
        }
    }
    return false;
}

/// The bar as a vector [m, world] when user coordinate i is `value`.
static void turn_bar(const trial *t, int i, double value, const hn_snapshot_angle *angle,
                     double out[3]) {
    const double kept = t->user[i];
    t->user[i] = value;
    hn_system_from_user(t->sys, t->user, t->q);
    t->user[i] = kept;
    hn_eval_run(t->eval, t->t, t->q, t->v);
    const double *points = hn_eval_get(t->eval, HN_TERM_POINTS);
    for (int k = 0; k < 3; k++) {
        out[k] = points[3 * angle->end + k] - points[3 * angle->pivot + k];
    }
}

/// Finds where the bar lies at 0 and after a quarter of a turn, as unit vectors. False where it
/// turns on a cone, so that no plane holds the angle.
static bool find_directions(const trial *t, int i, hn_snapshot_angle *angle) {
    const double half = 3.14159265358979324;
    double at[3][3], length = 0, lean = 0;
    for (int k = 0; k < 3; k++) {
        turn_bar(t, i, 0.5 * half * k, angle, at[k]);
    }
    for (int k = 0; k < 3; k++) {
        length = hypot(length, at[0][k]);
        lean = hypot(lean, at[0][k] + at[2][k]);
    }
    for (int k = 0; k < 3; k++) {
        angle->zero[k] = at[0][k] / length;
        angle->quarter[k] = at[1][k] / length;
    }
    return length > 0 && lean <= STRAIGHT * length;
}

static int list_angles(const hn_model *model, const trial *t, hn_snapshot_angle *out) {
    const hn_scene *s = hn_model_scene(model);
    int n = 0;
    for (int i = 0; i < hn_system_get_info(t->sys).n_user; i++) {
        const hn_coordinate *x = &s->coordinates[hn_system_user_coordinate(t->sys, i)];
        const hn_joint *joint = x->joint >= 0 ? &s->joints[x->joint] : NULL;
        if (!joint || joint->type != HN_JOINT_REVOLUTE || joint->is_formal) {
            continue;
        }
        hn_snapshot_angle angle = {.value = t->user[i], .name = x->name};
        if (isfinite(angle.value) && find_bar(s, joint, &angle.pivot, &angle.end) &&
            find_directions(t, i, &angle)) {
            out[n++] = angle;
        }
    }
    return n;
}

hn_status hn_picture_angles(const hn_model *model, const hn_sample *sample, hn_snapshot_angle *out,
                            int *n) {
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    hn_arena *arena = hn_arena_create(0);
    trial t = {.sys = sys, .t = sample->t, .v = hn_model_v(model)};
    hn_status status = HN_ERR_MEMORY;
    *n = 0;
    if (arena) {
        t.user = hn_arena_doubles(arena, (size_t)info.n_user + 1);
        t.q = hn_arena_doubles(arena, (size_t)info.nq + 1);
    }
    if (t.user && t.q) {
        memcpy(t.user, sample->q, (size_t)info.n_user * sizeof *t.user);
        status = hn_eval_create(sys, HN_TERM_POINTS, arena, &t.eval);
    }
    if (status == HN_OK) {
        *n = list_angles(model, &t, out);
    }
    hn_eval_free(t.eval);
    hn_arena_free(arena);
    return status;
}
