// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_READ_EXPECT_H
#define HN_SESSION_EXTREME_EXTREME_READ_EXPECT_H
// Reads the prediction of a trial: a band for a number, or a word for an outcome.

#include "session/extreme/extreme_reader.h"

/// Members "predicted" and "corrected" of a trial.
void hn_xr_expect(hn_xr *r, const cJSON *root, hn_extreme_trial *t);
void hn_xr_corrected(hn_xr *r, const cJSON *root, hn_extreme_expect *e);
#endif
