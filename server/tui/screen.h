// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_SCREEN_H
#define HN_TUI_SCREEN_H
// A terminal by wide ncurses: shows pages of cells, reads keys and the mouse, and is as it was
// before after any end.
//
// ncurses rather than notcurses: it is on every Debian machine, starts in a millisecond, sends only
// what has changed, and works over slow lines and old terminals. The finer dots of braille and
// quadrants are characters here as there.

#include "terminal/cells.h"

typedef enum hn_mouse_what { HN_MOUSE_PRESS, HN_MOUSE_MOVE, HN_MOUSE_RELEASE } hn_mouse_what;

typedef struct hn_mouse {
    int x, y;
    hn_mouse_what what; ///< of the left button; a move comes while it is held
} hn_mouse;

enum { HN_KEY_NONE = -1, HN_KEY_MOUSE = 0x110100, HN_KEY_RESIZE, HN_KEY_ANSWER };

/// Takes over the terminal; `theme`: hn_theme of its background; `colours` false: none at all.
/// false: this is no terminal that ncurses can drive. Undone by hn_screen_close(), at exit, and by
/// every signal that ends the program.
bool hn_screen_open(int theme, bool colours);
void hn_screen_close(void);
/// Colours for another background from the next picture on.
void hn_screen_set_theme(int theme);
/// Nobody is there any more: the program that started this one has ended, or the terminal is
/// closed.
bool hn_screen_gone(void);
void hn_screen_size(int *columns, int *rows);
/// The same in pixels, as the line of the terminal has it; 0: it does not.
void hn_screen_pixels(int *width, int *height);
/// Returns whether the terminal has read the picture before: until then the next one is left out,
/// so that a slow line shows fewer pictures and none of them late. The terminal is asked after each
/// picture; where it never answers, this is always true after a few seconds.
bool hn_screen_ready(void);
/// Shows the cells; then sends `picture` (NULL or empty: nothing), a sequence that leaves the
/// cursor where it is.
void hn_screen_show(const hn_cells *c, bool ascii, const hn_strbuf *picture);
/// Returns how long the last picture with a sequence was on its way [s]; 0: that is not known.
double hn_screen_delay(void);
/// Cells of these rows are written again with the next picture, whatever was over them.
void hn_screen_rewrite(int first, int rows);
/// Sends a question about pictures (pictures.h). Every question ends in "ESC [ c", or asks after
/// the window. Answers come as HN_KEY_ANSWER.
void hn_screen_ask(const char *question);
/// The last answer.
const char *hn_screen_answer(void);
/// Sets the text that is sent before the terminal is left, after a crash too. It must be static.
/// NULL: nothing.
void hn_screen_farewell(const char *sequence);
/// The next key within the time [s]: a character, HN_KEY_* of keys.h or of this file; HN_KEY_NONE:
/// none came. HN_KEY_RESIZE: the size has changed, or the terminal was another program's meanwhile.
int hn_screen_key(double seconds, hn_mouse *mouse);
/// Hands the text to the terminal's clipboard (OSC 52); terminals that do not know it show nothing.
void hn_screen_copy(const char *text);
#endif
