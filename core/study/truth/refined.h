// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_REFINED_H
#define HN_STUDY_REFINED_H
// A reference solution between its stored times. Each interval is integrated anew from the stored
// state at its start to the time of the next stored state. The distance between the computed end
// and that state is the error estimate of the interval. If no method comes to the end of an
// interval, only its ends are known. What is known does not depend on the speed of the machine: the
// work is limited in operations, and a computation that a limit of time cuts off has no result.

#include "study/truth/reference.h"

#include <stdbool.h>

/// Parts of an interval: a power of two, so that every stored time is met bit for bit.
enum { HN_REFINED_PARTS = 32 };

typedef struct hn_refined {
    const hn_ref *ref;
    int parts;                       ///< of each interval, a power of two; 1: nothing lies between
    int found;                       ///< intervals that came to their end
    bool too_long;                   ///< the operations did not suffice for the others
    double *q, *v, *lambda, *energy; ///< ref->n x parts rows; the first of an interval is not used
    /// ref->n x HN_ERROR_COUNT: how far the end of an interval is from the stored state; NaN: the
    /// interval did not come to its end
    double *error;
} hn_refined;

/// Memory from `arena`; the reference must outlive it. Once all intervals have taken `most_ops`
/// operations together, the rest is not refined. A system with many coordinates gets fewer parts,
/// to bound the memory.
/// Fails: HN_ERR_STOPPED on request, HN_ERR_LIMIT out of the limits' time, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_refined_create(const hn_system *sys, const hn_ref *ref,
                                          hn_errors *errors, double most_ops,
                                          const hn_walk_limits *limits, hn_arena *arena,
                                          hn_refined **out);
/// The state at time number k, 0..ref->n x parts (borrowed).
hn_state_seen hn_refined_at(const hn_refined *r, int k);
/// Returns how far the state at time number k may itself be off: HN_ERROR_COUNT entries, NaN where
/// it is not known. NULL at a stored time: the reference says it.
const double *hn_refined_error(const hn_refined *r, int k);
#endif
