// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_STATE_H
#define HN_DYNAMICS_ASSEMBLE_STATE_H
// The state of one assembly at work, and what all its stages do with it: evaluate, move, measure.

#include "base/diag.h"
#include "dynamics/compile/rate_tree.h"
#include "dynamics/evaluate/eval.h"

#include <stdbool.h>

/// One assembly at work. The search runs in USER coordinates x, because pins are user coordinates.
/// They are scaled to be comparable: z = x / reach (1 rad, or the characteristic length), residual
/// r = phi / L in length rows, phi elsewhere.
typedef struct hn_assembler {
    const hn_system *sys;
    const hn_scene *scene;
    hn_arena *arena;
    hn_diags *diags;
    double t;
    int n, nq, nc; ///< user coordinates (= nv), system positions, constraint rows
    double length;

    hn_eval *eval; ///< M, phi, phi_t, J, energy; M and J as lists
    double *M, *J; ///< the same dense, filled where they are used: hn_assemble_dense()
    /// user coordinates, their start, system coordinates, velocities of zero
    double *x, *guess, *q, *rest;
    int *turn;              ///< n: 0, 1, 2 for the entries of a rotation vector, else -1
    double *reach;          ///< n
    double *row_scale;      ///< nc
    int n_free, *free;      ///< user coordinates that may move
    double *residual, size; ///< scaled phi (nc) and its length

    hn_rate_tree rates; ///< how velocities are made of the user's rates

    int iterations;
    const char *route;
} hn_assembler;

/// Evaluates at s->x: q, residual, size. False when phi is not finite (size is then HUGE_VAL).
bool hn_assemble_evaluate(hn_assembler *s);
/// Moves x by `delta` (n, user rates times time): a sum, and for orientations a turn about the
/// child's axes.
void hn_assemble_move(const hn_assembler *s, double *x, const double *delta);
/// Returns how far user coordinate i is from its guess; of an orientation, the angle of the turn
/// between them.
double hn_assemble_moved(const hn_assembler *s, int i);
/// M or J (n columns) where s->eval was last run.
const double *hn_assemble_dense(const hn_assembler *s, hn_term term);
/// Row i of J in user rates, out (n).
void hn_assemble_user_row(const hn_assembler *s, int row, double *out);
/// Euclidean norm of the unscaled phi, over all rows (loop < 0) or those of one loop.
double hn_assemble_gap(const hn_assembler *s, int loop);

#endif
