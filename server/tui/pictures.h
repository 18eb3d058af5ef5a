// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_PICTURES_H
#define HN_TUI_PICTURES_H
// Finds out whether the terminal shows pictures of pixels, and of which kind. It asks the terminal:
//
//   ESC [ 14 t          how large is the window?    ESC [ 4 ; height ; width t
//   ESC [ c             who are you?                ESC [ ? 62 ; 4 c    4: it shows sixels
//   ESC _ G ... ESC \   do you know kitty's         ESC _ G i=31;OK ESC \  (then ESC [ c again)
//                       graphics protocol?
//   ESC ] 11 ; ? BEL    which background?           ESC ] 11 ; rgb:ffff/ffff/ffff ESC or BEL
//
// The last two questions go only to terminals of a VT220 or above (first number of "who are you"
// from 60 on): others, tmux among them, do not skip such strings in silence. A terminal that
// answers nothing gets no picture.

#include "terminal/cells.h"

typedef enum hn_pixels {
    HN_PIXELS_AUTO, ///< kitty, else sixel, else characters
    HN_PIXELS_KITTY,
    HN_PIXELS_SIXEL,
    HN_PIXELS_OFF ///< characters
} hn_pixels;

typedef struct hn_pictures {
    hn_pixels wanted;            ///< by the option, then by the key
    bool kitty, sixel;           ///< what the terminal says it shows
    bool asked_kitty, known;     ///< the third question is out; all answers are in
    int columns, rows;           ///< of the window
    int cell_width, cell_height; ///< [px]; 0: not known
    int theme;                   ///< hn_theme; that of the background where it is asked for
    bool asks_background;        ///< no theme was given
} hn_pictures;

/// Nothing is known of the terminal; theme -1: dark, until the terminal says what its background
/// is. It is taken at the user's word where that names a kind.
hn_pictures hn_pictures_start(hn_pixels wanted, int theme);
/// "auto", "kitty", "sixel", "off"; false: another word.
bool hn_pixels_parse(const char *word, hn_pixels *out);
/// The first question; NULL: none, since no pictures are wanted.
const char *hn_pictures_question(const hn_pictures *p);
/// Takes an answer; returns a further question, or NULL. Other bytes change nothing.
const char *hn_pictures_answer(hn_pictures *p, const char *answer);
/// The size of the window, in cells and in pixels (0: not known). Returns the question after its
/// pixels where they are needed and not known, else NULL.
const char *hn_pictures_resize(hn_pictures *p, int columns, int rows, int width, int height);
/// The kind that is used now: HN_PIXELS_KITTY, HN_PIXELS_SIXEL or HN_PIXELS_OFF.
hn_pixels hn_pictures_form(const hn_pictures *p);
/// The next kind that the terminal shows; returns a sentence that says which. Static text.
const char *hn_pictures_next(hn_pictures *p);
#endif
