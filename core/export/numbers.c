// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/numbers.h"

#include "export/spelling.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONG_NUMBER = 10, FEWEST_USES = 3, LONGEST = 24, MOST = 1024 };

typedef struct named_number {
    char text[LONGEST];
    int uses, name; ///< name: its place in the table, 0: it has none
} named_number;

typedef struct numbers {
    int n;
    named_number of[MOST];
} numbers;

/// The letters of the number that begins here; *digits: how many of them are digits.
static size_t length_of(const char *at, int *digits) {
    size_t n = strspn(at, "0123456789");
    *digits = (int)n;
    if (n > 0 && at[n] == '.') {
        const size_t behind = strspn(at + n + 1, "0123456789");
        *digits += (int)behind;
        n += behind > 0 ? 1 + behind : 0;
    }
    return n;
}

/// The entry of a number, which is added where it is new; NULL: the table is full.
static named_number *find(numbers *all, const char *text, size_t length) {
    for (int i = 0; i < all->n; i++) {
        if (strncmp(all->of[i].text, text, length) == 0 && all->of[i].text[length] == '\0') {
            return &all->of[i];
        }
    }
    if (all->n == MOST || length >= LONGEST) {
        return NULL;
    }
    named_number *one = &all->of[all->n++];
    snprintf(one->text, sizeof one->text, "%.*s", (int)length, text);
    return one;
}

/// Goes through the formulas: counts the long numbers (out NULL), or writes the formulas with the
/// names of those that have one.
static void read_formulas(numbers *all, const char *text, hn_strbuf *out,
                          const hn_language *language, const char *prefix) {
    for (const char *at = text; *at;) {
        int digits = 0;
        size_t n = at > text && (isalnum((unsigned char)at[-1]) || at[-1] == '_')
                       ? 0
                       : length_of(at, &digits);
        named_number *one = digits >= LONG_NUMBER ? find(all, at, n) : NULL;
        if (one) {
            one->uses++;
        }
        if (out && one && one->name > 0) {
            char name[32];
            snprintf(name, sizeof name, "%.16s%d", prefix, one->name);
            hn_code_name(out, language, name);
            at += n;
            continue;
        }
        n = n > 0 ? n : 1;
        if (out) {
            hn_strbuf_add_n(out, at, n);
        }
        at += n;
    }
}

/// The heading, and a line for each number that has a name.
static void put_table(const numbers *all, hn_strbuf *out, const hn_language *language,
                      const char *prefix) {
    bool is_first = true;
    for (int i = 0; i < all->n; i++) {
        if (all->of[i].name == 0) {
            continue;
        }
        char plain[32];
        hn_strbuf name;
        hn_strbuf_init(&name);
        snprintf(plain, sizeof plain, "%.16s%d", prefix, all->of[i].name);
        hn_code_name(&name, language, plain);
        hn_strbuf_printf(out, "%s%s", is_first ? language->numbers : "", is_first ? "\n" : "");
        hn_code_fill(out, language->constant,
                     (const char *[]){hn_strbuf_text(&name), all->of[i].text});
        hn_strbuf_add(out, "\n");
        out->failed |= name.failed;
        hn_strbuf_reset(&name);
        is_first = false;
    }
}

void hn_code_name_numbers(hn_strbuf *b, size_t from, const hn_language *language,
                          const char *prefix) {
    numbers *all = calloc(1, sizeof *all);
    char *formulas = strdup(hn_strbuf_text(b) + from);
    if (!all || !formulas) {
        b->failed = true;
        free(all);
        free(formulas);
        return;
    }
    read_formulas(all, formulas, NULL, language, prefix);
    int named = 0;
    for (int i = 0; i < all->n; i++) {
        all->of[i].name = all->of[i].uses >= FEWEST_USES ? ++named : 0;
    }

    // what stands before, the table, the formulas
    if (named > 0) {
        hn_strbuf out;
        hn_strbuf_init(&out);
        hn_strbuf_add_n(&out, hn_strbuf_text(b), from);
        put_table(all, &out, language, prefix);
        read_formulas(all, formulas, &out, language, prefix);
        hn_strbuf_clear(b);
        hn_strbuf_add_n(b, hn_strbuf_text(&out), out.n);
        b->failed |= out.failed;
        hn_strbuf_reset(&out);
    }
    free(all);
    free(formulas);
}
