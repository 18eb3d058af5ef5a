// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_READ_H
#define HN_SESSION_EXTREME_EXTREME_READ_H
// A case of the extreme matrix, read strictly: every field is known, every number is in bounds,
// every name exists.

#include "session/extreme/extreme_reader.h"

/// A whole case into r->c, which is emptied first.
void hn_xr_case(hn_xr *r, const cJSON *root);
#endif
