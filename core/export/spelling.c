// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_DENOMINATOR = 24 }; // of the fractions that inertias of simple bodies bring
/// Digits of a number in a formula to read. What follows is rounding of our own, by which numbers
/// that are one differ; the sheets of all scenes still give their terms to 1e-11.
enum { MOST_READ = 14 };

/// Writes a number that is a fraction to the last bit, 1/3, as one; false where it is none.
static bool put_fraction(hn_strbuf *b, const hn_language *language, double value) {
    char above[16], below[16];
    for (int d = 3; d <= LARGEST_DENOMINATOR && fabs(value) < 1000; d++) {
        const double n = round(fabs(value) * d);
        if (n >= 1 && n / d == fabs(value) && round(1000 * value) != 1000 * value) {
            snprintf(above, sizeof above, "%.0f", n);
            snprintf(below, sizeof below, "%d", d);
            hn_strbuf_add(b, value < 0 ? "-" : "");
            hn_code_fill(b, language->fraction, (const char *[]){above, below});
            return true;
        }
    }
    return false;
}

void hn_code_number(hn_strbuf *b, const hn_language *language, double value) {
    char text[40];
    if (language->fraction && put_fraction(b, language, value)) {
        return;
    }
    // the fewest digits that give the value again; in a formula to read no more than count, and no
    // power of ten where a number of few digits needs none
    const bool is_plain = fabs(value) >= 1e-3 && fabs(value) < 1e6;
    const int most = language->fraction ? MOST_READ : 17;
    for (int digits = 1; digits <= most; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value && !(is_plain && strchr(text, 'e'))) {
            break;
        }
    }
    char *const e = language->power ? strchr(text, 'e') : NULL;
    if (e) {
        // the power of ten as a number of its own, without its sign of plus and leading zeros
        *e = '\0';
        char exponent[16];
        snprintf(exponent, sizeof exponent, "%d", atoi(e + 1));
        hn_code_fill(b, language->power, (const char *[]){text, exponent});
        return;
    }
    hn_strbuf_add(b, text);
    if (language->needs_point && !strpbrk(text, ".e")) {
        hn_strbuf_add(b, ".0");
    }
}

void hn_code_given(hn_strbuf *b, const hn_language *language, double value) {
    if (!language->given) {
        hn_code_number(b, language, value);
        return;
    }
    char text[40];
    snprintf(text, sizeof text, "%.6g", value);
    char *const e = strchr(text, 'e');
    if (!e) {
        hn_code_fill(b, language->given, (const char *[]){text});
        return;
    }
    *e = '\0';
    char exponent[16];
    snprintf(exponent, sizeof exponent, "%d", atoi(e + 1));
    hn_code_fill(b, language->power, (const char *[]){text, exponent});
}

/// Returns whether `word` is among the words of `list`.
static bool lists(const char *list, const char *word) {
    const size_t n = strlen(word);
    for (const char *at = list; (at = strstr(at, word)) != NULL; at += n) {
        const bool begins = at == list || at[-1] == ' ', ends = at[n] == ' ' || at[n] == '\0';
        if (begins && ends) {
            return true;
        }
    }
    return false;
}

void hn_code_name(hn_strbuf *b, const hn_language *language, const char *name) {
    char whole[128];
    snprintf(whole, sizeof whole, "%s%s", name, lists(language->reserved, name) ? "_" : "");
    if (language->put_name) {
        language->put_name(b, whole);
    } else {
        hn_strbuf_add(b, whole);
    }
}

void hn_code_words(hn_strbuf *b, const hn_language *language, const char *words) {
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    for (; *words; words++) {
        const unsigned char c = (unsigned char)*words;
        const char kept[2] = {(char)(c < 32 || c == 127 ? ' '
                                     : c == '"'         ? '\''
                                     : c == '\\'        ? '/'
                                                        : c),
                              0};
        hn_strbuf_add(&plain, kept);
    }
    if (language->put_words) {
        language->put_words(b, hn_strbuf_text(&plain));
    } else {
        hn_strbuf_add(b, hn_strbuf_text(&plain));
    }
    b->failed |= plain.failed;
    hn_strbuf_reset(&plain);
}

void hn_code_fill(hn_strbuf *b, const char *form, const char *const *texts) {
    for (const char *c = form; *c; c++) {
        if (*c == '#' && isdigit((unsigned char)c[1])) {
            hn_strbuf_add(b, texts[*++c - '1']);
        } else {
            hn_strbuf_add_n(b, c, 1);
        }
    }
}
