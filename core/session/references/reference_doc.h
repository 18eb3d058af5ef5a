// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_REFERENCE_DOC_H
#define HN_SESSION_REFERENCES_REFERENCE_DOC_H
// A reference solution as JSON: what is stored, and the motion between.

#include "session/references/references.h"

/// {"scene","scene_hash","source","time","means","refused","digits","error","scales","coordinates",
/// "rows","t","q","v","lambda","energy","digits_at"}: columns over the stored times, a row a time.
void hn_reference_json(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                       hn_ref_source source);
/// The same with "motion": {"every","method","between","t","q","points","energy"} at k * every, as
/// far as the reference goes. Between stored times the motion is carried on from the last one by
/// projection@dop853; `between` is by how much it misses the next, at most. Fails: HN_ERR_INPUT
/// (every, or more numbers than the bounds above), HN_ERR_BUDGET, as a run does.
HN_MUST_CHECK hn_status hn_reference_motion_json(hn_strbuf *b, const hn_model *model,
                                                 const hn_ref *ref, hn_ref_source source,
                                                 double every, const hn_walk_limits *limits,
                                                 hn_diags *diags);
#endif
