// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ACCEL_LANES_H
#define HN_DYNAMICS_ACCEL_LANES_H
// Accelerations at HN_LANES states of one system at once, by the tape of an hn_accel in lanes
// (expr/lanes.h). Lanes whose answer is sure have the bits that hn_accel_eval() gives; the others,
// at pivots in doubt or states that are not finite, are left to it.

#include "dynamics/evaluate/accel.h"
#include "expr/lanes_tape.h"

typedef struct hn_accel_lanes {
    hn_lanes_tape code;
    int nq, nv;
    const struct hn_accel_tape *layout; ///< of the outputs; like the slots of the hn_accel
    const uint16_t *slots;
    double *work; ///< blocks of HN_LANES doubles: the inputs, then whatever the tape keeps
    /// Inputs, to be written before each evaluation: q (nq blocks), v (nv blocks), and one block
    /// each of time [s], alpha and beta [1/s].
    double *q, *v, *t, *alpha, *beta;
} hn_accel_lanes;

/// Says whether this solver can be had in lanes: it has a tape.
bool hn_accel_has_lanes(const hn_accel *s);
/// Makes a workspace for the solver, which must outlive it; every input is 0. Fails: HN_ERR_MEMORY,
/// HN_ERR_UNSUPPORTED (see hn_accel_has_lanes).
HN_MUST_CHECK hn_status hn_accel_lanes_create(const hn_accel *s, hn_lanes_set set, hn_arena *arena,
                                              hn_accel_lanes *out);
/// Frees what is not from the arena.
void hn_accel_lanes_free(hn_accel_lanes *l);
/// Evaluates all lanes; returns those whose answer is sure. Allocates nothing.
hn_lane_bits hn_accel_lanes_eval(hn_accel_lanes *l);
/// The block of acceleration i after that.
static inline const double *hn_accel_lanes_a(const hn_accel_lanes *l, int i) {
    return l->work + (size_t)l->slots[i] * HN_LANES;
}
#endif
