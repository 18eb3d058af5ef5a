// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PRECISE_H
#define HN_STUDY_PRECISE_H
// A motion in extended precision (long double: 64 bits of mantissa on x86). Two computations are
// offered; they have the model's terms in common (precise_model.h) and nothing else:
//
//     saddle@extrapolation   the saddle system whole, by elimination; extrapolated midpoint steps;
//                            after each step the change of least kinetic energy that closes the
//                            loops
//     nullspace@gauss10      the equations on an orthogonal basis of the null space of J; Gauss
//                            collocation of order 20; the shortest change that closes the loops
//
// Steps end at the corners of loads given as tables, and at every time that is looked at.

#include "base/diag.h"
#include "study/run/walk.h"

typedef enum hn_precise_kind { HN_PRECISE_SADDLE, HN_PRECISE_NULLSPACE } hn_precise_kind;

/// "saddle@extrapolation in long double"; static text.
const char *hn_precise_name(hn_precise_kind kind);

/// From the assembled state (q, v) in system coordinates, its loops first closed to 1e-18, to T;
/// `see` gets the samples at T k / n, k = 0..n, of which t, q, v, lambda, kinetic, potential and
/// energy are set; it is called from k = 0 again when a tolerance has to be loosened. *end tells
/// OVER and STOPPED apart. Fails, told in diag: HN_ERR_SINGULAR, HN_ERR_NO_CONVERGENCE,
/// HN_ERR_STEP_UNDERFLOW, HN_ERR_DIVERGED, HN_ERR_STOPPED, HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_precise_walk(hn_precise_kind kind, const hn_system *sys, const double *q,
                                        const double *v, double T, int n,
                                        const hn_walk_limits *limits, hn_walk_see see, void *user,
                                        hn_walk_end *end, hn_diag *diag);
#endif
