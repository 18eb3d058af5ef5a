// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/formula_frame.h"

#include "grade/parts/unit_text.h"

#include <ctype.h>
#include <string.h>

enum { MAX_KNOWN = 24 };

const char *hn_formula_behind_name(const char *text) {
    const char *equals = strchr(text, '=');
    const char *at = text + strspn(text, " \t");
    bool word = false;
    if (!equals || strchr(equals + 1, '=') || equals == at) {
        return text;
    }
    for (; at < equals; at++) {
        const unsigned char c = (unsigned char)*at;
        if (!isalnum(c) && c < 0x80 && !strchr("_\\{}()[], '\t$", c)) {
            return text; // an equation, not the name of the result
        }
        word |= isalpha(c) || c >= 0x80;
    }
    const char *formula = equals + 1 + strspn(equals + 1, " \t");
    return word && *formula ? formula : text;
}

bool hn_formula_find_unit(const char *text, size_t *at) {
    hn_unit unit;
    const size_t n = strlen(text);
    for (size_t i = *at + 1; i < n; i++) {
        if (text[i - 1] == ' ' && text[i] != ' ' && !isdigit((unsigned char)text[i]) &&
            !strchr("*/()", text[i]) && hn_unit_parse(text + i, &unit)) {
            *at = i;
            return true;
        }
    }
    return false;
}

void hn_formula_put_known(hn_strbuf *b, const char *const *names, int n) {
    for (int i = 0; i < n && i < MAX_KNOWN; i++) {
        hn_strbuf_printf(b, "%s%s", i ? ", " : "known here: ", names[i]);
    }
    hn_strbuf_add(b, n > MAX_KNOWN ? ", ..." : "");
}
