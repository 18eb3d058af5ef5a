#ifndef HN_FORMULATIONS_FLOPS_H
#define HN_FORMULATIONS_FLOPS_H
// Arithmetic operations (additions and multiplications each count one) of the dense linear algebra that methods do
// beside their tapes. Leading terms as in Golub & Van Loan 2013; exact enough to compare methods, free of timing noise.

#include "formulations/ground/formulation.h"

double hn_flops_qr(int m, int n);       ///< Householder QR with pivoting, m x n
double hn_flops_qr_solve(int m, int n); ///< Q' b and R^-1
double hn_flops_cholesky(int n);
double hn_flops_cholesky_solve(int n);
double hn_flops_product(int m, int k, int n); ///< (m x k) (k x n)
/// the dense rank-revealing solve of linalg/saddle.h, one refinement
double hn_flops_saddle(int nv, int nc);

/// sum += part, field by field.
void hn_cost_add(hn_cost *sum, const hn_cost *part);
/// what lies between two readings: after - before
hn_cost hn_cost_between(const hn_cost *before, const hn_cost *after);

#endif
