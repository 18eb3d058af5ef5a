// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_H
#define HN_SESSION_REFERENCES_H
// The reference solution of a model: shipped beside the scene (lessons/NN-topic/references), cached
// from an earlier request, or computed. A file is used only if its hash of the scene with its
// parameters and its end time match.

#include "session/model/model.h"
#include "study/truth/reference.h"

#include <stdbool.h>

typedef enum hn_ref_source { HN_REF_SHIPPED, HN_REF_KEPT, HN_REF_COMPUTED } hn_ref_source;

typedef struct hn_ref_request {
    double time;        ///< end [s]; NaN: that of the shipped one, else the scene's
    const char *folder; ///< cache of computed references; NULL: none
    bool again;         ///< compute, ignore stored references
    bool only_stored;   ///< use stored references only
    hn_ref_opts opts;
} hn_ref_request;

struct cJSON;

enum { HN_REF_MOTION_SAMPLES = 2000, HN_REF_MOTION_NUMBERS = 400000 };
#endif
