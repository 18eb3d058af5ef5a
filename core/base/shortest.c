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
    uint64_t bits;
    memcpy(&bits, &size, sizeof bits);
    const int field = (int)(bits >> 52), two = field - 1023; // size = m 2^(two - 52)
    const uint64_t m = (bits & ((1ull << 52) - 1)) | 1ull << 52;
    if (field == 0) {
        return false; // below every product
    }
    const int least = (two * 315653) >> 20; // floor of log10 of 2^two: the exponent, or one less
    if (!multiply(m, two - 52, least, y) ||
        (y->whole >= 10 * TEN_TO_16 && !multiply(m, two - 52, least + 1, y))) {
        return false;
    }
    y->is_even = m % 2 == 0;
    y->is_uneven = m == 1ull << 52;
    return y->whole >= TEN_TO_16 && y->whole < 10 * TEN_TO_16;
}

/// Rounds y to its first digits, up to those of value `u`, halves to even; returns whether they
/// read back to the same double. Inline, because a division by a known `u` is a product.
static inline bool round_to(const scaled *y, uint64_t u, uint64_t *digits) {
    const uint64_t left = y->whole % u;
    const wide one = (wide)1 << y->shift;

    // twice what is left against a whole unit
    const wide twice = 2 * (((wide)left << y->shift) + y->rest), all = u * one;
    *digits = y->whole / u;
    const bool up = twice > all || (twice == all && *digits % 2 == 1);
    *digits += up;

    // how far that is from y, against half the gap to the next double: both in units of 2^-s / 4
    const wide off = up ? 2 * all - twice : twice;
    const wide half = y->is_uneven && !up ? y->five : 2 * y->five;
    return 2 * off < half || (2 * off == half && y->is_even);
}

/// The fewest digits from 15 on that read back; returns how many. The last, 17, always do.
static int fewest(const scaled *y, uint64_t *digits) {
    if (round_to(y, 100, digits)) {
        return MOST_DIGITS - 2;
    }
    if (round_to(y, 10, digits)) {
        return MOST_DIGITS - 1;
    }
    (void)round_to(y, 1, digits);
    return MOST_DIGITS;
}

/// Writes an exponent of at least two digits, as %g does; returns the end.
static char *put_exponent(int exponent, char *out) {
    const int size = abs(exponent);
    *out++ = 'e';
    *out++ = exponent < 0 ? '-' : '+';
    *out++ = (char)('0' + size / 10);
    *out++ = (char)('0' + size % 10);
    return out;
}

/// As %g with this precision: `n` digits are left of it once the zeros at the end are gone; returns
/// the end. All MOST_DIGITS are copied at a time, which takes no call: the text has room for them.
static char *layout(const char *digits, int n, int precision, int exponent, char *out) {
    if (exponent < -4 || exponent >= precision) {
        memcpy(out + 1, digits, MOST_DIGITS);
        out[0] = digits[0];
        out[1] = '.';
        return put_exponent(exponent, n > 1 ? out + n + 1 : out + 1);
    }

    // zeros before the first digit
    if (exponent < 0) {
        memcpy(out, "0.000", 5);
        memcpy(out + 1 - exponent, digits, MOST_DIGITS);
        return out + 1 - exponent + n;
    }

    // the digits with a point among them
    const int before = exponent + 1;
    if (before < n) {
        memcpy(out + 1, digits, MOST_DIGITS);
        for (int i = 0; i < before; i++) {
            out[i] = digits[i];
        }
        out[before] = '.';
        return out + n + 1;
    }

    // zeros up to where the point would be
    memcpy(out, digits, MOST_DIGITS);
    for (int i = n; i < before; i++) {
        out[i] = '0';
    }
    return out + before;
}

/// Writes a number below 100 with two digits.
static void put_pair(uint32_t pair, char *out) {
    static const char pairs[] = "00010203040506070809101112131415161718192021222324"
                                "25262728293031323334353637383940414243444546474849"
                                "50515253545556575859606162636465666768697071727374"
                                "75767778798081828384858687888990919293949596979899";
    memcpy(out, pairs + 2 * pair, 2);
}

/// Writes a number below 10^8 with eight digits.
static void put_eight(uint32_t number, char *out) {
    const uint32_t high = number / 10000, low = number % 10000;
    put_pair(high / 100, out);
    put_pair(high % 100, out + 2);
    put_pair(low / 100, out + 4);
    put_pair(low % 100, out + 6);
}

/// All MOST_DIGITS digits of a number, the first of them zeros where it has fewer.
static void list_digits(uint64_t number, char digits[MOST_DIGITS]) {
    const uint32_t first = (uint32_t)(number / 100000000u), last = (uint32_t)(number % 100000000u);
    digits[0] = (char)('0' + first / 100000000u);
    put_eight(first % 100000000u, digits + 1);
    put_eight(last, digits + 9);
}

/// Returns the end of the text; NULL where the number is too large, too small, or rounded up to one
/// digit more.
static char *write_by_product(double value, char *text) {
    static const uint64_t most[] = {10 * TEN_TO_16, TEN_TO_16, TEN_TO_16 / 10};
    scaled y;
    if (!scale(fabs(value), &y)) {
        return NULL;
    }
    uint64_t number = 0;
    const int precision = fewest(&y, &number), zeros = MOST_DIGITS - precision;
    if (number >= most[zeros]) {
        return NULL;
    }

    // as many bytes behind the digits as layout() copies beyond them
    char all[2 * MOST_DIGITS] = {0};
    const char *digits = all + zeros;
    list_digits(number, all);
    int n = precision;
    while (n > 1 && digits[n - 1] == '0') {
        n--;
    }
    if (signbit(value)) {
        *text++ = '-';
    }
    return layout(digits, n, precision, y.exponent, text);
}

int hn_shortest_write(double value, char text[HN_SHORTEST_TEXT]) {
    if (value == 0) {
        strcpy(text, signbit(value) ? "-0" : "0");
        return signbit(value) ? 2 : 1;
    }
    char *end = write_by_product(value, text);
    if (!end) {
        write_by_trial(value, text);
        return (int)strlen(text);
    }
    *end = '\0';
    return (int)(end - text);
}
