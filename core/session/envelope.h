#ifndef HN_SESSION_ENVELOPE_H
#define HN_SESSION_ENVELOPE_H
// Where a mechanism will be: its points at a state, and the box around its motion, so that a view is fitted once.

#include "session/model.h"

/// World points (3 n_points) at q (system coordinates).
HN_MUST_CHECK hn_status hn_model_points(const hn_model *model, const double *q, double *points);

/// xmin, ymin, xmax, ymax around the start and the motion of the next seconds (bounded work). A scene without points gives
/// zeros.
void hn_model_envelope(const hn_model *model, double box[4]);

#endif
