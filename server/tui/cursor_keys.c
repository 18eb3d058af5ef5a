// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/cursor_keys.h"

#include <ncurses.h>

void hn_cursor_keys_define(void) {
    static const struct {
        char letter;
        int key;
    } moves[] = {{'A', KEY_UP},   {'B', KEY_DOWN}, {'C', KEY_RIGHT},
                 {'D', KEY_LEFT}, {'H', KEY_HOME}, {'F', KEY_END}};
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        const char normal[] = {'\033', '[', moves[i].letter, '\0'};
        const char application[] = {'\033', 'O', moves[i].letter, '\0'};
        define_key(normal, moves[i].key);
        define_key(application, moves[i].key);
    }
    static const char *const ends[] = {"\033[1~", "\033[7~", "\033[4~", "\033[8~"};
    for (int i = 0; i < 4; i++) {
        define_key(ends[i], i < 2 ? KEY_HOME : KEY_END);
    }
}
