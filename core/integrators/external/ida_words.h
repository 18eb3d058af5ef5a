// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IDA_WORDS_H
#define HN_INTEGRATORS_IDA_WORDS_H
// The flags of SUNDIALS IDA in words.

#include "base/status.h"
#include "integrators/external/ida_problem.h"

#include <stddef.h>

/// The status of a flag; a negative one is told in `why`: "IDA: the corrector did not converge at t
/// = 0 s (flag -4)".
hn_status hn_ida_status(int flag, double t, char *why, size_t size);

/// Appends to `why` the cause of a corrector that did not converge, or of steps that collapsed, and
/// the formulation that solves the same motion; nothing for other failures.
void hn_ida_add_remedy(const hn_ida_problem *p, hn_status status, char *why, size_t size);

#endif
