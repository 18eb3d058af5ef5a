// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_DOC_H
#define HN_SESSION_EXTREME_EXTREME_DOC_H
// The extreme matrix as JSON and CSV.

#include "session/extreme/extreme.h"

/// The whole matrix as JSON.
void hn_extreme_json(hn_strbuf *b, const hn_extreme *x);
void hn_extreme_csv(hn_strbuf *b, const hn_extreme *x); ///< a row a trial, with a head
#endif
