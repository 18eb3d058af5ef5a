// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shortest.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Half of what a run costs may be the printing of its numbers, and nearly all of that the search
// for the digits by printf and strtod. For numbers of usual size the digits follow from one product
//
//     y = |value| 10^k,    10^16 <= y < 10^17,    0 <= k <= 27                                  (1)
//
// in a long double of 64 bits: 10^27 = 2^27 5^27 is the last power of ten that it holds exactly,
// so y is known to 2^-8, half a unit in its last place. What depends on less than MARGIN is left
// to printf.
static const long double MARGIN = 0.01L;
enum { MOST_POWER = 27, MOST_DIGITS = 17 };

// ---- by printf ----

/// printf writes the locale's decimal sign; documents know only the point.
static void force_point(char *text) {
    const char *sign = localeconv()->decimal_point;
    char *found = strcmp(sign, ".") != 0 ? strstr(text, sign) : NULL;
    if (found != NULL) {
        const size_t n = strlen(sign);
        *found = '.';
        memmove(found + 1, found + n, strlen(found + n) + 1);
    }
}

static void write_by_trial(double value, char text[HN_SHORTEST_TEXT]) {
    for (int digits = 15; digits <= MOST_DIGITS; digits++) {
        snprintf(text, HN_SHORTEST_TEXT, "%.*g", digits, value);
        if (digits == MOST_DIGITS || strtod(text, NULL) == value) {
            break;
        }
    }
    force_point(text);
}

// ---- by one product ----

/// 10^k, exact.
static long double power_of_ten(int k) {
    static const long double power[MOST_POWER + 1] = {
        1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,  1e8L,  1e9L,
        1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L,
        1e20L, 1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
    return power[k];
}

/// Whether long doubles carry 64 bits here: some processors, and tools that stand in for one, have
/// fewer.
static bool has_wide_sums(void) {
    volatile long double one = 1;
    return LDBL_MANT_DIG >= 64 && one + 0x1p-60L != one;
}

/// A number y of (1): its integer part, the rest, and how far from it other doubles begin.
typedef struct scaled {
    uint64_t whole;
    long double rest, half_gap;
    bool is_uneven; ///< the gap above is twice as wide
    int exponent;   ///< of the first digit
} scaled;

static bool scale(double size, scaled *y) {
    int two;
    const double fraction = frexp(size, &two);
    int exponent = (int)floor((two - 1) * 0.30102999566398120); // log10 of 2; may be one too small
    if (exponent < 16 - MOST_POWER || exponent > 15) {
        return false;
    }
    long double product = (long double)size * power_of_ten(16 - exponent);
    if (product >= 1e17L) {
        exponent++;
        product = (long double)size * power_of_ten(16 - exponent);
    }
    if (!(product >= 1e16L && product < 1e17L)) {
        return false;
    }

    // a double stands half a unit in the last place from the next; a power of two nearer to the
    // one below it
    y->exponent = exponent;
    y->whole = (uint64_t)product;
    y->rest = product - (long double)y->whole;
    y->is_uneven = fraction == 0.5;
    y->half_gap = ldexpl(power_of_ten(16 - exponent), two - 54 - y->is_uneven);
    return true;
}

typedef enum verdict { NO, YES, UNSURE } verdict;

/// Rounds y to its first 17 - dropped digits; YES: they read back to the same double.
static verdict round_to(const scaled *y, int dropped, uint64_t *digits) {
    static const uint64_t unit[] = {1, 10, 100};
    const uint64_t u = unit[dropped];
    const long double left = (long double)(y->whole % u) + y->rest, half = 0.5L * (long double)u;
    const bool up = left > half;
    const long double off = up ? (long double)u - left : left;
    *digits = y->whole / u + up;
    if (fabsl(left - half) < MARGIN) {
        return UNSURE;
    }
    if (off < y->half_gap - MARGIN) {
        return YES;
    }
    return off > y->half_gap + MARGIN && !y->is_uneven ? NO : UNSURE;
}

/// As %g with this precision: `n` digits are left of it once the zeros at the end are gone.
static void layout(const char *digits, int n, int precision, int exponent, char *text) {
    char *out = text;
    if (exponent < -4 || exponent >= precision) {
        *out++ = digits[0];
        if (n > 1) {
            *out++ = '.';
            memcpy(out, digits + 1, (size_t)n - 1);
            out += n - 1;
        }
        const int size = abs(exponent);
        *out++ = 'e';
        *out++ = exponent < 0 ? '-' : '+';
        *out++ = (char)('0' + size / 10);
        *out++ = (char)('0' + size % 10);
        *out = '\0';
        return;
    }

    // zeros before the first digit, the digits with a point among them, zeros up to the point
    if (exponent < 0) {
        memcpy(out, "0.000", (size_t)(1 - exponent));
        out += 1 - exponent;
    }
    for (int i = 0; i < n || i <= exponent; i++) {
        if (i == exponent + 1 && i > 0) {
            *out++ = '.';
        }
        *out++ = i < n ? digits[i] : '0';
    }
    *out = '\0';
}

/// False where the digits depend on less than is known.
static bool write_by_product(double value, char *text) {
    scaled y;
    if (!has_wide_sums() || !scale(fabs(value), &y)) {
        return false;
    }

    // 15, 16 or 17 digits: the last always read back
    uint64_t number = 0;
    int dropped = 2;
    verdict is_same = round_to(&y, dropped, &number);
    while (is_same == NO && dropped > 0) {
        is_same = round_to(&y, --dropped, &number);
    }
    const int precision = MOST_DIGITS - dropped;
    if (is_same != YES || (long double)number >= power_of_ten(precision)) {
        return false;
    }

    // from the last digit to the first, without the zeros at the end
    char digits[MOST_DIGITS];
    int n = 0;
    for (int i = precision - 1; i >= 0; i--) {
        digits[i] = (char)('0' + number % 10);
        number /= 10;
        n = n == 0 && digits[i] != '0' ? i + 1 : n;
    }
    if (signbit(value)) {
        *text++ = '-';
    }
    layout(digits, n, precision, y.exponent, text);
    return true;
}

void hn_shortest_write(double value, char text[HN_SHORTEST_TEXT]) {
    if (value == 0) {
        strcpy(text, signbit(value) ? "-0" : "0");
        return;
    }
    if (!write_by_product(value, text)) {
        write_by_trial(value, text);
    }
}
