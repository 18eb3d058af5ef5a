// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_FONT_H
#define HN_RENDER_FONT_H
// A stroke font in the manner of technical lettering (ISO 3098: even strokes, round ends), drawn by
// the canvas as lines. Printable ASCII and a few signs that captions need: ° · × µ – − … Δ λ φ.
// Anything else is an empty box.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Units of the glyphs: capitals are 28 high, small letters 20, descenders 8; the baseline is y =
/// 0, y up.
enum { HN_FONT_CAP = 28, HN_FONT_DESCENT = 8, HN_FONT_MAX_POINTS = 160 };

/// One glyph as polylines: line i has points start[i] .. start[i + 1] - 1.
typedef struct hn_glyph {
    double advance;
    int n_lines, n_points;
    int start[12];
    double xy[2 * HN_FONT_MAX_POINTS];
} hn_glyph;

/// The outline of a character; of one that the font lacks, that of a box.
void hn_font_glyph(uint32_t code, hn_glyph *out);
/// Returns how far the next character stands from this one, in units of the height of the type.
double hn_font_advance(uint32_t code);
/// 1 if the font has the character itself, not the box.
bool hn_font_has(uint32_t code);

/// Reads one character of UTF-8 and moves `text` on; a bad byte is taken as U+FFFD. 0 at the end.
uint32_t hn_utf8_next(const char **text);

#endif
