// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_KITTY_IMAGE_H
#define HN_TERMINAL_KITTY_IMAGE_H
// Pictures by the graphics protocol of the terminal kitty, which others know too (Ghostty, WezTerm,
// Konsole): pixels, compressed by zlib, in base64, in pieces of 4096 characters.
// Source: sw.kovidgoyal.net/kitty/graphics-protocol.

#include "base/strbuf.h"

#include <stdbool.h>

/// Appends the sequence that shows a picture at the cursor, which stays where it is.
///
/// rgb            in  3 * width * height bytes, row by row from the top
/// columns, rows  in  cells that the picture is stretched over
/// id             in  number of the picture, from 1 on; an older picture of this number goes
/// Returns:       false: no memory; nothing is then appended
bool hn_kitty_show(hn_strbuf *b, const unsigned char *rgb, int width, int height, int columns,
                   int rows, int id);
/// Takes all pictures away.
#define HN_KITTY_REMOVE_ALL "\033_Ga=d,d=A,q=2\033\\"
/// Appends the sequence that takes the picture of this number away.
void hn_kitty_remove(hn_strbuf *b, int id);
#endif
