// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_INSTABILITY_H
#define HN_STUDY_INSTABILITY_H
// A fixed step above the stability limit of its integrator: the limit, and the fastest part of the
// motion that sets it.

#include "study/stepping/stepping.h"

/// Compares the step with the stability limit at the state `earlier` of the run. Where the step is
/// larger, writes a sentence that names the limit and what makes the motion so fast.
///
/// limit    out [s] the largest stable step; set only where the result is true
/// Returns: true where the step is above the limit; false where it is not, and where no limit can
///          be computed (adaptive and implicit methods, too many velocities, no memory)
bool hn_instability_explain(const hn_stepping *s, double *limit, char *out, size_t size);

#endif
