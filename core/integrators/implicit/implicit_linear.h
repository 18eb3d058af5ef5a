// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_LINEAR_H
#define HN_INTEGRATORS_IMPLICIT_LINEAR_H
// The linear systems of Newton's method on a differential-algebraic system (implicit_dae.h), with s
// in the place of d/dt:
//
//  s x - w - Y m = -r1, s M w + K x + C w - J' l = -r2, J x = -r3 | V x + J w = -r3 | both (1)
//
// With w = s x + r1 - Y m and, M Y = J', l' = l + s m, what has to be factored is a saddle-point
// matrix of the size nv + nc,
//
//     [M + C/s + (K - C Y S^-1 V)/s^2,  -J';  J (+ V/s),  0] [x; l'/s^2],    S = J Y          (2)
//
// (V/s: index 2; the term with S: GGL, m = S^-1 (V x + r3' + J r1 - s r3)). In these unknowns, h^2
// times the multipliers, its condition does not depend on the step. Rows of J that depend on others
// are left out, and their multipliers stay as they are. Source: Bottasso, Dopico & Trainelli 2008,
// on the scaling of index three equations.
//
// Large mechanisms: Y, S and with them (2) of GGL are full. There p = Y m stays an unknown of its
// own,
//
//     [M + C/s + K/s^2   -J'   -C/s     .  ] [ x      ]
//     [J                  .      .      .  ] [ l'/s^2 ]
//     [.                  .      M     -J' ] [ p/s    ]
//     [V/s                .     -J      .  ] [ m/s    ]                                       (3)
//
// and every block is as sparse as the mechanism (linalg/newton_matrix.h).

#include "base/arena.h"
#include "dynamics/evaluate/linearise.h"
#include "formulations/ground/formulation.h"
#include "integrators/implicit/stages.h"
#include "linalg/newton_matrix.h"
#include "linalg/qr.h"
#include "linalg/row_check.h"
#include "linalg/sparse_spd.h"

#include <stdbool.h>

typedef struct hn_implicit_linear {
    hn_dae_form form;
    bool stabilised; ///< GGL: mu holds the velocities
    int nv, nc;
    hn_linear *terms;                ///< M K C J V R at the start of the step
    const double *M, *K, *C, *J, *V; ///< whole matrices; NULL where it is sparse and they are lists
    bool has_damping;                ///< C is not identically zero
    bool sparse;
    int n_kept, *kept;
    int *place;          ///< nc: which of the kept rows this is; -1: left out
    hn_row_check *check; ///< NULL: the pivoted QR always chooses
    double *unit;        ///< nc: 1 / length of a row
    double *column_unit; ///< nv: see hn_system_velocity_unit
    double *seen;        ///< nc: the longest it has been
    hn_qr qr;
    double *Y, *S, *damped; ///< GGL, dense: nv x nc; n_kept x n_kept factored; C Y S^-1 V (nv x nv)
    const hn_system *sys;
    double *mass_unit;          ///< nv: powers of two, see implicit_linear.c
    double *diagonal;           ///< nv: of M
    double *mass;               ///< nv x nv factored
    hn_sparse_spd *mass_factor; ///< GGL, sparse
    int *lower;                 ///< which entries of M's pattern are in its lower triangle
    int n_lower;
    double *lower_values;
    hn_newton_matrix *matrix[2]; ///< real, complex
    double *packed, *packed_rows;
    double s[2][2]; ///< of the real and the complex matrix
    double *work[2][5];
    double ops; ///< of what is not in `terms`, `matrix` and `check`
} hn_implicit_linear;

/// Compiles the matrix of Newton's method; end with hn_implicit_linear_free(). Fails:
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_implicit_linear_init(hn_implicit_linear *l, const hn_system *sys,
                                                hn_dae_form form, hn_arena *arena);
void hn_implicit_linear_free(hn_implicit_linear *l);
/// Chooses the rows that stand on their own at a pose: to be called where the loops are closed,
/// because rows that depend on others do so only there. Returns the smallest pivot that was kept,
/// of the largest.
double hn_implicit_linear_choose(hn_implicit_linear *l, double t, const double *q, const double *v);
/// Evaluates the terms with the rows chosen before. Fails with HN_ERR_SINGULAR where the mass
/// matrix does (GGL only), HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_implicit_linear_at(hn_implicit_linear *l, double t, const double *q,
                                              const double *v, const double *a,
                                              const double *lambda);
/// Factors matrix (2) or (3) for s = re + i im; `which`: 0 the real one, 1 the complex one
/// (hn_stage_equations). Solving: implicit_linear_solve.h.
HN_MUST_CHECK hn_status hn_implicit_linear_factor(hn_implicit_linear *l, int which, double re,
                                                  double im);
/// out (nv) = Y m, m (nc): what mu adds to the rate of the displacement (GGL only).
void hn_implicit_linear_push(hn_implicit_linear *l, const double *m, double *out);
/// Matrix (2) for a real s, row-major of size nv + n_kept, as it is factored when it is dense; for
/// reports on its condition.
void hn_implicit_linear_matrix(hn_implicit_linear *l, double s, double *out);
/// Arithmetic operations so far.
double hn_implicit_linear_ops(const hn_implicit_linear *l);

#endif
