// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_INPUTS_H
#define HN_DYNAMICS_INPUTS_H
// The inputs that every tape of a system takes: q, v, t, alpha, beta, the parameters where they
// stayed symbols, and the pulls. They are written straight into the tape's workspace.

#include "dynamics/compile/system_impl.h"
#include "expr/tape.h"

typedef struct hn_inputs {
    int nq, nv, n;
    int n_pulled;             ///< of the inputs, those of the pulls
    const hn_pull_log *pulls; ///< NULL: none
    double *x;                ///< n values; with a tape they stand at the start of its workspace
    hn_tape *tape;            ///< owned; NULL until compiled
    const uint16_t *slots;    ///< output k is x[slots[k]]
} hn_inputs;

/// Room for the values alone, where there is no tape.
HN_MUST_CHECK hn_status hn_inputs_create(const hn_system *sys, hn_arena *arena, hn_inputs *in);
/// The same with a tape for `outputs` and its workspace.
HN_MUST_CHECK hn_status hn_inputs_compile(const hn_system *sys, const hn_ex *outputs, int n_out,
                                          hn_arena *arena, hn_inputs *in);
/// The same with a check of the first outputs, see hn_tape_run_checked().
HN_MUST_CHECK hn_status hn_inputs_compile_checked(const hn_system *sys, const hn_ex *outputs,
                                                  int n_out, const hn_tape_check *check,
                                                  hn_arena *arena, hn_inputs *in);
void hn_inputs_free(hn_inputs *in);                ///< the tape
void hn_inputs_put_pulls(hn_inputs *in, double t); ///< their values at t, the last inputs
/// q (nq); v (nv) or NULL for zero. For a handful of numbers loops are quicker than a call.
static inline void hn_inputs_set(hn_inputs *in, double t, const double *q, const double *v,
                                 double alpha, double beta) {
    double *x = in->x;
    for (int i = 0; i < in->nq; i++) {
        x[i] = q[i];
    }
    x += in->nq;
    if (v) {
        for (int i = 0; i < in->nv; i++) {
            x[i] = v[i];
        }
    } else {
        for (int i = 0; i < in->nv; i++) {
            x[i] = 0;
        }
    }
    x += in->nv;
    x[0] = t;
    x[1] = alpha;
    x[2] = beta;
    if (in->pulls) {
        hn_inputs_put_pulls(in, t);
    }
}
#endif
