// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/frame.h"

#include "linalg/small3.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
/// an entry of a rotation this near to 0, 1 or -1 is meant to be that [-]
static const double ROUNDING = 4e-16;
static const double NO_LENGTH = 1e-10; ///< below this a vector has no direction

hn_im_frame hn_im_frame_unit(void) {
    return (hn_im_frame){.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

void hn_im_snap(double R[3][3]) {
    hn_num3_snap(R, ROUNDING);
}

void hn_im_turn(const hn_im_frame *a, const double x[3], double out[3]) {
    double y[3];
    for (int i = 0; i < 3; i++) {
        y[i] = a->R[i][0] * x[0] + a->R[i][1] * x[1] + a->R[i][2] * x[2];
    }
    memcpy(out, y, sizeof y);
}

void hn_im_place(const hn_im_frame *a, const double x[3], double out[3]) {
    hn_im_turn(a, x, out);
    for (int i = 0; i < 3; i++) {
        out[i] += a->p[i];
    }
}

hn_im_frame hn_im_frame_mul(const hn_im_frame *a, const hn_im_frame *b) {
    hn_im_frame out = *a, inner = *b;
    hn_num3_mul(out.R, inner.R, out.R);
    hn_im_snap(out.R);
    hn_im_place(a, b->p, out.p);
    return out;
}

hn_im_frame hn_im_frame_inverse(const hn_im_frame *a) {
    hn_im_frame out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.R[i][j] = a->R[j][i];
        }
    }
    hn_im_turn(&out, a->p, out.p);
    for (int i = 0; i < 3; i++) {
        out.p[i] = -out.p[i] + 0.0;
    }
    return out;
}

bool hn_im_normalise(double a[3]) {
    double n = hn_num3_norm(a);
    if (!(n >= NO_LENGTH) || !isfinite(n)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        a[i] = a[i] / n + 0.0;
    }
    return true;
}

void hn_im_across(const double axis[3], double out[3]) {
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = fabs(axis[i]) < fabs(axis[k]) ? i : k;
    }
    for (int i = 0; i < 3; i++) {
        out[i] = (i == k) - axis[k] * axis[i];
    }
    (void)hn_im_normalise(out);
}

/// Rodrigues: cos 1 + sin [u]x + (1 - cos) u u'.
void hn_im_rotation(const double u[3], double angle, double R[3][3]) {
    double c = cos(angle), s = sin(angle), k = 1 - c;
    double out[3][3] = {
        {c + k * u[0] * u[0], k * u[0] * u[1] - s * u[2], k * u[0] * u[2] + s * u[1]},
        {k * u[0] * u[1] + s * u[2], c + k * u[1] * u[1], k * u[1] * u[2] - s * u[0]},
        {k * u[0] * u[2] - s * u[1], k * u[1] * u[2] + s * u[0], c + k * u[2] * u[2]}};
    hn_im_snap(out);
    memcpy(R, out, sizeof out);
}

void hn_im_from_quaternion(const double q[4], double R[3][3]) {
    double w = q[0], x = q[1], y = q[2], z = q[3];
    double out[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                        {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                        {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    hn_im_snap(out);
    memcpy(R, out, sizeof out);
}

/// Through the quaternion with its largest entry first (Shepperd 1978): no loss of digits at any
/// angle.
void hn_im_rotation_vector(double R[3][3], double out[3]) {
    double trace = R[0][0] + R[1][1] + R[2][2], q[4];
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = R[i][i] > R[k][k] ? i : k;
    }

    // the largest entry of the quaternion first
    if (trace >= R[k][k]) {
        q[0] = 1 + trace;
        q[1] = R[2][1] - R[1][2];
        q[2] = R[0][2] - R[2][0];
        q[3] = R[1][0] - R[0][1];
    } else {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        q[0] = R[j][i] - R[i][j];
        q[1 + k] = 1 + R[k][k] - R[i][i] - R[j][j];
        q[1 + i] = R[i][k] + R[k][i];
        q[1 + j] = R[j][k] + R[k][j];
    }

    // the half turn that is at most pi
    double sign = q[0] < 0 ? -1 : 1, s = hn_num3_norm(q + 1), angle = 2 * atan2(s, sign * q[0]);
    angle = fmin(angle, PI);
    for (int i = 0; i < 3; i++) {
        out[i] = s > 0 ? sign * q[1 + i] / s * angle + 0.0 : 0;
    }
}

// ---- mass ----

static void to_matrix(const double I[6], double out[3][3]) {
    double M[3][3] = {{I[0], I[3], I[4]}, {I[3], I[1], I[5]}, {I[4], I[5], I[2]}};
    memcpy(out, M, sizeof M);
}

hn_im_mass hn_im_mass_moved(const hn_im_mass *a, const hn_im_frame *at) {
    hn_im_mass out = *a;
    double M[3][3], R[3][3], T[3][3];
    to_matrix(a->I, M);
    memcpy(R, at->R, sizeof R);
    hn_num3_mul(R, M, M);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            T[i][j] = R[j][i];
        }
    }
    hn_num3_mul(M, T, M);
    double I[6] = {M[0][0], M[1][1], M[2][2], M[0][1], M[0][2], M[1][2]};
    double size = fabs(I[0]) + fabs(I[1]) + fabs(I[2]);
    for (int k = 0; k < 6; k++) {
        out.I[k] = fabs(I[k]) <= 4 * ROUNDING * size ? 0 : I[k];
    }
    hn_im_place(at, a->c, out.c);
    return out;
}

/// Tensor of m at the place d, about the origin.
static void add_point(double I[6], double m, const double d[3]) {
    I[0] += m * (d[1] * d[1] + d[2] * d[2]);
    I[1] += m * (d[0] * d[0] + d[2] * d[2]);
    I[2] += m * (d[0] * d[0] + d[1] * d[1]);
    I[3] -= m * d[0] * d[1];
    I[4] -= m * d[0] * d[2];
    I[5] -= m * d[1] * d[2];
}

hn_im_mass hn_im_mass_sum(const hn_im_mass *a, const hn_im_mass *b) {
    hn_im_mass out = {.m = a->m + b->m};
    double da[3], db[3];
    if (out.m == 0) {
        return *a;
    }
    for (int i = 0; i < 3; i++) {
        out.c[i] = (a->m * a->c[i] + b->m * b->c[i]) / out.m;
        da[i] = a->c[i] - out.c[i];
        db[i] = b->c[i] - out.c[i];
    }
    for (int k = 0; k < 6; k++) {
        out.I[k] = a->I[k] + b->I[k];
    }
    add_point(out.I, a->m, da);
    add_point(out.I, b->m, db);
    for (int k = 0; k < 6; k++) {
        out.I[k] += 0.0;
    }
    return out;
}

double hn_im_volume(hn_im_solid solid, const double s[3]) {
    double ball = 4 * PI / 3;
    switch (solid) {
    case HN_IM_SPHERE:
        return ball * s[0] * s[0] * s[0];
    case HN_IM_CAPSULE:
        return 2 * PI * s[0] * s[0] * s[1] + ball * s[0] * s[0] * s[0];
    case HN_IM_CYLINDER:
        return 2 * PI * s[0] * s[0] * s[1];
    case HN_IM_ELLIPSOID:
        return ball * s[0] * s[1] * s[2];
    case HN_IM_BOX:
        break;
    }
    return 8 * s[0] * s[1] * s[2];
}

/// A cylinder between two half balls; the share of each in the mass is that of its volume.
static hn_im_mass capsule(double r, double h, double m) {
    double balls = m * 2 * r / (2 * r + 3 * h), middle = m - balls;
    // a half ball's centre of mass is 3/8 r beyond its flat side: two at h make 2/5 r^2 + h^2 + 3/4
    // h r
    double across = middle * (r * r / 4 + h * h / 3) + balls * (0.4 * r * r + h * h + 0.75 * h * r);
    double along = middle * r * r / 2 + balls * 0.4 * r * r;
    return (hn_im_mass){.m = m, .I = {across, across, along}};
}

hn_im_mass hn_im_solid_mass(hn_im_solid solid, const double s[3], double m) {
    hn_im_mass out = {.m = m};
    double a = s[0] * s[0], b = s[1] * s[1], c = s[2] * s[2];

    // about the centre, by the textbook formula of each solid
    switch (solid) {
    case HN_IM_SPHERE:
        out.I[0] = out.I[1] = out.I[2] = 0.4 * m * a;
        break;
    case HN_IM_CAPSULE:
        return capsule(s[0], s[1], m);
    case HN_IM_CYLINDER:
        out.I[0] = out.I[1] = m * (a / 4 + b / 3);
        out.I[2] = m * a / 2;
        break;
    case HN_IM_ELLIPSOID:
    case HN_IM_BOX: {
        double share = solid == HN_IM_BOX ? m / 3 : m / 5;
        out.I[0] = share * (b + c);
        out.I[1] = share * (a + c);
        out.I[2] = share * (a + b);
        break;
    }
    }
    return out;
}
