// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_SIXEL_IMAGE_H
#define HN_TERMINAL_SIXEL_IMAGE_H
// Pictures in sixels: bands of six rows, in each of them one line of characters a colour.
// Source: DEC, VT330/VT340 Programmer Reference Manual, volume 2, chapter 14.

#include "base/strbuf.h"

#include <stdbool.h>

/// Colours of a picture; the lower bits of its pixels are left out until they are no more.
enum { HN_SIXEL_COLOURS = 255, HN_SIXEL_BAND = 6 };

/// Appends the sequence that shows a picture at the cursor.
///
/// rgb      in  3 * width * height bytes, row by row from the top
/// Shades are written in per cent: with at most HN_SIXEL_COLOURS colours every shade is shown to
/// within 2 of 255, with more to within 2 more than half of the bits that are left out.
/// Returns: false: no memory; nothing is then appended
bool hn_sixel_show(hn_strbuf *b, const unsigned char *rgb, int width, int height);
#endif
