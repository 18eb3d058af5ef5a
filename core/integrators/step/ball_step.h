// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_BALL_STEP_H
#define HN_INTEGRATORS_BALL_STEP_H
// Variational steps on the group of turns, for the balls of a system. A ball goes from R0 to R1 =
// R0 exp(D) through the middle R0 exp(D / 2); its three entries X of the momentum M w and F of L_q
// are those at the middle, in the ball's own axes. With x = [D x], and both ends varied in their
// own axes, the discrete Lagrangian h L(middle, D / h) gives the momenta
//
//     p0 = x e^x / (e^x - 1) X - h/2 (1 + tanh(x / 4)) F,      p1 = p0 - D x X + h F          (1)
//     x e^x / (e^x - 1) = 1 + x / 2 + c x^2,  c = (1 - a/2 cot(a/2)) / a^2;
//     tanh(x / 4) = tan(a / 4) / a x;   a = |D|
//
// exactly. The map is symmetric, and of a free body R p is kept. Coordinates that are no ball's
// have x = 0 in (1). Source: Marsden & West 2001; Bou-Rabee & Marsden 2009 (the trivialised
// differential of exp and its inverse).

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "linalg/newton_matrix.h"

typedef struct hn_ball_step {
    const hn_system *sys;
    int nv, n;  ///< n: balls
    int *speed; ///< n: first of each ball's speeds
    int *owner; ///< nv: the first speed of the ball that this speed belongs to; -1: none
} hn_ball_step;

/// Memory for the balls of a mechanism, in the arena. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ball_step_init(hn_ball_step *b, const hn_system *sys, hn_arena *arena);
/// The largest angle of a ball in D (nv) [rad].
double hn_ball_step_angle(const hn_ball_step *b, const double *D);
/// out (nv) += what p0 + h/2 F - X of (1) has for balls alone.
void hn_ball_step_leave(const hn_ball_step *b, double h, const double *D, const double *X,
                        const double *F, double *out);
/// out (nv) += -D x X.
void hn_ball_step_turn(const hn_ball_step *b, const double *D, const double *X, double *out);
/// Entries of a Newton matrix for h p0 of (1) by D, where hn_lagrange_matrices() has M (nv x nv) at
/// the n_pattern places: those of 1/2 D x X, to the first order in D. At most 2 n_pattern + 6 n.
void hn_ball_step_put(const hn_ball_step *b, double h, const double *D, const double *X,
                      const double *M, int n_pattern, const int *rows, const int *cols,
                      hn_newton_matrix *to);
/// q (nq) moved by D, of which each plain entry is added with the rounding kept in `low` (nv).
void hn_ball_step_move(const hn_ball_step *b, double *q, double *low, const double *D,
                       double *scratch);
/// high + low <- high + low + x for n numbers, exactly but for the rounding of low.
void hn_add_kept(int n, double *high, double *low, const double *x);
#endif
