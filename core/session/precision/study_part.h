// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_PART_H
#define HN_SESSION_PRECISION_STUDY_PART_H
// A part of a study as JSON: all that putting it together needs, so that neither the scene's file
// nor the folder of references has to be where that is done.

#include "session/precision/study.h"

/// What a part of a study has to hand over: JSON that holds the scene, the request, the reference
/// and this part's points.
void hn_study_part(hn_strbuf *b, const hn_study *study);
#endif
