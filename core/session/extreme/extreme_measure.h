// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_MEASURE_H
#define HN_SESSION_EXTREME_EXTREME_MEASURE_H
// Reduces the quantities of a sweep to one number or one word.

#include "session/extreme/extreme_internal.h"

extern const hn_extreme_measure hn_extreme_measures[];
extern const int hn_extreme_n_measures;
#endif
