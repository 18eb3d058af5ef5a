// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/ball_step.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/vec3.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

hn_status hn_ball_step_init(hn_ball_step *b, const hn_system *sys, hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    *b = (hn_ball_step){.sys = sys, .nv = info.nv};
    b->speed = hn_arena_ints(arena, (size_t)(info.nq - info.nv) + 1);
    b->owner = hn_arena_ints(arena, (size_t)info.nv);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < info.nv; i++) {
        b->owner[i] = -1;
    }
    for (int i = 0; i < info.nv; i++) {
        if (hn_system_position_of(sys, i) < 0) {
            b->speed[b->n++] = i;
            b->owner[i] = b->owner[i + 1] = b->owner[i + 2] = i;
            i += 2;
        }
    }
    HN_ASSERT(b->n == info.nq - info.nv);
    return HN_OK;
}

double hn_ball_step_angle(const hn_ball_step *b, const double *D) {
    double most = 0;
    for (int k = 0; k < b->n; k++) {
        most = fmax(most, hn_norm2(3, D + b->speed[k]));
    }
    return most;
}

/// c of (1); 1 - a/2 cot(a/2) loses its digits where the series has them all.
static double curvature(double a) {
    return a < 1e-2 ? 1.0 / 12 + a * a / 720 : (1 - a / 2 / tan(a / 2)) / (a * a);
}

void hn_ball_step_leave(const hn_ball_step *b, double h, const double *D, const double *X,
                        const double *F, double *out) {
    for (int k = 0; k < b->n; k++) {
        const int at = b->speed[k];
        const double *d = D + at, a = hn_norm2(3, d), c = curvature(a);
        const double skew = a > 0 ? tan(a / 4) / a : 0.25;
        double once[3], twice[3], force[3];
        hn_num3_cross(d, X + at, once);
        hn_num3_cross(d, once, twice);
        hn_num3_cross(d, F + at, force);
        for (int i = 0; i < 3; i++) {
            out[at + i] += once[i] / 2 + c * twice[i] - h / 2 * skew * force[i];
        }
    }
}

void hn_ball_step_turn(const hn_ball_step *b, const double *D, const double *X, double *out) {
    for (int k = 0; k < b->n; k++) {
        const int at = b->speed[k];
        double turned[3];
        hn_num3_cross(D + at, X + at, turned);
        hn_axpy(3, -1, turned, out + at);
    }
}

void hn_ball_step_put(const hn_ball_step *b, double h, const double *D, const double *X,
                      const double *M, int n_pattern, const int *rows, const int *cols,
                      hn_newton_matrix *to) {
    for (int k = 0; b->n > 0 && k < n_pattern; k++) {
        const int i = rows[k], j = cols[k], at = b->owner[i];
        if (at < 0) {
            continue;
        }
        const int x = i - at, y = (x + 1) % 3, z = (x + 2) % 3;
        const double m = M[(size_t)i * (size_t)b->nv + (size_t)j] / 2;
        hn_newton_matrix_put(to, at + y, j, D[at + z] * m, 0);
        hn_newton_matrix_put(to, at + z, j, -D[at + y] * m, 0);
    }
    for (int k = 0; k < b->n; k++) {
        const int at = b->speed[k];
        for (int x = 0; x < 3; x++) {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            hn_newton_matrix_put(to, at + x, at + y, h / 2 * X[at + z], 0);
            hn_newton_matrix_put(to, at + x, at + z, -h / 2 * X[at + y], 0);
        }
    }
}

void hn_add_kept(int n, double *high, double *low, const double *x) {
    for (int i = 0; i < n; i++) {
        const double add = x[i] + low[i], sum = high[i] + add, back = sum - high[i];
        low[i] = (high[i] - (sum - back)) + (add - back);
        high[i] = sum;
    }
}

void hn_ball_step_move(const hn_ball_step *b, double *q, double *low, const double *D,
                       double *scratch) {
    if (b->n == 0) {
        hn_add_kept(b->nv, q, low, D);
        return;
    }
    for (int i = 0; i < b->nv; i++) {
        const int position = hn_system_position_of(b->sys, i);
        scratch[i] = position < 0 ? D[i] : 0;
        if (position >= 0) {
            hn_add_kept(1, q + position, low + i, D + i);
        }
    }
    hn_system_move(b->sys, q, scratch);
    (void)hn_system_normalise(b->sys, q);
}
