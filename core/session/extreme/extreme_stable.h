// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_STABLE_H
#define HN_SESSION_EXTREME_EXTREME_STABLE_H
// Measures with a loop of their own: the largest step that does not grow, and how fast neighbours
// part.

#include "session/extreme/extreme_internal.h"

/// The largest step that does not grow, over the predicted one where that comes from the spectrum.
void hn_extreme_see_stable_step(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                                const hn_extreme_scene *scene, const char *method,
                                hn_extreme_seen *out);
void hn_extreme_see_lyapunov(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                             const hn_extreme_scene *scene, const char *method,
                             hn_extreme_seen *out);
#endif
