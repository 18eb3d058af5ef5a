// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_STABLE_H
#define HN_SESSION_EXTREME_EXTREME_STABLE_H
// Measures that make several runs: the largest stable step, and how fast neighbouring motions
// separate.

#include "session/extreme/extreme_internal.h"

/// Finds the largest stable step, divided by the predicted one where the spectrum predicts it.
void hn_extreme_see_stable_step(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                                const hn_extreme_scene *scene, const char *method,
                                hn_extreme_seen *out);
void hn_extreme_see_lyapunov(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                             const hn_extreme_scene *scene, const char *method,
                             hn_extreme_seen *out);
#endif
