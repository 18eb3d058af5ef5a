// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_UNIT_TEXT_H
#define HN_GRADE_UNIT_TEXT_H
// Units as people write them: "mm", "rad/s", "kg m^2", "N*m", "deg".

enum { HN_UNIT_ANGLE = 3, HN_UNIT_CYCLE = 4, HN_UNIT_BASES = 5 };

/// A factor to SI and the powers of m, kg, s, rad and Hz; Hz has its power of s besides.
typedef struct hn_unit {
    double factor;
    int power[HN_UNIT_BASES];
} hn_unit;

/// Reads a unit; "" and "1" are pure numbers. Returns 0 when the text is no unit.
int hn_unit_parse(const char *text, hn_unit *out);
/// 1 when both measure the same thing; rad counts as a pure number here, as N m and J do as one.
int hn_unit_fits(const hn_unit *a, const hn_unit *b);
/// Returns how many of `b` one of `a` is: 2 pi for Hz in rad/s, 1 for Hz in 1/s. They must fit.
double hn_unit_ratio(const hn_unit *a, const hn_unit *b);
#endif
