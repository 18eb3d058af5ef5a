// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_TABLEAU_H
#define HN_INTEGRATORS_TABLEAU_H
// Explicit Runge-Kutta methods as data. A tableau holds
//
//     k_i = F(t + c_i h, y + h sum_{j<i} a_ij k_j),     y1 = y + h sum_i b_i k_i              (1)
//     err = h sum_i e_i k_i,   e = b - b^ of an embedded solution of lower order              (2)
//
// and, where the method has one, the weights d of its standard continuous extension
// (explicit_rk.h), which may need stages of its own. With a second embedded solution of lower order
// still, its error err2 makes the estimate sharper, entry by entry:
//
//  err |err| / sqrt(err^2 + err2^2 / 100) of the order of h^8 when err = O(h^6), err2 = O(h^4) (3)

#include <stdbool.h>

typedef struct hn_tableau {
    int stages; ///< that y1 needs
    int extra;  ///< stages after those, for dense output only; the first of them is F(t + h, y1)
    int order;  ///< of y1
    int embedded_order, embedded_order2; ///< of the solutions behind e and e2, 0: none
    bool fsal;        ///< the last stage is F(t + h, y1), the first of the next step
    const double *c;  ///< stages + extra
    const double *A;  ///< square of stages + extra, row-major, strictly lower
    const double *b;  ///< stages
    const double *e;  ///< stages, NULL without an embedded solution
    const double *e2; ///< stages, NULL without a second one
    const double *d;  ///< dense_rows x (stages + extra), NULL without dense output
    int dense_rows;
    /// A stage at t + h beside y1: how far its slope is from F(t + h, y1), for the distance of the
    /// two, tells how fast the equation answers. 0: none.
    int stiff_stage;
} hn_tableau;

extern const hn_tableau hn_tableau_euler;  ///< 1 stage, order 1
extern const hn_tableau hn_tableau_heun;   ///< 2 stages, order 2 (Heun 1900)
extern const hn_tableau hn_tableau_rk4;    ///< 4 stages, order 4 (Kutta 1901)
extern const hn_tableau hn_tableau_dopri5; ///< 7 stages, order 5(4), FSAL (Dormand & Prince 1980)
extern const hn_tableau hn_tableau_dop853; ///< 12 + 4 stages, order 8(5,3) (in dop853.c)

#endif
