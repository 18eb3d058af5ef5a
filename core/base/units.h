// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_UNITS_H
#define HN_BASE_UNITS_H
// Numbers for people: SI prefixes so that one to three digits stand before the point.

#include <stddef.h>

enum { HN_SI_TEXT = 48 };

/// Smaller values get no prefix [m, s, J, ...]: nobody pictures a picometre.
#define HN_SI_SMALLEST 1e-9

/// "4.20 mm", "1.30 µs", "312 kg" (kg has its prefix already). `digits` significant
/// digits (1..9). Zero is "0 m"; values that are not finite are "not finite"; beyond the prefixes
/// n..T the number is written with a power of ten ("2.1e-17 m"). An empty unit, kg, deg, % or a
/// power (m^2) takes no prefix. UTF-8, at most HN_SI_TEXT bytes with the zero; `unit` is cut if
/// longer than 16 bytes.
void hn_si_format(double value, const char *unit, int digits, char out[HN_SI_TEXT]);

/// Returns `value` rounded to `digits` (1..9) significant digits: 253 to 2 digits is 250. Values
/// that are not finite are returned as they are.
double hn_round_digits(double value, int digits);

/// Returns the number of significant digits, `least` (1..17) or more, with which printf's %.*g
/// writes two numbers as different texts: "0.001201 exceeds 0.0012", not "0.0012 exceeds 0.0012".
/// Equal numbers get `least`.
int hn_digits_apart(double a, double b, int least);

/// The largest of 1, 2, 5 x 10^k that is not above `value` (> 0, finite): lengths of scale bars,
/// ticks.
double hn_round_125(double value);
#endif
