// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/screen.h"

#include "cli/shell/plain.h"
#include "tui/keys.h"

#include <ncurses.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

enum { MOST_EVENTS = 16 };

static struct {
    bool open, colours, have_modes, mouse;
    struct termios modes; ///< of the terminal before
    pid_t parent;         ///< who started this program
    hn_mouse events[MOST_EVENTS];
    int n_mouse; ///< events that are still to be handed out
} screen;

// ---- leaving the terminal as it was ----

static const int FATAL[] = {SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGBUS,
                            SIGABRT, SIGFPE, SIGILL,  SIGPIPE};
enum { N_FATAL = sizeof FATAL / sizeof *FATAL };

/// Only calls that a signal may interrupt: writes the sequences that ncurses would have written.
static void restore_and_die(int number) {
    static const char back[] = "\033[?1000l\033[?1002l\033[?1006l\033[0m\033[?25h\033[?1049l\r";
    const ssize_t ignored = write(STDOUT_FILENO, back, sizeof back - 1);
    (void)ignored;
    if (screen.have_modes) {
        tcsetattr(STDIN_FILENO, TCSANOW, &screen.modes);
    }
    signal(number, SIG_DFL);
    raise(number);
}

static void watch_signals(void) {
    struct sigaction action = {.sa_handler = restore_and_die};
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < N_FATAL; i++) {
        sigaction(FATAL[i], &action, NULL);
    }
}

/// Moves of the mouse while a button is held are reported, or not.
static const char MOVES_ON[] = "\033[?1002h", MOVES_OFF[] = "\033[?1002l";

static void put_sequence(const char *sequence) {
    fputs(sequence, stdout);
    fflush(stdout);
}

void hn_screen_close(void) {
    if (screen.open) {
        screen.open = false;
        if (screen.mouse) {
            put_sequence(MOVES_OFF);
        }
        endwin();
    }
}

// ---- colours ----

/// The nearest of eight colours, where a terminal has no more.
static int of_eight(int colour_256) {
    const int i = colour_256 - 16, red = i / 36, green = i / 6 % 6, blue = i % 6;
    const int most = red > green ? (red > blue ? red : blue) : (green > blue ? green : blue);
    return (2 * red > most ? 1 : 0) | (2 * green > most ? 2 : 0) | (2 * blue > most ? 4 : 0);
}

static void make_colours(int theme) {
    start_color();
    use_default_colors();
    for (int i = 0; i < HN_CELL_COLOURS; i++) {
        const int colour = hn_cell_colour_256(i, theme);
        init_pair((short)(i + 1), (short)(colour < 0 || COLORS >= 256 ? colour : of_eight(colour)),
                  -1);
    }
}

bool hn_screen_open(int theme, bool colours) {
    // a shell that is killed takes the terminal back: modes are set all the same
    screen.parent = getppid();
    signal(SIGTTOU, SIG_IGN);
    screen.have_modes = tcgetattr(STDIN_FILENO, &screen.modes) == 0;
    // a fresh description of the terminal rather than initscr(), which ends the program where there
    // is none
    SCREEN *made = newterm(NULL, stdout, stdin);
    if (!made) {
        return false;
    }
    screen.open = true;
    screen.colours = colours && has_colors();
    if (screen.colours) {
        make_colours(theme);
    }

    // keys one by one and unseen; an escape is not waited for
    set_escdelay(25);
    cbreak();
    noecho();
    keypad(stdscr, TRUE);
    curs_set(0);
    mousemask(BUTTON1_PRESSED | BUTTON1_RELEASED | REPORT_MOUSE_POSITION, NULL);
    mouseinterval(0);
    screen.mouse = has_mouse();
    atexit(hn_screen_close);
    watch_signals();
    return true;
}

bool hn_screen_gone(void) {
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    const bool closed = poll(&input, 1, 0) > 0 && input.revents & (POLLHUP | POLLERR | POLLNVAL);
    return closed || getppid() != screen.parent;
}

void hn_screen_size(int *columns, int *rows) {
    getmaxyx(stdscr, *rows, *columns);
}

// ---- showing ----

static attr_t attributes_of(const hn_cell *cell) {
    attr_t a = A_NORMAL;
    a |= cell->style & HN_CELL_BOLD ? A_BOLD : A_NORMAL;
    a |= cell->style & HN_CELL_REVERSE ? A_REVERSE : A_NORMAL;
    return a | (screen.colours ? (attr_t)COLOR_PAIR(cell->colour + 1) : A_NORMAL);
}

void hn_screen_show(const hn_cells *c, bool ascii) {
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    for (int y = 0; y < c->rows; y++) {
        move(y, 0);
        for (int x = 0; x < c->columns; x++) {
            const hn_cell *cell = &c->at[y * c->columns + x];
            const char *glyph = cell->glyph[0] ? cell->glyph : " ";
            if (ascii) {
                hn_strbuf_clear(&plain);
                hn_plain_add(&plain, glyph);
                glyph = hn_strbuf_text(&plain);
            }
            attrset(attributes_of(cell));
            addstr(glyph);
        }
    }
    hn_strbuf_reset(&plain);
    refresh();
}

// ---- keys ----

static int translate(int key) {
    // keys of ncurses, and control characters that stand for keys
    static const struct {
        int from, to;
    } table[] = {
        {KEY_LEFT, HN_KEY_LEFT}, {KEY_RIGHT, HN_KEY_RIGHT},      {KEY_UP, HN_KEY_UP},
        {KEY_DOWN, HN_KEY_DOWN}, {KEY_PPAGE, HN_KEY_PAGE_UP},    {KEY_NPAGE, HN_KEY_PAGE_DOWN},
        {KEY_HOME, HN_KEY_HOME}, {KEY_END, HN_KEY_END},          {KEY_BACKSPACE, HN_KEY_BACKSPACE},
        {127, HN_KEY_BACKSPACE}, {8, HN_KEY_BACKSPACE},          {KEY_ENTER, HN_KEY_ENTER},
        {'\n', HN_KEY_ENTER},    {'\r', HN_KEY_ENTER},           {27, HN_KEY_ESCAPE},
        {'\t', HN_KEY_TAB},      {KEY_SLEFT, HN_KEY_SHIFT_LEFT}, {KEY_SRIGHT, HN_KEY_SHIFT_RIGHT},
        {KEY_F(1), '?'},         {KEY_RESIZE, HN_KEY_RESIZE}};

    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        if (table[i].from == key) {
            return table[i].to;
        }
    }
    return key >= 32 && key < 127 ? key : HN_KEY_NONE;
}

static hn_mouse mouse_of(const MEVENT *event) {
    const bool press = event->bstate & BUTTON1_PRESSED, let_go = event->bstate & BUTTON1_RELEASED;
    return (hn_mouse){event->x, event->y,
                      press    ? HN_MOUSE_PRESS
                      : let_go ? HN_MOUSE_RELEASE
                               : HN_MOUSE_MOVE};
}

/// ncurses announces events that came together once, and hands them out from the last to the first:
/// they are put on a stack, whose top is the oldest.
static void take_mouse(void) {
    MEVENT event;
    screen.n_mouse = 0;
    while (screen.n_mouse < MOST_EVENTS && getmouse(&event) == OK) {
        screen.events[screen.n_mouse++] = mouse_of(&event);
    }
}

static bool next_mouse(hn_mouse *out) {
    if (screen.n_mouse == 0) {
        return false;
    }
    *out = screen.events[--screen.n_mouse];

    // asked for at every press: a program that was suspended meanwhile has lost it
    if (out->what == HN_MOUSE_PRESS && screen.mouse) {
        put_sequence(MOVES_ON);
    }
    return true;
}

int hn_screen_key(double seconds, hn_mouse *mouse) {
    if (next_mouse(mouse)) {
        return HN_KEY_MOUSE;
    }
    timeout((int)(1000 * seconds));
    const int key = getch();
    if (key == KEY_MOUSE) {
        take_mouse();
        return next_mouse(mouse) ? HN_KEY_MOUSE : HN_KEY_NONE;
    }
    return key == ERR ? HN_KEY_NONE : translate(key);
}

void hn_screen_copy(const char *text) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *in = (const unsigned char *)text;
    const size_t n = strlen(text);
    printf("\033]52;c;");
    for (size_t i = 0; i < n; i += 3) {
        const unsigned bits = (unsigned)in[i] << 16 | (i + 1 < n ? in[i + 1] : 0u) << 8 |
                              (i + 2 < n ? in[i + 2] : 0u);
        printf("%c%c%c%c", digits[bits >> 18 & 63], digits[bits >> 12 & 63],
               i + 1 < n ? digits[bits >> 6 & 63] : '=', i + 2 < n ? digits[bits & 63] : '=');
    }
    printf("\a");
    fflush(stdout);
}
