// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_QUANTITY_H
#define HN_SESSION_EXTREME_EXTREME_QUANTITY_H
// Quantities of a run, of a model or of a solver's answer: one number each.

#include "session/extreme/extreme_internal.h"

extern const hn_extreme_quantity hn_extreme_quantities[];
extern const int hn_extreme_n_quantities;
/// The point's quantity: NaN with a reason, and the status, where there is none.
double hn_extreme_quantity_of(hn_extreme_bench *bench, const hn_extreme_point *point,
                              char reason[200], hn_status *status);
#endif
