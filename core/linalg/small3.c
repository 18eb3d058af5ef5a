// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/small3.h"

#include <math.h>
#include <string.h>

void hn_num3_mul(double a[3][3], double b[3][3], double out[3][3]) {
    double c[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    memcpy(out, c, sizeof c);
}

void hn_num3_transpose(double a[3][3], double out[3][3]) {
    const double t[3][3] = {
        {a[0][0], a[1][0], a[2][0]}, {a[0][1], a[1][1], a[2][1]}, {a[0][2], a[1][2], a[2][2]}};
    memcpy(out, t, sizeof t);
}

void hn_num3_apply(double a[3][3], const double x[3], double out[3]) {
    double y[3];
    for (int i = 0; i < 3; i++) {
        y[i] = a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2];
    }
    memcpy(out, y, sizeof y);
}

void hn_num3_snap(double a[3][3], double within) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const double nearest = round(a[i][j]);
            if (fabs(a[i][j] - nearest) < within) {
                a[i][j] = nearest + 0.0; // no negative zero
            }
        }
    }
}

void hn_num3_compose(double a[3][3], double b[3][3], double out[3][3]) {
    hn_num3_mul(a, b, out);
    hn_num3_snap(out, HN_NUM3_SNAP);
}

void hn_num3_cross(const double a[3], const double b[3], double out[3]) {
    const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    memcpy(out, c, sizeof c);
}

double hn_num3_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double hn_num3_norm(const double a[3]) {
    return sqrt(hn_num3_dot(a, a));
}
