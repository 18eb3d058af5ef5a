// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/decades.h"

#include "base/status.h"

#include <math.h>

enum {
    LEAST_APART = 2,
    LABELS = 3
}; // rows from a label to the next; intervals, where there is room
/// Few labels count as an axis that is longer by this share for each further choice of the step.
static const double SPARSE = 0.1;

double hn_decades_spread(double high, double *low, int rows) {
    static const double steps[] = {1, 2, 3, 5, 10, 20, 50, 100};
    enum { STEPS = sizeof steps / sizeof *steps };
    HN_ASSERT(rows > LEAST_APART && high > *low);
    const double span = high - *low;
    double best = HUGE_VAL, step = steps[STEPS - 1], shown = span;
    const int most_apart = (rows - 1) / LABELS > LEAST_APART ? (rows - 1) / LABELS : LEAST_APART;
    for (int i = 0; i < STEPS; i++) {
        for (int apart = LEAST_APART; apart <= most_apart; apart++) {
            const double all = steps[i] / apart * (rows - 1), cost = all * (1 + SPARSE * i);
            if (all >= span - 1e-9 && cost < best) {
                best = cost;
                step = steps[i];
                shown = all;
            }
        }
    }
    *low = high - shown;
    return step;
}
