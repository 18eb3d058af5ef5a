// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/seconds.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool hn_seconds_read(const char *text, double *out) {
    char typed[64], *end;
    *out = (double)NAN;
    if (snprintf(typed, sizeof typed, "%s", text) >= (int)sizeof typed) {
        return false;
    }
    for (char *c = typed; *c; c++) {
        *c = *c == ',' ? '.' : *c;
    }

    // a number, then its unit or nothing
    const double value = strtod(typed, &end);
    const bool number = end != typed;
    end += strspn(end, " ");
    const bool milli = strncmp(end, "ms", 2) == 0;
    end += milli ? 2 : *end == 's';
    end += strspn(end, " ");
    if (!number || *end != '\0') {
        return false;
    }
    *out = milli ? 1e-3 * value : value;
    return value > 0 && isfinite(value);
}
