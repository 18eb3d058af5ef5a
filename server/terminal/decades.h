// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_DECADES_H
#define HN_TERMINAL_DECADES_H
// Labels of a logarithmic axis in rows of characters.

/// Lowers *low (a power of ten, as `high`) a little, so that labels 1, 2, 3, 5 or 10 decades apart,
/// from `high` down, stand on rows that are evenly apart. rows: of the axis, 3 or more. Returns the
/// decades between two labels.
double hn_decades_spread(double high, double *low, int rows);
#endif
