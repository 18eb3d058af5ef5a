// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_REFERENCE_DOC_H
#define HN_SESSION_REFERENCES_REFERENCE_DOC_H
// A reference solution as JSON: the stored states, and the motion between them.

#include "session/references/references.h"

/// Writes {"scene","scene_hash","source","time","duration","means","refused","digits","error",
/// "scales","coordinates","rows","t","q","v","lambda","energy","digits_at"}. The columns hold
/// one row per stored time.
void hn_reference_json(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                       hn_ref_source source);
/// Writes the same object with "motion": {"every","method","between","q","points","energy"}, one
/// row at each k * every up to the end of the reference. A precise method integrates from the start
/// through the stored times. `between` is the largest difference from the stored states, and at
/// least the error of the reference itself.
/// Fails: HN_ERR_INPUT (`every`, or more samples or numbers than HN_REF_MOTION_SAMPLES and
/// HN_REF_MOTION_NUMBERS), HN_ERR_STOPPED, or as a run does.
HN_MUST_CHECK hn_status hn_reference_motion_json(hn_strbuf *b, const hn_model *model,
                                                 const hn_ref *ref, hn_ref_source source,
                                                 double every, const hn_walk_limits *limits,
                                                 hn_diags *diags);
#endif
