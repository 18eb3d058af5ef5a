// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PICTURE_ANGLES_H
#define HN_SESSION_PICTURE_ANGLES_H
// The angles of joints that a picture shows.

#include "render/snapshot.h"
#include "session/model/model.h"
#include "study/run/run.h"

/// Lists the angle of each revolute joint that carries a coordinate, where a bar of its second body
/// ends there and is perpendicular to the axis; joints that close a loop carry none. The directions
/// are those of the world, whatever the view.
///
/// sample  in   its t and q (n_user user coordinates)
/// out     out  room for one per coordinate of the scene; the names are the scene's
/// n       out  how many there are
/// Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_picture_angles(const hn_model *model, const hn_sample *sample,
                                          hn_snapshot_angle *out, int *n);
#endif
