// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_REFERENCE_STORE_H
#define HN_SESSION_REFERENCES_REFERENCE_STORE_H
// Stores reference solutions. A file that does not fit the scene is ignored as a whole. A file is
// written atomically.

#include "session/references/references.h"

const char *hn_ref_source_name(hn_ref_source source); ///< "shipped", "kept", "computed"
/// Finds or computes the reference. *out is owned by the caller; source may be NULL. A computed
/// reference is cached if the request has a folder.
/// Fails: as hn_ref_create(); HN_ERR_UNSUPPORTED when only_stored is set and none is stored.
HN_MUST_CHECK hn_status hn_reference_get(const hn_model *model, const hn_ref_request *request,
                                         hn_ref **out, hn_ref_source *source, hn_diags *diags);
/// Returns the longest time [s], to two digits, up to which the reference has this many correct
/// digits of the coordinates; its end time when it has them throughout, 0 when it lacks them at its
/// first time.
double hn_reference_horizon(const hn_ref *ref, double digits);
/// Reads such an object. The result is owned by the caller; NULL unless the object belongs to this
/// model and has n intervals to the end time T (NaN: any end time).
hn_ref *hn_reference_take(const struct cJSON *o, const hn_model *model, double T, int n);
hn_ref_request hn_ref_request_default(void);
/// Appends the reference to a document, as one compact JSON object.
void hn_reference_put(hn_strbuf *b, const hn_model *model, const hn_ref *ref);
#endif
