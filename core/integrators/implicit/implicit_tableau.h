// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_TABLEAU_H
#define HN_INTEGRATORS_IMPLICIT_TABLEAU_H
// Collocation methods, given by their nodes: with l_j the Lagrange polynomials of the nodes,
//
//     a_ij = integral of l_j from 0 to c_i,   b_j = integral of l_j from 0 to 1               (1)
//
// and what makes Newton's method cheap: a basis in which A^-1 falls apart into one real number and
// a pair of complex ones,
//
//     T^-1 A^-1 T = diag(gamma, [alpha beta; -beta alpha])                                    (2)
//
// so that the stages are solved for with one real and one complex matrix of the size of a single
// stage (real: odd number of stages; complex: two or three). Source: Hairer & Wanner 1996, sections
// IV.5 and IV.8.

#include <stdbool.h>

enum { HN_IMPLICIT_STAGES = 3 };

typedef struct hn_collocation {
    int stages, order;
    double c[HN_IMPLICIT_STAGES];
    double A[HN_IMPLICIT_STAGES][HN_IMPLICIT_STAGES];
    double A_inverse[HN_IMPLICIT_STAGES][HN_IMPLICIT_STAGES];
    double b[HN_IMPLICIT_STAGES];
    double end[HN_IMPLICIT_STAGES]; ///< b A^-1: y1 = y0 + sum end_i Z_i
    double T[HN_IMPLICIT_STAGES][HN_IMPLICIT_STAGES],
        T_inverse[HN_IMPLICIT_STAGES][HN_IMPLICIT_STAGES];
    int n_real, n_pairs; ///< blocks of (2): n_real + 2 n_pairs = stages, the real one first
    double gamma, alpha, beta;
    /// With error weights e: F(y0) + sum e_i Z_i / h, brought back by the real Newton matrix,
    /// estimates the error.
    bool has_error;
    double e[HN_IMPLICIT_STAGES];
} hn_collocation;

/// From 1 to 3 different nodes in (0, 1].
void hn_collocation_init(hn_collocation *col, int stages, int order, const double *c);
/// Returns the factor for an error estimate of order 4 in h by which the solution, of order 5, is
/// as accurate as asked for and no more: rtol over 0.1 rtol^(2/3), not above 1. Source: Hairer &
/// Wanner 1996, the program RADAU5.
double hn_collocation_estimate_weight(double rtol);
/// Returns the share of the tolerance, widened by that factor, that Newton's method may leave as an
/// error (same source).
double hn_collocation_newton_share(double rtol);
/// Values of the Lagrange polynomials of the nodes at x (stages entries).
void hn_collocation_basis(const hn_collocation *col, double x, double *l);
/// Weights of the Z_i in y(t + theta h) - y0, the polynomial through 0 and the stages.
void hn_collocation_dense(const hn_collocation *col, double theta, double *w);

#endif
