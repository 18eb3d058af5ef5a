// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/keys.h"

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

hn_tui_action hn_tui_action_of(int key) {
    for (int i = 0; i < N_KEYS; i++) {
        if (KEYS[i].key == key) {
            return KEYS[i].action;
        }
    }
    return HN_TUI_NONE;
}
