// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_H
#define HN_SESSION_REFERENCES_H
// The reference solution of a model, from the nearest place that has it: shipped beside the scene
// (lessons/NN-topic/references), kept from before, or computed. A file is used only where the hash
// of the scene with its parameters is this one's, and the time.

#include "session/model/model.h"
#include "study/truth/reference.h"

typedef enum hn_ref_source { HN_REF_SHIPPED, HN_REF_KEPT, HN_REF_COMPUTED } hn_ref_source;

typedef struct hn_ref_request {
    double time;        ///< [s]; NaN: that of the shipped one where there is one, else the scene's
    const char *folder; ///< where computed ones are kept; NULL: nowhere
    int again;          ///< 1: computed in any case
    int only_stored;    ///< 1: never computed
    hn_ref_opts opts;
} hn_ref_request;

struct cJSON;

enum { HN_REF_MOTION_SAMPLES = 2000, HN_REF_MOTION_NUMBERS = 400000 };
#endif
