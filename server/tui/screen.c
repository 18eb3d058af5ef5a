// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/screen.h"

#include "base/base64.h"
#include "base/clock.h"
#include "base/hash.h"
#include "cli/shell/plain.h"
#include "terminal/keys.h"
#include "tui/cursor_keys.h"
#include "tui/foreground.h"
#include "tui/screen_colours.h"

#include <math.h>
#include <ncurses.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

enum { MOST_EVENTS = 16, SUSPEND = 26 /* Ctrl-Z */ };

/// Question whether the terminal is well, its answer, and the key that stands for it.
static const char QUESTION[] = "\033[5n", ANSWER[] = "\033[0n";
/// Beginnings of answers about pictures, and keys that stand for them.
static const char NAME[] = "\033[?", PIXELS[] = "\033[4;", GRAPHICS[] = "\033_G";
static const char BACKGROUND[] = "\033]11;";
enum { KEY_ANSWER = KEY_MAX + 1, KEY_NAME, KEY_PIXELS, KEY_GRAPHICS, KEY_BACKGROUND };
/// How long the byte after an Escape is waited for: where the user alone writes, where an answer is
/// expected, and from a terminal that has answered before; then between the bytes of an answer that
/// has begun. A busy machine may hand them over one by one.
enum { ESCAPE = 27, ESCAPE_MS = 25, ANSWER_MS = 300, KNOWN_MS = 1000, BEGUN_MS = 2000 };

static const double UNKNOWN = 8.0;  // [s] a terminal that is silent so long does not answer at all
static const double SPARSE = 0.5;   // [s] to the second picture until that is known; then doubled
static const double LOST = 10.0;    // [s] an answer that comes later is not waited for
static const double FAREWELL = 1.5; // [s] for the last answer, or the shell would read it

static struct {
    bool open, colours, have_modes, mouse;
    struct termios modes; ///< of the terminal before
    pid_t parent;         ///< who started this program
    hn_mouse events[MOST_EVENTS];
    int n_mouse; ///< events that are still to be handed out

    // pictures wait until the terminal has read the one before
    bool asks, asked, answers, early; ///< early: the question before the first picture is open
    double early_at;                  ///< [s] when that was asked
    double first_asked, asked_at;     ///< [s]
    uint64_t shown;                   ///< hash of the last picture
    bool with_sequence;               ///< the last picture had one
    double delay;                     ///< [s] of the last picture with a sequence
    double pause;                     ///< [s] to the next one, while it is not known

    // questions about pictures
    int questions; ///< of those that end in the name: still unanswered
    double questioned_at;
    bool parted; ///< an Escape came alone while an answer is expected: its rest may follow
    char answer[128];
    const char *farewell; ///< before the terminal is left
    char back[256];       ///< sequences that put the terminal back
} screen;

// ---- leaving the terminal as it was ----

static const int FATAL[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV,
                            SIGBUS, SIGABRT, SIGFPE, SIGILL,  SIGPIPE};
enum { N_FATAL = sizeof FATAL / sizeof *FATAL };

/// Reads to the end of an answer that is on its way, or the shell would take it for typed keys.
static void swallow_answer(void) {
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    char c = '\0';
    bool more = true;
    while (more && (screen.questions > 0 || c != ANSWER[sizeof ANSWER - 2])) {
        more = poll(&input, 1, ANSWER_MS) > 0 && read(STDIN_FILENO, &c, 1) == 1;
    }
}

/// Prepares the sequences that undo the modes set by ncurses: keys, colours, the cursor, the other
/// screen with the title of the window. Made beforehand, as a handler of signals may not ask for
/// it.
static void prepare_restoring(void) {
    static const char *const names[] = {"rmkx", "sgr0", "op", "cnorm", "rmcup"};
    size_t n = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *at = tigetstr(names[i]);
        at = at && at != (char *)-1 ? at : "";
        while (*at && n + 2 < sizeof screen.back) {
            const char *end = strncmp(at, "$<", 2) == 0 ? strchr(at, '>') : NULL;
            if (end) { // a pause for a slow terminal
                at = end + 1;
            } else {
                screen.back[n++] = *at++;
            }
        }
    }
    screen.back[n] = '\r';
    screen.back[n + 1] = '\0';
}

/// Only calls that a signal may interrupt: writes the sequences that ncurses would have written.
static void restore_and_die(int number) {
    static const char no_mouse[] = "\033[?1000l\033[?1002l\033[?1006l";
    const char *farewell = screen.farewell ? screen.farewell : "";
    const ssize_t ignored = write(STDOUT_FILENO, farewell, strlen(farewell)) +
                            write(STDOUT_FILENO, no_mouse, screen.mouse ? strlen(no_mouse) : 0) +
                            write(STDOUT_FILENO, screen.back, strlen(screen.back));
    (void)ignored;
    if ((screen.asked && screen.answers) || screen.questions > 0) {
        swallow_answer();
    }
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

// ---- no picture before the last one has arrived ----

/// Asks after a picture; the answer comes once the terminal has read all of it, however slow the
/// line and whatever lies between.
static void ask_terminal(void) {
    if (screen.asks && !screen.asked) {
        put_sequence(QUESTION);
        screen.asked = true;
        screen.asked_at = hn_clock_wall();
        screen.first_asked = screen.first_asked > 0 ? screen.first_asked : screen.asked_at;
    }
}

static void take_answer(void) {
    screen.answers = true;
    if (screen.early) {
        screen.early = false;
        return;
    }
    screen.asked = false;
    screen.delay = screen.with_sequence ? hn_clock_wall() - screen.asked_at : screen.delay;
}

/// Asks before the first picture: over a slow line that picture is long under way, and others would
/// queue up behind it until it is known that this terminal answers.
static void ask_early(void) {
    if (screen.asks) {
        put_sequence(QUESTION);
        screen.early = true;
        screen.early_at = hn_clock_wall();
    }
}

double hn_screen_delay(void) {
    return screen.delay;
}

// ---- questions about pictures ----

/// The rest of an answer that began with a key of ours, up to its end: a letter, or of a string
/// ESC \ or BEL.
static void read_answer(const char *begin, bool string) {
    size_t n = (size_t)snprintf(screen.answer, sizeof screen.answer, "%s", begin);
    bool ended = false;
    while (!ended) {
        timeout(BEGUN_MS);
        const int key = getch();
        if (key == ERR || key > 0xff) {
            break;
        }
        const bool closed = key == '\a' || (key == '\\' && screen.answer[n - 1] == '\033');
        ended = string ? closed : key >= 0x40 && key <= 0x7e;
        if (n + 1 < sizeof screen.answer) {
            screen.answer[n++] = (char)key;
            screen.answer[n] = '\0';
        }
    }
}

/// Returns whether the key is the second byte of an answer whose Escape came alone, which is then
/// read.
static bool take_parted_answer(int key) {
    if (key == ERR) {
        return false; // its rest is still under way
    }
    const bool follows = screen.parted && (key == '[' || key == ']' || key == '_');
    screen.parted = key == ESCAPE && (screen.questions > 0 || screen.early || screen.asked);
    if (!follows) {
        return false;
    }

    const char begin[] = {ESCAPE, (char)key, '\0'};
    read_answer(begin, key != '[');
    if (strcmp(screen.answer, ANSWER) == 0) {
        take_answer();
    } else if (strncmp(screen.answer, NAME, sizeof NAME - 1) == 0) {
        screen.questions -= screen.questions > 0;
    }
    return true;
}

/// Returns whether the key begins an answer about pictures, which is then read.
static bool take_picture_answer(int key) {
    if (key == KEY_NAME) {
        read_answer(NAME, false);
        screen.questions -= screen.questions > 0;
    } else if (key == KEY_PIXELS) {
        read_answer(PIXELS, false);
    } else if (key == KEY_GRAPHICS) {
        read_answer(GRAPHICS, true);
    } else if (key == KEY_BACKGROUND) {
        read_answer(BACKGROUND, true);
    } else if (!take_parted_answer(key)) {
        return false;
    }
    screen.questioned_at = hn_clock_wall(); // it answers, however slowly
    return true;
}

void hn_screen_ask(const char *question) {
    if (screen.asks) {
        put_sequence(question);
        screen.questions += question[strlen(question) - 1] == 'c';
        screen.questioned_at = hn_clock_wall();
    }
}

const char *hn_screen_answer(void) {
    return screen.answer;
}

void hn_screen_farewell(const char *sequence) {
    screen.farewell = sequence;
}

/// Bytes of an answer may come one by one over a slow line; an Escape of the user is waited for no
/// longer than needed.
static void choose_patience(void) {
    if (screen.questions > 0 && hn_clock_wall() - screen.questioned_at > UNKNOWN) {
        screen.questions = 0;
    }
    const bool known = screen.answers && screen.asked;
    set_escdelay(known ? KNOWN_MS : screen.questions > 0 ? ANSWER_MS : ESCAPE_MS);
}

bool hn_screen_ready(void) {
    // while it is not known whether the terminal answers
    static double drawn = 0; // [s]
    const double now = hn_clock_wall();
    if (!screen.asked) {
        return true;
    }

    // an answer is on its way, or was lost
    if (screen.answers) {
        screen.asked = now - screen.asked_at < LOST;
        return !screen.asked;
    }

    // a terminal that never answers is not asked again
    if (now - screen.first_asked < UNKNOWN &&
        now - fmax(drawn, screen.first_asked) < screen.pause) {
        return false;
    }
    drawn = now;
    screen.pause *= 2;
    return true;
}

/// The last answer is read here rather than by the shell.
static void await_answer(double seconds) {
    const double end = hn_clock_wall() + seconds;
    // the first question too, while it is not known that the terminal answers none
    const bool early = screen.early && hn_clock_wall() - screen.early_at < UNKNOWN;
    while (((screen.asked && screen.answers) || (early && screen.early) || screen.questions > 0) &&
           hn_clock_wall() < end) {
        timeout(20);
        const int key = getch();
        if (key == KEY_ANSWER) {
            take_answer();
        } else {
            take_picture_answer(key);
        }
    }
}

/// Ctrl-Z is a key here: the line is quiet before the shell has the terminal.
static void suspend(void) {
    await_answer(FAREWELL);
    screen.asked = screen.asked && !screen.answers;
    hn_foreground_stop();
}

/// A sequence that no key is known for is one key without a meaning, not an Escape and letters.
/// Returns whether Escape was the begin of one, which is read to its end.
static bool skip_sequence(void) {
    timeout(0);
    int key = getch();
    const bool asked = screen.questions > 0 || screen.early || screen.asked;
    if (asked && (key == '[' || key == ']' || key == '_')) {
        screen.parted = true; // it may be an answer that comes in parts
        return take_parted_answer(key);
    }
    if (key != '[' && key != 'O') {
        if (key != ERR) {
            ungetch(key);
        }
        return false;
    }
    do {
        key = getch();
    } while (key >= ' ' && key < '@');
    return true;
}

static void prepare_asking(void) {
    // only where sequences are those of ANSI
    const char *move_cursor = tigetstr("cup");
    screen.asks = move_cursor && move_cursor != (char *)-1 && strncmp(move_cursor, "\033[", 2) == 0;
    if (screen.asks) {
        hn_cursor_keys_define();
    }
    define_key(ANSWER, KEY_ANSWER);
    define_key(NAME, KEY_NAME);
    define_key(PIXELS, KEY_PIXELS);
    define_key(GRAPHICS, KEY_GRAPHICS);
    define_key(BACKGROUND, KEY_BACKGROUND);

    // the terminal sends Ctrl-Z as a character
    struct termios modes;
    if (tcgetattr(STDIN_FILENO, &modes) == 0) {
        modes.c_cc[VSUSP] = _POSIX_VDISABLE;
        tcsetattr(STDIN_FILENO, TCSANOW, &modes);
        def_prog_mode();
    }
}

void hn_screen_close(void) {
    if (screen.open) {
        screen.open = false;
        await_answer(FAREWELL);
        if (screen.farewell) {
            put_sequence(screen.farewell);
        }
        if (screen.mouse) {
            put_sequence(MOVES_OFF);
        }
        endwin();
    }
}

void hn_screen_set_theme(int theme) {
    if (screen.colours) {
        hn_screen_colours_make(theme);
        clearok(curscr, TRUE);
    }
}

bool hn_screen_open(int theme, bool colours) {
    // a shell that is killed takes the terminal back: modes are set all the same
    screen.parent = getppid();
    signal(SIGTTOU, SIG_IGN);
    screen.have_modes = tcgetattr(STDIN_FILENO, &screen.modes) == 0;
    // a fresh description of the terminal, with names that are not of the standard, rather than
    // initscr(), which ends the program where there is none
    use_extended_names(TRUE);
    SCREEN *made = newterm(NULL, stdout, stdin);
    if (!made) {
        return false;
    }
    screen.open = true;
    screen.pause = SPARSE;
    prepare_restoring();
    atexit(hn_screen_close);
    watch_signals();
    hn_foreground_watch();
    screen.colours = colours && has_colors();
    if (screen.colours) {
        hn_screen_colours_make(theme);
    }

    // keys one by one and unseen; an escape is not waited for
    set_escdelay(ESCAPE_MS);
    cbreak();
    noecho();
    // characters that are moved would take pixels over them along
    idcok(stdscr, FALSE);
    keypad(stdscr, TRUE);
    curs_set(0);
    mousemask(BUTTON1_PRESSED | BUTTON1_RELEASED | REPORT_MOUSE_POSITION, NULL);
    mouseinterval(0);
    prepare_asking();
    ask_early();
    screen.mouse = has_mouse();
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

void hn_screen_pixels(int *width, int *height) {
    struct winsize size = {0};
    *width = *height = 0;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) {
        *width = size.ws_xpixel;
        *height = size.ws_ypixel;
    }
}

// ---- showing ----

static attr_t attributes_of(const hn_cell *cell) {
    attr_t a = A_NORMAL;
    a |= cell->style & HN_CELL_BOLD ? A_BOLD : A_NORMAL;
    a |= cell->style & HN_CELL_REVERSE ? A_REVERSE : A_NORMAL;
    return a | (screen.colours ? (attr_t)COLOR_PAIR(cell->colour + 1) : A_NORMAL);
}

/// Asks the terminal after a picture that differs from the one before.
static void ask_after(const hn_cells *c) {
    const size_t n = (size_t)c->rows * (size_t)c->columns * sizeof *c->at;
    const uint64_t hash = hn_hash_bytes(HN_HASH_START, c->at, n);
    if (hash != screen.shown || screen.with_sequence) {
        screen.shown = hash;
        ask_terminal();
    }
}

void hn_screen_rewrite(int first, int rows) {
    wredrawln(stdscr, first, rows);
}

void hn_screen_show(const hn_cells *c, bool ascii, const hn_strbuf *picture) {
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
    screen.with_sequence = picture && picture->n > 0;
    if (screen.with_sequence) {
        fwrite(picture->text, 1, picture->n, stdout);
        fflush(stdout);
    }
    ask_after(c);
}

// ---- keys ----

static int translate(int key) {
    // keys of ncurses, and control characters that stand for keys
    static const struct {
        int from, to;
    } table[] = {{KEY_LEFT, HN_KEY_LEFT},
                 {KEY_RIGHT, HN_KEY_RIGHT},
                 {KEY_UP, HN_KEY_UP},
                 {KEY_DOWN, HN_KEY_DOWN},
                 {KEY_PPAGE, HN_KEY_PAGE_UP},
                 {KEY_NPAGE, HN_KEY_PAGE_DOWN},
                 {KEY_HOME, HN_KEY_HOME},
                 {KEY_END, HN_KEY_END},
                 {KEY_BACKSPACE, HN_KEY_BACKSPACE},
                 {127, HN_KEY_BACKSPACE},
                 {8, HN_KEY_BACKSPACE},
                 {KEY_ENTER, HN_KEY_ENTER},
                 {'\n', HN_KEY_ENTER},
                 {'\r', HN_KEY_ENTER},
                 {ESCAPE, HN_KEY_ESCAPE},
                 {'\t', HN_KEY_TAB},
                 {KEY_SLEFT, HN_KEY_SHIFT_LEFT},
                 {KEY_SRIGHT, HN_KEY_SHIFT_RIGHT},
                 {KEY_F(1), '?'},
                 {KEY_RESIZE, HN_KEY_RESIZE},
                 {KEY_NAME, HN_KEY_ANSWER},
                 {21, HN_KEY_CTRL_U},
                 {23, HN_KEY_CTRL_W}};

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

/// Answers after a picture are dealt with here, and do not shorten the wait; Ctrl-Z is too, and
/// what comes back from it is as after a change of the size.
static int next_key(double seconds) {
    const double end = hn_clock_wall() + seconds;
    choose_patience();
    for (;;) {
        const double left = end - hn_clock_wall();
        timeout(left > 0 ? (int)ceil(1000 * left) : 0);
        const int key = getch();
        if (key == KEY_ANSWER) {
            take_answer();
        } else if (key == SUSPEND || hn_foreground_must_stop()) {
            suspend();
            return KEY_RESIZE;
        } else if (key != ESCAPE || !skip_sequence()) {
            return take_picture_answer(key) ? KEY_NAME : key;
        }
    }
}

int hn_screen_key(double seconds, hn_mouse *mouse) {
    if (next_mouse(mouse)) {
        return HN_KEY_MOUSE;
    }
    const int key = next_key(seconds);
    if (key == KEY_MOUSE) {
        take_mouse();
        return next_mouse(mouse) ? HN_KEY_MOUSE : HN_KEY_NONE;
    }
    if (key != ERR && key <= KEY_MAX) {
        screen.pause = SPARSE; // what is typed is seen soon
    }
    return key == ERR ? HN_KEY_NONE : translate(key);
}

void hn_screen_copy(const char *text) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_base64(&b, text, strlen(text));
    printf("\033]52;c;%s\a", hn_strbuf_text(&b));
    fflush(stdout);
    hn_strbuf_reset(&b);
}
