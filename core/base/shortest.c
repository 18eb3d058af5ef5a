// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shortest.h"

#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Half of what a run costs may be the printing of its numbers, and nearly all of that the search
// for the digits by printf and strtod. For numbers of usual size the digits follow from one product
// of integers: with |value| = m 2^e, m < 2^53,
//
//     y = |value| 10^k = m 5^k / 2^s,    s = -(e + k),    10^16 <= y < 10^17                    (1)
//
// The product is exact, so nothing is left to a guess: neither to which side y is rounded, nor
// which of its digits read back to the same double. The bounds keep each number below 2^128.
enum { MOST_POWER = 52, LEAST_SHIFT = 1, MOST_SHIFT = 120, MOST_DIGITS = 17 };
#define TEN_TO_16 10000000000000000ull

__extension__ typedef unsigned __int128 wide;

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

/// 5^k for 0 <= k <= 54.
static wide power_of_five(int k) {
    // clang-format off
    static const uint64_t power[] = {
        1u, 5u, 25u, 125u, 625u, 3125u, 15625u, 78125u, 390625u, 1953125u, 9765625u, 48828125u,
        244140625u, 1220703125u, 6103515625ull, 30517578125ull, 152587890625ull, 762939453125ull,
        3814697265625ull, 19073486328125ull, 95367431640625ull, 476837158203125ull,
        2384185791015625ull, 11920928955078125ull, 59604644775390625ull, 298023223876953125ull,
        1490116119384765625ull, 7450580596923828125ull
    };
    // clang-format on
    return k < 28 ? power[k] : (wide)power[27] * power[k - 27];
}

/// A number y of (1).
typedef struct scaled {
    uint64_t whole; ///< integer part
    wide rest;      ///< in units of 2^-s
    wide five;      ///< 5^k: the gap between y and the next double in the same units
    int shift;      ///< s
    bool is_even;   ///< m is: what lies half way to the next double reads back to this one
    bool is_uneven; ///< m is a power of two: the gap below is half as wide
    int exponent;   ///< of the first digit
} scaled;

/// y for this exponent of the first digit, which may be one too small or too large.
static bool multiply(uint64_t m, int e, int exponent, scaled *y) {
    const int k = 16 - exponent, s = -(e + k);
    if (k < 0 || k > MOST_POWER || s < LEAST_SHIFT || s > MOST_SHIFT) {
        return false;
    }
    const wide five = power_of_five(k), first = (wide)m * (uint64_t)five,
               second = (wide)m * (uint64_t)(five >> 64);
    const wide low = first + (second << 64), top = (second >> 64) + (low < first);
    *y = (scaled){.whole = (uint64_t)((low >> s) | (top << (128 - s))),
                  .rest = low & (((wide)1 << s) - 1),
                  .five = five,
                  .shift = s,
                  .exponent = exponent};
    return true;
}

static bool scale(double size, scaled *y) {
    int two;
    const uint64_t m = (uint64_t)ldexp(frexp(size, &two), 53);
    const int least = (int)floor((two - 1) * 0.30102999566398120); // log10 of 2; or one too small
    if (!multiply(m, two - 53, least, y) ||
        (y->whole >= 10 * TEN_TO_16 && !multiply(m, two - 53, least + 1, y))) {
        return false;
    }
    y->is_even = m % 2 == 0;
    y->is_uneven = m == 1ull << 52;
    return y->whole >= TEN_TO_16 && y->whole < 10 * TEN_TO_16;
}

/// Rounds y to its first 17 - dropped digits, halves to even; returns whether they read back to the
/// same double.
static bool round_to(const scaled *y, int dropped, uint64_t *digits) {
    static const uint64_t unit[] = {1, 10, 100};
    const uint64_t u = unit[dropped], left = y->whole % u;
    const wide one = (wide)1 << y->shift;

    // twice what is left against a whole unit
    const wide twice = 2 * (left * one + y->rest), all = u * one;
    *digits = y->whole / u;
    const bool up = twice > all || (twice == all && *digits % 2 == 1);
    *digits += up;

    // how far that is from y, against half the gap to the next double: both in units of 2^-s / 4
    const wide off = up ? 2 * all - twice : twice;
    const wide half = y->is_uneven && !up ? y->five : 2 * y->five;
    return 2 * off < half || (2 * off == half && y->is_even);
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
    const int before = exponent < 0 ? 0 : exponent + 1 < n ? exponent + 1 : n;
    memcpy(out, digits, (size_t)before);
    out += before;
    for (int i = before; i <= exponent; i++) {
        *out++ = '0';
    }
    if (before < n) {
        if (exponent >= 0) {
            *out++ = '.';
        }
        memcpy(out, digits + before, (size_t)(n - before));
        out += n - before;
    }
    *out = '\0';
}

/// The first `n` digits of a number that has no more; returns how many are left without the zeros
/// at the end.
static int list_digits(uint64_t number, int n, char digits[MOST_DIGITS]) {
    // halves of at most nine digits: their divisions do not wait for each other, and are short
    const int low = n - 8;
    uint32_t first = (uint32_t)(number / 100000000u), last = (uint32_t)(number % 100000000u);
    for (int i = n - 1; i >= low; i--) {
        digits[i] = (char)('0' + last % 10);
        last /= 10;
    }
    for (int i = low - 1; i >= 0; i--) {
        digits[i] = (char)('0' + first % 10);
        first /= 10;
    }
    while (n > 1 && digits[n - 1] == '0') {
        n--;
    }
    return n;
}

/// False where the number is too large, too small, or rounded up to one digit more.
static bool write_by_product(double value, char *text) {
    static const uint64_t most[] = {10 * TEN_TO_16, TEN_TO_16, TEN_TO_16 / 10};
    scaled y;
    if (!scale(fabs(value), &y)) {
        return false;
    }

    // 15, 16 or 17 digits: the last always read back
    uint64_t number = 0;
    int dropped = 2;
    while (!round_to(&y, dropped, &number) && dropped > 0) {
        dropped--;
    }
    const int precision = MOST_DIGITS - dropped;
    if (number >= most[dropped]) {
        return false;
    }

    if (signbit(value)) {
        *text++ = '-';
    }
    char digits[MOST_DIGITS];
    const int n = list_digits(number, precision, digits);
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
