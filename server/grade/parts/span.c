// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/span.h"

#include <ctype.h>

hn_span hn_span_trim(hn_span s) {
    while (s.at < s.end && isspace((unsigned char)*s.at)) {
        s.at++;
    }
    while (s.end > s.at && isspace((unsigned char)s.end[-1])) {
        s.end--;
    }
    return s;
}
