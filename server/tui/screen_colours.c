// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/screen_colours.h"

#include "render/look.h"
#include "terminal/cells.h"

#include <ncurses.h>
#include <stdbool.h>

/// Colours of a terminal that has 8 or 16, for the slots of render/look.h and for an alarm. Blue is
/// hardly seen on black: there it is cyan, or bright where there are 16. -1 is the terminal's own,
/// which is seen on its background.
static int of_few(int colour, int theme) {
    enum { BLACK, RED, GREEN, YELLOW, BLUE, MAGENTA, CYAN, BRIGHT = 8 };
    static const signed char few[HN_LOOK_METHODS] = {BLUE, RED,  GREEN,  MAGENTA,
                                                     RED,  CYAN, YELLOW, GREEN};
    const bool dark = theme == HN_THEME_DARK;
    if (colour != HN_CELL_ALARM && colour >= HN_LOOK_METHODS) {
        return -1;
    }
    const int chosen = colour == HN_CELL_ALARM ? RED : few[colour];
    if (COLORS >= 2 * BRIGHT) {
        return chosen + (dark ? BRIGHT : 0);
    }
    return dark && chosen == BLUE ? CYAN : chosen;
}

/// From ncurses 6.1 on colours may have more than 16 bits.
#if NCURSES_EXT_FUNCS >= 20180127
#define TRUE_COLOURS
#endif

/// Returns whether the terminal's description says that the number of a colour is its red, green
/// and blue, as that of xterm-direct does.
static bool is_direct(void) {
#ifdef TRUE_COLOURS
    const char *bits = tigetstr("RGB");
    return tigetflag("RGB") > 0 || tigetnum("RGB") > 0 || (bits && bits != (char *)-1);
#else
    return false;
#endif
}

static void set_pair(int pair, int colour) {
#ifdef TRUE_COLOURS
    init_extended_pair(pair, colour, -1); // a short holds no true colour
#else
    init_pair((short)pair, (short)colour, -1);
#endif
}

void hn_screen_colours_make(int theme) {
    start_color();
    use_default_colors();
    const bool direct = is_direct();
    for (int i = 0; i < HN_CELL_COLOURS; i++) {
        set_pair(i + 1, direct          ? hn_cell_colour_rgb(i, theme)
                        : COLORS >= 256 ? hn_cell_colour_256(i, theme)
                                        : of_few(i, theme));
    }
}
