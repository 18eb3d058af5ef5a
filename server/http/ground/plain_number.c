// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/plain_number.h"

#include <stdlib.h>
#include <string.h>

static const char DIGITS[] = "0123456789";

/// Skips digits; NULL where there are none, or where `at` is NULL.
static const char *skip_digits(const char *at) {
    const size_t n = at ? strspn(at, DIGITS) : 0;
    return n > 0 ? at + n : NULL;
}

bool hn_plain_number(const char *text, bool whole, double *out) {
    const char *at = skip_digits(text + (*text == '-'));
    if (!whole && at && *at == '.') {
        at = skip_digits(at + 1);
    }
    if (!whole && at && (*at == 'e' || *at == 'E')) {
        at++;
        at = skip_digits(at + (*at == '+' || *at == '-'));
    }
    if (!at || *at) {
        return false;
    }
    *out = strtod(text, NULL);
    return true;
}
