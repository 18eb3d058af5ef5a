// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IDA_WORDS_H
#define HN_INTEGRATORS_IDA_WORDS_H
// The flags of SUNDIALS IDA in words.

#include "base/status.h"

#include <stddef.h>

/// The status of a flag; a negative one is told in `why`: "IDA: the corrector did not converge at t
/// = 0 s (flag -4)".
hn_status hn_ida_status(int flag, double t, char *why, size_t size);

#endif
