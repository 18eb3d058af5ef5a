// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/units.h"

#include "base/status.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SMALLEST = -3, LARGEST = 4, MAX_UNIT = 16 };

// n µ m (none) k M G T
static const char *const prefixes[] = {"n", "\xc2\xb5", "m", "", "k", "M", "G", "T"};

static bool takes_prefix(const char *unit) {
    static const char *const bare[] = {"", "kg", "deg", "\xc2\xb0", "%"};
    for (size_t i = 0; i < sizeof bare / sizeof *bare; i++) {
        if (strcmp(unit, bare[i]) == 0) {
            return false;
        }
    }
    // kilo of a power would mean the power of a kilo; "kg m" and the like begin with a prefix
    // already
    return strchr(unit, '^') == NULL && strncmp(unit, "kg", 2) != 0;
}

/// The decimal exponent of the value once it is rounded to `digits` digits.
static int rounded_exponent(double value, int digits) {
    char text[40];
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return (int)strtol(strchr(text, 'e') + 1, NULL, 10);
}

static int floor_div(int a, int b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

void hn_si_format(double value, const char *unit, int digits, char out[HN_SI_TEXT]) {
    HN_ASSERT(unit != NULL && digits >= 1 && digits <= 9);
    const char *space = unit[0] != '\0' ? " " : "";
    if (!isfinite(value)) {
        snprintf(out, HN_SI_TEXT, "not finite");
        return;
    }
    if (value == 0) {
        snprintf(out, HN_SI_TEXT, "0%s%.*s", space, MAX_UNIT, unit);
        return;
    }

    const int exponent = rounded_exponent(value, digits);
    const int group = takes_prefix(unit) ? floor_div(exponent, 3) : 0;
    const int before_point = exponent - 3 * group; // 0, 1, 2 where a prefix was taken
    if (group < SMALLEST || group > LARGEST || before_point < -3 || before_point > 5) {
        snprintf(out, HN_SI_TEXT, "%.*e%s%.*s", digits - 1, value, space, MAX_UNIT, unit);
        return;
    }
    const int decimals = digits - 1 - before_point;
    snprintf(out, HN_SI_TEXT, "%.*f%s%s%.*s", decimals > 0 ? decimals : 0,
             value / pow(10, 3 * group), space, prefixes[group - SMALLEST], MAX_UNIT, unit);
}

double hn_round_digits(double value, int digits) {
    HN_ASSERT(digits >= 1 && digits <= 9);
    char text[32];
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return isfinite(value) ? strtod(text, NULL) : value;
}

int hn_digits_apart(double a, double b, int least) {
    enum { MOST = 17 }; // tell any two doubles apart
    HN_ASSERT(least >= 1 && least <= MOST);
    for (int digits = least; digits <= MOST; digits++) {
        char text[2][40];
        snprintf(text[0], sizeof text[0], "%.*g", digits, a);
        snprintf(text[1], sizeof text[1], "%.*g", digits, b);
        if (strcmp(text[0], text[1]) != 0) {
            return digits;
        }
    }
    return least;
}

double hn_round_125(double value) {
    HN_ASSERT(value > 0 && isfinite(value));
    const double decade = pow(10, floor(log10(value)));
    // a value that is 1, 2 or 5 but for rounding counts as that
    const double lead = value / decade * (1 + 1e-12);
    return lead >= 10 ? 10 * decade : lead >= 5 ? 5 * decade : lead >= 2 ? 2 * decade : decade;
}
