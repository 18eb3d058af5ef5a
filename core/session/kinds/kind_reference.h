// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_KIND_REFERENCE_H
#define HN_SESSION_KIND_REFERENCE_H
// The content of a job of kind "reference", for writers that need more than its JSON.

#include "session/references/references.h"

#define HN_HOLD_DIGITS 6 ///< field "hold": to which time a motion is worth keeping

typedef struct hn_reference_work {
    const hn_model *model;
    hn_ref *ref; ///< NULL before the run
    hn_ref_source source;
} hn_reference_work;
#endif
