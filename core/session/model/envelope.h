// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ENVELOPE_H
#define HN_SESSION_ENVELOPE_H
// The region that a mechanism moves through: its points at one state, and the box around its
// motion, so that a view has to be fitted only once.

#include "render/view.h"
#include "session/model/model.h"

#include <stdbool.h>

/// Computes the world points (3 n_points) [m] at q (system coordinates).
HN_MUST_CHECK hn_status hn_model_points(const hn_model *model, const double *q, double *points);

/// Sets is_ground[i] = 1 for each world point (n_points) that depends neither on a coordinate nor
/// on time, else 0.
HN_MUST_CHECK hn_status hn_model_ground_points(const hn_model *model, char *is_ground);

/// Sets is_drawn[i] = 1 for each world point (n_points) that a picture shows, 0 for one that only
/// gives the direction of a slider or a guide.
void hn_model_drawn_points(const hn_model *model, char *is_drawn);

enum { HN_ENVELOPE_EXTREMES = 64 };

typedef struct hn_envelope {
    double low[3], high[3]; ///< world [m]
    /// farthest point reached [m] in each of 64 directions, to fit a view from any side
    double extremes[HN_ENVELOPE_EXTREMES][3];
    bool spatial; ///< the mechanism leaves the plane of the front view
    bool z_up;    ///< gravity acts along -z, and the mechanism is not planar in z = const
    /// the view asked for; by default the front view, or an oblique view for a spatial mechanism
    hn_view look;
    double box[4]; ///< in that view [m]: minimum right and up, maximum right and up
} hn_envelope;

/// Computes the envelope of the start and of the next seconds of motion (bounded work). `look`: a
/// view with y upwards, turned where z is up; NULL: the default view. A scene without points gives
/// zeros. A model that is interrupted (hn_model_source) meanwhile gives the part of the motion that
/// was seen.
void hn_model_envelope(const hn_model *model, const hn_view *look, hn_envelope *out);

#endif
