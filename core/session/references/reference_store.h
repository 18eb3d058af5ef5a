// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REFERENCES_REFERENCE_STORE_H
#define HN_SESSION_REFERENCES_REFERENCE_STORE_H
// Where references are kept. A file that does not fit is not used, never trusted halfway; one that
// is written appears whole.

#include "session/references/references.h"

const char *hn_ref_source_name(hn_ref_source source); ///< "shipped", "kept", "computed"
/// Returns owned in *out; source may be NULL. A computed one is kept where there is a folder. Fails
/// as hn_ref_create(); HN_ERR_UNSUPPORTED: it would have to be computed.
HN_MUST_CHECK hn_status hn_reference_get(const hn_model *model, const hn_ref_request *request,
                                         hn_ref **out, hn_ref_source *source, hn_diags *diags);
/// The longest time, a number of two digits, to which the reference keeps this many digits of the
/// coordinates; its own end when it does throughout, 0 when not even at its first time.
double hn_reference_horizon(const hn_ref *ref, double digits);
/// As it is shipped: one JSON object, compact. HN_ERR_IO with the reason.
HN_MUST_CHECK hn_status hn_reference_save(const char *path, const hn_model *model,
                                          const hn_ref *ref, hn_diag *diag);
hn_ref *hn_reference_take(const struct cJSON *o, const hn_model *model, double T, int n);
hn_ref_request hn_ref_request_default(void);
/// The same object into a document, and back: owned; NULL where it is not this model's over n
/// intervals to T (NaN: any).
void hn_reference_put(hn_strbuf *b, const hn_model *model, const hn_ref *ref);
#endif
