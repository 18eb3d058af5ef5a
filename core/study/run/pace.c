// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/pace.h"

#include "base/clock.h"

#include <stdbool.h>

enum { MOST_BETWEEN = 512 };
static const double SOON = 1e-3, LATE = 1e-2; // between two checks [s]

hn_pace hn_pace_begin(void) {
    return (hn_pace){.last = hn_clock_thread(), .every = 1};
}

bool hn_pace_is_due(hn_pace *pace) {
    if (++pace->n < pace->every) {
        return false;
    }
    const double now = hn_clock_thread(), took = now - pace->last;
    if (took < SOON) {
        pace->every = pace->every < MOST_BETWEEN / 2 ? 2 * pace->every : MOST_BETWEEN;
    } else if (took > LATE) {
        const double fewer = pace->every * LATE / took;
        pace->every = fewer > 1 ? (int)fewer : 1;
    }
    pace->last = now;
    pace->n = 0;
    return true;
}
