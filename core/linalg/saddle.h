// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SADDLE_H
#define HN_LINALG_SADDLE_H
// Solves the saddle-point system of constrained motion densely, for every case that the fast sparse
// factor cannot serve: redundant rows, rank lost at a configuration, massless coordinates, extreme
// mass ratios.
//
//     M a = f + J' lambda,  J a + gamma = 0,  i.e. [M J'; J 0] [a; -lambda] = [f; -gamma]     (1)
//
// Method: null space. Equilibrate, M_s = D M D (unit diagonal), J_s = R J D (unit rows), then
// J_s' P = Q [R11 R12; 0 0] by column-pivoted QR, which decides the rank. With T = Q' M_s Q and
// a_s = Q [y; z]:
//
//     R11' y = -(P' gamma_s)_1,  T22 z = (Q' f_s)_2 - T21 y,
//     R11 lambda_1 = T11 y + T12 z - (Q' f_s)_1                                               (2)
//
// Only T22, the mass on ker J, needs to be definite. Rows that depend on others get the multipliers
// of least norm. Iterative refinement follows, always, with residuals summed in twice the working
// precision: it improves the answer itself where light and heavy directions mix, which a small
// residual alone does not promise, and costs less than the factorisation.
// Source: Benzi, Golub & Liesen, Acta Numerica 14 (2005), sec. 6; Skeel 1980; Garcia de Jalon &
// Gutierrez-Lopez 2013.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

/// Scratch for systems up to (nv, nc). Owned by the arena it came from; one per thread.
typedef struct hn_saddle_ws hn_saddle_ws;

/// Options. Start from hn_saddle_opts_default(), then change fields.
typedef struct hn_saddle_opts {
    /// Pivots of the equilibrated J' at or below rank_tol * largest count as 0 [-]; 1e-10, and
    /// never less than 1000 max(nv, nc) eps.
    double rank_tol;
    /// Dependent rows that disagree by more than this contradict each other, relative to the sizes
    /// of gamma, J a and f, all equilibrated [-]; 1e-8. HUGE_VAL: accept the least-squares answer.
    double residual_tol;
    /// Relative error of J and gamma at this state, against the longest row [-]; 0: exact.
    /// Dependent rows contradict each other only where they disagree by more than such an error
    /// explains: noise / (smallest kept pivot), times the stretch of the shortest row.
    double noise;
    /// Size of the accelerations due to the velocities alone, equilibrated (sqrt(M_jj) a_j); 0.
    /// Disagreements are measured against it as well: gamma, J a and f may all vanish at a
    /// configuration where the terms that they are sums of do not.
    double motion;
    /// Rows of J D shorter than this times the longest are not brought to unit length: they stay as
    /// small as they are against it [-]; 0.
    double row_floor;
    const double *row_unit; ///< nc: units in which those lengths are compared, borrowed; NULL: 1
    double refine_tol;      ///< refine until the correction is below this * the solution [-]; 2 eps
    int max_refine;         ///< 4; 0 switches refinement off
    bool want_cond;         ///< estimate the condition number too, about five more solves
} hn_saddle_opts;

/// The result of a factorisation or a solution. rank and pivot_ratio are set unless an input was
/// not finite or M has a negative diagonal entry.
typedef struct hn_saddle_info {
    int rank;              ///< numerical rank of J, 0..nc
    double pivot_ratio;    ///< smallest kept pivot / largest [-]; 1e-10..1e-6: nearly singular
    double dropped;        ///< largest dropped pivot / largest [-]; 0 when none was dropped
    double residual;       ///< max |J a + gamma| [row unit / s^2]
    double backward_error; ///< largest residual of a row of (1) relative to |K| |x| + |b| of it [-]
    int refinements;       ///< refinement steps kept
    /// Estimate of the 1-norm condition of the equilibrated K on the kept rows; 0: not asked for.
    double cond;
} hn_saddle_info;

/// The options that the program uses.
hn_saddle_opts hn_saddle_opts_default(void);
/// NULL when memory is out.
HN_MUST_CHECK hn_saddle_ws *hn_saddle_ws_create(hn_arena *arena, int nv, int nc);

/// Accelerations and multipliers of a constrained system at one instant, eq. (1).
///
/// M      in  (nv x nv) row-major, symmetric positive semidefinite, definite on ker J; lower
///            triangle read
/// J      in  (nc x nv) row-major; rows may be redundant
/// f      in  (nv)      applied + velocity-dependent force          [N | N m]
/// gamma  in  (nc)      Jdot v, plus stabilisation if any           [row unit / s^2]
/// a      out (nv)      generalised acceleration                    [m/s^2 | rad/s^2]
/// lambda out (nc)      J' lambda is the force ON the bodies        [N m per row unit]; may be NULL
///
/// With rank < nc, `a` and J' lambda are unique and lambda is the one of least Euclidean norm.
/// Inputs and outputs must not overlap. `info` and `opts` may be NULL.
/// Cost: about 2 nv nc^2 + 4 nv^2 nc + nv^3 / 3 flops. Allocates nothing.
/// Fails, with a and lambda untouched:
///   HN_ERR_DIVERGED      an input is not finite
///   HN_ERR_NOT_SPD       M has a negative direction on ker J, or a negative diagonal entry
///   HN_ERR_SINGULAR      M vanishes on a direction of ker J
///   HN_ERR_INCONSISTENT  gamma lies outside the range of J
HN_MUST_CHECK hn_status hn_saddle_solve(int nv, int nc, const double *M, const double *J,
                                        const double *f, const double *gamma, double *a,
                                        double *lambda, hn_saddle_info *info,
                                        const hn_saddle_opts *opts, hn_saddle_ws *ws);

/// The same in two parts, for several right-hand sides with one M and J (copied into `ws`).
HN_MUST_CHECK hn_status hn_saddle_factor(int nv, int nc, const double *M, const double *J,
                                         hn_saddle_info *info, const hn_saddle_opts *opts,
                                         hn_saddle_ws *ws);
/// Solves with the factor in `ws`. `info` keeps what the factorisation set and receives the rest.
/// Fails as hn_saddle_solve().
HN_MUST_CHECK hn_status hn_saddle_apply(const double *f, const double *gamma, double *a,
                                        double *lambda, hn_saddle_info *info, hn_saddle_ws *ws);

#endif
