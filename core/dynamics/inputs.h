#ifndef HN_DYNAMICS_INPUTS_H
#define HN_DYNAMICS_INPUTS_H
// The inputs every tape of a system takes: q, v, t, alpha, beta, and the parameters where they stayed symbols.

#include "dynamics/system_impl.h"
#include "expr/tape.h"

typedef struct hn_inputs {
    int nv, n;
    double *x; ///< n values
} hn_inputs;

/// The values, from `arena`; symbolic parameters take the scene's.
HN_MUST_CHECK hn_status hn_inputs_create(const hn_system *sys, hn_arena *arena, hn_inputs *in);
/// A tape for `outputs` with these inputs, owned by the caller.
HN_MUST_CHECK hn_status hn_inputs_compile(hn_system *sys, const hn_inputs *in, const hn_ex *outputs,
                                          int n_out, hn_tape **tape);
/// q (nv); v (nv) or NULL for zero.
void hn_inputs_set(hn_inputs *in, double t, const double *q, const double *v, double alpha,
                   double beta);
#endif
