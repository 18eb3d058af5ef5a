// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_TANGENT_SPACE_H
#define HN_FORMULATIONS_TANGENT_SPACE_H
// The tangent space of the closed mechanism at one state, with an orthonormal basis, and what lies
// near it. At the state (t0, q0), the base, with W^1/2 = diag(scale_j), unit_scales.h, for measure
// (metres and radians become comparable):
//
//     J N0 = 0,   N0' W^-1 N0 = I,   Y0' W^-1 Y0 = I,   N0' W^-1 Y0 = 0                       (1)
//
// by pivoted QR of W^1/2 J'. Elsewhere speeds are written with the basis that keeps its part along
// N0:
//
// v = N u + s,   N = N0 - Y0 (J Y0)^-1 J N0,   s = -Y0 (J Y0)^-1 phi_t,  so  u = N0' W^-1 v  (2) a
// = N u' + c,  c = -Y0 (J Y0)^-1 gamma,      (N' M N) u' = N' (f - M c)                 (3)
//
// At the base N is orthonormal and turns by no more than it must, N0' W^-1 N' = 0: parallel
// transport. Aligning an orthonormal basis at each stage instead, by Procrustes, differs from (2)
// by terms of second order in the step, and its rate is not -J^+ gamma once there are two freedoms
// or more: an integrator of order 4 would fall to order 2. The rate of (2) is exact.
//
// Redundant rows: Y0 has rank J columns and (J Y0) is solved in the least-squares sense, which for
// consistent rows is exact. Source: Kim & Vanderploeg 1986; Liang & Lance 1987; Potra & Rheinboldt
// 1991; polar factors in Golub & Van Loan 2013, 6.4.

#include "dynamics/evaluate/eval.h"
#include "formulations/ground/formulation.h"
#include "formulations/ground/reduced_mass.h"
#include "linalg/qr.h"

#include <stdbool.h>

enum { HN_TSPACE_TEXT = 240 };

typedef struct hn_tspace {
    const hn_system *sys;
    int nq, nv, nc;
    int rank, r; ///< r = nv - rank; -1 before the first base
    hn_eval *loop, *full, *mass;
    hn_mass_entries M_at;
    int n_J;
    const int *J_row, *J_col;
    double length; ///< characteristic length [m]

    // the base
    bool has_base;
    double t0;
    double *q0;        ///< nq
    double *scale;     ///< nv: W^1/2
    double *N0, *Y0;   ///< nv x r, nv x rank, row-major
    double pivot0;     ///< smallest pivot of J Y0 there
    hn_qr base_qr;     ///< of W^1/2 J', nv x nc
    double *new_scale; ///< scratch

    // where equations (2) and (3) were last taken
    bool valid;
    double t;
    double *q;      ///< nq
    hn_qr jy;       ///< J Y0, nc x rank
    double *N, *s;  ///< nv x r, nv
    double gap;     ///< ||phi||
    double *JN, *X; ///< nc x r, rank x r
    double *b, *x;  ///< nv + nc each
    double *c, *force, *MN, *A;
    hn_cost cost;
    char why[HN_TSPACE_TEXT];
} hn_tspace;

/// Compiles what the basis needs; end with hn_tspace_destroy(). Fails: HN_ERR_MEMORY, reported in
/// diag.
HN_MUST_CHECK hn_status hn_tspace_init(hn_tspace *ts, const hn_system *sys, hn_arena *arena,
                                       hn_diag *diag);
void hn_tspace_destroy(hn_tspace *ts);

/// Describes how the new base gets its N0: by QR, signs and order as they come, or from N at the
/// same place, made orthonormal again (only where (t, q) was the last place located).
typedef enum hn_tspace_basis { HN_TSPACE_FRESH, HN_TSPACE_CARRIED } hn_tspace_basis;
/// Makes (t, q) the base. HN_ERR_CHART when the rank of J is not what it was, HN_ERR_DIVERGED when
/// q is not finite; the base is then the old one.
HN_MUST_CHECK hn_status hn_tspace_set_base(hn_tspace *ts, double t, const double *q,
                                           hn_tspace_basis basis);
/// Returns whether the base is at (t, q).
bool hn_tspace_base_is_at(const hn_tspace *ts, double t, const double *q);

/// N and s at (t, q), closed or not; nothing is done when they are there already. HN_ERR_CHART when
/// J Y0 is singular there.
HN_MUST_CHECK hn_status hn_tspace_locate(hn_tspace *ts, double t, const double *q);
/// Adds Y0 eta to `delta` (nv) such that q (nq) = `from` moved by delta closes the loops to `tol`
/// [of the characteristic length], or as far as rounding allows; then as hn_tspace_locate. `from`
/// must not be q. HN_ERR_CHART: no such eta was found.
HN_MUST_CHECK hn_status hn_tspace_close(hn_tspace *ts, double t, const double *from, double *delta,
                                        double *q, double tol);
#define HN_TSPACE_TOL 1e-13      ///< inside a step
#define HN_TSPACE_TOL_FINE 5e-16 ///< at its end

/// v = N u + s, and u = N0' W^-1 v (for v of any kind the nearest in this measure).
void hn_tspace_speeds(const hn_tspace *ts, const double *u, double *v);
void hn_tspace_coordinates(const hn_tspace *ts, const double *v, double *u);
/// u' of (3) at the place last located, with speeds v.
HN_MUST_CHECK hn_status hn_tspace_accel(hn_tspace *ts, const double *v, double *u_dot);

/// Adds what its tapes and factorisations have cost so far.
void hn_tspace_add_cost(const hn_tspace *ts, hn_cost *cost);

#endif
