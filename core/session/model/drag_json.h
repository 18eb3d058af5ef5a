// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_DRAG_JSON_H
#define HN_SESSION_MODEL_DRAG_JSON_H
// A mechanism dragged by one point or one coordinate, as a document.

#include "session/model/model.h"

typedef struct hn_drag_request {
    const hn_state_entry *from; ///< where it is dragged from; the rest is the assembled start
    int n_from;
    int point;              ///< world point; -1: `coordinate`
    const char *coordinate; ///< its name
    const double *target;   ///< of a point 2 or 3 numbers [m], of a coordinate 1
    int n_target;
    double seconds; ///< of computing, for the way
} hn_drag_request;

/// Writes {"scene","reached","end","reason","distance_before","distance","gap","steps",
/// "cpu_seconds","state":{name:value},"points"}. `state` is closed, with rates that are consistent
/// with it, and names every free coordinate and rate.
/// Fails: HN_ERR_INPUT (a name, an index, how many numbers), or as hn_drag() does, with the reason.
HN_MUST_CHECK hn_status hn_model_drag_json(hn_strbuf *b, const hn_model *model,
                                           const hn_drag_request *request, hn_diags *diags);
#endif
