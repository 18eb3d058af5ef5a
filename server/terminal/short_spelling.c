// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/short_spelling.h"

#include <stdio.h>
#include <stdlib.h>

enum { LONG = 8 }; // characters of a number that is shown as it is

void hn_short_spelling(const char *spelling, char *out, size_t size) {
    size_t n = 0;
    for (const char *at = spelling; *at && n + 1 < size;) {
        char *end = NULL;
        const double value = at > spelling && at[-1] == '=' ? strtod(at, &end) : 0;
        if (!end || end - at <= LONG) {
            out[n++] = *at++;
            continue;
        }
        n += (size_t)snprintf(out + n, size - n, "%.4g", value);
        n = n < size ? n : size - 1;
        at = end;
    }
    out[n] = '\0';
}
