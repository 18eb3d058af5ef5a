// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/plain.h"

#include "terminal/cells.h"
#include "terminal/spell_out.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>

// a braille cell by its rows of dots, top to bottom, whatever column they are in
enum { BRAILLE = 0x2800, BRAILLE_END = 0x28ff };

static const struct {
    const char *utf8;
    char ascii;
} LIKENESSES[] = {
    {"●", 'o'},  {"■", '#'}, {"▲", '^'},  {"▼", 'v'}, {"◆", '%'}, {"✕", '*'}, {"╳", 'X'},
    {"━", '='},  {"○", '0'}, {"□", '='},  {"△", 'A'}, {"▽", 'V'}, {"◇", '&'}, {"★", '*'},
    {"☆", '*'},  {"×", 'x'}, {"·", '.'},  {"−", '-'}, {"–", '-'}, {"—", '-'}, {"µ", 'u'},
    {"μ", 'u'},  {"°", 'd'}, {"…", '~'},  {"→", '>'}, {"←", '<'}, {"↑", '^'}, {"↓", 'v'},
    {"≤", '<'},  {"≥", '>'}, {"≈", '~'},  {"±", '~'}, {"“", '"'}, {"”", '"'}, {"‘", '\''},
    {"’", '\''}, {"│", '|'}, {"┤", '|'},  {"├", '|'}, {"─", '-'}, {"┬", '-'}, {"┴", '-'},
    {"┼", '+'},  {"┌", '+'}, {"┐", '+'},  {"└", '+'}, {"┘", '+'}, {"█", '#'}, {"▓", '+'},
    {"▒", ':'},  {"░", '.'}, {"σ", 's'},  {"λ", 'l'}, {"α", 'a'}, {"β", 'b'}, {"ω", 'w'},
    {"Φ", 'P'},  {"↗", '/'}, {"↘", '\\'}, {"▶", '>'}, {"⬡", '6'}, {"⁻", '-'}, {"⁰", '0'},
    {"¹", '1'},  {"²", '2'}, {"³", '3'},  {"⁴", '4'}, {"⁵", '5'}, {"⁶", '6'}, {"⁷", '7'},
    {"⁸", '8'},  {"⁹", '9'}, {"⇥", '|'},  {"‖", '|'}, {"⊕", '@'},
};
enum { N_LIKENESSES = sizeof LIKENESSES / sizeof *LIKENESSES };

static bool names_utf8(const char *locale) {
    for (; *locale; locale++) {
        if (strncasecmp(locale, "utf-8", 5) == 0 || strncasecmp(locale, "utf8", 4) == 0) {
            return true;
        }
    }
    return false;
}

int hn_plain_wanted(const char *lc_all, const char *lc_ctype, const char *lang) {
    const char *const said[] = {lc_all, lc_ctype, lang};
    for (int i = 0; i < 3; i++) {
        if (said[i] && said[i][0]) {
            return !names_utf8(said[i]);
        }
    }
    return 0;
}

/// Rows of the dots that are set, a bit each, top row first: bits 0..2 of a column are its upper
/// three dots, 6 and 7 the lowest.
static unsigned rows_of(unsigned dots) {
    return ((dots | dots >> 3) & 7u) | ((dots >> 6 | dots >> 7) & 1u) << 3;
}

static char like_braille(unsigned dots) {
    // by rows: none, then '\'' for the upper half, '.' for the lower, '-' for the middle, '|' where
    // three rows or more are set
    static const char by_rows[16] = {' ', '\'', '-', '\'', '-', ':', '-', '|',
                                     '.', ':',  ':', '|',  '.', '|', '|', '|'};
    return by_rows[rows_of(dots)];
}

/// Bytes of the character that begins here, 1 where it is not well formed.
static size_t length_of(const char *text) {
    const unsigned char first = (unsigned char)text[0];
    const size_t n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1;
    for (size_t i = 1; i < n; i++) {
        if (((unsigned char)text[i] & 0xc0) != 0x80) {
            return 1;
        }
    }
    return n;
}

static char like(const char *text, size_t n) {
    const unsigned char *byte = (const unsigned char *)text;
    if (n == 3) {
        const unsigned code = (byte[0] & 0x0fu) << 12 | (byte[1] & 0x3fu) << 6 | (byte[2] & 0x3fu);
        if (code >= BRAILLE && code <= BRAILLE_END) {
            return like_braille(code - BRAILLE);
        }
    }
    for (int i = 0; i < N_LIKENESSES; i++) {
        if (strlen(LIKENESSES[i].utf8) == n && memcmp(LIKENESSES[i].utf8, text, n) == 0) {
            return LIKENESSES[i].ascii;
        }
    }
    return '?';
}

/// Writes "e-10" for the "×10⁻¹⁰" that begins here. Returns the bytes of the latter; 0: none does.
static size_t read_power(const char *utf8, char out[16]) {
    static const char ten[] = "×10";
    size_t n = strlen(ten), digits = 1;
    if (strncmp(utf8, ten, n) != 0) {
        return 0;
    }
    out[0] = 'e';
    while (digits < 15 && (unsigned char)utf8[n] >= 0x80) {
        const size_t bytes = length_of(utf8 + n);
        const char c = like(utf8 + n, bytes);
        if (c != '-' && (c < '0' || c > '9')) {
            break;
        }
        out[digits++] = c;
        n += bytes;
    }
    out[digits] = '\0';
    return digits > 1 ? n : 0;
}

void hn_plain_powers(char *text) {
    char power[16], *to = text;
    for (const char *from = text; *from;) {
        const size_t n = read_power(from, power);
        if (n > 0) {
            memcpy(to, power, strlen(power));
            to += strlen(power);
            from += n;
        } else {
            *to++ = *from++;
        }
    }
    *to = '\0';
}

void hn_plain_add(hn_strbuf *b, const char *utf8) {
    char power[16];
    while (*utf8) {
        const size_t bytes = read_power(utf8, power);
        if (bytes > 0) { // two columns shorter: what stands behind it stays where it is
            hn_strbuf_printf(b, "%s  ", power);
            utf8 += bytes;
            continue;
        }
        size_t n = 0;
        while (utf8[n] && (unsigned char)utf8[n] < 0x80) {
            n++;
        }
        hn_strbuf_add_n(b, utf8, n);
        utf8 += n;
        if (*utf8 && read_power(utf8, power) == 0) {
            n = length_of(utf8);
            const char ascii = like(utf8, n);
            hn_strbuf_add_n(b, &ascii, 1);
            utf8 += n;
        }
    }
}

/// Bytes up to the end of the line, or to where two blanks stand.
static size_t field_length(const char *text) {
    size_t n = strspn(text, " ");
    while (text[n] && text[n] != '\n' && strncmp(text + n, "  ", 2) != 0) {
        n++;
    }
    return n;
}

/// Writes one field. Returns the columns that it takes more than before.
static int add_field(hn_strbuf *b, const char *utf8, size_t n) {
    hn_strbuf field, spelled;
    hn_strbuf_init(&field);
    hn_strbuf_init(&spelled);
    hn_strbuf_add_n(&field, utf8, n);
    const int columns = hn_text_columns(hn_strbuf_text(&field));
    if (field.n > 0) {
        hn_plain_powers(field.text);
    }
    hn_spell_out(&spelled, hn_strbuf_text(&field), true);
    hn_strbuf_clear(&field);
    hn_plain_add(&field, hn_strbuf_text(&spelled));
    hn_strbuf_add(b, hn_strbuf_text(&field));
    const int more = hn_text_columns(hn_strbuf_text(&field)) - columns;
    hn_strbuf_reset(&spelled);
    hn_strbuf_reset(&field);
    return more;
}

void hn_plain_text(hn_strbuf *b, const char *utf8) {
    int more = 0; // columns that the line has become longer
    while (*utf8) {
        const size_t n = field_length(utf8);
        more += add_field(b, utf8, n);
        utf8 += n;

        // the blanks behind it make up for that, but one of them stays
        const int blanks = (int)strspn(utf8, " ");
        const int kept = blanks == 0 ? 0 : blanks > more ? blanks - more : 1;
        hn_strbuf_printf(b, "%*s", kept, "");
        more -= blanks - kept;
        utf8 += blanks;
        if (*utf8 == '\n') {
            hn_strbuf_add(b, "\n");
            more = 0;
            utf8++;
        }
    }
}
