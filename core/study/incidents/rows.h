// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INCIDENT_ROWS_H
#define HN_STUDY_INCIDENT_ROWS_H
// The rows of J without their zeros. A loop moves with a few coordinates however many the mechanism
// has, so the watch goes over the entries alone, in their order: the lengths are those of the whole
// rows, to the last bit.

#include "dynamics/evaluate/eval.h"

/// The terms of an evaluator for them alone. M costs little beside J, and with it this is the tape
/// of the monitor (dynamics/analyse/singularity_monitor.h), which is compiled once.
enum { HN_CLOSURE_ROWS_TERMS = HN_TERM_M | HN_TERM_J };

typedef struct hn_closure_rows {
    int n;           ///< rows
    const double *J; ///< entries of the evaluator; their values change with every state
    int *first;      ///< n + 1: entries first[i] .. first[i + 1] - 1 belong to row i
    int *col;        ///< of an entry, ascending in a row
    int *at;         ///< of an entry in J
} hn_closure_rows;

/// Finds the entries of HN_TERM_J of `eval`, which lists them and whose values are borrowed. Memory
/// from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_closure_rows_create(const hn_eval *eval, int nc, hn_arena *arena,
                                               hn_closure_rows *rows);
/// Length of row i, as hn_norm2().
double hn_closure_rows_length(const hn_closure_rows *rows, int i);
/// The largest |J_ij x_j| of row i.
double hn_closure_rows_largest(const hn_closure_rows *rows, int i, const double *x);
#endif
