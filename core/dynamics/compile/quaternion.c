// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/quaternion.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// |q|^2 this close to 1 is the rounding of a product of quaternions
static const double UNIT_ROUNDING = 8 * DBL_EPSILON;

void hn_quat_exp(const double r[3], double q[4]) {
    const double half = 0.5 * hypot(hypot(r[0], r[1]), r[2]);
    // sin(h) / (2 h) by its series where the quotient would be 0 / 0
    const double k = half > 1e-4 ? 0.5 * sin(half) / half : 0.5 - half * half / 12;
    q[0] = cos(half);
    for (int i = 0; i < 3; i++) {
        q[i + 1] = k * r[i];
    }
}

void hn_quat_log(const double q[4], double r[3]) {
    const double s = hypot(hypot(q[1], q[2]), q[3]), w = fabs(q[0]);
    const double sign = q[0] < 0 ? -1 : 1; // q and -q are one rotation: the shorter way
    double k = 0;
    if (s > 1e-8 * w) {
        k = 2 * atan2(s, w) / s;
    } else if (w > 0) {
        k = 2 / w;
    }
    for (int i = 0; i < 3; i++) {
        r[i] = sign * k * q[i + 1];
    }
}

void hn_quat_mul(const double a[4], const double b[4], double out[4]) {
    const double c[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                         a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                         a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
                         a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1]};
    memcpy(out, c, sizeof c);
}

void hn_quat_move(double q[4], const double delta[3]) {
    double turn[4];
    hn_quat_exp(delta, turn);
    hn_quat_mul(q, turn, q);
}

void hn_quat_difference(const double from[4], const double to[4], double delta[3]) {
    const double back[4] = {from[0], -from[1], -from[2], -from[3]};
    double turn[4];
    hn_quat_mul(back, to, turn);
    hn_quat_log(turn, delta);
}

void hn_quat_rate(const double q[4], const double omega[3], double rate[4]) {
    const double half[4] = {0, 0.5 * omega[0], 0.5 * omega[1], 0.5 * omega[2]};
    hn_quat_mul(q, half, rate);
}

bool hn_quat_normalise(double q[4]) {
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(fabs(square - 1) > UNIT_ROUNDING) || !isfinite(square) || square == 0) {
        return false;
    }
    const double k = 1 / sqrt(square);
    for (int i = 0; i < 4; i++) {
        q[i] *= k;
    }
    return true;
}
