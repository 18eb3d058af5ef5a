// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_SHORTEST_H
#define HN_BASE_SHORTEST_H
// Doubles as text, in the fewest digits from 15 on that read back to the same double.

enum { HN_SHORTEST_TEXT = 32 };

/// Writes a finite double as printf does with %.15g, or with %.16g or %.17g where fewer digits
/// would read back to another double; always with a point, whatever the locale. Returns the length
/// of the text.
int hn_shortest_write(double value, char text[HN_SHORTEST_TEXT]);

#endif
