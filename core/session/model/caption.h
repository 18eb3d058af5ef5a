// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_CAPTION_H
#define HN_SESSION_CAPTION_H
// What a mechanism is called, in a few words: "crank-rocker, 1 freedom (3 - 2)".

#include "session/model/model.h"

/// Writes at most `size` bytes. A planar chain of four revolute joints is named by Grashof's rule;
/// every scene has its freedoms counted as speeds minus rank; a redundant row is said. Source:
/// Grashof 1883; Barker, "A complete classification of planar four-bar linkages", Mechanism and
/// Machine Theory 20 (1985).
void hn_model_caption(const hn_model *model, char *out, size_t size);

#endif
