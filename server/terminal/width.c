// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/width.h"

#include <curses.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <term.h>
#include <unistd.h>

#undef columns // term.h makes a macro of it

enum { LEAST = 40, MOST = 300, USUAL = 80 };

static bool wide; // standard output belongs to the process, and so does how wide it is

void hn_terminal_be_wide(void) {
    wide = true;
}

/// Columns of the terminal behind an output, else of COLUMNS, else the usual ones.
static int columns_of(int output) {
    struct winsize size = {0};
    const char *said = getenv("COLUMNS");
    int columns = USUAL;
    if (ioctl(output, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        columns = size.ws_col;
    } else if (said && atoi(said) > 0) {
        columns = atoi(said);
    }
    return columns < LEAST ? LEAST : columns > MOST ? MOST : columns;
}

int hn_terminal_columns(void) {
    return columns_of(STDOUT_FILENO);
}

static int limit_of(int output) {
    const char *said = getenv("COLUMNS");
    const bool known = isatty(output) || (said && atoi(said) > 0);
    return known && !wide ? columns_of(output) : 0;
}

int hn_terminal_limit(void) {
    return limit_of(STDOUT_FILENO);
}

int hn_terminal_prose(void) {
    return wide ? 0 : hn_terminal_columns();
}

int hn_terminal_error_limit(void) {
    return limit_of(STDERR_FILENO);
}

/// Returns whether the terminal is known, and its description says that it has colours.
static bool has_colours(const char *term) {
    int known = 0;
    bool has = false;
    if (term && term[0] && setupterm(term, STDOUT_FILENO, &known) == OK) {
        has = tigetnum("colors") > 0;
        del_curterm(cur_term);
    }
    return has;
}

bool hn_terminal_colours(void) {
    const char *no = getenv("NO_COLOR");
    return isatty(STDOUT_FILENO) && !(no && no[0]) && has_colours(getenv("TERM"));
}
