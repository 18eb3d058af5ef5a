// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_STORE_H
#define HN_SESSION_PRECISION_STUDY_STORE_H
// The journal of an unfinished study: one line per point, one line per sample of CPU time.

#include "session/precision/study_internal.h"

#include <stdbool.h>

/// Opens the journal of this study and reads its lines into the study. Fails: as hn_journal_open().
HN_MUST_CHECK hn_status hn_store_open(hn_study *study, hn_diags *diags);
/// Writes the results of a point except CPU times into the open object. `q`: n_user values.
void hn_store_put_point(hn_strbuf *b, const hn_study *study, int m, int k);
/// Reads such an object. Returns false when it is not valid; the point must then not be used.
bool hn_store_take_point(const hn_study *study, const cJSON *o, hn_wp_point *p);
/// Adds one sample of CPU time. Returns false when the sample is not valid.
bool hn_store_take_sample(hn_wp_point *p, double cpu, double busy);
void hn_store_keep_point(hn_study *study, int m, int k);
void hn_store_keep_sample(hn_study *study, int m, int k);
#endif
