// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_factor.h"

#include <math.h>
#include <stdio.h>

enum { LARGEST_DIVISOR = 24 }; ///< of a factor that is told as a fraction

bool hn_value_factor_is_constant(const double *factor, int n) {
    double low = factor[0], high = factor[0];
    for (int i = 1; i < n; i++) {
        low = fmin(low, factor[i]);
        high = fmax(high, factor[i]);
    }
    return high - low <= 1e-4 * fmax(fabs(low), fabs(high));
}

static double mean_of(const double *x, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] / n;
    }
    return sum;
}

double hn_value_factor_name(const double *factor, int n, char *text, size_t size, bool *fraction) {
    const double mean = mean_of(factor, n);
    for (int divisor = 1; divisor <= LARGEST_DIVISOR; divisor++) {
        const double above = round(mean * divisor);
        if (above != 0 && fabs(mean * divisor - above) <= 1e-5 * fabs(above)) {
            snprintf(text, size, divisor == 1 ? "%g" : "%g/%d", above, divisor);
            if (fraction) {
                *fraction = true;
            }
            return above / divisor;
        }
    }
    snprintf(text, size, "%.3g", mean);
    if (fraction) {
        *fraction = false;
    }
    return mean;
}
