// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_H
#define HN_SESSION_REFERENCES_H
// The reference solution of a model, from the nearest place that has it: shipped beside the scene (lessons/NN-topic/references), kept
// from before, or computed. A file is used only where the hash of the scene with its parameters is this one's, and the time.

#include "session/model/model.h"
#include "study/truth/reference.h"

typedef enum hn_ref_source { HN_REF_SHIPPED, HN_REF_KEPT, HN_REF_COMPUTED } hn_ref_source;
const char *hn_ref_source_name(hn_ref_source source); ///< "shipped", "kept", "computed"

typedef struct hn_ref_request {
    double time;        ///< [s]; NaN: that of the shipped one where there is one, else the scene's
    const char *folder; ///< where computed ones are kept; NULL: nowhere
    int again;          ///< 1: computed in any case
    int only_stored;    ///< 1: never computed
    hn_ref_opts opts;
} hn_ref_request;
hn_ref_request hn_ref_request_default(void);

/// Returns owned in *out; source may be NULL. A computed one is kept where there is a folder. Fails as hn_ref_create(); HN_ERR_UNSUPPORTED: it would
/// have to be computed.
HN_MUST_CHECK hn_status hn_reference_get(const hn_model *model, const hn_ref_request *request,
                                         hn_ref **out, hn_ref_source *source, hn_diags *diags);
/// The longest time, a number of two digits, to which the reference keeps this many digits of the coordinates; its own end when it does
/// throughout, 0 when not even at its first time.
double hn_reference_horizon(const hn_ref *ref, double digits);
/// As it is shipped: one JSON object, compact. HN_ERR_IO with the reason.
HN_MUST_CHECK hn_status hn_reference_save(const char *path, const hn_model *model,
                                          const hn_ref *ref, hn_diag *diag);
/// The same object into a document, and back: owned; NULL where it is not this model's over n intervals to T (NaN: any).
void hn_reference_put(hn_strbuf *b, const hn_model *model, const hn_ref *ref);
struct cJSON;
hn_ref *hn_reference_take(const struct cJSON *o, const hn_model *model, double T, int n);

/// {"scene","scene_hash","source","time","means","refused","digits","error","scales","coordinates","rows","t","q","v","lambda","energy",
/// "digits_at"}: columns over the stored times, a row a time.
void hn_reference_json(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                       hn_ref_source source);
enum { HN_REF_MOTION_SAMPLES = 2000, HN_REF_MOTION_NUMBERS = 400000 };
/// The same with "motion": {"every","method","between","t","q","points","energy"} at k * every, as far as the reference goes. Between stored
/// times the motion is carried on from the last one by projection@dop853; `between` is by how much it misses the next, at most. Fails:
/// HN_ERR_INPUT (every, or more numbers than the bounds above), HN_ERR_BUDGET, as a run does.
HN_MUST_CHECK hn_status hn_reference_motion_json(hn_strbuf *b, const hn_model *model,
                                                 const hn_ref *ref, hn_ref_source source,
                                                 double every, const hn_walk_limits *limits,
                                                 hn_diags *diags);
#endif
