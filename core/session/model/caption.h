// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_CAPTION_H
#define HN_SESSION_CAPTION_H
// A short description of a mechanism: "crank-rocker, 1 degree of freedom (3 - 2)".

#include "session/model/model.h"

/// Writes the description, at most `size` bytes. A planar chain of four revolute joints is
/// classified by Grashof's rule. The degrees of freedom are the number of velocities minus the rank
/// of J. Redundant constraints are counted.
/// Source: Grashof 1883; Barker, "A complete classification of planar four-bar linkages", Mechanism
/// and Machine Theory 20 (1985).
void hn_model_caption(const hn_model *model, char *out, size_t size);

#endif
