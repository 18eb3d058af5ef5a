// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/line_break.h"

#include <ctype.h>
#include <string.h>

/// Returns whether text begins with a unit, with a prefix or without, that no letter follows.
static bool begins_with_unit(const char *text) {
    static const char *const prefixes[] = {"", "n", "µ", "m", "k", "M", "G"};
    static const char *const units[] = {"m", "s", "J", "N", "W", "rad", "Hz", "kg", "%", "1/s"};
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        const size_t n = strlen(prefixes[i]);
        if (strncmp(text, prefixes[i], n) != 0) {
            continue;
        }
        for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
            const size_t m = strlen(units[k]);
            if (strncmp(text + n, units[k], m) == 0 && !isalnum((unsigned char)text[n + m])) {
                return true;
            }
        }
    }
    return false;
}

bool hn_line_may_break(const char *text, size_t at) {
    const bool number = at > 0 && isdigit((unsigned char)text[at - 1]);
    const bool before_sign = text[at + 1] == '=' && text[at + 2] == ' ';
    const bool behind_sign = at > 1 && text[at - 1] == '=' && text[at - 2] == ' ';
    return !before_sign && !behind_sign && !(number && begins_with_unit(text + at + 1));
}
