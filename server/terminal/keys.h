// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_KEYS_H
#define HN_TERMINAL_KEYS_H
// The keys of the workbench as one table: the loop obeys it, the menu shows it. A key that the page
// has too does the same there (web/state/keys.js); a test compares the two tables.

#include <stdbool.h>

/// Keys other than characters; the loop translates what a terminal sends to these.
enum {
    HN_KEY_LEFT = 0x110000,
    HN_KEY_RIGHT,
    HN_KEY_UP,
    HN_KEY_DOWN,
    HN_KEY_PAGE_UP,
    HN_KEY_PAGE_DOWN,
    HN_KEY_HOME,
    HN_KEY_END,
    HN_KEY_BACKSPACE,
    HN_KEY_ENTER,
    HN_KEY_ESCAPE,
    HN_KEY_TAB,
    HN_KEY_SHIFT_LEFT,
    HN_KEY_SHIFT_RIGHT,
    HN_KEY_CTRL_U, ///< clears a line that is typed
    HN_KEY_CTRL_W  ///< takes its last word away
};

#define HN_TUI_ACTIONS(X)                                          \
    X(PLAY, ' ', "Space", "play or pause")                         \
    X(NEXT, HN_KEY_RIGHT, "→", "one frame on")                     \
    X(BACK, HN_KEY_LEFT, "←", "one frame back")                    \
    X(NEXT_TEN, HN_KEY_SHIFT_RIGHT, "Shift →", "ten frames on")    \
    X(BACK_TEN, HN_KEY_SHIFT_LEFT, "Shift ←", "ten frames back")   \
    X(START, HN_KEY_BACKSPACE, "Backspace", "back to the start")   \
    X(FIRST, HN_KEY_HOME, "Home", "to the first frame")            \
    X(LAST, HN_KEY_END, "End", "to the end of the motion")         \
    X(SLOWER, '-', "-", "slower")                                  \
    X(FASTER, '=', "=", "faster")                                  \
    X(UP, HN_KEY_UP, "↑", "select the method above")               \
    X(DOWN, HN_KEY_DOWN, "↓", "select the method below")           \
    X(CYCLE, '9', "9", "select the next method")                   \
    X(HIDE, 'v', "v", "hide or show the selected method")          \
    X(PLOT, 'g', "g", "next plot: gap, error, energy")             \
    X(WHY, 'i', "i", "why: the incidents of the method")           \
    X(REACTIONS, 'r', "r", "reactions: multipliers, joint forces") \
    X(PICTURES, 'c', "c", "characters or pictures, if shown here") \
    X(STEP, 'd', "d", "type another step dt for all methods")      \
    X(PARAMETERS, 'p', "p", "change parameters")                   \
    X(METHODS, 'm', "m", "add, change or remove methods")          \
    X(SCENES, 's', "s", "choose another scene")                    \
    X(FORMULAS, 'f', "f", "formulas: the equations of motion")     \
    X(LESSONS, 't', "t", "lessons to read, exercises to answer")   \
    X(STUDY, 'w', "w", "what accuracy costs (work-precision)")     \
    X(MAP, 'b', "b", "map of stability over alpha and beta")       \
    X(BUDGET, 'e', "e", "where the error comes from")              \
    X(LINK, 'l', "l", "copy a link that opens this in the page")   \
    X(EXPORT, 'x', "x", "export: recording, programs")             \
    X(UNDO, 'z', "z", "undo the last change")                      \
    X(REDO, 'y', "y", "redo it")                                   \
    X(GLOSSARY, 'h', "h", "words: what the terms here mean")       \
    X(HELP, '?', "?", "menu: this table, Enter does it")           \
    X(QUIT, 'q', "q", "quit")

typedef enum hn_tui_action {
    HN_TUI_NONE,
#define HN_TUI_ACTION_ENUM(action, key, shown, means) HN_TUI_##action,
    HN_TUI_ACTIONS(HN_TUI_ACTION_ENUM)
#undef HN_TUI_ACTION_ENUM
        HN_TUI_N_ACTIONS
} hn_tui_action;

typedef struct hn_tui_key {
    hn_tui_action action;
    int key;
    const char *shown, *means;
} hn_tui_key;

/// The table, in the order of the help; returns how many rows.
int hn_tui_keys(const hn_tui_key **out);
/// The action of a key on the main view; HN_TUI_NONE: it has none (digits select methods).
hn_tui_action hn_tui_action_of(int key);
/// The next key of a text: a character, or a name in angle brackets, "<Enter>", "<Down>"; *text
/// moves behind it. 0: the text is over, or names no key (*text stays there).
int hn_tui_key_read(const char **text);
#endif
