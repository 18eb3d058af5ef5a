// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BENCH_HAND_FOURBAR_H
#define HN_BENCH_HAND_FOURBAR_H
// The reference four-bar FB0 as an expert would write it for this one mechanism.

#include <math.h>

/// FB0 by hand: M, f, J, gamma and the saddle-point solve by elimination, straight-line.
__attribute__((noinline)) static void hn_hand_fourbar(const double *q, const double *w, double *a,
                                                      double *lambda) {
    const double l1 = 1, l2 = 2, l3 = 1.8, m1 = 1, m2 = 2, m3 = 1.8, g = 9.81;
    const double k = m2 * l1 * l2 / 2, M11 = m1 * l1 * l1 / 3 + m2 * l1 * l1,
                 M22 = m2 * l2 * l2 / 3, M33 = m3 * l3 * l3 / 3;
    const double s1 = sin(q[0]), c1 = cos(q[0]), s2 = sin(q[1]), c2 = cos(q[1]), s3 = sin(q[2]),
                 c3 = cos(q[2]);
    const double w1 = w[0] * w[0], w2 = w[1] * w[1], w3 = w[2] * w[2];
    const double c12 = c1 * c2 + s1 * s2, s12 = s1 * c2 - c1 * s2, M12 = k * c12;
    const double f1 = -k * s12 * w2 - g * (m1 / 2 + m2) * l1 * c1,
                 f2 = k * s12 * w1 - g * m2 / 2 * l2 * c2, f3 = -g * m3 / 2 * l3 * c3;
    const double a1 = l1 * c1, b1 = l1 * s1, a2 = l2 * c2, b2 = l2 * s2, a3 = l3 * c3, b3 = l3 * s3;
    // J = [-b1 -b2 b3; a1 a2 -a3], gamma = [-a1 w1 - a2 w2 + a3 w3; -b1 w1 - b2 w2 + b3 w3]
    const double gx = a3 * w3 - a1 * w1 - a2 * w2, gy = b3 * w3 - b1 * w1 - b2 * w2;
    // M^-1 J', the two by two block of th1 and th2 by its inverse
    const double r = 1 / (M11 * M22 - M12 * M12), i11 = M22 * r, i12 = -M12 * r, i22 = M11 * r,
                 i33 = 1 / M33;
    const double x1 = -(i11 * b1 + i12 * b2), x2 = -(i12 * b1 + i22 * b2), x3 = i33 * b3;
    const double y1 = i11 * a1 + i12 * a2, y2 = i12 * a1 + i22 * a2, y3 = -i33 * a3;
    const double z1 = i11 * f1 + i12 * f2, z2 = i12 * f1 + i22 * f2, z3 = i33 * f3;
    const double Sxx = b3 * x3 - b1 * x1 - b2 * x2, Sxy = b3 * y3 - b1 * y1 - b2 * y2,
                 Syy = a1 * y1 + a2 * y2 - a3 * y3;
    const double rx = -gx - (b3 * z3 - b1 * z1 - b2 * z2), ry = -gy - (a1 * z1 + a2 * z2 - a3 * z3);
    const double d = 1 / (Sxx * Syy - Sxy * Sxy);
    lambda[0] = (Syy * rx - Sxy * ry) * d;
    lambda[1] = (Sxx * ry - Sxy * rx) * d;
    a[0] = z1 + x1 * lambda[0] + y1 * lambda[1];
    a[1] = z2 + x2 * lambda[0] + y2 * lambda[1];
    a[2] = z3 + x3 * lambda[0] + y3 * lambda[1];
}
#endif
