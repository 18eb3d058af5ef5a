// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PICTURE_ANGLES_H
#define HN_SESSION_PICTURE_ANGLES_H
// The angles of a plane mechanism that a picture shows.

#include "render/snapshot.h"
#include "session/model/model.h"

/// Lists the angle of each revolute joint about z that carries a coordinate, where a bar of its
/// second body ends there; joints that close a loop carry none.
///
/// q    in   (n_user) user coordinates
/// out  out  room for one per coordinate of the scene; the names are the scene's
/// Returns: how many there are.
int hn_picture_angles(const hn_model *model, const double *q, hn_snapshot_angle *out);
#endif
