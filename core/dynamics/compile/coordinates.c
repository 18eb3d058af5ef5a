// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"

#include "dynamics/compile/quaternion.h"
#include "dynamics/compile/system_impl.h"

#include <string.h>

// ---- user and system coordinates ----
//
//     user_i = sign_i (q_i - q_ref(i) - offset_i), references first in tree order             (1)

static const hn_link *link_of(const hn_system *sys, int coordinate) {
    return &sys->tree.links[sys->tree.link_of[coordinate]];
}

/// Angles and slides by (1), balls left out. `place` holds the entry of q of each velocity; NULL
/// converts rates: entry i stands at i, and offsets do not count.
static void to_user(const hn_system *sys, const double *q, double *user, const int *place) {
    for (int i = 0; i < sys->nv; i++) {
        const hn_link *l = link_of(sys, i);
        if (l->n_speeds == 3) {
            continue;
        }
        const int ref = l->angle_ref;
        const double turned = ref < 0 ? 0 : q[place ? place[ref] : ref];
        user[i] = l->sign * (q[place ? place[i] : i] - turned - (place ? l->offset : 0));
    }
}

/// The inverse of to_user().
static void from_user(const hn_system *sys, const double *user, double *q, const int *place) {
    for (int k = 0; k < sys->tree.n_order; k++) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->n_speeds != 1) {
            continue;
        }
        const int i = l->coordinate, ref = l->angle_ref;
        const double turned = ref < 0 ? 0 : q[place ? place[ref] : ref];
        q[place ? place[i] : i] = l->sign * user[i] + turned + (place ? l->offset : 0);
    }
}

static void copy(const double *from, double *to, int n) {
    if (n > 0) {
        memcpy(to, from, (size_t)n * sizeof *to);
    }
}

void hn_system_to_user(const hn_system *sys, const double *q, double *user_q) {
    if (sys->scene->is_lagrangian) {
        copy(q, user_q, sys->nv);
        return;
    }
    to_user(sys, q, user_q, sys->tree.position);
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_log(q + sys->balls[k].position, user_q + sys->balls[k].speed);
    }
}

void hn_system_from_user(const hn_system *sys, const double *user_q, double *q) {
    if (sys->scene->is_lagrangian) {
        copy(user_q, q, sys->nv);
        return;
    }
    from_user(sys, user_q, q, sys->tree.position);
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_exp(user_q + sys->balls[k].speed, q + sys->balls[k].position);
    }
}

void hn_system_rates_to_user(const hn_system *sys, const double *v, double *user_v) {
    if (sys->scene->is_lagrangian) {
        copy(v, user_v, sys->nv);
        return;
    }
    to_user(sys, v, user_v, NULL);
    for (int k = 0; k < sys->n_balls; k++) {
        copy(v + sys->balls[k].speed, user_v + sys->balls[k].speed, 3);
    }
}

void hn_system_rates_from_user(const hn_system *sys, const double *user_v, double *v) {
    if (sys->scene->is_lagrangian) {
        copy(user_v, v, sys->nv);
        return;
    }
    from_user(sys, user_v, v, NULL);
    for (int k = 0; k < sys->n_balls; k++) {
        copy(user_v + sys->balls[k].speed, v + sys->balls[k].speed, 3);
    }
}

void hn_system_forces_to_user(const hn_system *sys, const double *f, double *user_f) {
    copy(f, user_f, sys->nv);
    if (sys->scene->is_lagrangian) {
        return;
    }

    // v = S user_v fills from the references downwards, so user_f = S' f gathers from the leaves up
    for (int k = sys->tree.n_order - 1; k >= 0; k--) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->angle_ref >= 0) {
            user_f[l->angle_ref] += user_f[l->coordinate];
        }
    }
    for (int i = 0; i < sys->nv; i++) {
        user_f[i] *= link_of(sys, i)->sign; // 1 for balls
    }
}

// ---- positions and velocities: balls, and everything else ----

/// Entries of q that are not a ball's stand in the order of their velocities: between two balls, a
/// run of entries of q matches a run of equal length in v.
typedef struct stretch {
    int position, speed, n;
} stretch;

/// The run of plain coordinates before ball k (k = n_balls: after the last).
static stretch run_before(const hn_system *sys, int k) {
    stretch run = {0, 0, 0};
    if (k > 0) {
        run.position = sys->balls[k - 1].position + 4;
        run.speed = sys->balls[k - 1].speed + 3;
    }
    run.n = (k < sys->n_balls ? sys->balls[k].speed : sys->nv) - run.speed;
    return run;
}

void hn_system_kinematics(const hn_system *sys, const double *q, const double *v, double *qdot) {
    // without balls, in every stage of an integrator: for a handful of numbers quicker than a call
    if (sys->n_balls == 0) {
        for (int i = 0; i < sys->nv; i++) {
            qdot[i] = v[i];
        }
        return;
    }

    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        copy(v + run.speed, qdot + run.position, run.n);
    }

    for (int k = 0; k < sys->n_balls; k++) {
        const hn_ball *ball = &sys->balls[k];
        hn_quat_rate(q + ball->position, v + ball->speed, qdot + ball->position);
    }
}

void hn_system_move(const hn_system *sys, double *q, const double *delta) {
    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        for (int i = 0; i < run.n; i++) {
            q[run.position + i] += delta[run.speed + i];
        }
    }
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_move(q + sys->balls[k].position, delta + sys->balls[k].speed);
    }
}

void hn_system_difference(const hn_system *sys, const double *from, const double *to,
                          double *delta) {
    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        for (int i = 0; i < run.n; i++) {
            delta[run.speed + i] = to[run.position + i] - from[run.position + i];
        }
    }
    for (int k = 0; k < sys->n_balls; k++) {
        const hn_ball *ball = &sys->balls[k];
        hn_quat_difference(from + ball->position, to + ball->position, delta + ball->speed);
    }
}

bool hn_system_normalise(const hn_system *sys, double *q) {
    bool changed = false;
    for (int k = 0; k < sys->n_balls; k++) {
        changed |= hn_quat_normalise(q + sys->balls[k].position);
    }
    return changed;
}
