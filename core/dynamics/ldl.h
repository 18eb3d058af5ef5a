#ifndef HN_DYNAMICS_LDL_H
#define HN_DYNAMICS_LDL_H
// The sparse LDL' of the saddle-point matrix as expressions.
//
//     K = [A J'; J 0],   K [x; -y] = [r1; r2],   A symmetric, structurally as given                    (1)
//
// The order is static, chosen once from the pattern alone: minimum degree, and
//   * a multiplier comes only after every speed it touches that can be a pivot, so its pivot is a piece of -J A^-1 J';
//   * a speed without inertia comes after a multiplier that gives it a pivot;
//   * two multipliers of one loop that are ready together form a 2 x 2 pivot: one division in a row fewer.
// No pivoting at run time: each pivot that could be lost has a guard, |pivot| >= HN_PIVOT_GUARD |reference|, to be checked after
// evaluation. Source: Bunch & Kaufman 1977 for the pivots, Benzi, Golub & Liesen 2005 sec. 5 for the matrix.

#include "base/arena.h"
#include "expr/graph.h"

/// Pattern and entries of K. A: nv x nv, J: nc x nv, both row-major; the lower triangle of A is read.
typedef struct hn_ldl_input {
    int nv, nc;
    const hn_ex *A, *J;
    const int *row_loop; ///< nc: rows of one loop may form a 2 x 2 pivot; NULL: 1 x 1 only
} hn_ldl_input;

/// A pivot that can be lost, and what to measure it by.
typedef struct hn_ldl_guard {
    hn_ex pivot, reference;
} hn_ldl_guard;

/// K = L D L' in the order of `order`. Unknown u < nv is speed u, nv + i is multiplier i (with its sign turned).
typedef struct hn_ldl {
    int n; ///< nv + nc
    int nv, nc;
    int available; ///< 0: no static order exists (nothing else is set then)
    int n_blocks;
    int *block;     ///< n_blocks + 1: places in `order` where blocks begin
    int *order;     ///< n unknowns in order of elimination
    int *start;     ///< n + 1: entries of the column at each place
    int *row;       ///< unknown of each entry
    hn_ex *L;       ///< entries below the diagonal blocks
    hn_ex *inverse; ///< 3 per block: 1/d, 0, 0 or the inverse of the 2 x 2 block, xx xy yy
    int n_guards;
    hn_ldl_guard *guards;
} hn_ldl;

/// Everything in `out` from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ldl_factor(hn_graph *g, const hn_ldl_input *in, hn_arena *arena,
                                      hn_ldl *out);

/// The solution of (1) as expressions: x (nv) and y (nc) for r1 (nv), r2 (nc). `work` holds n expressions.
void hn_ldl_solve(hn_graph *g, const hn_ldl *f, const hn_ex *r1, const hn_ex *r2, hn_ex *x,
                  hn_ex *y, hn_ex *work);

/// The same in numbers: L and inverse evaluated (arrays in the order of f->L and f->inverse). r1 or r2 NULL: zero. y may be
/// NULL. `work` holds n doubles. Inputs and outputs may be the same arrays.
void hn_ldl_solve_numbers(const hn_ldl *f, const double *L, const double *inverse, const double *r1,
                          const double *r2, double *x, double *y, double *work);
#endif
