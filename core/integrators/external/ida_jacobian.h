// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IDA_JACOBIAN_H
#define HN_INTEGRATORS_IDA_JACOBIAN_H
// The matrix of IDA's Newton iteration, dF/dy + c dF/dy', for the residual of ida_problem.h, from
// exact derivatives of the equations of motion:
//
//            q                         v               lambda    mu
//     (1)    c - (G v)_q               -G
//       mu   c M                       -M                        -J'
//     (2)    K                         C + c M         -J'
//     (3)    gamma_q + (J v')_q        gamma_v + c J                       INDEX1
//            + 2 alpha V + beta^2 J    + 2 alpha J                         STABILISED
//            V                         J                                   INDEX2, GGL
//            J                                                             INDEX3, GGL        (4)
//
// With mu the first block leaves out (M (q' - v) - J' mu)_q: both factors vanish with the error.
// If a joint has more coordinates than speeds, derivatives along the speeds are spread over the
// coordinates by the pseudo-inverse of G, and the direction that changes the length of a quaternion
// is left out; the iteration converges as before, because no correction goes there.

#include "dynamics/evaluate/linearise.h"
#include "integrators/external/ida_problem.h"
#include "linalg/compressed.h"

#include <stdbool.h>

typedef struct hn_ida_sparse {
    hn_compressed places;
    double *values;
} hn_ida_sparse;

typedef struct hn_ida_jacobian {
    const hn_ida_problem *problem;
    hn_linear *terms;
    hn_linear *turn;             ///< V alone, for (J v')_q = V(v') - V(0); NULL where not needed
    int offset;                  ///< V(0) is not zero
    double *G, *Gp;              ///< nq x nv and nv x nq; NULL when nq == nv
    double *unit, *rate, *still; ///< nq + nv scratch each
    double *A;                   ///< what is being filled, when it is full
    hn_ida_sparse *sparse;       ///< NULL: the matrix is full
    double *lambda;              ///< nc
    long long count;
} hn_ida_jacobian;

/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_ida_jacobian_init(hn_ida_jacobian *j, const hn_ida_problem *problem,
                                             hn_arena *arena);
void hn_ida_jacobian_free(hn_ida_jacobian *j);
/// Fills A (n x n, column by column).
void hn_ida_jacobian_fill(hn_ida_jacobian *j, double t, double c, const double *y,
                          const double *ydot, double *A);
/// Returns whether the matrix is large and has few entries: it is then filled in compressed columns
/// with at most so many entries. Their places are the same from one filling to the next as long as
/// the rows that are kept are.
bool hn_ida_jacobian_is_sparse(const hn_ida_jacobian *j);
int hn_ida_jacobian_puts(const hn_ida_jacobian *j);
/// The places, and the values of their entries (borrowed).
const hn_compressed *hn_ida_jacobian_fill_sparse(hn_ida_jacobian *j, double t, double c,
                                                 const double *y, const double *ydot,
                                                 const double **values);
double hn_ida_jacobian_ops(const hn_ida_jacobian *j); ///< arithmetic operations of one

#endif
