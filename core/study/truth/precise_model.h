// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PRECISE_MODEL_H
#define HN_STUDY_PRECISE_MODEL_H
// The equations of a system in extended precision: its tapes run in long double. This, and nothing
// behind it, is what computations that check each other have in common.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/tape.h"

/// 64 bits of mantissa where the processor has them (x87), 113 elsewhere.
typedef long double hn_real;

/// A tape and where its outputs go.
typedef struct hn_precise_part {
    hn_tape *tape;
    hn_real *work, **to; ///< to: n places, some twice (M is symmetric)
    const uint16_t *slot;
    int n;
    int *source; ///< output behind each place
} hn_precise_part;

typedef struct hn_precise_model {
    const hn_system *sys;
    int nq, nv, nc;
    hn_precise_part dynamics, closure, energies;
    hn_real *M, *J;                   ///< nv x nv and nc x nv, row-major
    hn_real *f, *gamma, *phi, *phi_t; ///< nv, nc, nc, nc
    hn_real energy[2];                ///< kinetic, potential [J]
    int *position;  ///< nv: entry of q behind a speed; of a ball's first speed, its quaternion
    int *is_ball;   ///< nv: 1 at the first speed of a ball
    hn_real *floor; ///< nv: what counts as one: L for lengths, 1 for angles
} hn_precise_model;

/// Memory from `arena`; the tapes are freed by hn_precise_model_free(). Fails: HN_ERR_MEMORY,
/// HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_precise_model_create(const hn_system *sys, hn_arena *arena,
                                                hn_precise_model **out);
void hn_precise_model_free(hn_precise_model *m); ///< NULL is legal
/// M, f, J, gamma at a state.
void hn_precise_model_dynamics(hn_precise_model *m, hn_real t, const hn_real *q, const hn_real *v);
/// M, J, phi, phi_t at a pose.
void hn_precise_model_closure(hn_precise_model *m, hn_real t, const hn_real *q);
void hn_precise_model_energy(hn_precise_model *m, hn_real t, const hn_real *q, const hn_real *v);
/// qdot = G(q) v, as hn_system_kinematics().
void hn_precise_model_kinematics(const hn_precise_model *m, const hn_real *q, const hn_real *v,
                                 hn_real *qdot);
/// q moved by G(q) delta, quaternions brought back to length 1: exact to the second order of delta,
/// for Newton's corrections.
void hn_precise_model_nudge(const hn_precise_model *m, hn_real *q, const hn_real *delta);
void hn_precise_model_normalise(const hn_precise_model *m, hn_real *q);
hn_real *hn_arena_reals(hn_arena *arena, size_t n); ///< zeroed; NULL when memory is out
#endif
