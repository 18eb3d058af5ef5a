// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_SCREEN_COLOURS_H
#define HN_TUI_SCREEN_COLOURS_H

/// Makes the colours of all slots of render/look.h known to the terminal that ncurses drives now:
/// true colours, the nearest of 256, or one of the terminal's own 8 or 16.
///
/// theme  in  hn_theme of the terminal's background
///
/// The pair of slot i is i + 1.
void hn_screen_colours_make(int theme);

#endif
