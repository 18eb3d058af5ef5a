// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/unit_text.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

// powers of m, kg, s, rad, and of Hz, which is 1/s as well
static const struct {
    const char *name;
    hn_unit unit;
} UNITS[] = {
    {"m", {1, {1, 0, 0, 0}}},
    {"mm", {1e-3, {1, 0, 0, 0}}},
    {"cm", {1e-2, {1, 0, 0, 0}}},
    {"km", {1e3, {1, 0, 0, 0}}},
    {"um", {1e-6, {1, 0, 0, 0}}},
    {"µm", {1e-6, {1, 0, 0, 0}}},
    {"nm", {1e-9, {1, 0, 0, 0}}},
    {"pm", {1e-12, {1, 0, 0, 0}}},
    {"kg", {1, {0, 1, 0, 0}}},
    {"g", {1e-3, {0, 1, 0, 0}}},
    {"t", {1e3, {0, 1, 0, 0}}},
    {"s", {1, {0, 0, 1, 0}}},
    {"sec", {1, {0, 0, 1, 0}}},
    {"ms", {1e-3, {0, 0, 1, 0}}},
    {"us", {1e-6, {0, 0, 1, 0}}},
    {"min", {60, {0, 0, 1, 0}}},
    {"h", {3600, {0, 0, 1, 0}}},
    {"rad", {1, {0, 0, 0, 1}}},
    {"metre", {1, {1, 0, 0, 0}}},
    {"metres", {1, {1, 0, 0, 0}}},
    {"meter", {1, {1, 0, 0, 0}}},
    {"meters", {1, {1, 0, 0, 0}}},
    {"second", {1, {0, 0, 1, 0}}},
    {"seconds", {1, {0, 0, 1, 0}}},
    {"degree", {DEGREE, {0, 0, 0, 1}}},
    {"degrees", {DEGREE, {0, 0, 0, 1}}},
    {"mrad", {1e-3, {0, 0, 0, 1}}},
    {"deg", {DEGREE, {0, 0, 0, 1}}},
    {"°", {DEGREE, {0, 0, 0, 1}}},
    {"turn", {360 * DEGREE, {0, 0, 0, 1}}},
    {"rev", {360 * DEGREE, {0, 0, 0, 1}}},
    {"U", {360 * DEGREE, {0, 0, 0, 1}}},
    {"rpm", {6 * DEGREE, {0, 0, -1, 1}}},
    {"Hz", {1, {0, 0, -1, 0, 1}}},
    {"kHz", {1e3, {0, 0, -1, 0, 1}}},
    {"N", {1, {1, 1, -2, 0}}},
    {"kN", {1e3, {1, 1, -2, 0}}},
    {"mN", {1e-3, {1, 1, -2, 0}}},
    {"Nm", {1, {2, 1, -2, 0}}},
    {"kNm", {1e3, {2, 1, -2, 0}}},
    {"mNm", {1e-3, {2, 1, -2, 0}}},
    {"J", {1, {2, 1, -2, 0}}},
    {"kJ", {1e3, {2, 1, -2, 0}}},
    {"mJ", {1e-3, {2, 1, -2, 0}}},
    {"W", {1, {2, 1, -3, 0}}},
    {"kW", {1e3, {2, 1, -3, 0}}},
    {"%", {1e-2, {0, 0, 0, 0}}},
    {"ppm", {1e-6, {0, 0, 0, 0}}},
    {"ppb", {1e-9, {0, 0, 0, 0}}},
    {"ppt", {1e-12, {0, 0, 0, 0}}},
    {"1", {1, {0, 0, 0, 0}}},
};
enum { N_UNITS = sizeof UNITS / sizeof *UNITS };

static void multiply(hn_unit *u, const hn_unit *by, int power) {
    u->factor *= pow(by->factor, power);
    for (int i = 0; i < HN_UNIT_BASES; i++) {
        u->power[i] += by->power[i] * power;
    }
}

static const char MINUS[] = "⁻"; // superscript

/// "^2", "²", "2", "⁻¹", "^-1" behind a unit, else 1.
static int read_power(const char **at) {
    int power = 1;
    char *end;
    if (strncmp(*at, MINUS, strlen(MINUS)) == 0) {
        static const char *const digits[] = {"¹", "²", "³"};
        for (int k = 0; k < 3; k++) {
            if (strncmp(*at + strlen(MINUS), digits[k], 2) == 0) {
                *at += strlen(MINUS) + 2;
                return -1 - k;
            }
        }
    }
    if (strncmp(*at, "²", 2) == 0 || strncmp(*at, "³", 2) == 0) {
        power = strncmp(*at, "²", 2) == 0 ? 2 : 3;
        *at += 2;
    } else if (**at == '^' || strncmp(*at, "**", 2) == 0) {
        const char *digits = *at + (**at == '^' ? 1 : 2);
        power = (int)strtol(digits, &end, 10);
        *at = end;
    } else if (strchr("234", **at) && **at && !isdigit((unsigned char)(*at)[1])) {
        power = *(*at)++ - '0'; // kg m2
    }
    return power;
}

static int read_one(const char **at, hn_unit *u, int sign) {
    size_t n = 0;
    while ((*at)[n] && !strchr(" */^().", (*at)[n]) && !isdigit((unsigned char)(*at)[n]) &&
           strncmp(*at + n, "·", 2) != 0 && strncmp(*at + n, "²", 2) != 0 &&
           strncmp(*at + n, "³", 2) != 0 && strncmp(*at + n, MINUS, strlen(MINUS)) != 0) {
        n++;
    }
    n += n == 0 && **at == '1' && strchr(" */", (*at)[1]); // a one that stands alone
    for (int i = 0; i < N_UNITS; i++) {
        if (strlen(UNITS[i].name) == n && strncmp(UNITS[i].name, *at, n) == 0) {
            *at += n;
            const int power = read_power(at);
            multiply(u, &UNITS[i].unit, abs(power) > 9 ? 0 : sign * power);
            return abs(power) <= 9;
        }
    }
    static const hn_unit kilogram = {1, {0, 1, 0, 0}};
    if (n > 2 && strncmp(*at, "kg", 2) == 0) { // kgm²
        *at += 2;
        multiply(u, &kilogram, sign);
        return 1;
    }
    return 0;
}

int hn_unit_parse(const char *text, hn_unit *out) {
    *out = (hn_unit){.factor = 1};
    int sign = 1;
    const char *p = text + strspn(text, " \t");
    while (*p) {
        if (*p == ' ' || *p == '*' || *p == '(' || *p == ')') {
            p++;
        } else if (strncmp(p, "·", 2) == 0) {
            p += 2;
        } else if (*p == '/') {
            sign = -1; // everything behind a stroke is below it, as in J/(kg m)
            p++;
        } else if (!read_one(&p, out, sign)) {
            return 0;
        }
    }
    return 1;
}

double hn_unit_ratio(const hn_unit *a, const hn_unit *b) {
    const bool angles = a->power[HN_UNIT_ANGLE] || b->power[HN_UNIT_ANGLE];
    const double turns =
        angles ? pow(360 * DEGREE, a->power[HN_UNIT_CYCLE] - b->power[HN_UNIT_CYCLE]) : 1;
    return turns * a->factor / b->factor;
}

int hn_unit_fits(const hn_unit *a, const hn_unit *b) {
    int same = 1;
    for (int i = 0; i < HN_UNIT_ANGLE; i++) {
        same &= a->power[i] == b->power[i];
    }
    return same;
}
