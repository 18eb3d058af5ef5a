// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MECHANISM_H
#define HN_SESSION_MECHANISM_H
// The mechanism itself, as MJCF or as URDF (urdf_writer.h). MJCF is drawn at the assembled start.
//
// Bodies keep their frames and names; each coordinate is a joint of its own name and keeps its
// value (`ref`), so 0 means what it means in the scene. Joints that close loops become equalities:
// `connect` for a ball and for a hinge of a planar mechanism, two of them along the axis for a
// hinge in space, `weld` for a fixed joint. A gear is an equality of joints. Springs and dampers on
// a coordinate belong to its joint; a constant drive is a `motor`, a follower of a constant target
// a `position`. A keyframe holds the start. Import (import/import.h) reads all of this.

#include "session/model/model.h"

/// Writes the mechanism to `b`, and to `left_out` a line for each thing of the scene that is not
/// in it, beginning with what it is. `loops`: the loop file beside a URDF; NULL: it is not wanted.
/// Fails: HN_ERR_INPUT (unknown format; a scene without bodies, or with one called "world"; a loop
/// file beside MJCF), HN_ERR_UNSUPPORTED (a free joint between two bodies; a ball in URDF),
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_model_export_mechanism(hn_strbuf *b, hn_strbuf *loops,
                                                  hn_strbuf *left_out, const hn_model *model,
                                                  const char *format, hn_diags *diags);

/// The ending of a file's name in a known format.
const char *hn_mechanism_suffix(const char *format);
/// Returns whether there is a format of this name.
bool hn_mechanism_is_format(const char *name);

#endif
