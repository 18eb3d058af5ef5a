// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/read_as.h"

#include "base/strbuf.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MAX_WORD = 64 };

/// Copies a formula with the names that its words stand for.
static void put_names(hn_strbuf *out, const char *at, hn_name_reader *reader, void *user) {
    char word[MAX_WORD];
    bool in_number = false;
    while (*at) {
        size_t n = 0;
        while (!in_number && (isalpha((unsigned char)at[0]) || at[0] == '_') &&
               (isalnum((unsigned char)at[n]) || at[n] == '_')) {
            n++;
        }
        if (n > 0 && n < sizeof word) {
            snprintf(word, sizeof word, "%.*s", (int)n, at);
            const char *name = reader(user, word);
            hn_strbuf_add(out, name ? name : word);
        } else {
            n += n == 0;
            hn_strbuf_add_n(out, at, n);
        }
        in_number = isdigit((unsigned char)at[n - 1]) || at[n - 1] == '.';
        at += n;
    }
}

/// The next character that is no blank, with ** as ^; steps over it.
static char next_sign(const char **at) {
    while (isspace((unsigned char)**at)) {
        (*at)++;
    }
    if (strncmp(*at, "**", 2) == 0) {
        *at += 2;
        return '^';
    }
    return **at ? *(*at)++ : 0;
}

static bool is_same_text(const char *a, const char *b) {
    char x, y;
    do {
        x = next_sign(&a);
        y = next_sign(&b);
    } while (x == y && x);
    return x == y;
}

bool hn_read_as(const char *given, const char *plain, hn_name_reader *reader, void *user, char *out,
                size_t size) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    put_names(&text, plain, reader, user);
    const char *read = hn_strbuf_text(&text);
    const bool differs = !text.failed && !is_same_text(given, read);
    snprintf(out, size, "%s", differs ? read : "");
    hn_strbuf_reset(&text);
    return differs;
}
