// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_PART_H
#define HN_SESSION_PRECISION_STUDY_PART_H
// A part of a study as JSON. It holds everything that merging needs: neither the scene's file nor
// the folder of references is required there.

#include "session/precision/study.h"

/// Writes the scene, the request, the reference and the points of this part.
void hn_study_part(hn_strbuf *b, const hn_study *study);
#endif
