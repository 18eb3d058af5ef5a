// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_DOC_H
#define HN_SESSION_PRECISION_STUDY_DOC_H
// The study as JSON and as CSV.

#include "session/precision/study.h"

/// The whole study as JSON.
void hn_study_json(hn_strbuf *b, const hn_study *study);
/// Writes a table with a header line and one line per point.
void hn_study_csv(hn_strbuf *b, const hn_study *study);
#endif
