// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_KKT_H
#define HN_LINALG_KKT_H
// The ways to solve the saddle-point system of constrained motion densely, one beside the other:
//
//     M a = f + J' lambda,    J a + gamma = 0                                                  (1)
//
// Each works on the equilibrated system (saddle.h says how) and ends with iterative refinement,
// residuals in twice the working precision, which brings all of them to the same digits where they
// apply at all. Each refuses the matrices that it cannot serve.
//
//   dense        Bunch-Kaufman of K; J of full row rank (the inertia of K tells)
//   range space  M = L L', S = (L^-1 J')' (L^-1 J'), Cholesky of S; M definite, J of full row
//                rank. Squares the conditioning.
//   null space   QR of J', Cholesky of M on ker J; J of full row rank
//   proximal     [M J'; J -mu I], repeated: any J; lambda of least norm, the
//                least-squares a where rows contradict each other
//   least norm   rank-revealing QR (saddle.h): any J; refuses rows that contradict each other
//
// If rows depend on each other, one of the last two can be used. Measured on copied rows, a Bennett
// linkage, and a parallelogram flat and 1e-6 and 1e-3 rad from it: accelerations and J' lambda of
// both agree to 2e-16 of their size, in the same time (1 to 2.6 us). solver=auto uses least norm
// because it says more: the rank; multipliers that are the shortest whatever the scales (the
// proximal ones are so in scaled rows: 3 % longer for Bennett); and where rows contradict each
// other it says so, where the proximal iteration goes on with multipliers 1000 times too long.
//
// Source: Benzi, Golub & Liesen 2005; Carpentier, Budhiraja & Mansard 2021 (proximal); Higham 2002
// (refinement, condition).

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

typedef enum hn_kkt_way {
    HN_KKT_DENSE,
    HN_KKT_RANGE_SPACE,
    HN_KKT_NULL_SPACE,
    HN_KKT_PROXIMAL,
    HN_KKT_LEAST_NORM,
    HN_KKT_WAYS
} hn_kkt_way;

typedef struct hn_kkt_opts {
    int max_refine; ///< corrections at most; 4. Proximal: turns, never below 1
    bool want_cond; ///< estimate the condition number: about five more solves
    double rank_tol, residual_tol, noise, motion, row_floor; ///< as in hn_saddle_opts
    const double *row_unit;                                  ///< likewise
} hn_kkt_opts;
/// The options that the program uses.
hn_kkt_opts hn_kkt_opts_default(void);

typedef struct hn_kkt_info {
    int rank;        ///< of J; nc where it was not looked for
    int massless;    ///< range space refused: the coordinate without mass; else -1
    double residual; ///< max |J a + gamma| [row unit / s^2]
    int refinements; ///< corrections that were kept
    double cond;     ///< 1-norm condition estimate of the equilibrated matrix; 0: not asked for
} hn_kkt_info;

typedef struct hn_kkt hn_kkt;
/// Scratch for systems up to (nv, nc). NULL when memory is out.
HN_MUST_CHECK hn_kkt *hn_kkt_create(hn_arena *arena, int nv, int nc);
/// Solves (1); arguments as for hn_saddle_solve(). Allocates nothing. Fails: HN_ERR_SINGULAR (rows
/// depend on each other and this way does not serve that; a massless coordinate), HN_ERR_NOT_SPD,
/// HN_ERR_INCONSISTENT (least norm only), HN_ERR_DIVERGED (an input is not finite),
/// HN_ERR_NO_CONVERGENCE (proximal); a and lambda are then untouched. `info`, `opts`, `lambda` may
/// be NULL.
HN_MUST_CHECK hn_status hn_kkt_solve(hn_kkt *k, hn_kkt_way way, int nv, int nc, const double *M,
                                     const double *J, const double *f, const double *gamma,
                                     double *a, double *lambda, hn_kkt_info *info,
                                     const hn_kkt_opts *opts);

#endif
