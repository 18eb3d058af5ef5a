// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_URDF_WRITER_H
#define HN_SESSION_URDF_WRITER_H
// A mechanism as URDF: the spanning tree, drawn where every coordinate is 0. Links have the names
// of the bodies and stand at the joint that carries them, with the axes of the body; the ground is
// the link "world". Each coordinate is a joint of its own name; joints of several coordinates are
// chains through links without mass. A gear is a mimic, a damper on a coordinate the joint's
// damping.
//
// URDF holds no loops, no gravity and no start. They go into a loop file (import/loops.h), which
// import reads beside the URDF, or are reported as left out.

#include "session/export/start_poses.h"

/// Writes the model to `out`, and to `left_out` a line for each thing that is in neither text.
/// `loops` gets the loop file; NULL: it is not wanted. Failures of memory show in `out`.
/// Fails: HN_ERR_UNSUPPORTED (a ball joint carries a body), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_urdf_write(hn_strbuf *out, hn_strbuf *loops, hn_strbuf *left_out,
                                      const hn_model *model, hn_arena *arena, hn_diags *diags);

#endif
