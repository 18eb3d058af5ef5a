// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/keys.h"

#include <string.h>

static const hn_tui_key KEYS[] = {
#define ROW(action, key, shown, means) {HN_TUI_##action, key, shown, means},
    HN_TUI_ACTIONS(ROW)
#undef ROW
};
enum { N_KEYS = sizeof KEYS / sizeof *KEYS };

int hn_tui_keys(const hn_tui_key **out) {
    *out = KEYS;
    return N_KEYS;
}

int hn_tui_key_read(const char **text) {
    static const struct {
        const char *name;
        int key;
    } names[] = {{"<Left>", HN_KEY_LEFT},
                 {"<Right>", HN_KEY_RIGHT},
                 {"<Up>", HN_KEY_UP},
                 {"<Down>", HN_KEY_DOWN},
                 {"<PageUp>", HN_KEY_PAGE_UP},
                 {"<PageDown>", HN_KEY_PAGE_DOWN},
                 {"<Home>", HN_KEY_HOME},
                 {"<End>", HN_KEY_END},
                 {"<Backspace>", HN_KEY_BACKSPACE},
                 {"<Enter>", HN_KEY_ENTER},
                 {"<Esc>", HN_KEY_ESCAPE},
                 {"<ShiftLeft>", HN_KEY_SHIFT_LEFT},
                 {"<ShiftRight>", HN_KEY_SHIFT_RIGHT},
                 {"<CtrlU>", HN_KEY_CTRL_U},
                 {"<CtrlW>", HN_KEY_CTRL_W}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const size_t n = strlen(names[i].name);
        if (strncmp(*text, names[i].name, n) == 0) {
            *text += n;
            return names[i].key;
        }
    }
    const bool named = **text == '<' && strchr(*text, '>');
    return named || **text < ' ' || **text > '~' ? 0 : *(*text)++;
}

hn_tui_action hn_tui_action_of(int key) {
    for (int i = 0; i < N_KEYS; i++) {
        if (KEYS[i].key == key) {
            return KEYS[i].action;
        }
    }
    return HN_TUI_NONE;
}
