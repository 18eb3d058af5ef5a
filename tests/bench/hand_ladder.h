// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BENCH_HAND_LADDER_H
#define HN_BENCH_HAND_LADDER_H
// The ladder of N four-bars (scene n-four-bar, all bars of 1 m and 1 kg) as an expert would write
// it: one sweep along the loops that eliminates a vertical, its coupler and their two multipliers,
// and one sweep back. Its cost for each loop does not depend on N.

#include <math.h>

enum { HN_HAND_LADDER_MOST = 1000 };

/// Describes what the sweep back needs of a loop: accelerations of the left vertical (1) and of the
/// coupler (2) are z + x lx + y ly; the multipliers are l - m times the acceleration of the right
/// vertical.
typedef struct hn_hand_loop {
    double x1, x2, y1, y2, z1, z2, lx, ly, mx, my;
} hn_hand_loop;

/// A vertical as the loops on its left leave it: inertia and moment, sine and cosine, rate squared.
typedef struct hn_hand_vertical {
    double mass, moment, s, c, ww;
} hn_hand_vertical;

/// Eliminates the loop between vertical `a` and the next one, whose own inertia and moment are in
/// `b`; the coupler lies at `angle` and turns at the rate `w`.
static inline void hn_hand_loop_eliminate(const hn_hand_vertical *a, double angle, double w,
                                          hn_hand_vertical *b, hn_hand_loop *out) {
    const double g = 9.81, half = 0.5, third = 1.0 / 3;
    const double s = sin(angle), c = cos(angle), ww = w * w;
    const double cross = half * (a->c * c + a->s * s), turn = half * (a->s * c - a->c * s);
    const double f1 = a->moment - turn * ww, f2 = turn * a->ww - g * half * c;
    const double gx = b->c * b->ww - a->c * a->ww - c * ww;
    const double gy = b->s * b->ww - a->s * a->ww - s * ww;

    // the two by two block of vertical and coupler by its inverse
    const double r = 1 / (a->mass * third - cross * cross);
    const double i11 = third * r, i12 = -cross * r, i22 = a->mass * r;
    const double x1 = -(i11 * a->s + i12 * s), x2 = -(i12 * a->s + i22 * s);
    const double y1 = i11 * a->c + i12 * c, y2 = i12 * a->c + i22 * c;
    const double z1 = i11 * f1 + i12 * f2, z2 = i12 * f1 + i22 * f2;

    // the multipliers, but for the acceleration of the right vertical
    const double Sxx = -a->s * x1 - s * x2, Sxy = -a->s * y1 - s * y2, Syy = a->c * y1 + c * y2;
    const double rx = -gx + a->s * z1 + s * z2, ry = -gy - a->c * z1 - c * z2;
    const double d = 1 / (Sxx * Syy - Sxy * Sxy);
    const double lx = (Syy * rx - Sxy * ry) * d, ly = (Sxx * ry - Sxy * rx) * d;
    const double mx = (Syy * b->s + Sxy * b->c) * d, my = -(Sxx * b->c + Sxy * b->s) * d;
    b->mass += b->s * mx - b->c * my;
    b->moment += b->s * lx - b->c * ly;
    *out = (hn_hand_loop){x1, x2, y1, y2, z1, z2, lx, ly, mx, my};
}

/// q, v, a: absolute angles of the verticals 0 .. n, then of the couplers 1 .. n; lambda: two a
/// loop.
__attribute__((noinline)) static void hn_hand_ladder(int n, const double *q, const double *v,
                                                     double *a, double *lambda) {
    static hn_hand_loop loops[HN_HAND_LADDER_MOST];
    const double g = 9.81;
    hn_hand_vertical left, right = {0};
    for (int k = 0; k <= n; k++) {
        const double coupler = k < n ? 1 : 0; // the next coupler hangs on all but the last
        left = right;
        right = (hn_hand_vertical){
            .mass = 1.0 / 3 + coupler, .s = sin(q[k]), .c = cos(q[k]), .ww = v[k] * v[k]};
        right.moment = -g * (0.5 + coupler) * right.c;
        if (k > 0) {
            hn_hand_loop_eliminate(&left, q[n + k], v[n + k], &right, &loops[k - 1]);
        }
    }
    a[n] = right.moment / right.mass;
    for (int k = n; k > 0; k--) {
        const hn_hand_loop *l = &loops[k - 1];
        const double lx = l->lx - l->mx * a[k], ly = l->ly - l->my * a[k];
        lambda[2 * k - 2] = lx;
        lambda[2 * k - 1] = ly;
        a[k - 1] = l->z1 + l->x1 * lx + l->y1 * ly;
        a[n + k] = l->z2 + l->x2 * lx + l->y2 * ly;
    }
}
#endif
