// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ENVELOPE_H
#define HN_SESSION_ENVELOPE_H
// Where a mechanism will be: its points at a state, and the box around its motion, so that a view
// is fitted once.

#include "render/view.h"
#include "session/model/model.h"

/// World points (3 n_points) at q (system coordinates).
HN_MUST_CHECK hn_status hn_model_points(const hn_model *model, const double *q, double *points);

/// is_ground[i]: 1 for each of the world points (n_points) that neither a coordinate nor time
/// moves.
HN_MUST_CHECK hn_status hn_model_ground_points(const hn_model *model, char *is_ground);

enum { HN_ENVELOPE_EXTREMES = 64 };

typedef struct hn_envelope {
    double low[3], high[3]; ///< world [m]
    /// the points reached farthest out in as many directions [m]: a view from anywhere is fitted to
    /// them
    double extremes[HN_ENVELOPE_EXTREMES][3];
    int spatial; ///< something leaves the plane that one looks at from the front
    int z_up;    ///< gravity pulls along -z, and the mechanism does not lie flat in z = const
    /// as asked for; else the front, or for a spatial mechanism a view from the side and above
    hn_view look;
    double box[4]; ///< in that view [m]: right and up at least, right and up at most
} hn_envelope;

/// Around the start and the motion of the next seconds (bounded work). `look`, y upwards, is turned
/// where z is; NULL: the view that fits. A scene without points gives zeros.
void hn_model_envelope(const hn_model *model, const hn_view *look, hn_envelope *out);

#endif
