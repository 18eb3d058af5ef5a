// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_MECHANISM_H
#define HN_SUPPORT_MECHANISM_H
// Random mechanisms, and their motion worked out the plain way: every body in world axes, body by
// body, numbers only. What the compiler of dynamics/ finds by other means must agree with this.

#include "base/arena.h"
#include "scene/scene.h"

typedef struct mechanism_opts {
    unsigned seed;
    int n_bodies, n_cuts; ///< a cut joint is placed so that it is closed at q0 of the coordinates
    double parallel;      ///< share of joints whose axis is parallel to the joint below [-]
    double prismatic;     ///< share of prismatic joints [-]
    /// share of joints of any type, in the tree and among the cuts (there all but free) [-]
    double mixed;
    int planar; ///< all axes along z (prismatic: across), everything in the plane
} mechanism_opts;

/// Tree joint i carries body i; the cut joints follow, and so do their coordinates. Memory from the
/// arena.
hn_scene *mechanism_random(hn_arena *arena, const mechanism_opts *opts);

typedef struct body_motion {
    double R[3][3], p[3];           ///< body axes to world; origin
    double w[3], v[3], al[3], a[3]; ///< at zero second derivatives of the coordinates
} body_motion;

/// Coordinates of the tree joints: the first so many.
int mechanism_coordinates(const hn_scene *scene);
/// Motion of all bodies for the coordinates of the tree joints (q: rotation vectors; qd: angular
/// velocities in the child's axes).
void mechanism_move(const hn_scene *scene, const double *q, const double *qd, body_motion *out);
/// World place, velocity and acceleration of a point in a body's own axes (HN_GROUND: fixed).
void mechanism_point(const body_motion *bodies, int body, const hn_quantity *at, double x[3],
                     double v[3], double a[3]);
/// Mass matrix (n x n) and h (n: Coriolis, centrifugal and gravity) in scene coordinates, and the
/// energies.
void mechanism_terms(const hn_scene *scene, const double *q, const double *qd, double *M, double *h,
                     double *kinetic, double *potential);
/// Uniform in -1 .. 1.
double random_signed(unsigned *seed);
#endif
