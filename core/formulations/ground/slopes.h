// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_SLOPES_H
#define HN_FORMULATIONS_SLOPES_H
// The object behind accel_jacobian.h, and the products and matrix entries that its derivatives
// (accel_jacobian.c) and its Newton systems (accel_newton.c) have in common.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/linearise.h"
#include "formulations/ground/accel_jacobian.h"
#include "linalg/newton_matrix.h"
#include "linalg/qr.h"

#include <stdbool.h>

enum { HN_SLOPES_REAL, HN_SLOPES_COMPLEX, HN_SLOPES_RESTING, HN_SLOPES_MATRICES }; // the last: (2)

/// Four entries of q from `position`, three speeds from `speed`.
typedef struct hn_ball_place {
    int position, speed;
} hn_ball_place;

struct hn_accel_jacobian {
    const hn_system *sys;
    int nq, nv, nc, n_balls, has_time;
    bool stabilised, gives;
    hn_ball_place *balls;
    int *at;      ///< nv: entry of q, -1 for the speeds of a ball
    int *ball_of; ///< nv: which ball, -1: none
    hn_accel *accel;
    hn_linear *terms, *twist; ///< twist: V alone, for (J a)_q = V(a) - V(0)
    hn_accel_law law;
    const double *q, *v; ///< copies
    const double *pose;  ///< q with quaternions of length 1
    double *unit;
    double *state, *a, *lambda;
    double *twisted;           ///< per entry of V's pattern: (J a)_q
    int n_kept, *kept, *place; ///< rows in use, and which of them a row is, -1: left out
    int may_combine, combined; ///< 1: rows in use are combinations, columns of W
    double *whole_M, *whole_J; ///< nv x nv, nc x nv: M and J where rows are chosen, else zero
    double *W;                 ///< nc x n_kept
    hn_qr qr;                  ///< nc x nv and nv x nc
    hn_newton_matrix *matrix[HN_SLOPES_MATRICES];
    hn_complex s[2];
    double *packed, *work[2][4]; ///< 2 (nv + nc); nv + nc each
    long long evals;
    double product_ops; ///< of the products on the right of (3)
    double ops;
};

/// out (nv or nc) += k X x for a term X of `terms`.
void hn_slopes_add_term(const hn_accel_jacobian *j, hn_linear_term term, double k, const double *x,
                        double *out);
/// out (nc) -= B_q x
void hn_slopes_subtract_by_position(const hn_accel_jacobian *j, const double *x, double *out);
/// Destination of terms in a matrix: all rows of the square terms, the rows in use of the others.
typedef struct hn_slopes_target {
    hn_newton_matrix *to;
    int rows_from; ///< first row; of constraint rows: nv
    bool by_row;   ///< rows are constraints
} hn_slopes_target;

/// Puts entry (row, col) of a term at its destination.
void hn_slopes_put_entry(const hn_accel_jacobian *j, const hn_slopes_target *at, int row, int col,
                         hn_complex e);
/// Puts k X, the columns of X along the velocities.
void hn_slopes_put_term(const hn_accel_jacobian *j, const hn_slopes_target *at, hn_linear_term term,
                        hn_complex k);
/// Begins a matrix with the part that (2) and (3) share.
void hn_slopes_put_saddle(const hn_accel_jacobian *j, hn_newton_matrix *to);
/// (nv) and the rows in use of (nc) into the packed right side, as part 0 or 1 of so many.
void hn_slopes_pack(hn_accel_jacobian *j, int parts, int part, const double *top,
                    const double *rows);

#endif
